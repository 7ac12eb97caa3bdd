// SPDX-License-Identifier: MIT OR Apache-2.0
//! An ideal core: it knows the device exactly as a calibration finds it, and rounds nothing.
//!
//! The place is where an isolated pad has the ratios r_x and r_y that were measured, found by
//! Newton's steps on a table of the forward map. R_p is the table's value there;
//! C = |I|/(ω·√(V² − |I|²·R_p²)) and F = k·(C·V_h)² (docs/physics.md §2, eq. 8).

use num_complex::Complex64;

use crate::device::Device;
use crate::effects::sheet::spline::{Axis, Spline};
use crate::plant::Plant;
use crate::ratios::{self, Ratios};
use crate::rotor::Rotor;
use crate::terminals::PerTerminal;
use crate::timing::Timing;

use super::norm::Quantities;

/// Columns and rows of the table; of one whose places cost more than this, ns.
const NODES: [usize; 2] = [65, 39];
const FEW_NODES: [usize; 2] = [33, 20];
const DEAR_NS: f64 = 5e3;

/// Newton's steps at most, and where they end, mm.
const MOST_STEPS: usize = 12;
const NEAR_MM: f64 = 1e-7;

/// What a core receives of a slot: amplitudes and a mean square, as fractions of full scale.
pub(super) struct Signals {
    terminals: PerTerminal<Complex64>,
    sense: Complex64,
    haptic_square: f64,
}

impl Signals {
    /// From the phasors.
    pub fn of_phasors(plant: &mut Plant, slot: usize) -> Signals {
        let mut phasors = vec![Complex64::ZERO; plant.channels() - 1];
        let haptic_square = plant.phasors(slot, &mut phasors);
        Signals::new(&phasors, haptic_square)
    }

    /// From the samples of the slot's window, under a Hann weight.
    pub fn of_samples(plant: &mut Plant, slot: usize, timing: &Timing) -> Signals {
        let mut samples = Vec::new();
        let first = timing.window_start;
        plant.samples(slot, first..first + timing.window_samples, &mut samples);
        let mut phasors = vec![Complex64::ZERO; plant.channels() - 1];
        let mut haptic_square = 0.0;
        let turns = 1.0 / timing.samples_per_period;
        let mut carrier = Rotor::new(-turns * first as f64, -turns);
        let mut hann = Rotor::new(0.0, 1.0 / timing.window_samples as f64);
        for row in samples.chunks_exact(plant.channels()) {
            let window = (1.0 - hann.turn().re) / timing.window_samples as f64;
            let weight = carrier.turn() * (2.0 * window);
            phasors.iter_mut().zip(row).for_each(|(phasor, sample)| *phasor += weight * sample);
            haptic_square += window * row[row.len() - 1].powi(2);
        }
        Signals::new(&phasors, haptic_square)
    }

    fn new(phasors: &[Complex64], haptic_square: f64) -> Signals {
        let (sense, terminals) = phasors.split_last().expect("a sensing voltage");
        Signals { terminals: terminals.iter().copied().collect(), sense: *sense, haptic_square }
    }
}

/// An ideal core.
pub(super) struct Core {
    device: Device,
    ratios: Ratios,
    /// r_x, r_y and R_p over the places that a pad reaches.
    table: Spline,
}

impl Core {
    /// Calibrated on a plant, which takes so long at a place.
    pub fn calibrated(plant: &Plant, timing: &Timing, place_ns: f64) -> Result<Core, String> {
        let device = plant.device();
        let ratios = ratios::of_device(&device, timing.signs.as_ref())?;
        let [columns, rows] = if place_ns > DEAR_NS { FEW_NODES } else { NODES };
        let map = plant.calibration_map(columns, rows, device.pad_diameter_mm / 2.0);
        let reach = device.reach_mm();
        let axes = [0, 1].map(|axis| Axis::symmetric(reach[axis], [columns, rows][axis]));
        let table = Spline::free(axes, 3, |column, row| {
            let place = &map[row * columns + column];
            [place.r_x, place.r_y, place.sheet_ohm].into_iter().collect()
        });
        Ok(Core { device, ratios, table })
    }

    /// What it reads of a pad near a place, mm.
    pub fn read(&self, signals: &Signals, near_mm: [f64; 2]) -> Quantities {
        let ratios = self.ratios.of_amplitudes(&signals.terminals.map(Complex64::norm));
        let [x_mm, y_mm] = self.place(ratios, near_mm);
        let sheet_ohm = self.table.at(x_mm, y_mm)[2];
        let total = signals.terminals.iter().sum::<Complex64>().norm();
        let ampere = total * self.device.current_full_scale_a;
        let volt = signals.sense.norm() * self.device.sense_full_scale_v;
        let across = (volt.powi(2) - (ampere * sheet_ohm).powi(2)).sqrt();
        let capacitance_f = ampere / (self.device.carrier_rad_s * across);
        let haptic_v = signals.haptic_square.sqrt() * self.device.haptic_full_scale_v;
        let force_n = self.device.force_k * (capacitance_f * haptic_v).powi(2);
        [x_mm, y_mm, 1e12 * capacitance_f, sheet_ohm, haptic_v, force_n, 0.0]
    }

    /// Where the ratios are nearest to those of the table; not a number where they say nothing of
    /// the place.
    fn place(&self, ratios: [f64; 2], near_mm: [f64; 2]) -> [f64; 2] {
        let reach = self.device.reach_mm();
        let held = |at: [f64; 2]| [0, 1].map(|axis| at[axis].clamp(-reach[axis], reach[axis]));
        let mut at = held(near_mm);
        for _ in 0..MOST_STEPS {
            let next = self.step(ratios, at, reach);
            let moved = (next[0] - at[0]).hypot(next[1] - at[1]);
            at = next;
            if moved < NEAR_MM || moved.is_nan() {
                break;
            }
        }
        at
    }

    /// A Newton step; along the edge of what a pad reaches, where it would leave that.
    fn step(&self, ratios: [f64; 2], at: [f64; 2], reach: [f64; 2]) -> [f64; 2] {
        let here = self.table.at(at[0], at[1]);
        let off = [0, 1].map(|n| ratios[n] - here[n]);
        let [right, up] = [0, 1].map(|axis| self.slope(at, axis));
        let determinant = right[0] * up[1] - up[0] * right[1];
        let mut by = [up[1] * off[0] - up[0] * off[1], right[0] * off[1] - right[1] * off[0]]
            .map(|part| part / determinant);
        let leaves = |axis: usize, by: f64| {
            (at[axis] + by).abs() > reach[axis] && at[axis].abs() == reach[axis]
        };
        for (axis, along) in [(0, up), (1, right)] {
            if leaves(axis, by[axis]) {
                by[1 - axis] =
                    (along[0] * off[0] + along[1] * off[1]) / (along[0].powi(2) + along[1].powi(2));
            }
        }
        [0, 1].map(|axis| (at[axis] + by[axis]).clamp(-reach[axis], reach[axis]))
    }

    /// How both ratios rise along an axis, 1/mm, by a difference inwards, where the table goes on.
    fn slope(&self, at: [f64; 2], axis: usize) -> [f64; 2] {
        const STEP_MM: f64 = 0.05;
        let step = STEP_MM.copysign(-at[axis]);
        let mut there = at;
        there[axis] += step;
        let (here, there) = (self.table.at(at[0], at[1]), self.table.at(there[0], there[1]));
        [0, 1].map(|n| (there[n] - here[n]) / step)
    }
}
