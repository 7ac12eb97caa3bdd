// SPDX-License-Identifier: MIT OR Apache-2.0
//! One pad of a controller in the words of `standard`, and its plant. The plant is a gap that follows the square of the
//! drive: C → 300 pF·(1 + d²/2), a fifth of the way with each frame, F = k·(C·d)².

use super::{Controller, Inputs, Outputs};
use crate::fidelity::force_loop::{curve_writes, tuning_codes};
use crate::support::Bench;
use hapticore_contract::control::{Control, Law, Tuning};
use hapticore_contract::profile::Profile;
use std::collections::HashMap;

/// Steps of the plant's capacitance, so that its state can come back, pF.
const STEP_PF: f64 = 1.0 / 1_048_576.0;

/// Frames within which a state comes back.
const MOST_FRAMES: usize = 50_000;

/// k of the plant, N/pF²: 0.36 N at full drive, settled.
pub const FORCE_GAIN: f64 = 4e-6 / 2.25;

/// A controller of one pad.
pub struct Rig {
    pub bench: Bench<Controller>,
    pub inputs: Inputs<i64>,
    pub control: Control,
    curve: Tuning,
    pub capacitance_pf: f64,
    pub drive: f64,
}

/// A tuning of every law, its curve a root that is right for a pad at 320 pF.
pub fn tuning(law: Law, control: &Control) -> Tuning {
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
    pub fn new(law: Law, change: impl Fn(&mut Tuning)) -> Rig {
        let mut profile = Profile::bundled("standard").expect("bundled");
        let control = Control::of(&profile, law);
        profile.control = Some(control.clone());
        let bench = Bench::new(Controller::try_new(&profile).unwrap());
        let mut tuning = tuning(law, &control);
        change(&mut tuning);
        let formats = bench.block.inputs().tuning;
        let inputs = Inputs { tuning: tuning_codes(&formats, &tuning), ..Inputs::of(0) };
        let mut rig =
            Rig { bench, inputs, control, curve: tuning, capacitance_pf: 300.0, drive: 0.0 };
        rig.begin();
        rig
    }

    /// What a host does after a reset: time passes, and the curve is written.
    pub fn begin(&mut self) {
        self.bench.clock(Inputs { tick: 1, ..self.inputs });
        self.write_curve();
    }

    pub fn write_curve(&mut self) {
        for tuning in curve_writes(self.bench.block.inputs().tuning, &self.curve) {
            self.bench.clock(Inputs { tuning, ..self.inputs });
        }
    }

    /// A frame with these measurements; the host is heard.
    pub fn frame(&mut self, target_n: f64, force_n: f64) -> Outputs<i64> {
        self.any_frame(target_n, force_n, 0)
    }

    pub fn any_frame(&mut self, target_n: f64, force_n: f64, invalid: i64) -> Outputs<i64> {
        self.bench.clock(Inputs { alive: 1, ..self.inputs });
        let inputs = Inputs { invalid, ..self.request(target_n, force_n) };
        let (outputs, _) = self.bench.operate(inputs);
        self.drive = self.control.drive.real(outputs.drive);
        outputs
    }

    /// What is held at the inputs for a frame.
    pub fn request(&self, target_n: f64, force_n: f64) -> Inputs<i64> {
        let f = self.bench.block.inputs();
        Inputs {
            target: f.target.code_saturating(target_n),
            capacitance: f.capacitance.code_saturating(self.capacitance_pf),
            measured: f.measured.code_saturating(force_n),
            force_gain: f.force_gain.code_saturating(FORCE_GAIN),
            ..self.inputs
        }
    }

    /// A frame of the closed loop: the force that was measured, N, and the drive word.
    pub fn closed(&mut self, target_n: f64) -> (f64, i64) {
        let settled_pf = 300.0 * (1.0 + self.drive.powi(2) / 2.0);
        let next_pf = self.capacitance_pf + 0.2 * (settled_pf - self.capacitance_pf);
        self.capacitance_pf = (next_pf / STEP_PF).round() * STEP_PF;
        let force_n = FORCE_GAIN * (self.capacitance_pf * self.drive).powi(2);
        (force_n, self.frame(target_n, force_n).drive)
    }

    /// Drive words of `frames` frames of the closed loop.
    pub fn drives(&mut self, target_n: f64, frames: usize) -> Vec<i64> {
        (0..frames).map(|_| self.closed(target_n).1).collect()
    }

    /// All that the next frame depends on: registers, what is kept of the pad, and the plant.
    pub fn state(&mut self) -> Vec<i64> {
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
    pub fn cycle(&mut self, target_n: f64) -> Vec<(f64, i64)> {
        let (mut seen, mut frames) = (HashMap::new(), Vec::new());
        for number in 0..MOST_FRAMES {
            if let Some(first) = seen.insert(self.state(), number) {
                return frames.split_off(first);
            }
            frames.push(self.closed(target_n));
        }
        panic!("no state comes back within {MOST_FRAMES} frames");
    }

    /// The drive word at which the closed loop settles, at 0.1 N.
    pub fn settled(&mut self) -> i64 {
        *self.drives(0.1, 2000).last().expect("frames")
    }

    /// Holds that the loop settles at the force of a drive word: the integral law takes what is within a step of the
    /// force's word for its target, on either side.
    pub fn assert_same(&mut self, word: i64) {
        let settled = self.settled();
        let off_n = 2.0 * 0.1 * (settled - word) as f64 / word as f64;
        let law = self.control.law;
        assert!(
            off_n.abs() <= 2.0 * self.force_step_n(),
            "{law:?}: {word} before, {settled} after"
        );
    }

    pub fn force_step_n(&self) -> f64 {
        self.bench.block.inputs().measured.lsb()
    }

    pub fn clear(&mut self) {
        self.bench.clock(Inputs { clear_faults: 1, alive: 1, ..self.inputs });
    }
}
