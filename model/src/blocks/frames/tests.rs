// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames: their words, and what was last valid of a pad; the clocks they take.

use super::{Frames, Inputs, Outputs};
use crate::support::random::Random;
use crate::support::{Bench, MILLION, check_latency, check_rest, operations};
use hapticore_contract::frame::Field;
use hapticore_contract::profile::Profile;
use hapticore_reference::rounded::{self, Exact};

#[test]
fn frames_hold_what_was_last_valid_of_their_pad() {
    for (seed, profile) in (0..).zip(Profile::all()) {
        let (mut bench, mut random) = (Bench::new(Frames::new(&profile)), Random::new(seed));
        let mut reference = rounded::Frames::new(&profile);
        let formats = bench.block.inputs();
        for _ in 0..operations(MILLION / 3) {
            let codes = Field::ALL.map(|field| random.word(field.format(&profile)));
            let [r_x, r_y, x, y, sheet, capacitance, force, mean_square] = codes;
            let pad = random.word(formats.pad) % profile.pads as i64;
            let [invalid, lifted] = [(); 2].map(|()| random.below(2) as i64);
            let quiet = Inputs {
                start: 0,
                pad,
                invalid,
                lifted,
                r_x,
                r_y,
                x,
                y,
                sheet,
                capacitance,
                haptic_force: force,
                mean_square,
            };
            bench.clock(Inputs { start: 1, ..quiet });
            let mut words = [0; Field::ALL.len()];
            let take = |out: &Outputs<i64>| {
                if out.valid == 1 {
                    words[out.index as usize] = out.word;
                }
                out.done == 1
            };
            (0..100).map(|_| bench.clock(quiet)).find(take).expect("a frame finishes");
            let values: [Exact; 8] =
                std::array::from_fn(|k| Exact::of(codes[k], Field::ALL[k].format(&profile)));
            let expected = reference.words(pad as usize, values, [invalid == 1, lifted == 1]);
            assert_eq!(
                words, expected,
                "clock {}: got, reference of {codes:?}, invalid {invalid}, lifted {lifted}",
                bench.clock
            );
        }
    }
}

#[test]
fn latency_is_the_clocks_measured() {
    for profile in Profile::all() {
        let block = Frames::new(&profile);
        check_latency(block.clone(), block.latency());
    }
}

/// No word of the frame before comes after the start, and no end.
#[test]
fn a_frame_is_begun_anew_while_another_is_given_out() {
    let profile = Profile::bundled("standard").expect("bundled");
    let latency = Frames::new(&profile).latency();
    for clocks in 1..=latency + 1 {
        let mut bench = Bench::new(Frames::new(&profile));
        let quiet = Inputs { start: 0, ..Inputs::of(0) };
        bench.clock(Inputs { start: 1, ..quiet });
        for _ in 1..clocks {
            bench.clock(quiet);
        }
        bench.clock(Inputs { start: 1, ..quiet });
        let outputs: Vec<_> = (0..latency).map(|_| bench.clock(quiet)).collect();
        let indices = outputs.iter().filter(|out| out.valid == 1).map(|out| out.index);
        assert!(indices.eq(0..Field::ALL.len() as i64), "after {clocks} clocks");
        let done = outputs.iter().position(|out| out.done == 1);
        assert_eq!(done, Some(latency as usize - 1), "after {clocks} clocks");
    }
}

#[test]
fn without_a_start_there_is_no_frame() {
    for profile in Profile::of_distinct_words() {
        check_rest(Frames::new(&profile), &["start"]);
    }
}
