// SPDX-License-Identifier: MIT OR Apache-2.0
//! Forces: those of eq. 8, rounded; the clocks they take.

use super::Force;
use crate::support::{
    Bench, MILLION, cases, check, check_latency, check_rest, check_restart, check_run_on,
};
use hapticore_contract::profile::Profile;
use hapticore_reference::rounded::{self, Exact};

#[test]
fn forces_are_those_of_eq_8() {
    for (seed, profile) in (0..).zip(Profile::all()) {
        let f = &profile.formats;
        let mut bench = Bench::new(Force::try_new(&profile).unwrap());
        let cases = cases(&bench.block, MILLION / 3, seed);
        check(&mut bench, cases, |i| {
            let capacitance = Exact::of(i.capacitance, f.capacitance);
            let (mean_square, gain) =
                (Exact::of(i.mean_square, f.mean_square), Exact::of(i.gain, f.force_gain));
            let expected = rounded::force(&profile, [capacitance, mean_square, gain]);
            [
                ("haptic_force", expected.force.code(f.force)),
                ("saturated", expected.saturated.into()),
            ]
        });
    }
}

#[test]
fn latency_is_the_clocks_measured() {
    for profile in Profile::all() {
        let block = Force::try_new(&profile).unwrap();
        check_latency(block.clone(), block.latency());
    }
}

#[test]
fn a_force_is_begun_anew_while_another_is_computed() {
    for profile in Profile::of_distinct_words() {
        let new = || Bench::new(Force::try_new(&profile).unwrap());
        check_restart([new(), new()], |latency| 1..=latency, |inputs| inputs);
    }
}

#[test]
fn forces_that_are_run_on_are_the_same() {
    for profile in Profile::of_distinct_words() {
        let block = || Force::try_new(&profile).unwrap();
        check_run_on([block(), block()], |i| i, |block, state, inputs| block.run_on(state, inputs));
    }
}

#[test]
fn without_a_start_there_is_no_force() {
    for profile in Profile::of_distinct_words() {
        check_rest(Force::try_new(&profile).unwrap(), &["start"]);
    }
}
