// SPDX-License-Identifier: MIT OR Apache-2.0
//! The controller's block around a plant whose state is a word, so that the loop's state can come
//! back: of the same state and the same inputs the same follows for ever.
//!
//! ```text
//! C → 300 pF·(1 + d²/2), a fifth of the way with each frame;   F = k·(C·d)²
//! ```

use std::collections::HashMap;

use hapticore_contract::control::{Control, Law, Tuning};
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, State, Submodule, Visitor};
use hapticore_hdl::bundle::{Bundle, Field};
use hapticore_hdl::format::Format;
use hapticore_hdl::memory::{Memory, Storage};
use hapticore_hdl::signal::{Signal, code};
use hapticore_model::blocks::controller::{Controller, Inputs};
use hapticore_model::fidelity::force_loop::{curve_writes, tuning_codes};

/// Steps of the plant's capacitance, pF.
const STEP_PF: f64 = 1.0 / 1_048_576.0;

/// Frames within which a state comes back.
const MOST_FRAMES: usize = 50_000;

/// k of the plant, N/pF²: 0.36 N at full drive, settled.
pub const FORCE_GAIN: f64 = 4e-6 / 2.25;

/// The plant alone.
#[derive(Clone)]
pub struct Plant {
    /// Its capacitance, pF.
    pub capacitance_pf: f64,
}

impl Plant {
    /// In equilibrium, not driven.
    pub fn new() -> Self {
        Plant { capacitance_pf: 300.0 }
    }

    /// A frame with this drive: the force, N.
    pub fn frame(&mut self, drive: f64) -> f64 {
        let settled_pf = 300.0 * (1.0 + drive.powi(2) / 2.0);
        let next_pf = self.capacitance_pf + 0.2 * (settled_pf - self.capacitance_pf);
        self.capacitance_pf = (next_pf / STEP_PF).round() * STEP_PF;
        FORCE_GAIN * (self.capacitance_pf * drive).powi(2)
    }
}

/// What a frame leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Given {
    /// Force before it, N.
    pub force_n: f64,
    /// Drive word.
    pub drive: i64,
    /// Faults: host silent, sensor, force.
    pub faults: [bool; 3],
}

/// A controller of one pad, in the words of `standard`, and its plant.
pub struct Rig {
    block: Controller,
    state: State<Controller, i64>,
    /// What is held at its inputs.
    pub inputs: Inputs<i64>,
    /// Its law and formats.
    pub control: Control,
    /// What it drives.
    pub plant: Plant,
    drive: f64,
    /// The host is heard with each frame.
    pub alive: bool,
    /// Clock of a frame, and the tuning from then on.
    pub retune: Option<(u64, Tuning)>,
}

/// A tuning of every law; its curve is right for a pad at 320 pF.
fn tuning(law: Law, control: &Control) -> Tuning {
    let scale = control.root_full_scale() / (FORCE_GAIN.sqrt() * 320.0);
    let at = |cell: u64| (scale * cell as f64 / control.cells as f64).min(1.0 - 1e-5);
    let correction = if law == Law::Integral { 0.2 } else { 0.125 };
    Tuning {
        curve: (0..=control.cells).map(at).collect(),
        proportional: 0.5,
        correction,
        ..Tuning::idle(control)
    }
}

impl Rig {
    /// A controller of a law, its tuning changed.
    ///
    /// # Panics
    /// Where the controller cannot be.
    pub fn new(law: Law, change: impl Fn(&mut Tuning)) -> Self {
        let mut profile = Profile::bundled("standard").expect("bundled");
        let control = Control::of(&profile, law);
        profile.control = Some(control.clone());
        let block = Controller::try_new(&profile).expect("a controller");
        let mut tuning = tuning(law, &control);
        change(&mut tuning);
        let formats = block.inputs().tuning;
        let inputs = Inputs { tuning: tuning_codes(&formats, &tuning), ..Inputs::of(0) };
        let state = block.reset();
        let plant = Plant::new();
        let mut rig =
            Rig { block, state, inputs, control, plant, drive: 0.0, alive: true, retune: None };
        for tuning in curve_writes(formats, &tuning) {
            rig.clock(Inputs { tuning, ..Inputs::of(0) });
        }
        rig.tick();
        rig
    }

    /// The tuning that it would have been made with.
    pub fn tuning(&self, change: impl Fn(&mut Tuning)) -> Tuning {
        let mut tuning = tuning(self.control.law, &self.control);
        change(&mut tuning);
        tuning
    }

    fn clock(&mut self, inputs: Inputs<i64>) -> Option<Given> {
        let words = Inputs::zip(inputs, self.block.inputs());
        let out = step(
            &self.block,
            &mut self.state,
            Inputs::map(words, |(word, format)| code(word, format)),
        );
        let faults = out.faults;
        (out.done.value != 0).then_some(Given {
            force_n: 0.0,
            drive: out.drive.value,
            faults: [faults.silence_fault, faults.sensor_fault, faults.force_fault]
                .map(|bit: Signal<i64>| bit.value != 0),
        })
    }

