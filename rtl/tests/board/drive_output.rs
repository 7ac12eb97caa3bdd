// SPDX-License-Identifier: MIT OR Apache-2.0
//! The drive output against converters as their data sheets describe them: after each change every
//! channel has the voltage that its drive word, its wave and its slots ask for.

use crate::bench::Bench;
use crate::dac::Dac;
use crate::random::Random;
use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::Profile;
use hapticore_hdl::format::Format;
use hapticore_model::blocks::controller::Faults;
use hapticore_rtl::board::drive_output::serial::Frame;
use hapticore_rtl::board::drive_output::{self, Converter, DriveOutput, Inputs, Wave};
use std::f64::consts::TAU;

const DRIVE: Format = Format::unsigned(16, 16);
/// Clocks of a slot, and of it before the switch closes.
const SLOT: u64 = 700;
const OPEN: u64 = 60;
/// Clocks within which all of four channels are written.
const WRITTEN: u64 = 4 * 55;
const STALE: u64 = 9_000;

/// A drive output of pads in slots, with its converter.
struct Rig {
    bench: Bench<DriveOutput>,
    converter: Converter,
    dac: Dac,
    clock: u64,
    pads: u64,
    enable: i64,
    fault: i64,
    /// How often the force loop was to begin anew.
    cleared: i64,
    pulses: Vec<u64>,
    /// The bits behind a path of `TAU_CLOCKS`, of the range.
    filtered: Vec<f64>,
}

/// 96 µs at 25 MHz.
const TAU_CLOCKS: f64 = 2_400.0;

impl Rig {
    fn new([pads, parts]: [u64; 2], wave: Wave, converter: Converter) -> Rig {
        let block = DriveOutput::new([pads, parts], DRIVE, STALE, wave, converter);
        let (dac, pulses) = (Dac::new(), vec![0; pads as usize]);
        let filtered = vec![0.0; pads as usize];
        Rig {
            bench: Bench::new(block),
            converter,
            dac,
            clock: 0,
            pads,
            enable: 1,
            fault: 0,
            cleared: 0,
            pulses,
            filtered,
        }
    }

    fn clock(&mut self, word: Option<(u64, i64)>) {
        let (pad, drive) = word.unwrap_or_default();
        let inputs = Inputs {
            drive_valid: word.is_some().into(),
            drive_pad: pad as i64,
            drive,
            serve: (self.clock / SLOT % self.pads) as i64,
            closed: (self.clock % SLOT >= OPEN).into(),
            enable: self.enable,
            faults: Faults { force_fault: self.fault, ..Faults::of(0) },
        };
        self.clock += 1;
        let drive_output::Outputs { dac: pins, drives_clear } = self.bench.clock(inputs);
        self.cleared += drives_clear;
        match self.converter {
            Converter::Serial(frame) => self.dac.serial(&frame, pins),
            Converter::Parallel { .. } => self.dac.parallel(pins),
            Converter::Pulses => {
                for (n, (sum, level)) in self.pulses.iter_mut().zip(&mut self.filtered).enumerate()
                {
                    let bit = pins.dac_pulses as u64 >> n & 1;
                    *sum += bit;
                    *level += (bit as f64 - *level) / TAU_CLOCKS;
                }
            }
        }
        self.dac.pins = pins;
    }

    fn wait(&mut self, clocks: u64) {
        (0..clocks).for_each(|_| self.clock(None));
    }

    /// To the given clock of the current slot, or of the next.
    fn wait_for(&mut self, at: u64) {
        self.wait((at + SLOT - self.clock % SLOT) % SLOT);
    }

    /// The voltage of each channel in codes: its magnitude with the sign of its pin.
    fn codes(&self, channels: usize) -> Vec<i64> {
        let of = |channel: usize| self.dac.voltage(channel).expect("was written");
        (0..channels).map(of).collect()
    }
}

/// The word of a level in codes of the drive: rounded half to even.
fn word(level: f64, bits: i32) -> i64 {
    let full = 2f64.powi(bits);
    let rounded = (level / 65_536.0 * full).round_ties_even();
    rounded.clamp(1.0 - full, full - 1.0) as i64
}

/// How often a channel's polarity has turned when its last slot has ended so often.
fn turns(ends: u64, turn_slots: u64) -> u64 {
    ends.div_ceil(turn_slots)
}

