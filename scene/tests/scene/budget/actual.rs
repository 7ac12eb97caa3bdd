// SPDX-License-Identifier: MIT OR Apache-2.0
//! The actual error of a scene against the same scene at other levels, over every slot and every
//! quantity, by code of its own. An ideal core that is calibrated on the finer scene reads both.
//!
//! Norms: a position against the sheet's size along its axis; capacitance and R_p against
//! themselves; voltage, force and friction against the largest of the case.

use std::f64::consts::TAU;

use hapticore_scene::{Complex, Device, Plant, Scene, Timing, Truth, signs_by_place};

/// What a core receives in a slot.
struct Signals {
    terminals: Vec<Complex>,
    sense: Complex,
    haptic_square: f64,
}

/// What a core makes of it.
#[derive(Clone, Copy, Debug)]
struct Reading {
    place_mm: [f64; 2],
    capacitance_f: f64,
    sheet_ohm: f64,
    haptic_v: f64,
    force_n: f64,
}

/// The worst error, percent, and what has it.
pub fn worst(coarse: &Scene, fine: &Scene, timing: &Timing) -> (f64, String) {
    let cases = (0..fine.cases.len()).map(|case| of_case(coarse, fine, case, timing));
    cases.fold((0.0, String::new()), larger)
}

fn larger(a: (f64, String), b: (f64, String)) -> (f64, String) {
    // What is not a number is the worst of all.
    if b.0 > a.0 || b.0.is_nan() { b } else { a }
}

fn of_case(coarse: &Scene, fine: &Scene, case: usize, timing: &Timing) -> (f64, String) {
    let [coarse, (core, fine)] = [coarse, fine].map(|scene| run(scene, case, timing));
    let coarse = coarse.1;
    let largest = |of: fn(&Truth) -> f64| {
        fine.iter().map(|(truth, _)| of(truth).abs()).fold(f64::MIN_POSITIVE, f64::max)
    };
    let device = &fine_device(&core);
    let [volt, newton, friction] =
        [largest(|t| t.haptic_v_rms), largest(|t| t.force_n), largest(|t| t.friction_n)];
    let mut worst = (0.0, String::new());
    for (slot, ((ct, cs), (ft, fs))) in coarse.iter().zip(&fine).enumerate() {
        let fine = core.read(fs, [ft.x_mm, ft.y_mm]);
        let coarse = core.read(cs, fine.place_mm);
        let own = |a: f64, b: f64| if a == b { 0.0 } else { a / b - 1.0 };
        let errors = [
            ("true x", (ct.x_mm - ft.x_mm) / device.width_mm),
            ("true y", (ct.y_mm - ft.y_mm) / device.height_mm),
            ("true C", own(ct.capacitance_pf, ft.capacitance_pf)),
            ("true R_p", own(ct.sheet_ohm, ft.sheet_ohm)),
            ("true V", (ct.haptic_v_rms - ft.haptic_v_rms) / volt),
            ("true F", (ct.force_n - ft.force_n) / newton),
            ("friction", (ct.friction_n - ft.friction_n) / friction),
            ("x", (coarse.place_mm[0] - fine.place_mm[0]) / device.width_mm),
            ("y", (coarse.place_mm[1] - fine.place_mm[1]) / device.height_mm),
            ("C", own(coarse.capacitance_f, fine.capacitance_f)),
            ("R_p", own(coarse.sheet_ohm, fine.sheet_ohm)),
            ("V", (coarse.haptic_v - fine.haptic_v) / volt),
            ("F", (coarse.force_n - fine.force_n) / newton),
        ];
        for (name, error) in errors {
            worst = larger(worst, (100.0 * error.abs(), format!("{name} in slot {slot}")));
        }
    }
    worst
}

fn fine_device(core: &Core) -> Device {
    core.plant.device()
}

/// Every slot of a case, and a core that knows its device.
fn run(scene: &Scene, case: usize, timing: &Timing) -> (Core, Vec<(Truth, Signals)>) {
    let mut plant = Plant::new(scene, case, timing).unwrap_or_else(|error| panic!("{error}"));
    let sampled = scene.cases[case].sampled();
    let slots = (0..plant.slots()).map(|slot| {
        let truth = plant.truth(slot);
        let signals =
            if sampled { lock_in(&mut plant, slot, timing) } else { phasors(&mut plant, slot) };
        (truth, signals)
    });
    let slots = slots.collect();
    (Core::new(plant), slots)
}

fn phasors(plant: &mut Plant, slot: usize) -> Signals {
    let terminals = plant.terminals().len();
    let mut found = vec![Complex::default(); terminals + 1];
    let haptic_square = plant.phasors(slot, &mut found);
    Signals { sense: found[terminals], terminals: found[..terminals].to_vec(), haptic_square }
}

