// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ratios: those of eqs. 2 and 3, rounded; the clocks they take.

use super::{Inputs, Ratio};
use crate::blocks::currents::Currents;
use crate::support::{
    Bench, MILLION, cases, check, check_latency_of, check_rest, check_restart, check_run_on,
};
use hapticore_contract::profile::Profile;
use hapticore_reference::rounded::{self, Exact};

/// A numerator is at most its denominator: each term of the one is a term of the other.
fn bounded(i: Inputs<i64>) -> Inputs<i64> {
    let bound = |x: i64| if i.corners == 0 { 0 } else { x % (i.corners + 1) };
    Inputs { x: bound(i.x), y: bound(i.y), least: bound(i.least), ..i }
}

#[test]
fn ratios_are_those_of_eqs_2_and_3() {
    for (seed, profile) in (0..).zip(Profile::of_distinct_words()) {
        let currents = Currents::try_new(&profile).unwrap();
        let ((sums, corners), least) = (currents.sums(), currents.least());
        let ratio = profile.formats.ratio;
        let mut bench = Bench::new(Ratio::try_new(&profile, (sums, corners), least).unwrap());
        let cases = cases(&bench.block, MILLION / 3, seed).map(bounded);
        check(&mut bench, cases, |i| {
            let of = |code| Exact::of(code, sums);
            let [total, sense] = [Exact::ZERO; 2];
            let corners = Exact::of(i.corners, corners);
            let (x, y, least) = (of(i.x), of(i.y), Exact::of(i.least, least));
            let currents =
                rounded::Currents { total, sense, x, y, corners, least, saturated: false };
            let expected = rounded::ratio(&profile, &currents);
            let [r_x, r_y, share] =
                [expected.r_x, expected.r_y, expected.share].map(|r| r.code(ratio));
            [("r_x", r_x), ("r_y", r_y), ("share", share), ("invalid", expected.invalid.into())]
        });
    }
}

#[test]
fn latency_is_the_clocks_measured() {
    for profile in Profile::all() {
        let currents = Currents::try_new(&profile).unwrap();
        let block = Ratio::try_new(&profile, currents.sums(), currents.least()).unwrap();
        check_latency_of(block.clone(), block.latency(), bounded);
    }
}

#[test]
fn ratios_that_are_run_on_are_the_same() {
    let profile = Profile::bundled("small").expect("bundled");
    let currents = Currents::try_new(&profile).unwrap();
    let block = || Ratio::try_new(&profile, currents.sums(), currents.least()).unwrap();
    let mut hurried = block();
    hurried.hurry();
    check_run_on([block(), hurried], bounded, |block, state, inputs| block.run_on(state, inputs));
}

#[test]
fn ratios_are_begun_as_soon_as_others_are_done() {
    for profile in Profile::of_distinct_words() {
        let currents = Currents::try_new(&profile).unwrap();
        let block = || Ratio::try_new(&profile, currents.sums(), currents.least()).unwrap();
        check_restart([block(), block()].map(Bench::new), |latency| latency..=latency, bounded);
    }
}

#[test]
fn without_a_start_there_are_no_ratios() {
    for profile in Profile::of_distinct_words() {
        let currents = Currents::try_new(&profile).unwrap();
        let block = Ratio::try_new(&profile, currents.sums(), currents.least()).unwrap();
        check_rest(block, &["start"]);
    }
}