/// Random drive words of random pads; before each the converter has what was asked for.
fn check_square(shape: [u64; 2], turn_slots: u64, converter: Converter, bits: i32) {
    let channels = (shape[0] / shape[1]) as usize;
    let mut rig = Rig::new(shape, Wave::Square { turn_slots }, converter);
    let (mut words, mut random) = (vec![0i64; channels], Random::new(5));
    // The first word sets the converter up.
    rig.clock(Some((shape[1] - 1, 0)));
    rig.wait(2 * WRITTEN);
    for _ in 0..2_000 {
        let at = OPEN + WRITTEN + random.below(SLOT - OPEN - 2 * WRITTEN);
        rig.wait_for(at);
        let channel = random.below(channels as u64);
        let drive = match random.below(8) {
            0 => 65_535,
            1 => 0,
            _ => random.below(65_536) as i64,
        };
        words[channel as usize] = drive;
        rig.clock(Some((channel * shape[1] + shape[1] - 1, drive)));
        rig.wait(WRITTEN);
        let slots = (rig.clock - 1) / SLOT;
        let expected: Vec<i64> = (0..channels as u64)
            .map(|channel| {
                let last = (channel + 1) * shape[1] - 1;
                let ends = (slots + shape[0] - 1 - last) / shape[0];
                let sign = if turns(ends, turn_slots).is_multiple_of(2) { 1.0 } else { -1.0 };
                word(sign * words[channel as usize] as f64, bits)
            })
            .collect();
        assert_eq!(rig.codes(channels), expected, "clock {}", rig.clock);
    }
}

#[test]
fn serial_converters_get_every_word_and_turn() {
    check_square([4, 1], 1, Converter::Serial(Frame::AD5664), 16);
    check_square([4, 1], 3, Converter::Serial(Frame::AD5664), 16);
    check_square([6, 3], 2, Converter::Serial(Frame::AD5664), 16);
    // 32 bits at half the clock, one pad: a frame takes 130 clocks.
    let slow = Frame { half_clocks: 2, ..Frame::AD5668 };
    check_square([1, 1], 1, Converter::Serial(slow), 16);
}

#[test]
fn parallel_converters_get_every_word_and_turn() {
    check_square([4, 1], 1, Converter::Parallel { bits: 12 }, 12);
    check_square([2, 2], 2, Converter::Parallel { bits: 16 }, 16);
    check_square([3, 1], 1, Converter::Parallel { bits: 18 }, 18);
}

#[test]
fn a_word_is_at_the_pins_after_the_latency() {
    let mut rig = Rig::new([4, 1], Wave::Dc, Converter::Parallel { bits: 16 });
    rig.clock(Some((2, 0)));
    rig.wait(WRITTEN);
    rig.clock(Some((2, 40_000)));
    let latency = rig.bench.block.latency();
    rig.wait(latency - 1);
    assert_ne!(rig.dac.pins.dac_word, word(40_000.0, 16));
    rig.wait(1);
    assert_eq!([rig.dac.pins.dac_word, rig.dac.pins.dac_address], [word(40_000.0, 16), 2]);
}

#[test]
fn a_density_of_pulses_is_the_level() {
    const CLOCKS: u64 = 80_000;
    let mut rig = Rig::new([4, 1], Wave::Dc, Converter::Pulses);
    let words = [65_535, 12_345, 0, 1];
    (0..4).for_each(|pad| {
        rig.clock(Some((pad, words[pad as usize])));
        rig.wait(20);
    });
    let density = |word: i64| word as f64 / 65_536.0;
    let mut worst = 0.0f64;
    for run in 0..10 {
        rig.pulses.fill(0);
        for clock in 0..CLOCKS {
            // Fresh words, as frames bring them.
            rig.clock((clock % 8_000 == 0).then_some((1, 12_345)));
            for (level, word) in rig.filtered.iter().zip(words).filter(|_| run > 0) {
                worst = worst.max((level - density(word)).abs());
            }
        }
        for (sum, word) in rig.pulses.iter().zip(words) {
            let expected = density(word) * CLOCKS as f64;
            // A pin holds each of its bits for 8 clocks.
            assert!((*sum as f64 - expected).abs() < 16.0, "{sum} of {expected}");
        }
    }
    // Four channels: a bit lasts 8 clocks.
    println!("a path of 96 µs leaves {:.3} % of the range", 100.0 * worst);
    assert!(worst < 8.0 / TAU_CLOCKS && worst > 0.0, "{worst}");
}

/// The level leaves the sine by the sine's rounding and the word's only.
#[test]
fn a_sine_has_its_amplitude_and_its_period() {
    let (points, point_clocks) = (64, 50);
    let mut rig =
        Rig::new([3, 1], Wave::Sine { points, point_clocks }, Converter::Parallel { bits: 16 });
    let words = [65_535, 30_000, 7];
    rig.clock(Some((0, words[0])));
    rig.wait(10);
    (1..3).for_each(|pad| {
        rig.clock(Some((pad, words[pad as usize])));
        rig.wait(10);
    });
    rig.wait(point_clocks - rig.clock % point_clocks - 1);
    for n in 0..5 * points {
        if n % 8 == 0 {
            rig.clock(Some((0, words[0])));
        } else {
            rig.clock(None);
        }
        rig.wait(point_clocks - 1);
        // Points begin with the first clock after reset, at 0; all three are written 20 clocks later.
        let point = 1 + (rig.clock - 20) / point_clocks;
        let sine = (TAU * point as f64 / points as f64).sin();
        for (code, amplitude) in rig.codes(3).into_iter().zip(words) {
            let exact = sine * amplitude as f64;
            let off = (code as f64 - exact).abs();
            assert!(off <= 1.1, "point {n}: {code}, {exact}");
        }
    }
}

