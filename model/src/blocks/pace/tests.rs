// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pace: a strobe within the clocks of the one before is reported until it is cleared.

use super::{Inputs, Pace};
use crate::support::random::Random;
use crate::support::{Bench, MILLION, operations};

#[test]
fn a_strobe_that_comes_too_early_is_told() {
    for (seed, clocks) in (0..).zip([2, 3, 5, 16]) {
        let (mut bench, mut random) = (Bench::new(Pace { clocks }), Random::new(seed));
        let (mut since_strobe, mut overrun) = (clocks, 0);
        for clock in 0..operations(MILLION / 10) {
            let strobe = i64::from(random.below(clocks) == 0);
            let clear = i64::from(random.below(7) == 0);
            let out = bench.clock(Inputs { strobe, clear });
            assert_eq!(out.overrun, overrun, "{clocks} clocks, at {clock}");
            let early = strobe == 1 && since_strobe < clocks;
            overrun = i64::from((overrun == 1 || early) && clear == 0);
            // What is cleared is no sample.
            since_strobe = if strobe == 1 && clear == 0 { 1 } else { since_strobe + 1 };
        }
    }
}
