// SPDX-License-Identifier: MIT OR Apache-2.0
//! What usually breaks a force controller: rails, faults, rest, and what a law leaves behind.
//!
//! One pad in the words of `standard`. Where the loop is closed, its plant is a gap that follows the
//! square of the drive: C → 300 pF·(1 + d²/2), a fifth of the way with each frame, F = k·(C·d)².
//!
//! What holds for any number of frames is shown by a state that comes back: of the same state and
//! the same inputs the same follows for ever.

use super::{Controller, Inputs, Outputs};
use crate::fidelity::force_loop::{curve_writes, tuning_codes};
use crate::support::{Bench, MILLION, operations};
use hapticore_contract::control::{Control, Law, Tuning};
use hapticore_contract::profile::Profile;
use std::collections::HashMap;

/// Steps of the plant's capacitance, so that its state can come back, pF.
const STEP_PF: f64 = 1.0 / 1_048_576.0;

/// Frames within which a state comes back.
const MOST_FRAMES: usize = 50_000;

/// k of the plant, N/pF²: 0.36 N at full drive and rest.
const FORCE_GAIN: f64 = 4e-6 / 2.25;

/// A controller of one pad.
struct Rig {
    bench: Bench<Controller>,
    inputs: Inputs<i64>,
    control: Control,
    capacitance_pf: f64,
    drive: f64,
}

/// A tuning of every law, its curve a root that is right for a pad at 320 pF.
fn tuning(law: Law, control: &Control) -> Tuning {
    let scale = control.root_full_scale() / (FORCE_GAIN.sqrt() * 320.0);
    let at = |cell: u64| (scale * cell as f64 / control.cells as f64).min(1.0 - 1e-5);
    let (proportional, correction) = match law {
        Law::Integral => (0.5, 0.2),
        _ => (0.5, 0.125),
    };
    Tuning {
        curve: (0..=control.cells).map(at).collect(),
        proportional,
        correction,
        ..Tuning::idle(control)
    }
}

impl Rig {
    fn new(law: Law, change: impl Fn(&mut Tuning)) -> Rig {
        let mut profile = Profile::bundled("standard").expect("bundled");
        let control = Control::of(&profile, law);
        profile.control = Some(control.clone());
        let mut bench = Bench::new(Controller::try_new(&profile).unwrap());
        let mut tuning = tuning(law, &control);
        change(&mut tuning);
        let formats = bench.block.inputs().tuning;
        for tuning in curve_writes(formats, &tuning) {
            bench.clock(Inputs { tuning, ..Inputs::of(0) });
        }
        let inputs = Inputs { tuning: tuning_codes(&formats, &tuning), ..Inputs::of(0) };
        Rig { bench, inputs, control, capacitance_pf: 300.0, drive: 0.0 }
    }

    /// A frame with these measurements; the host is heard.
    fn frame(&mut self, target_n: f64, force_n: f64) -> Outputs<i64> {
        self.any_frame(target_n, force_n, 0)
    }

    fn any_frame(&mut self, target_n: f64, force_n: f64, invalid: i64) -> Outputs<i64> {
        let f = self.bench.block.inputs();
        self.bench.clock(Inputs { alive: 1, ..self.inputs });
        let inputs = Inputs {
            target: f.target.code_saturating(target_n),
            capacitance: f.capacitance.code_saturating(self.capacitance_pf),
            measured: f.measured.code_saturating(force_n),
            force_gain: f.force_gain.code_saturating(FORCE_GAIN),
            invalid,
            ..self.inputs
        };
        let (outputs, _) = self.bench.operate(inputs);
        self.drive = self.control.drive.real(outputs.drive);
        outputs
    }

    /// A frame of the closed loop: the force that was measured, N, and the drive word.
    fn closed(&mut self, target_n: f64) -> (f64, i64) {
        let settled_pf = 300.0 * (1.0 + self.drive.powi(2) / 2.0);
        let next_pf = self.capacitance_pf + 0.2 * (settled_pf - self.capacitance_pf);
        self.capacitance_pf = (next_pf / STEP_PF).round() * STEP_PF;
        let force_n = FORCE_GAIN * (self.capacitance_pf * self.drive).powi(2);
        (force_n, self.frame(target_n, force_n).drive)
    }

