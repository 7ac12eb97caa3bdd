// SPDX-License-Identifier: MIT OR Apache-2.0
//! Samples are counted into slots.

use super::{Inputs, Multiplexer, Outputs};
use crate::support::random::Random;
use crate::support::{Bench, MILLION, operations};
use hapticore_contract::profile::Profile;

#[test]
fn samples_are_counted_into_slots() {
    for (seed, profile) in (0..).zip(Profile::all()) {
        let (mut bench, mut random) = (Bench::new(Multiplexer::new(&profile)), Random::new(seed));
        for n in 0..operations(MILLION / 3) {
            bench.clock(Inputs { strobe: 1, clear: 0 });
            let sampled = bench.clock(Inputs { strobe: 0, clear: 0 });
            for _ in 0..random.below(3) {
                let waiting = bench.clock(Inputs { strobe: 0, clear: 0 });
                assert_eq!(waiting, Outputs { sample: 0, ..sampled }, "sample {n}");
            }
            let (slot, at) = (&profile.slot, n % profile.slot.samples());
            let expected = Outputs {
                sample: 1,
                restart: (at == 0).into(),
                integrate: (at >= slot.blanking()).into(),
                first: (at == slot.blanking()).into(),
                last: (at == slot.samples() - 1).into(),
                pad: (n / slot.samples() % profile.pads) as i64,
                closed: (at >= slot.open).into(),
            };
            assert_eq!(sampled, expected, "sample {n}");
        }
    }
}
