// SPDX-License-Identifier: MIT OR Apache-2.0
//! Mean squares: those of the last sum, or of the last windows of a pad.

use super::{HapticVoltage, Inputs, Outputs};
use crate::support::random::Random;
use crate::support::{Bench, MILLION, operations};
use hapticore_contract::profile::Profile;
use hapticore_hdl::format::Format;
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
