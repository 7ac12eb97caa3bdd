// SPDX-License-Identifier: MIT OR Apache-2.0
//! Each peripheral by what its file says of it.

use crate::bench::Bench;
use crate::pins::Host;
use crate::random::Random;
use hapticore_contract::profile::Profile;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_host::Command;
use hapticore_model::blocks::core::{self, Core};
use hapticore_rtl::board::framing::END;
use hapticore_rtl::board::pads::{self, Pads};
use hapticore_rtl::board::registers::{self, CommandRegisters};
use hapticore_rtl::board::sigma_delta::{self, SigmaDelta};
use hapticore_rtl::board::uart::{receiver, transmitter};
use hapticore_rtl::board::{Board, Parameters};
use std::f64::consts::TAU;

#[test]
fn no_two_pads_are_ever_closed_nor_one_right_after_another() {
    const DEAD: u64 = 5;
    let mut bench = Bench::new(Pads::new(4, DEAD));
    let mut random = Random::new(3);
    let (mut last, mut open, mut closings) = (0, DEAD, 0);
    let (mut serve, mut closed) = (0, 0);
    for _ in 0..100_000 {
        if random.below(6) == 0 {
            (serve, closed) = (random.below(4) as i64, (random.below(3) != 0).into());
        }
        let select = bench.clock(pads::Inputs { serve, closed }).select;
        assert!(select.count_ones() <= 1, "{select:b}");
        match (last, select) {
            (_, 0) => open += 1,
            (0, _) => {
                assert!(open >= DEAD || closings == 0, "closed after {open} clocks");
                (open, closings) = (0, closings + 1);
            }
            (before, now) => assert_eq!(before, now, "one pad to the next with none between"),
        }
        last = select;
    }
    assert!(closings > 1_000);
}

#[test]
fn a_pad_closes_a_clock_after_it_is_wanted() {
    let mut bench = Bench::new(Pads::new(3, 2));
    let run: Vec<i64> =
        (0..4).map(|_| bench.clock(pads::Inputs { serve: 2, closed: 1 }).select).collect();
    assert_eq!(run, [0, 4, 4, 4]);
    assert_eq!(bench.clock(pads::Inputs { serve: 2, closed: 0 }).select, 4);
    assert_eq!(bench.clock(pads::Inputs { serve: 2, closed: 0 }).select, 0);
}

#[test]
fn the_bits_of_a_carrier_sum_to_it() {
    let carrier = Format::signed(16, 15);
    let mut bench = Bench::new(SigmaDelta::new(carrier));
    let (mut wanted, mut given, mut worst) = (0.0, 0.0, 0.0f64);
    let full = [i64::from(i16::MIN), i64::from(i16::MAX)];
    for clock in 0..60_000 {
        let code = match clock / 20_000 {
            0 => (32_000.0 * (TAU * f64::from(clock / 24) / 5.0).cos()) as i64,
            1 => full[clock as usize / 100 % 2],
            _ => 12_345,
        };
        wanted += (carrier.real(code) + 1.0) / 2.0;
        bench.clock(sigma_delta::Inputs { carrier: code });
        // The bit that belongs to this clock comes with the next.
        given += bench.block_output();
        worst = worst.max((wanted - given).abs());
    }
    println!("sums differ by at most {worst:.3} of a bit");
    assert!(worst < 1.0 && worst > 0.5, "{worst}");
}

/// A carrier of zero has a pulse every other clock. The first sum is half of full scale.
#[test]
fn the_bits_of_a_carrier_begin_with_none_and_nothing_left() {
    let mut bench = Bench::new(SigmaDelta::new(Format::signed(16, 15)));
    let pulses = [0; 6].map(|carrier| bench.clock(sigma_delta::Inputs { carrier }).pulse);
    assert_eq!(pulses, [0, 0, 1, 0, 1, 0]);
}

impl Bench<SigmaDelta> {
    /// The output register, which a clock has just replaced.
    fn block_output(&self) -> f64 {
        self.registers().pulse as f64
    }
}

#[test]
fn a_glitch_is_no_byte_and_a_break_is_one_end() {
    let mut receiver = Bench::new(receiver::Receiver::new(12));
    let mut heard = Vec::new();
    let mut hear = |rx: i64, clocks: u64| {
        for _ in 0..clocks {
            let outputs = receiver.clock(receiver::Inputs { rx });
            heard.extend((outputs.valid != 0).then_some(outputs.octet));
        }
        heard.len()
    };
    assert_eq!([hear(1, 50), hear(0, 4), hear(1, 200)], [0; 3], "shorter than half a start bit");
    assert_eq!([hear(0, 130), hear(1, 100)], [1; 2], "no stop bit");
    assert_eq!([hear(0, 12), hear(1, 96), hear(0, 9_000), hear(1, 100)], [1, 1, 2, 2], "a break");
    assert_eq!([hear(0, 12), hear(1, 200)], [2, 3], "and then a byte");
    assert_eq!(heard, [i64::from(END), i64::from(END), 0xff]);
}

#[test]
fn a_line_at_rest_is_no_byte_and_a_transmitter_at_rest_leaves_it_high() {
    let mut receiver = Bench::new(receiver::Receiver::new(12));
    let mut transmitter = Bench::new(transmitter::Transmitter::new(7));
    for clock in 0..200 {
        let outputs = receiver.clock(receiver::Inputs { rx: 1 });
        assert_eq!((outputs.valid, outputs.octet), (0, 0), "clock {clock}");
        let outputs = transmitter.clock(transmitter::Inputs { valid: 0, octet: 0x55 });
        assert_eq!((outputs.taken, outputs.tx), (0, 1), "clock {clock}");
    }
}

