// SPDX-License-Identifier: MIT OR Apache-2.0
//! Mean squares: those of the last sum, or of the last windows of a pad.

use super::{HapticVoltage, Inputs, Outputs};
use crate::support::random::Random;
use crate::support::{Bench, MILLION, check_rest, operations};
use hapticore_contract::profile::Profile;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::{Format, MAX_WIDTH};
use hapticore_hdl::signal::Signal;
use hapticore_reference::rounded::{self, Exact};

#[test]
fn mean_squares_are_the_last_sum() {
    for (seed, profile) in (0..).zip(Profile::all()) {
        let (mut bench, mut random) =
            (Bench::new(HapticVoltage::try_new(&profile).unwrap()), Random::new(seed));
        let (format, last) = (bench.block.inputs().sum, 2 * profile.demodulated() as i64);
        let mut reference = Outputs { mean_square: 0, saturated: 0 };
        for _ in 0..operations(MILLION / 3) {
            let (valid, index) = (random.below(2) as i64, last - random.below(2) as i64);
            let sum = random.word(format) >> random.below(20);
            let out = bench.clock(Inputs { clear: 0, pad: 0, valid, index, sum });
            assert_eq!(out, reference, "clock {}", bench.clock);
            if valid == 1 && index == last {
                let expected = rounded::mean_square(&profile, Exact::of(sum, format));
                let mean_square = expected.value.code(profile.formats.mean_square);
                reference = Outputs { mean_square, saturated: expected.held.into() };
            }
        }
    }
}

#[test]
fn mean_squares_of_several_windows_are_the_mean_of_the_pads_last() {
    for (seed, windows) in (0..).zip([2, 4, 64]) {
        let mut profile = Profile::bundled("small").expect("bundled");
        profile.haptic.windows = windows;
        let block = HapticVoltage::try_new(&profile).unwrap();
        let (format, last, latency) =
            (block.inputs().sum, 2 * profile.demodulated() as i64, block.latency());
        let (mut bench, mut random) = (Bench::new(block), Random::new(seed));
        let mut reference = rounded::Squares::new(&profile);
        for round in 0..20 * windows {
            let clear = i64::from(round > 0 && random.below(4 * windows) == 0);
            if clear == 1 {
                bench.clock(Inputs { clear, pad: 0, valid: 0, index: 0, sum: 0 });
                reference = rounded::Squares::new(&profile);
            }
            for pad in 0..profile.pads as i64 {
                let sum = (random.word(format) >> random.below(20)).abs();
                let mut inputs = Inputs { clear: 0, pad, valid: 1, index: last, sum };
                (0..latency).for_each(|_| {
                    bench.clock(inputs);
                    inputs.valid = 0;
                });
                let newest = rounded::mean_square(&profile, Exact::of(sum, format));
                let expected = reference.mean(&profile, pad as usize, newest);
                let mean_square = expected.value.code(profile.formats.mean_square);
                let expected = Outputs { mean_square, saturated: expected.held.into() };
                assert_eq!(
                    bench.clock(inputs),
                    expected,
                    "{windows} windows, round {round}, pad {pad}"
                );
            }
        }
    }
}

/// A bit more of the pad would double the memory.
#[test]
fn squares_are_as_many_as_windows_of_pads() {
    for (pads, bits) in [(2, 1), (4, 2), (5, 3)] {
        let mut profile = Profile::bundled("small").expect("bundled");
        (profile.pads, profile.haptic.windows) = (pads, 8);
        let block = HapticVoltage::try_new(&profile).unwrap();
        assert_eq!(block.inputs().pad, Format::unsigned(bits, 0));
        assert_eq!(block.squares.words, 8 << bits);
    }
}

fn of_windows(windows: u64) -> HapticVoltage {
    let mut profile = Profile::bundled("small").expect("bundled");
    profile.haptic.windows = windows;
    HapticVoltage::try_new(&profile).unwrap()
}

#[test]
fn latency_is_the_clocks_measured() {
    for windows in [1, 2, 4, 8, 64] {
        let mut bench = Bench::new(of_windows(windows));
        let (index, sum) = (bench.block.sums as i64 - 1, bench.block.sum.max_code() as i64);
        let inputs = Inputs { clear: 0, pad: 0, valid: 1, index, sum };
        bench.clock(inputs);
        let quiet = Inputs { valid: 0, ..inputs };
        let measured = (1..1000).find(|_| bench.clock(quiet).mean_square != 0);
        assert_eq!(measured, Some(bench.block.latency()), "clocks from the sum to its square");
    }
}

#[test]
fn mean_squares_stay_until_the_next_window() {
    for windows in [2, 4, 8] {
        let (mut bench, mut random) = (Bench::new(of_windows(windows)), Random::new(windows));
        let (index, sum) = (bench.block.sums as i64 - 1, bench.block.sum);
        for window in 0..6 * windows {
            let sum = random.word(sum).abs();
            let inputs = Inputs { clear: 0, pad: 0, valid: 1, index, sum };
            bench.clock(inputs);
            let quiet = Inputs { valid: 0, ..inputs };
            (1..bench.block.latency()).for_each(|_| _ = bench.clock(quiet));
            let out = bench.clock(quiet);
            for clock in 0..10 * windows {
                assert_eq!(bench.clock(quiet), out, "window {window}, {clock} clocks later");
            }
        }
    }
}

#[test]
fn mean_squares_that_are_run_on_are_the_same() {
    for windows in [1, 2, 4, 8] {
        let [mut clocked, mut hurried] = [0; 2].map(|_| Bench::new(of_windows(windows)));
        let mut random = Random::new(windows);
        let (index, sum) = (clocked.block.sums as i64 - 1, clocked.block.sum);
        for window in 0..10 * windows {
            let clear = i64::from(random.below(3 * windows) == 0);
            let sum = random.word(sum).abs();
            let inputs = Inputs { clear, pad: 0, valid: 1, index, sum };
            clocked.clock(inputs);
            hurried.clock(inputs);
            let with_formats = Inputs::zip(inputs, hurried.block.inputs());
            let signals = Inputs::map(with_formats, |(value, format)| Signal { value, format });
            hurried.block.run_on(&mut hurried.state, signals);
            let quiet = Inputs { clear: 0, valid: 0, ..inputs };
            let at_once = hurried.clock(quiet);
            (1..clocked.block.latency()).for_each(|_| _ = clocked.clock(quiet));
            assert_eq!(at_once, clocked.clock(quiet), "{windows} windows, window {window}");
        }
    }
}

/// A half step of a mean square has as many bits as the model has, and then one more.
#[test]
fn a_mean_square_that_cannot_be_rounded_is_refused() {
    for mut profile in Profile::all() {
        let sum = HapticVoltage::try_new(&profile).unwrap().sum;
        profile.formats.mean_square.frac = sum.frac + profile.square_shift() - MAX_WIDTH as i8;
        assert!(HapticVoltage::try_new(&profile).is_ok(), "half a step is a word");
        profile.formats.mean_square.frac -= 1;
        let refused = HapticVoltage::try_new(&profile).expect_err("half a step is no word");
        assert!(refused.to_string().contains("formats.mean_square"), "{refused}");
    }
}

#[test]
fn without_sums_there_is_no_mean_square() {
    for windows in [1, 2, 64] {
        check_rest(of_windows(windows), &["valid"]);
    }
}
