// SPDX-License-Identifier: MIT OR Apache-2.0
//! A host whose clock is not the board's: how far the rates may differ, and a session at 3 %.

use crate::bench::Bench;
use crate::device::calibration;
use crate::pins::Host;
use crate::random::Random;
use crate::session::{Session, parameters, samples, simulated, small};
use hapticore_contract::profile::Profile;
use hapticore_host::Command;
use hapticore_host::startup::start;
use hapticore_rtl::board::uart::BitClocks;
use hapticore_rtl::board::uart::receiver::{self, Receiver};
use hapticore_rtl::board::uart::transmitter::{self, Transmitter};
use hapticore_rtl::board::{Parameters, Target};

/// Bytes with the longest runs of either level among them.
fn bytes() -> Vec<u8> {
    let mut random = Random::new(5);
    let any = (0..40).map(|_| random.below(256) as u8);
    [0x00, 0xff, 0x00, 0x80, 0x7f, 0x01, 0xfe, 0x55, 0xaa].into_iter().chain(any).collect()
}

/// Parts of a clock that a start bit's edge is before the clock that sees it.
fn phases() -> impl Iterator<Item = f64> {
    (0..10).map(|tenths| f64::from(tenths) / 10.0)
}

/// Whether a board with bits of these clocks hears what a host with such bits sends without a pause.
fn board_hears(bits: impl Into<BitClocks>, bit: f64) -> bool {
    let bits = bits.into();
    phases().all(|phase| {
        let mut receiver = Bench::new(Receiver::new(bits));
        let (mut host, mut heard) = (Host::with_bit(bit), Vec::new());
        host.send_early(bytes(), phase);
        for _ in 0..(bytes().len() + 2) as u64 * 11 * bits.most() {
            let outputs = receiver.clock(receiver::Inputs { rx: host.line() });
            host.clock(1);
            heard.extend((outputs.valid != 0).then_some(outputs.octet as u8));
        }
        heard == bytes()
    })
}

/// Whether a host with such bits hears what a board with bits of these clocks sends without a pause.
fn host_hears(bits: impl Into<BitClocks>, bit: f64) -> bool {
    let bits = bits.into();
    let mut transmitter = Bench::new(Transmitter::new(bits));
    let (mut host, mut left) = (Host::with_bit(bit), bytes().into_iter().peekable());
    for _ in 0..(bytes().len() + 2) as u64 * 11 * bits.most() {
        let octet = left.peek().copied();
        let valid = octet.is_some().into();
        let inputs = transmitter::Inputs { valid, octet: octet.unwrap_or(0).into() };
        let outputs = transmitter.clock(inputs);
        host.clock(outputs.tx);
        left.next_if(|_| outputs.taken != 0);
    }
    host.heard == bytes()
}

/// The largest error of a rate in steps of 0.1 % up to which, from none on, all bytes are heard.
fn limit(hears: impl Fn(f64) -> bool, sign: f64) -> f64 {
    let steps = (0..100).map(|step| sign * f64::from(step) * 1e-3);
    steps.take_while(|&error| hears(1.0 + error)).last().expect("equal rates")
}

#[test]
fn bytes_cross_the_line_both_ways_with_a_clock_three_percent_off() {
    for divisor in Target::ALL.map(|target| target.parameters().bits().least()) {
        for error in [-0.03, -0.02, -0.01, 0.0, 0.01, 0.02, 0.03] {
            let bit = divisor as f64 * (1.0 + error);
            assert!(board_hears(divisor, bit), "to the board, {divisor} clocks, {error}");
            assert!(host_hears(divisor, bit), "to the host, {divisor} clocks, {error}");
        }
    }
}

