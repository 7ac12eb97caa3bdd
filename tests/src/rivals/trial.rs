// SPDX-License-Identifier: MIT OR Apache-2.0
//! The plant of scene `fig9` in a loop with a law.

use std::sync::Arc;

use hapticore_contract::calibration::Calibration;
use hapticore_contract::control::{Control, Tuning};
use hapticore_contract::profile::Profile;
use hapticore_run::case::Case;
use hapticore_run::inputs;
use hapticore_scene::{Plant, Scene};

use super::laws::{FULL_SCALE_V, Gains, Idsp, Law, Linien, Ours, PyRpl, Seen};

/// From a frame's end to its drive, s.
const LATENCY_S: f64 = 22e-6;

/// A law with its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// One of this project's, by its name in a scene, with `proportional_v`, and `filter` or
    /// `integral_v`.
    Ours(&'static str, [f64; 2]),
    /// idsp's.
    Idsp(Gains),
    /// PyRPL's.
    PyRpl(Gains),
    /// Linien's.
    Linien(Gains),
}

/// A pad's target force over time, as TOML of a scene.
#[derive(Clone, Copy, Debug)]
pub enum Target {
    /// A square of 0.3 s from 0.05 s on, N.
    Square(f64),
    /// A sine of 4 Hz from 0 to this many N.
    Sine(f64),
    /// The first number, N, from 0.05 s to 0.25 s, then the second.
    Step(f64, f64),
}

impl Target {
    fn toml(self) -> String {
        match self {
            Target::Square(n) => {
                format!("{{ timeline = [[0.05, 0], [0.05, {n}], [0.35, {n}], [0.35, 0]] }}")
            }
            Target::Sine(n) => format!(
                "{{ sine = {{ mean = {0}, amplitude = {0}, frequency_hz = 4, phase_turns = -0.25 }} }}",
                n / 2.0
            ),
            Target::Step(first, then) => {
                format!(
                    "{{ timeline = [[0.05, 0], [0.05, {first}], [0.25, {first}], [0.25, {then}]] }}"
                )
            }
        }
    }
}

/// A frame of a trial.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Its end, s.
    pub end_s: f64,
    /// Force that the pad shall have in the middle of the frame, N.
    pub target_n: f64,
    /// The pad's true force in the middle of the frame, N.
    pub force_n: f64,
}

/// A pad that a law drives.
pub struct Trial {
    plant: Plant,
    frames: usize,
    frame_s: f64,
    force_k: f64,
    rail_v: f64,
    law: Box<dyn Law>,
}

impl Trial {
    /// A law that follows this target, the amplifier's rail at `rail_v` V rms.
    ///
    /// # Panics
    /// A scene that has no plant.
    pub fn new(kind: Kind, target: Target, rail_v: f64) -> Trial {
        let (name, gains) =
            if let Kind::Ours(name, gains) = kind { (name, gains) } else { ("inverse", [0.0; 2]) };
        let scene = scene((name, gains), target, rail_v);
        let profile = Profile::bundled("standard").expect("bundled");
        let profile = inputs::windowed(profile, &scene).expect("a window");
        let case = Case::new(&Arc::new(scene), 0, &profile, &[]).expect("a case");
        let plant = case.plant().expect("a plant");
        let law: Box<dyn Law> = match kind {
            Kind::Ours(..) => Box::new(ours(&case, &plant)),
            Kind::Idsp(gains) => Box::new(Idsp::new(gains, rail_v)),
            Kind::PyRpl(gains) => Box::new(PyRpl::new(gains)),
            Kind::Linien(gains) => Box::new(Linien::new(gains)),
        };
        let (frame_s, force_k) = (case.clock.seconds(1), case.device.device.force_k);
        Trial { plant, frames: case.slots, frame_s, force_k, rail_v, law }
    }

    /// All frames.
    ///
    /// # Panics
    /// A drive that the plant does not take.
    pub fn run(mut self) -> Vec<Frame> {
        self.plant.set_drive(0, 0.0, 0.0).expect("nothing has been seen");
        (0..self.frames).map(|number| self.frame(number)).collect()
    }

    fn frame(&mut self, number: usize) -> Frame {
        let truth = self.plant.truth(number);
        let end_s = self.frame_s * (number + 1) as f64;
        let target_n = self.plant.target_n(0, end_s);
        let charge = truth.capacitance_pf * 1e-12 * truth.haptic_v_rms;
        let force_n = self.force_k * charge * charge;
        let seen = Seen { target_n, force_n, capacitance_pf: truth.capacitance_pf };
        let volts = self.law.volts(&seen).clamp(0.0, self.rail_v);
        self.plant.set_drive(0, end_s + LATENCY_S, volts).expect("the frame has just been seen");
        Frame { end_s, target_n: truth.set.target_n, force_n: truth.force_n }
    }
}

fn scene((law, gains): (&str, [f64; 2]), target: Target, rail_v: f64) -> Scene {
    let set = [
        ("case", "[]".to_string()),
        ("supply", "false".to_string()),
        ("control.force", "eq8".to_string()),
        ("control.trim_s", "0".to_string()),
        ("criterion", "[]".to_string()),
        ("control.law", law.to_string()),
        ("control.rail_v", rail_v.to_string()),
        ("pad.0.target_n", target.toml()),
    ];
    let keys: &[&str] = match law {
        "proportional" => &["control.proportional_v", "control.filter"],
        "integral" => &["control.proportional_v", "control.integral_v"],
        _ => &[],
    };
    let gains = keys.iter().zip(gains).map(|(&key, value)| (key, value.to_string()));
    let set: Vec<_> =
        set.into_iter().chain(gains).map(|(key, value)| (key.to_string(), value)).collect();
    inputs::scene("fig9", &set).unwrap_or_else(|error| panic!("{error}"))
}

fn ours(case: &Case, plant: &Plant) -> Ours {
    let tuning: Tuning = case.tuning(plant).expect("gains that fit").expect("a controller");
    let control: &Control = case.profile.control.as_ref().expect("a controller");
    let calibration: &Calibration = case.calibration().expect("a calibration");
    Ours::new(control, &tuning, calibration.force_gain, FULL_SCALE_V)
}

/// Root mean square of true force − target, N.
pub fn rms_n(frames: &[Frame]) -> f64 {
    let sum: f64 = frames.iter().map(|frame| (frame.force_n - frame.target_n).powi(2)).sum();
    (sum / frames.len() as f64).sqrt()
}

/// From a time on, how long until the true force stays within `within_n` N of its target, s; none
/// where it does not.
pub fn settled_s(frames: &[Frame], from_s: f64, within_n: f64) -> Option<f64> {
    let after = frames.iter().skip_while(|frame| frame.end_s <= from_s);
    let is_off = |frame: &&Frame| (frame.force_n - frame.target_n).abs() > within_n;
    let last_off = after.clone().filter(is_off).last();
    let last = frames.last()?;
    match last_off {
        None => Some(0.0),
        Some(off) if off.end_s < last.end_s => Some(off.end_s - from_s),
        Some(_) => None,
    }
}