/// Three clocks after the middle of the stop bit: two of the pin, and that of the register.
#[test]
fn a_byte_is_heard_in_the_middle_of_its_stop_bit_for_one_clock() {
    const BIT: usize = 12;
    let mut receiver = Bench::new(receiver::Receiver::new(BIT as u64));
    for byte in [0x5a, 0xff, 0x00, 0x81] {
        let line = |clock: usize| (byte << 1 | 0x200) >> (clock / BIT).min(9) & 1;
        let heard: Vec<_> = (0..11 * BIT)
            .filter_map(|clock| {
                let outputs = receiver.clock(receiver::Inputs { rx: line(clock) });
                (outputs.valid != 0).then_some((clock, outputs.octet))
            })
            .collect();
        assert_eq!(heard, [(9 * BIT + BIT / 2 + 3, byte)]);
    }
}

#[test]
fn the_transmitter_is_heard_and_takes_a_byte_each_ten_bits() {
    let mut transmitter = Bench::new(transmitter::Transmitter::new(7));
    let mut host = Host::new(7);
    let mut taken = Vec::new();
    for clock in 0..1_000u64 {
        let outputs = transmitter
            .clock(transmitter::Inputs { valid: 1, octet: taken.len() as i64 * 37 % 256 });
        host.clock(outputs.tx);
        if outputs.taken != 0 {
            taken.push(clock);
        }
    }
    assert!(
        taken.windows(2).all(|pair| pair[1] - pair[0] == 71),
        "ten bits of seven clocks, and one to take it"
    );
    let expected: Vec<u8> = (0..host.heard.len()).map(|k| (k * 37 % 256) as u8).collect();
    assert_eq!(host.heard, expected);
    assert!(expected.len() >= 13);
}

#[test]
fn a_board_that_cannot_be_says_what_was_expected() {
    let profile = Profile::bundled("standard").expect("bundled");
    let board = Parameters { clock_hz: 25_000_000, baud: 1_000_000, sclk_latency: 3, drive: None };
    assert!(Board::new(&profile, &board).is_ok());
    for (parameters, words) in [
        (Parameters { baud: 20_000_000, ..board }, "baud: expected 381 to 6250000, got 20000000"),
        (Parameters { clock_hz: 1, ..board }, "clock_hz: expected 1000000 to 200000000, got 1"),
        (Parameters { sclk_latency: 16, ..board }, "sclk_latency: expected 0 to 15, got 16"),
        (Parameters { clock_hz: 100_000_000, ..board }, "clocks from a conversion"),
    ] {
        let Err(error) = Board::new(&profile, &parameters) else { panic!("{words}") };
        assert!(error.to_string().contains(words), "{error}");
    }
}

#[test]
fn strobes_that_come_closer_than_the_profile_s_are_told_until_the_slot_is_abandoned() {
    for profile in Profile::all() {
        let clocks = profile.clocks_per_sample;
        let core = Core::new(&profile);
        let quiet = core::Inputs::map(core.inputs(), |_| 0);
        let mut bench = Bench::new(core);
        let strobe = |bench: &mut Bench<Core>, clocks: u64| -> i64 {
            bench.clock(core::Inputs { strobe: 1, ..quiet });
            (1..clocks).map(|_| bench.clock(quiet).overrun).max().expect("clocks")
        };
        assert_eq!((0..50).map(|_| strobe(&mut bench, clocks)).max(), Some(0), "{}", profile.name);
        strobe(&mut bench, clocks - 1);
        assert_eq!(strobe(&mut bench, clocks), 1, "{}: a clock too early", profile.name);
        assert_eq!(strobe(&mut bench, clocks), 1, "it stays");
        bench.clock(core::Inputs { clear: 1, ..quiet });
        assert_eq!(strobe(&mut bench, clocks), 0, "and is cleared");
    }
}

#[test]
fn every_command_is_taken() {
    let profile = Profile::bundled("small").expect("bundled");
    let core = Core::new(&profile).inputs();
    let mut bench = Bench::new(CommandRegisters::new(core.calibration, 100, None));
    let mut random = Random::new(9);
    for count in 1..2_000 {
        let (address, code) = (random.below(100) as u16, random.word(core.calibration.table.word));
        let mut written = None;
        let bytes = Command::Table { address, code }.encode(&profile);
        for byte in bytes.iter().map(|&byte| Some(byte)).chain([None]) {
            let (valid, octet) = (byte.is_some().into(), byte.unwrap_or(0).into());
            let outputs = bench.clock(registers::Inputs { valid, octet, shift: 0, answer: 0 });
            assert_eq!(outputs.refused, 0, "{count}: {bytes:x?}");
            if outputs.table.write != 0 {
                assert_eq!(written, None, "{count}: once");
                written = Some((outputs.table.address as u16, outputs.table.word));
            }
        }
        assert_eq!(written, Some((address, code)), "{count}: {bytes:x?}");
    }
}

#[test]
fn registers_are_zero_until_a_command_and_what_is_none_is_refused_for_one_clock() {
    let profile = Profile::bundled("small").expect("bundled");
    let core = Core::new(&profile).inputs();
    let mut bench = Bench::new(CommandRegisters::new(core.calibration, 100, None));
    let quiet = registers::Inputs { valid: 0, octet: 0x55, shift: 0, answer: 1 };
    for clock in 0..50 {
        registers::Outputs::each(bench.clock(quiet), |field, code| {
            assert_eq!(code, 0, "{} in clock {clock}", field.name);
        });
    }
    for _ in 0..3 {
        for octet in [1, END.into()] {
            assert_eq!(bench.clock(registers::Inputs { valid: 1, octet, ..quiet }).refused, 0);
        }
        assert_eq!([0; 3].map(|_| bench.clock(quiet).refused), [1, 0, 0]);
    }
}
