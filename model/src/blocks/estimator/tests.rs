// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clocks from the last sum to the last word.

use super::{Estimator, Inputs};
use crate::support::Bench;
use hapticore_contract::profile::Profile;
use hapticore_hdl::bundle::Bundle;

#[test]
fn latency_is_the_clocks_measured() {
    for profile in Profile::all() {
        let mut bench = Bench::new(Estimator::try_new(&profile).unwrap());
        let quiet = Inputs::map(bench.block.inputs(), |_| 0);
        let sums = 2 * profile.demodulated() as i64;
        for index in 0..=sums {
            bench.clock(Inputs { valid: 1, index, sum: 1 << 20, ..quiet });
        }
        let measured = (1..10_000).find(|_| bench.clock(quiet).frames.done == 1);
        assert_eq!(
            measured,
            Some(bench.block.latency()),
            "clocks from the last sum to the last word"
        );
    }
}
