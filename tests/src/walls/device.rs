// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pad at the wall: a scene of this project's plant, and the inverse law that makes a voltage of
//! a force.
//!
//! ```text
//! V = √(F_t/k)/C′,   at most 1.1·V(F_t) of the steady curve at nominal load          (docs/physics.md §6)
//! ```
//!
//! C′ is that of the electrodes that brake, of the last frame; k and V(F) come from the resting
//! device under the nominal load, as a calibration finds them.

use std::fmt::Write;

use hapticore_scene::{Plant, Scene, Timing, Truth};

use super::hand::Hand;

/// What the amplifier gives, V rms: 1 N takes 475 V of the default device (docs/physics.md §3).
pub const MOST_V: f64 = 500.0;
/// Nominal load, N.
const NOMINAL_N: f64 = 0.8;
/// What a push at this height does to the pad's gap, mm: not given by the paper.
const PUSH_HEIGHT_MM: f64 = 5.0;
/// Standard gravity, m/s².
const GRAVITY: f64 = 9.80665;
/// Area of the outer strips of a pad with split drive, % of the pad.
const OUTER_PERCENT: f64 = 20.0;
/// What the sensing strips stay at, V rms.
const SENSING_V: f64 = 150.0;

/// How the pad is split and driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pad {
    /// Two halves, which sense and brake.
    Halves,
    /// Four strips: the outer two sense at 150 V at most, the inner two brake.
    Strips,
}

impl Pad {
    /// Capacitances of the two electrodes that sense, and of those that brake, pF.
    pub fn capacitances(self, truth: &Truth) -> ([f64; 2], f64) {
        let [a, b, c, d] = truth.electrodes_pf;
        match self {
            Pad::Halves => ([a, b], a + b),
            Pad::Strips => ([a, d], b + c),
        }
    }

    fn tables(self, mismatch_percent: f64, gap: &str, senses: &str) -> String {
        let strips = match self {
            Pad::Halves => String::new(),
            Pad::Strips => format!(
                "strips = 4\nouter_share_percent = {OUTER_PERCENT}\nsensing_v_rms = {SENSING_V}\n"
            ),
        };
        format!(
            "[gap]\nrung = {gap}\n[halves]\nmismatch_percent = {mismatch_percent}\n{strips}{senses}"
        )
    }
}

/// Slots of one pad that follow one another without a pause.
fn timing(frame_ms: f64) -> Timing {
    let samples = (1e3 * frame_ms).round() as usize;
    Timing {
        pads: 1,
        slot_samples: samples,
        window_start: 0,
        window_samples: samples,
        samples_per_period: 10.0,
        signs: None,
    }
}

fn plant(text: &str, frame_ms: f64) -> Plant {
    let scene = Scene::parse(text, "wall.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    Plant::new(&scene, 0, &timing(frame_ms)).unwrap_or_else(|error| panic!("{error}"))
}

/// The plant with a hand on its pad.
pub fn with_hand(pad: Pad, hand: &Hand, mismatch_percent: f64, frame_ms: f64) -> Plant {
    plant(&scene_of(pad, hand, mismatch_percent, ""), frame_ms)
}

/// The scene of a hand on a pad, its target a point every 4 ms; `senses` are more keys of the pad's
/// electrodes.
pub fn scene_of(pad: Pad, hand: &Hand, mismatch_percent: f64, senses: &str) -> String {
    let (mut points, duration_s) = (String::new(), hand.duration_s());
    for n in 0..=(duration_s / 4e-3).ceil() as u32 {
        let time_s = 4e-3 * f64::from(n);
        write!(points, "[{time_s:.3}, {:.6}],", hand.target_mm(time_s)).expect("a string takes it");
    }
    let along: Vec<String> =
        hand.along.iter().map(|[time_s, mm]| format!("[{time_s:.4}, {mm}]")).collect();
    let y_mm = match along.is_empty() {
        true => String::new(),
        false => format!(", y_mm = [{}]", along.join(", ")),
    };
    let load_g = 1e3 * hand.load_n / GRAVITY;
    let pushed = format!("push_height_mm = {PUSH_HEIGHT_MM}\n{senses}[hand]\n");
    let Hand { stiffness_n_per_m: k, damping_n_s_per_m: c, mass_kg: m, .. } = hand;
    format!(
        "title = \"a hand at a wall\"\nduration_s = {duration_s}\n[[pad]]\nload_g = {load_g}\n\
         position_mm = {{ timeline = {{ x_mm = [{points}]{y_mm} }} }}\n{}\
         stiffness_n_per_m = {k}\ndamping_n_s_per_m = {c}\nmass_kg = {m}\n\
         [friction]\nrung = \"lugre\"\n",
        pad.tables(mismatch_percent, "\"tr-bdf2\"", &pushed)
    )
}

/// The inverse law of a device.
#[derive(Clone, Debug)]
pub struct Drive {
    /// k, N/(pF·V)².
    k: f64,
    /// Force and voltage of the steady curve, rising.
    steady: Vec<[f64; 2]>,
}

impl Drive {
    /// As a calibration of the resting device finds it.
    pub fn calibrated(pad: Pad) -> Drive {
        let (points, load_g) = (81, 1e3 * NOMINAL_N / GRAVITY);
        let text = format!(
            "title = \"steady curve\"\n[[pad]]\nposition_mm = [0, 0]\nload_g = {load_g}\n\
             haptic_v_rms = {{ sweep = {{ from = 0, to = {MOST_V}, points = {points} }} }}\n{}\
             [friction]\nrung = \"coulomb\"\n",
            pad.tables(0.0, "\"static\"", "")
        );
        let mut plant = plant(&text, 1.0);
        let (mut above, mut below, mut steady) = (0.0, 0.0, Vec::new());
        for slot in 0..points {
            let truth = plant.truth(slot);
            let square = (pad.capacitances(&truth).1 * truth.haptic_v_rms).powi(2);
            above += truth.force_n * square;
            below += square * square;
            steady.push([truth.force_n, truth.haptic_v_rms]);
        }
        Drive { k: above / below, steady }
    }

    /// The voltage for a force, with this capacitance of what brakes, pF.
    pub fn voltage(&self, force_n: f64, capacitance_pf: f64) -> f64 {
        if force_n <= 0.0 {
            return 0.0;
        }
        let inverse = (force_n / self.k).sqrt() / capacitance_pf.max(1.0);
        inverse.min(1.1 * self.steady_v(force_n)).min(MOST_V)
    }

    fn steady_v(&self, force_n: f64) -> f64 {
        let n = self.steady.partition_point(|[force, _]| *force < force_n);
        match (n.checked_sub(1).map(|n| self.steady[n]), self.steady.get(n)) {
            (Some([f0, v0]), Some([f1, v1])) => v0 + (v1 - v0) * (force_n - f0) / (f1 - f0),
            (None, Some([_, v])) => *v,
            _ => MOST_V,
        }
    }

    /// The largest force of the steady curve, N.
    pub fn most_n(&self) -> f64 {
        self.steady.last().map_or(0.0, |[force, _]| *force)
    }
}