    /// Drive words of so many frames of the closed loop.
    fn drives(&mut self, target_n: f64, frames: usize) -> Vec<i64> {
        (0..frames).map(|_| self.closed(target_n).1).collect()
    }

    /// All that the next frame depends on: registers, what is kept of the pad, and the plant.
    fn state(&mut self) -> Vec<i64> {
        // Memories read in a clock in which something happens.
        self.bench.clock(Inputs { alive: 1, ..self.inputs });
        self.bench.clock(Inputs { alive: 1, ..self.inputs });
        let (block, within) = (&self.bench.block, &mut self.bench.state.submodules);
        let pad = block.pads.data(&mut within.pads).value;
        let correction = match block.feeds_back() {
            true => block.corrections.data(&mut within.corrections).value,
            false => 0,
        };
        let mut state: Vec<i64> = self.bench.registers().map(|(_, code)| code).collect();
        state.extend([pad, correction, (self.capacitance_pf / STEP_PF) as i64]);
        state
    }

    /// Forces and drive words of the frames that come back for ever.
    fn cycle(&mut self, target_n: f64) -> Vec<(f64, i64)> {
        let (mut seen, mut frames) = (HashMap::new(), Vec::new());
        for number in 0..MOST_FRAMES {
            if let Some(first) = seen.insert(self.state(), number) {
                return frames.split_off(first);
            }
            frames.push(self.closed(target_n));
        }
        panic!("no state comes back within {MOST_FRAMES} frames");
    }

    /// The drive word at which the closed loop rests, at 0.1 N.
    fn settled(&mut self) -> i64 {
        *self.drives(0.1, 2000).last().expect("frames")
    }

    /// Holds that the loop rests at the force of a drive word: the integral law takes what is within
    /// a step of the force's word for its target, on either side.
    fn assert_same(&mut self, word: i64) {
        let settled = self.settled();
        let off_n = 2.0 * 0.1 * (settled - word) as f64 / word as f64;
        let law = self.control.law;
        assert!(
            off_n.abs() <= 2.0 * self.force_step_n(),
            "{law:?}: {word} before, {settled} after"
        );
    }

    fn force_step_n(&self) -> f64 {
        self.bench.block.inputs().measured.lsb()
    }

    fn clear(&mut self) {
        self.bench.clock(Inputs { clear_faults: 1, alive: 1, ..self.inputs });
    }
}

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
        // Back at once, where the law's error says so; a filter needs its time.
        let first = rig.frame(0.0, 0.3).drive;
        let filters = law == Law::Proportional;
        assert!(
            if filters { first < rail } else { first < rail / 2 },
            "{law:?}: {first} of {rail}"
        );
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
fn a_force_beyond_its_cap_takes_the_drive_to_zero_at_the_slew_limit() {
    for law in Law::ALL {
        let mut rig = Rig::new(law, |tuning| (tuning.slew, tuning.force_cap) = (0.05, 0.2));
        let before = rig.settled();
        let slew = rig.inputs.tuning.slew;
        let mut drive = before;
        for _ in 0..=before / slew {
            let outputs = rig.frame(0.1, 0.3);
            assert_eq!(outputs.faults.force_fault, 1, "{law:?}");
            assert_eq!(outputs.drive, (drive - slew).max(0), "{law:?}");
            drive = outputs.drive;
        }
        assert_eq!(drive, 0, "{law:?}");
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

/// A loop at rest has no limit cycle, in any number of frames: its drive word toggles by one at most.
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

/// What narrowing leaves of the force at rest, beside the law in numbers without words: half a step of
/// the force's word, which is what the measurement's own rounding leaves.
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

/// The force at which the law's equations and the plant rest, N.
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