/// 25 MHz are 8⅓ clocks for each bit of 3 Mbaud: whole bits would be 4 % off.
#[test]
fn bits_of_unequal_clocks_cross_the_line_with_a_clock_two_percent_off() {
    for (clock_hz, baud) in
        [(25_000_000u64, 3_000_000u64), (25_000_000, 2_000_000), (12_000_000, 2_500_000)]
    {
        let (bits, clocks) = (BitClocks::of(clock_hz, baud), clock_hz as f64 / baud as f64);
        assert!(bits.most() == bits.least() + 1, "{bits:?}");
        assert!((bits.byte() as f64 - 10.0 * clocks).abs() <= 0.5, "{bits:?}");
        for error in [-0.02, -0.01, 0.0, 0.01, 0.02] {
            let bit = clocks * (1.0 + error);
            assert!(board_hears(bits, bit), "to the board, {baud} baud, {error}");
            assert!(host_hears(bits, bit), "to the host, {baud} baud, {error}");
        }
    }
}

/// 4,000 frames a second, each of 43 bytes.
#[test]
fn a_line_of_three_megabaud_carries_every_slot_of_the_profile_fast() {
    let profile = Profile::bundled("fast").expect("a bundled profile");
    let (calibration, samples) = (calibration(&profile), samples(&profile, 12));
    // No frame's length depends on its content: a part of the table does, in whose time the ADC is ready.
    let is_early = |command: &Command| !matches!(command, Command::Table { address: 200.., .. });
    let start: Vec<_> = start(&profile, &calibration).into_iter().filter(is_early).collect();
    let dropped = [1_000_000, 3_000_000].map(|baud| {
        let parameters = Parameters { clock_hz: 25_000_000, baud, sclk_latency: 2, drive: None };
        let mut session = Session::new(&profile, parameters, &samples);
        session.host = Host::with_bit(25_000_000.0 / baud as f64);
        session.send(&start);
        let packets = session.packets(6);
        packets.windows(2).filter(|of| of[1].status.sequence != of[0].status.sequence + 1).count()
    });
    assert!(dropped[0] > 0, "1 Mbaud is too slow for it");
    assert_eq!(dropped[1], 0);
}

/// The receiver samples the stop bit ⌊9½·D⌋ to ⌊9½·D⌋ + 1 clocks behind the start bit's edge: that
/// must be within the sender's bit from 9 to 10.
#[test]
fn rates_may_differ_until_a_stop_bit_is_missed() {
    for divisor in [4u64, 12, 25] {
        let clocks = divisor as f64;
        let looks = (9 * divisor + divisor / 2) as f64;
        let predicted = [(looks + 1.0) / (10.0 * clocks) - 1.0, looks / (9.0 * clocks) - 1.0];
        let measured =
            [-1.0, 1.0].map(|sign| limit(|bit| board_hears(divisor, clocks * bit), sign));
        let host = [-1.0, 1.0].map(|sign| limit(|bit| host_hears(divisor, clocks * bit), sign));
        println!(
            "{divisor:3} clocks a bit: the host's bits may be {:+.2} to {:+.2} % longer to be heard ({:+.2} to {:+.2} % predicted), \
             {:+.2} to {:+.2} % to hear",
            100.0 * measured[0],
            100.0 * measured[1],
            100.0 * predicted[0],
            100.0 * predicted[1],
            100.0 * host[0],
            100.0 * host[1]
        );
        // A step of the search, and the tenth of a clock between phases.
        let resolution = 1e-3 + 0.1 / (9.0 * clocks);
        for (measured, predicted) in measured.into_iter().zip(predicted) {
            assert!(
                (measured - predicted).abs() < resolution,
                "{divisor}: {measured}, {predicted}"
            );
        }
    }
}

#[test]
fn a_session_holds_with_a_host_three_percent_off() {
    let (profile, divisor) = (small(), Target::Icebreaker.parameters().bits().least());
    let (calibration, samples) = (calibration(&profile), samples(&profile, 12));
    let expected = simulated(&profile, &calibration, &samples);
    for error in [-0.03, 0.03] {
        let mut session = Session::new(&profile, parameters(&profile, divisor, 0), &samples);
        session.host = Host::with_bit(divisor as f64 * (1.0 + error));
        let commands = start(&profile, &calibration);
        session.send(&commands);
        for packet in session.packets(2) {
            assert_eq!(packet.frame, expected[usize::from(packet.status.sequence) - 1], "{error}");
            assert_eq!(packet.status.commands, commands.len() as u8 % 16, "{error}");
            assert!(!packet.status.refused, "{error}");
        }
    }
}
