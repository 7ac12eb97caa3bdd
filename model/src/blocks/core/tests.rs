// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clocks from the last strobe to the last word.

use super::{Core, Inputs};
use crate::support::Bench;
use crate::support::device::short_profiles;
use hapticore_hdl::bundle::Bundle;

#[test]
fn latency_is_the_clocks_measured() {
    for profile in short_profiles() {
        let mut bench = Bench::new(Core::new(&profile));
        let quiet = Inputs::map(bench.block.inputs(), |_| 0);
        let clocks = profile.clocks_per_sample;
        for clock in 0..(profile.slot.samples() - 1) * clocks {
            bench.clock(Inputs { strobe: (clock % clocks == 0).into(), code: 100, ..quiet });
        }
        bench.clock(Inputs { strobe: 1, ..quiet });
        let measured = (1..10_000).find(|_| bench.clock(quiet).frames.done == 1);
        let latency = bench.block.latency();
        assert_eq!(
            measured,
            Some(latency),
            "{}: clocks from the last strobe to the last word",
            profile.name
        );
    }
}
