// SPDX-License-Identifier: MIT OR Apache-2.0
//! Capacitances: those of the equation, rounded; the clocks they take.

use super::{Capacitance, Inputs};
use crate::blocks::currents::Currents;
use crate::blocks::rests::Rests;
use crate::support::{Bench, MILLION, cases, check, check_latency, check_rest, check_run_on};
use hapticore_contract::profile::Profile;
use hapticore_reference::rounded::{self, Exact};

#[test]
fn capacitances_have_the_sheet_taken_out() {
    let with = |correction| {
        Profile::of_distinct_words().into_iter().map(move |profile| (correction, profile))
    };
    for (seed, (correction, mut profile)) in (0..).zip([true, false].into_iter().flat_map(with)) {
        profile.capacitance.sheet_correction = correction;
        let amplitude = Currents::try_new(&profile).unwrap().amplitude();
        let f = &profile.formats;
        let mut bench = Bench::new(Capacitance::try_new(&profile, amplitude).unwrap());
        // Every other current is below the voltage, as a real one is; else most would saturate.
        let plausible = |i: Inputs<i64>| match i.total % 2 {
            0 => Inputs { total: i.total / 4, sense: i.sense.max(i.total / 3), ..i },
            _ => i,
        };
        let cases = cases(&bench.block, MILLION / 6, seed).map(plausible);
        check(&mut bench, cases, |i| {
            let [total, sense] = [i.total, i.sense].map(|code| Exact::of(code, amplitude));
            let (sheet, gain) =
                (Exact::of(i.sheet, profile.sheet()), Exact::of(i.gain, f.capacitance_gain));
            let expected = rounded::capacitance(&profile, total, sense, sheet, gain);
            let code = expected.capacitance.code(f.capacitance);
            [
                ("capacitance", code),
                ("invalid", expected.invalid.into()),
                ("saturated", expected.saturated.into()),
            ]
        });
    }
}

#[test]
fn latency_is_the_clocks_measured() {
    for mut profile in Profile::all() {
        for sheet_correction in [true, false] {
            profile.capacitance.sheet_correction = sheet_correction;
            let block =
                Capacitance::try_new(&profile, Currents::try_new(&profile).unwrap().amplitude())
                    .unwrap();
            check_latency(block.clone(), block.latency());
        }
    }
}

#[test]
fn a_capacitance_that_is_run_on_is_the_same() {
    for name in ["small", "standard"] {
        let profile = Profile::bundled(name).expect("bundled");
        let amplitude = Currents::try_new(&profile).unwrap().amplitude();
        let block = || Capacitance::try_new(&profile, amplitude).unwrap();
        let mut hurried = block();
        hurried.hurry();
        check_run_on(
            [block(), hurried],
            |i| i,
            |block, state, inputs| {
                assert!(block.is_busy(state));
                block.run_on(state, inputs);
                assert_eq!((state.registers.step, state.registers.done), (0, 1));
            },
        );
    }
}

#[test]
fn without_a_start_there_is_no_capacitance() {
    for profile in Profile::of_distinct_words() {
        let amplitude = Currents::try_new(&profile).unwrap().amplitude();
        check_rest(Capacitance::try_new(&profile, amplitude).unwrap(), &["start"]);
    }
}
