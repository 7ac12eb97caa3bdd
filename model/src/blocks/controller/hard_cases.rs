// SPDX-License-Identifier: MIT OR Apache-2.0
//! What usually breaks a force controller: rails, faults, standstill, and what a law leaves behind.
//!
//! One pad and its plant (`rig.rs`).
//!
//! What holds for any number of frames is shown by a state that comes back: of the same state and
//! the same inputs the same follows for ever.

use super::rig::{FORCE_GAIN, Rig, tuning};
use crate::support::{MILLION, operations};
use hapticore_contract::control::{Control, Law, Tuning};

/// The largest difference between two of the words.
fn spread(words: &[i64]) -> i64 {
    words.iter().max().expect("words") - words.iter().min().expect("words")
}

/// The state after three frames is that after all others, a million or more.
#[test]
fn a_target_at_the_rail_for_any_time_leaves_nothing_behind() {
    for law in Law::ALL {
        let mut rig = Rig::new(law, |tuning| tuning.rail = 0.4);
        let rail = rig.inputs.tuning.rail;
        let mut frame = || {
            assert_eq!(rig.frame(1.5, 0.02).drive, rail, "{law:?}");
            rig.state()
        };
        let states: Vec<_> = (0..6).map(|_| frame()).collect();
        assert_eq!(states[2], states[3], "{law:?}");
        // Back in the first frame, where the law's error says so; a filter needs its time.
        let first = rig.frame(0.0, 0.3).drive;
        let filters = law == Law::Proportional;
        assert!(
            if filters { first < rail } else { first < rail / 2 },
            "{law:?}: {first} of {rail}"
        );
    }
}

/// *Limited* is said of a drive that is at its limit: not while slew holds it, nor of an invalid estimate.
#[test]
fn a_drive_is_limited_only_at_its_limit() {
    for law in Law::ALL {
        let mut rig = Rig::new(law, |tuning| (tuning.rail, tuning.slew) = (0.4, 0.05));
        let rail = rig.inputs.tuning.rail;
        let outputs: Vec<_> = (0..20).map(|_| rig.frame(1.5, 0.02)).collect();
        assert!(outputs[0].drive < rail && outputs[19].drive == rail, "{law:?}");
        assert!(outputs.iter().all(|of| (of.high == 1) == (of.drive == rail)), "{law:?}");
        let held = rig.any_frame(1.5, 0.02, 1);
        assert_eq!((held.drive, held.high, held.low), (rail, 0, 0), "{law:?}: invalid");
        rig.inputs.tuning.enable = 0;
        let off: Vec<_> = (0..20).map(|_| rig.frame(1.5, 0.02)).collect();
        assert!(off.iter().all(|of| of.high == 0) && off[19].drive == 0, "{law:?}: off");
    }
}

/// As at the rail: a force that no drive explains, for however long, with a target of zero.
#[test]
fn a_drive_at_zero_for_any_time_leaves_nothing_behind() {
    for law in Law::ALL {
        let mut rig = Rig::new(law, |_| ());
        let mut frame = || {
            assert_eq!(rig.frame(0.0, 0.5).drive, 0, "{law:?}");
            rig.state()
        };
        let states: Vec<_> = (0..6).map(|_| frame()).collect();
        assert_eq!(states[2], states[3], "{law:?}");
        let first = rig.frame(0.1, 0.05).drive;
        let fresh = Rig::new(law, |_| ()).frame(0.1, 0.05).drive;
        assert!(first >= fresh - 1, "{law:?}: {first} of {fresh}");
    }
}

#[test]
fn a_target_that_steps_with_every_frame_stays_within_rail_and_slew() {
    for law in Law::ALL {
        let mut rig = Rig::new(law, |tuning| (tuning.rail, tuning.slew) = (0.7, 0.1));
        let (rail, slew) = (rig.inputs.tuning.rail, rig.inputs.tuning.slew);
        let mut last = 0;
        for frame in 0..operations(MILLION / 20) {
            let (_, drive) = rig.closed([0.0, 1.9][frame as usize % 2]);
            assert!(drive <= rail && (drive - last).abs() <= slew, "{law:?}: {last} {drive}");
            last = drive;
        }
    }
}

#[test]
fn an_invalid_sensor_holds_the_drive_then_lets_go_until_it_is_cleared() {
    for law in Law::ALL {
        let mut rig = Rig::new(law, |_| ());
        let held = rig.settled();
        assert!(held > 0);
        let most = rig.control.invalid_frames;
        for frame in 1..=most + 3 {
            let outputs = rig.any_frame(0.1, 1.9, 1);
            let expected = if frame < most { (held, 0) } else { (0, 1) };
            let got = (outputs.drive, outputs.faults.sensor_fault);
            assert_eq!(got, expected, "{law:?}, frame {frame}");
        }
        let outputs = rig.frame(0.1, 0.0);
        assert_eq!((outputs.drive, outputs.faults.sensor_fault), (0, 1), "{law:?}: latched");
        rig.clear();
        rig.assert_same(held);
    }
}

/// What an invalid frame measured is in no drive word after it.
#[test]
fn one_invalid_frame_changes_no_later_drive() {
    for law in Law::ALL {
        let after = |force_n: f64| {
            let mut rig = Rig::new(law, |_| ());
            rig.settled();
            rig.any_frame(0.1, force_n, 1);
            rig.drives(0.1, 40)
        };
        assert_eq!(after(1.9), after(0.0), "{law:?}");
        assert!(spread(&after(1.9)) <= 1, "{law:?}: {:?}", after(1.9));
    }
}

