// SPDX-License-Identifier: MIT OR Apache-2.0
//! Samples are counted into slots.

use super::{Inputs, Multiplexer, Outputs};
use crate::support::random::Random;
use crate::support::{Bench, MILLION, operations};
use hapticore_contract::profile::Profile;
use hapticore_hdl::bundle::Bundle;

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
            assert_eq!(sampled, of_sample(&profile, n), "sample {n}");
        }
    }
}

/// The outputs of the sample of this number since the beginning.
fn of_sample(profile: &Profile, n: u64) -> Outputs<i64> {
    let (slot, at) = (&profile.slot, n % profile.slot.samples());
    Outputs {
        sample: 1,
        restart: (at == 0).into(),
        integrate: (at >= slot.blanking()).into(),
        first: (at == slot.blanking()).into(),
        last: (at == slot.samples() - 1).into(),
        pad: (n / slot.samples() % profile.pads) as i64,
        closed: (at >= slot.open).into(),
    }
}

#[test]
fn a_pads_number_has_no_spare_bit() {
    for profile in Profile::all() {
        let numbers = profile.pads.next_power_of_two().max(2);
        assert_eq!(Multiplexer::new(&profile).pad().max_code(), i128::from(numbers) - 1);
    }
}

/// Also with a strobe in the same cycle, and in any sample of any pad's slot.
#[test]
fn clear_drives_no_pad_and_begins_with_the_first_pad() {
    for (seed, profile) in (0..).zip(Profile::all()) {
        let (mut bench, mut random) = (Bench::new(Multiplexer::new(&profile)), Random::new(seed));
        let round = profile.slot.samples() * profile.pads;
        let none = <Outputs as Bundle>::map(bench.block.outputs(), |_| 0);
        let (mut n, mut expected) = (0, none);
        for clock in 0..operations(MILLION).max(20 * round) {
            // Often where flags are set: clear takes them back.
            let flagged = expected.restart | expected.first | expected.last != 0;
            let one_in = if flagged { 12 } else { 2 * round };
            let [strobe, clear] = [random.below(3) != 0, random.below(one_in) == 0];
            let outputs = bench.clock(Inputs { strobe: strobe.into(), clear: clear.into() });
            assert_eq!(outputs, expected, "clock {clock}, sample {n}");
            n = if clear { 0 } else { n + u64::from(strobe) };
            expected = match (clear, strobe) {
                (true, _) => none,
                (false, true) => of_sample(&profile, n - 1),
                (false, false) => Outputs { sample: 0, ..expected },
            };
        }
    }
}