/// Amplitudes and mean square under a Hann window.
fn lock_in(plant: &mut Plant, slot: usize, timing: &Timing) -> Signals {
    let (channels, count) = (plant.channels(), timing.window_samples);
    let mut samples = Vec::new();
    plant.samples(slot, timing.window_start..timing.window_start + count, &mut samples);
    let (mut found, mut haptic_square) = (vec![Complex::default(); channels - 1], 0.0);
    for (n, row) in samples.chunks_exact(channels).enumerate() {
        let hann = (1.0 - (TAU * n as f64 / count as f64).cos()) / count as f64;
        let turns = (timing.window_start + n) as f64 / timing.samples_per_period;
        let weight = Complex::cis(-TAU * turns) * (2.0 * hann);
        found.iter_mut().zip(row).for_each(|(sum, sample)| *sum += weight * sample);
        haptic_square += hann * row[channels - 1].powi(2);
    }
    let sense = found.pop().expect("a sensing voltage");
    Signals { terminals: found, sense, haptic_square }
}

/// An ideal core, calibrated on a plant's device.
struct Core {
    plant: Plant,
    device: Device,
    signs: [Vec<i8>; 2],
}

impl Core {
    fn new(plant: Plant) -> Core {
        let device = plant.device();
        let signs = signs_by_place(&device.terminals_mm, [device.width_mm, device.height_mm]);
        Core { plant, device, signs }
    }

    fn read(&self, signals: &Signals, near_mm: [f64; 2]) -> Reading {
        let amplitudes: Vec<f64> = signals.terminals.iter().map(|i| i.norm()).collect();
        let place_mm = self.place(self.ratios(&amplitudes), near_mm);
        let sheet_ohm = self.plant.measurements(&[place_mm])[0].sheet_ohm;
        let ampere =
            signals.terminals.iter().sum::<Complex>().norm() * self.device.current_full_scale_a;
        let volt = signals.sense.norm() * self.device.sense_full_scale_v;
        let across = (volt.powi(2) - (ampere * sheet_ohm).powi(2)).sqrt();
        let capacitance_f = ampere / (self.device.carrier_rad_s * across);
        let haptic_v = signals.haptic_square.sqrt() * self.device.haptic_full_scale_v;
        let force_n = self.device.force_k * (capacitance_f * haptic_v).powi(2);
        Reading { place_mm, capacitance_f, sheet_ohm, haptic_v, force_n }
    }

    fn ratios(&self, amplitudes: &[f64]) -> [f64; 2] {
        let [x, y] = &self.signs;
        let counted =
            amplitudes.iter().zip(x.iter().zip(y)).filter(|(_, (x, y))| **x != 0 || **y != 0);
        let sum: f64 = counted.map(|(amplitude, _)| amplitude).sum();
        self.signs.each_ref().map(|signs| {
            amplitudes
                .iter()
                .zip(signs)
                .map(|(amplitude, sign)| amplitude * f64::from(*sign))
                .sum::<f64>()
                / sum
        })
    }

    /// Where an isolated pad's ratios are nearest to these, by Newton's steps within the places
    /// that a pad reaches.
    fn place(&self, ratios: [f64; 2], near_mm: [f64; 2]) -> [f64; 2] {
        const STEP_MM: f64 = 0.05;
        let reach = self.device.reach_mm();
        let mut at = [0, 1].map(|axis| near_mm[axis].clamp(-reach[axis], reach[axis]));
        for _ in 0..25 {
            // Differences are taken inwards, where the pad stays on the sheet.
            let step = at.map(|mm| if mm > 0.0 { -STEP_MM } else { STEP_MM });
            let places = [at, [at[0] + step[0], at[1]], [at[0], at[1] + step[1]]];
            let [here, right, up] = <[_; 3]>::try_from(self.plant.measurements(&places))
                .expect("three places")
                .map(|of| self.ratios(&of.siemens.iter().map(|s| s.norm()).collect::<Vec<_>>()));
            let slope = |there: [f64; 2], step: f64| [0, 1].map(|n| (there[n] - here[n]) / step);
            let columns = [slope(right, step[0]), slope(up, step[1])];
            let off = [0, 1].map(|n| ratios[n] - here[n]);
            let next = [0, 1].map(|axis| at[axis] + bounded(columns, off, at, reach)[axis]);
            let next = [0, 1].map(|axis| next[axis].clamp(-reach[axis], reach[axis]));
            let moved = (next[0] - at[0]).hypot(next[1] - at[1]);
            at = next;
            if moved < 1e-9 {
                break;
            }
        }
        at
    }
}

/// The step that takes `off` away; where it would leave the bounds at one of them, the best along
/// that bound.
fn bounded(columns: [[f64; 2]; 2], off: [f64; 2], at: [f64; 2], reach: [f64; 2]) -> [f64; 2] {
    let [[a, c], [b, d]] = columns;
    let determinant = a * d - b * c;
    let newton = [(d * off[0] - b * off[1]) / determinant, (a * off[1] - c * off[0]) / determinant];
    let stuck = [0, 1].map(|n| at[n].abs() >= reach[n] && (at[n] + newton[n]).abs() > reach[n]);
    let alone = |[a, c]: [f64; 2]| (a * off[0] + c * off[1]) / (a * a + c * c);
    match stuck {
        [true, true] => [0.0; 2],
        [true, false] => [0.0, alone(columns[1])],
        [false, true] => [alone(columns[0]), 0.0],
        [false, false] => newton,
    }
}