#[test]
fn a_force_beyond_its_cap_takes_the_drive_to_zero_in_that_frame() {
    for law in Law::ALL {
        let mut rig = Rig::new(law, |tuning| (tuning.slew, tuning.force_cap) = (0.05, 0.2));
        assert!(rig.settled() > 0, "{law:?}");
        for force_n in [0.3, 0.0, 0.1] {
            let outputs = rig.frame(0.1, force_n);
            assert_eq!((outputs.drive, outputs.faults.force_fault), (0, 1), "{law:?}: {force_n} N");
        }
    }
}

#[test]
fn a_lifted_pad_is_not_driven_and_once_it_is_back_rises_gently_to_what_it_was() {
    for law in Law::ALL {
        let mut rig = Rig::new(law, |_| ());
        let before = rig.settled();
        for frame in 0..40 {
            rig.capacitance_pf = 2.0;
            rig.inputs.lifted = 1;
            let outputs = rig.any_frame(0.1, 0.0, i64::from(frame % 5 == 4));
            let got = (outputs.drive, outputs.low, outputs.high);
            assert_eq!(got, (0, 0, 0), "{law:?}: frame {frame}");
        }
        (rig.capacitance_pf, rig.inputs.lifted, rig.drive) = (300.0, 0, 0.0);
        let most = rig.control.drive.code_saturating(rig.control.contact_slew());
        let mut last = 0;
        for drive in rig.drives(0.1, 200) {
            assert!(drive - last <= most, "{law:?}: {last} {drive}");
            last = drive;
        }
        rig.assert_same(before);
    }
}

/// What the law corrected before the pad was lifted is in no drive word after it.
#[test]
fn a_lifted_pad_forgets_what_its_law_corrected() {
    for law in Law::ALL {
        let after = |target_n: f64| {
            let mut rig = Rig::new(law, |_| ());
            rig.drives(target_n, 60);
            rig.inputs.lifted = 1;
            rig.any_frame(0.1, 0.0, 0);
            (rig.capacitance_pf, rig.inputs.lifted, rig.drive) = (300.0, 0, 0.0);
            rig.drives(0.1, 40)
        };
        assert_eq!(after(0.0), after(0.3), "{law:?}");
    }
}

#[test]
fn a_drive_that_is_switched_off_and_on_comes_back_no_faster_than_its_slew() {
    for law in Law::ALL {
        let mut rig = Rig::new(law, |tuning| tuning.slew = 0.05);
        let (before, slew) = (rig.settled(), rig.inputs.tuning.slew);
        rig.inputs.tuning.enable = 0;
        assert_eq!(rig.drives(0.1, 50)[49], 0, "{law:?}");
        rig.inputs.tuning.enable = 1;
        let mut last = 0;
        for drive in rig.drives(0.1, 50) {
            assert!((drive - last).abs() <= slew, "{law:?}: {last} {drive}");
            last = drive;
        }
        rig.assert_same(before);
    }
}

/// A settled loop has no limit cycle, in any number of frames: its drive word toggles by one at most.
/// The law with a large gain and no filter has one.
#[test]
fn a_loop_at_rest_stays_within_one_step_of_its_drive_word() {
    for law in Law::ALL {
        for target_n in [0.01, 0.1, 0.25] {
            let cycle = Rig::new(law, |_| ()).cycle(target_n);
            let words: Vec<i64> = cycle.iter().map(|(_, word)| *word).collect();
            println!("{law:?} at {target_n} N: {} frames, {} steps", words.len(), spread(&words));
            assert!(spread(&words) <= 1, "{law:?} at {target_n} N: {}", spread(&words));
        }
    }
    let raw = |tuning: &mut Tuning| (tuning.proportional, tuning.correction) = (7.9, 1.0);
    let words = Rig::new(Law::Proportional, raw).drives(0.25, 3000);
    assert!(spread(&words[2000..]) > 1000, "{}", spread(&words[2000..]));
}

/// What narrowing leaves of the settled force, beside the law in numbers without words: half a step of the force's
/// word, which is what the measurement's own rounding leaves.
#[test]
fn rounding_leaves_half_a_step_of_the_force_at_most() {
    for law in [Law::Proportional, Law::Integral] {
        for target_n in [0.011, 0.093, 0.244] {
            let mut rig = Rig::new(law, |_| ());
            let cycle = rig.cycle(target_n);
            let mean_n = cycle.iter().map(|(force_n, _)| force_n).sum::<f64>() / cycle.len() as f64;
            // The target itself is a word.
            let word = rig.bench.block.inputs().target;
            let target_n = word.real(word.code_saturating(target_n));
            let expected_n = at_rest(law, &rig.control, target_n);
            let off = (mean_n - expected_n) / rig.force_step_n();
            println!("{law:?} at {target_n} N: {off:.2} steps");
            assert!(off.abs() <= 0.5, "{law:?} at {target_n} N: {off} steps");
        }
    }
}

/// The force at which the law's equations and the plant settle, N.
fn at_rest(law: Law, control: &Control, target_n: f64) -> f64 {
    if law == Law::Integral {
        return target_n;
    }
    let tuning = tuning(law, control);
    let root = target_n.sqrt() / control.root_full_scale() * control.cells as f64;
    let cell = root as usize;
    let [low, high] = [tuning.curve[cell], tuning.curve[cell + 1]];
    let curve = low + (high - low) * (root - cell as f64);
    let mut drive: f64 = curve;
    let mut force_n = 0.0;
    for _ in 0..10_000 {
        let capacitance_pf = 300.0 * (1.0 + drive * drive / 2.0);
        force_n = FORCE_GAIN * (capacitance_pf * drive).powi(2);
        drive += 0.1 * (curve + tuning.proportional * (target_n - force_n) - drive);
    }
    force_n
}
