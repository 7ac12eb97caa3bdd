// SPDX-License-Identifier: MIT OR Apache-2.0
//! A force loop at fidelity `clock`, in which idle drives are skipped, beside one that is evaluated in each clock.

use crate::device::calibration;
use crate::harness::operations;
use crate::overlap::{controlled, slots, tuning, window};
use hapticore_contract::control::Surface;
use hapticore_hdl::probe::Probe;
use hapticore_model::fidelity::force_loop::ClockLoop;

fn registers(of: &ClockLoop) -> Vec<i64> {
    let mut codes = Vec::new();
    of.sample(&mut codes);
    codes
}

/// After each slot every register is the same: what is left out changes nothing.
#[test]
fn drives_that_rest_are_left_out_of_no_clock_that_changes_them() {
    for (seed, profile) in (30..).zip(controlled()) {
        let (calibration, tuning) = (calibration(&profile), tuning(&profile));
        let new = || ClockLoop::new(&profile, &calibration, &tuning).expect("a loop");
        let (mut unseen, mut seen) = (new(), new());
        let mut drives = 0;
        for (slot, (pad, codes)) in slots(&profile, operations(24) as usize, seed).enumerate() {
            for of in [&mut unseen, &mut seen] {
                if slot % 3 == 0 {
                    of.set_target(pad, 0.02 * (slot % 50) as f64);
                }
                if profile.wall.is_some() && slot % 5 == 0 {
                    let mm = 40.0 * (slot as f64 / 7.0).sin();
                    of.set_surface(pad, Surface { mm, right: slot % 25 > 17 });
                }
            }
            let codes = window(&profile, &codes);
            let (got, expected) = (unseen.slot(codes), seen.slot_with(codes, |_| ()));
            let case = format!("{}, {} pads, slot {slot}", profile.name, profile.pads);
            assert_eq!(got, expected, "{case}");
            assert_eq!(registers(&unseen), registers(&seen), "{case}: registers");
            drives += usize::from(got.1.is_some());
        }
        assert!(drives > 0, "{}: drive words are given", profile.name);
    }
}