    /// A frame with this measurement.
    ///
    /// # Panics
    /// Where the controller gives no drive word.
    pub fn measured(&mut self, target_n: f64, force_n: f64, invalid: bool) -> Given {
        let f = self.block.inputs();
        self.clock(Inputs { alive: self.alive.into(), ..self.inputs });
        let mut held = Inputs {
            target: f.target.code_saturating(target_n),
            capacitance: f.capacitance.code_saturating(self.plant.capacitance_pf),
            measured: f.measured.code_saturating(force_n),
            force_gain: f.force_gain.code_saturating(FORCE_GAIN),
            invalid: invalid.into(),
            ..self.inputs
        };
        for clock in 0..=self.block.latency() {
            if let Some((at, tuning)) = &self.retune
                && *at == clock
            {
                held.tuning = tuning_codes(&f.tuning, tuning);
                self.inputs.tuning = held.tuning;
            }
            if let Some(given) = self.clock(Inputs { start: (clock == 0).into(), ..held }) {
                self.drive = self.control.drive.real(given.drive);
                return Given { force_n, ..given };
            }
        }
        panic!("no drive word within {} clocks", self.block.latency());
    }

    /// A frame of the closed loop.
    pub fn frame(&mut self, target_n: f64) -> Given {
        let force_n = self.plant.frame(self.drive);
        self.measured(target_n, force_n, false)
    }

    /// A frame of the closed loop whose estimate is invalid.
    pub fn invalid_frame(&mut self, target_n: f64) -> Given {
        self.plant.frame(self.drive);
        self.measured(target_n, 1.9, true)
    }

    /// Runs `count` frames of the closed loop; returns the last.
    pub fn frames(&mut self, target_n: f64, count: usize) -> Given {
        (1..count).for_each(|_| {
            self.frame(target_n);
        });
        self.frame(target_n)
    }

    /// A millisecond passes.
    pub fn tick(&mut self) {
        self.clock(Inputs { tick: 1, ..self.inputs });
    }

    /// Clears faults.
    pub fn clear(&mut self) {
        self.clock(Inputs { clear_faults: 1, alive: 1, ..self.inputs });
    }

    /// The step of the force's word, N.
    pub fn force_step_n(&self) -> f64 {
        self.block.inputs().measured.lsb()
    }

    /// The largest target, N.
    pub fn largest_target_n(&self) -> f64 {
        self.control.target.real(self.control.target.max_code() as i64)
    }

    /// The target as its word has it, N.
    pub fn target_n(&self, newtons: f64) -> f64 {
        let word = self.block.inputs().target;
        word.real(word.code_saturating(newtons))
    }

    /// Clocks of a frame.
    pub fn latency(&self) -> u64 {
        self.block.latency()
    }

    /// All that the next frame depends on: registers, what is kept of the pads, and the plant.
    pub fn state(&mut self) -> Vec<i64> {
        // Memories read in a clock in which something happens.
        self.clock(Inputs { alive: 1, ..self.inputs });
        self.clock(Inputs { alive: 1, ..self.inputs });
        let mut all = Everything(Vec::new());
        self.block.visit("controller", &self.state, &mut all);
        all.0.push((self.plant.capacitance_pf / STEP_PF) as i64);
        all.0
    }

    /// Frames until the state is one that has been, and the frames that come back from then on.
    ///
    /// # Panics
    /// Where no state comes back.
    pub fn cycle(&mut self, target_n: f64) -> Vec<Given> {
        let (mut seen, mut frames) = (HashMap::new(), Vec::new());
        for number in 0..MOST_FRAMES {
            if let Some(first) = seen.insert(self.state(), number) {
                return frames.split_off(first);
            }
            frames.push(self.frame(target_n));
        }
        panic!("no state comes back within {MOST_FRAMES} frames");
    }

    /// The force at which the law's equations and the plant settle without words, N.
    pub fn at_rest(&self, target_n: f64) -> f64 {
        if self.control.law == Law::Integral {
            return target_n;
        }
        let tuning = self.tuning(|_| ());
        let root = target_n.sqrt() / self.control.root_full_scale() * self.control.cells as f64;
        let cell = root as usize;
        let [low, high] = [tuning.curve[cell], tuning.curve[cell + 1]];
        let curve = low + (high - low) * (root - cell as f64);
        let (mut drive, mut force_n): (f64, f64) = (curve, 0.0);
        for _ in 0..10_000 {
            let capacitance_pf = 300.0 * (1.0 + drive * drive / 2.0);
            force_n = FORCE_GAIN * (capacitance_pf * drive).powi(2);
            drive += 0.1 * (curve + tuning.proportional * (target_n - force_n) - drive);
        }
        force_n
    }
}

/// Out of line: once is enough.
#[inline(never)]
fn step(
    block: &Controller,
    state: &mut State<Controller, i64>,
    inputs: Inputs<Signal<i64>>,
) -> hapticore_model::blocks::controller::Outputs<Signal<i64>> {
    block.clock(state, inputs)
}

struct Everything(Vec<i64>);

impl Visitor<i64> for Everything {
    fn enter(&mut self, _name: &'static str) {}
    fn register(&mut self, _field: &'static Field, _format: Format, value: i64) {
        self.0.push(value);
    }
    fn memory(&mut self, memory: &Memory, words: &<i64 as Storage>::Words) {
        // The curve stays as it was written.
        if memory.name == "points" {
            return;
        }
        let mut words = words.clone();
        self.0.push(memory.data(&mut words).value);
        for address in 0..memory.words {
            memory.read(&mut words, code::<i64>(address as i64, memory.address()));
            self.0.push(memory.data(&mut words).value);
        }
    }
    fn leave(&mut self) {}
}