#[test]
fn every_channel_is_set_to_zero_after_reset_before_the_output_is_live() {
    for wave in [Wave::Dc, Wave::Square { turn_slots: 1 }] {
        let mut rig = Rig::new([4, 1], wave, Converter::Serial(Frame::AD5664));
        while rig.dac.updates.len() < 4 {
            assert!(rig.clock < 2 * WRITTEN, "{wave:?}");
            rig.wait(1);
        }
        assert_eq!((rig.codes(4), rig.dac.pins.dac_live), (vec![0; 4], 0), "{wave:?}");
        rig.clock(Some((1, 0)));
        while rig.dac.pins.dac_live == 0 {
            assert!(rig.clock < 4 * WRITTEN, "{wave:?}");
            rig.wait(1);
        }
        assert_eq!(rig.dac.updates.len(), 8, "{wave:?}: set up again with the first drive word");
    }
}

/// Until the output is live; how long that took.
fn until_live(rig: &mut Rig) -> u64 {
    let from = rig.clock;
    while rig.dac.pins.dac_live == 0 {
        assert!(rig.clock - from < 2 * WRITTEN, "not live");
        rig.wait(1);
    }
    rig.clock - from
}

#[test]
fn code_zero_and_pins_that_are_low_are_zero_volts() {
    for converter in [
        Converter::Pulses,
        Converter::Serial(Frame::AD5664),
        Converter::Serial(Frame::AD5668),
        Converter::Parallel { bits: 16 },
    ] {
        for wave in
            [Wave::Dc, Wave::Square { turn_slots: 1 }, Wave::Sine { points: 8, point_clocks: 9 }]
        {
            let mut rig = Rig::new([4, 1], wave, converter);
            // A converter powers up with code 0, and nothing else is ever given to one without a drive word.
            rig.wait(3 * SLOT);
            let given: Vec<_> = rig.dac.codes.iter().flatten().copied().collect();
            assert!(given.iter().all(|code| *code == 0), "{converter:?}, {wave:?}: {given:?}");
            assert_eq!(rig.pulses, [0; 4], "{converter:?}, {wave:?}: pulses");
            assert_eq!(rig.dac.pins.dac_polarity, 0, "{converter:?}, {wave:?}: polarity");
        }
    }
}

#[test]
fn a_reference_is_switched_on_before_the_first_word_and_each_time_the_output_is_on_again() {
    for frame in [Frame::AD5664R, Frame::AD5668] {
        let mut rig = Rig::new([4, 1], Wave::Dc, Converter::Serial(frame));
        rig.wait(2 * WRITTEN);
        assert_eq!((rig.dac.references, rig.dac.updates.len()), (1, 4), "{frame:?}: after reset");
        assert_eq!(rig.dac.pins.dac_live, 0, "{frame:?}: no drive word has come");
        rig.clock(Some((0, 0)));
        until_live(&mut rig);
        assert_eq!((rig.dac.references, rig.dac.updates.len()), (2, 8), "{frame:?}: the first");
        rig.enable = 0;
        rig.wait(WRITTEN);
        rig.enable = 1;
        rig.wait(2);
        assert_eq!(rig.dac.pins.dac_live, 0, "{frame:?}: not before it is set up again");
        until_live(&mut rig);
        // Zero for the channel that had a word, then the reference and all channels.
        assert_eq!((rig.dac.references, rig.dac.updates.len()), (3, 13), "{frame:?}: enabled");
    }
    let mut rig = Rig::new([4, 1], Wave::Dc, Converter::Serial(Frame::AD5664));
    rig.clock(Some((0, 0)));
    until_live(&mut rig);
    assert_eq!(rig.dac.references, 0, "an AD5664 has none: the command is reserved");
}

#[test]
fn a_fault_sets_all_channels_to_zero_and_takes_live_away_until_it_is_cleared() {
    let mut rig = Rig::new([4, 1], Wave::Dc, Converter::Serial(Frame::AD5664R));
    (0..4).for_each(|pad| rig.clock(Some((pad, 20_000))));
    until_live(&mut rig);
    rig.wait(WRITTEN);
    assert_eq!(rig.codes(4), [20_000; 4]);
    rig.fault = 1;
    rig.wait(2);
    assert_eq!(rig.dac.pins.dac_live, 0, "at once");
    rig.wait(WRITTEN);
    assert_eq!(rig.codes(4), [0; 4]);
    rig.clock(Some((1, 20_000)));
    rig.wait(WRITTEN);
    assert_eq!((rig.codes(4), rig.dac.pins.dac_live), (vec![0; 4], 0), "no word counts");
    rig.fault = 0;
    until_live(&mut rig);
    assert_eq!(rig.codes(4), [0; 4], "a word from before does not come back");
    rig.clock(Some((1, 20_000)));
    rig.wait(WRITTEN);
    assert_eq!(rig.codes(4), [0, 20_000, 0, 0]);
}

#[test]
fn live_falls_and_the_controller_is_told_when_words_are_stale() {
    let mut rig = Rig::new([4, 1], Wave::Dc, Converter::Serial(Frame::AD5664R));
    (0..4).for_each(|pad| rig.clock(Some((pad, 20_000))));
    until_live(&mut rig);
    let from = rig.clock;
    while rig.dac.pins.dac_live != 0 {
        assert!(rig.clock - from <= STALE, "live with stale words");
        rig.wait(1);
    }
    rig.wait(STALE);
    assert_eq!(rig.cleared, 1, "once, before live falls");
}

#[test]
fn words_are_stale_after_a_tenth_of_a_second_whatever_a_frame_is() {
    let mut profile = Profile::bundled("standard").expect("bundled");
    profile.control = Some(Control::of(&profile, Law::Inverse));
    let of = |settle: u64, clock_hz: u64| {
        let mut profile = profile.clone();
        profile.slot.settle = settle;
        let block = DriveOutput::of_profile(&profile, Wave::Dc, Converter::Pulses, clock_hz);
        block.map(|block| block.inputs().drive).map_err(|error| error.to_string())
    };
    let stale = |settle: u64, clock_hz: u64| {
        let mut profile = profile.clone();
        profile.slot.settle = settle;
        let block = DriveOutput::of_profile(&profile, Wave::Dc, Converter::Pulses, clock_hz);
        let mut rig = Bench::new(block.expect("a drive output"));
        let idle = Inputs { enable: 1, ..Inputs::of(0) };
        rig.clock(Inputs { drive_valid: 1, drive: 1_000, ..idle });
        // The cycle after the last in which the word counts.
        (0..).find(|_| rig.clock(idle).drives_clear != 0).expect("it comes")
    };
    let short = stale(profile.slot.settle, 25_000_000);
    assert_eq!(short, 16 * profile.slot_clocks(), "four frames of four pads");
    // Slots of 80 ms at 12.5 MHz.
    let long = stale(40_000, 12_500_000);
    assert_eq!(long, 1_250_000, "a tenth of a second");
    let error = of(4_000_000, 25_000_000).expect_err("slots of 4 s");
    assert!(error.contains("100 ms"), "{error}");
}

#[test]
fn without_drive_words_all_channels_go_to_zero_and_a_word_ends_that() {
    let mut rig = Rig::new([4, 1], Wave::Dc, Converter::Parallel { bits: 16 });
    (0..4).for_each(|pad| rig.clock(Some((pad, 20_000))));
    rig.wait(STALE - 1);
    assert_eq!((rig.codes(4), rig.cleared), (vec![20_000; 4], 0));
    rig.wait(WRITTEN);
    assert_eq!((rig.codes(4), rig.cleared), (vec![0; 4], 1), "the loop begins anew, once");
    rig.clock(Some((3, 20_000)));
    rig.wait(WRITTEN);
    assert_eq!(rig.codes(4), [0, 0, 0, 20_000]);
}

#[test]
fn a_disabled_output_is_zero_whatever_words_come() {
    let mut rig = Rig::new([2, 1], Wave::Dc, Converter::Parallel { bits: 16 });
    (0..2).for_each(|pad| rig.clock(Some((pad, 20_000))));
    rig.wait(100);
    rig.enable = 0;
    rig.wait(100);
    assert_eq!(rig.codes(2), [0; 2]);
    rig.clock(Some((1, 20_000)));
    rig.wait(100);
    assert_eq!(rig.codes(2), [0; 2]);
    rig.enable = 1;
    rig.wait(100);
    assert_eq!(rig.codes(2), [0; 2], "a word from before does not come back");
    rig.clock(Some((1, 20_000)));
    rig.wait(100);
    assert_eq!(rig.codes(2), [0, 20_000]);
}

#[test]
#[should_panic(expected = "channels need 3")]
fn a_frame_with_too_short_an_address_is_refused() {
    let frame = Frame { address_bits: 2, ..Frame::AD5664 };
    DriveOutput::new([8, 1], DRIVE, STALE, Wave::Dc, Converter::Serial(frame));
}
