// SPDX-License-Identifier: MIT OR Apache-2.0
//! A device drawn at random: an ideal resistive sheet with four or six terminals, and pads on it.
//!
//! Terminal k at 1 V and all others at 0 V give the sheet the potential φ_k, which obeys Laplace's
//! equation. By reciprocity φ_k(p) is the share of a pad's current at p that flows into terminal k.
//! Solved on a square grid by successive overrelaxation.

use std::f64::consts::TAU;

use fastrand::Rng;

/// Nodes along x.
const COLUMNS: usize = 41;

/// The carrier, Hz, and samples per second: those of the profile `standard`.
pub const CARRIER_HZ: f64 = 101e3;
pub const RATE_HZ: f64 = 1e6;

/// Full scales: A, V, V, peak.
pub const CURRENT_A: f64 = 4e-3;
pub const SENSE_V: f64 = 8.0;
pub const HAPTIC_V: f64 = 600.0;

/// The sensing voltage, V peak.
const SENSING_V: f64 = 5.0;

/// A pad on the sheet.
#[derive(Debug, Clone)]
pub struct Pad {
    /// Where it begins and where it goes, mm.
    pub from_mm: [f64; 2],
    pub to_mm: [f64; 2],
    pub farad: f64,
    pub haptic_v_rms: f64,
    pub haptic_hz: f64,
}

/// A sheet and its pads.
#[derive(Clone)]
pub struct Device {
    pub size_mm: [f64; 2],
    pub terminals_mm: Vec<[f64; 2]>,
    pub ohm: f64,
    pub pads: Vec<Pad>,
    rows: usize,
    /// Of each terminal, by node.
    potentials: Vec<Vec<f64>>,
}

impl Device {
    /// The device of a seed.
    pub fn draw(seed: u64) -> Device {
        let mut rng = Rng::with_seed(0x51EE7 + seed);
        let within = |rng: &mut Rng, low: f64, high: f64| low + (high - low) * rng.f64();
        let width = within(&mut rng, 200.0, 900.0);
        let rows = rng.usize(21..36);
        let pitch = width / (COLUMNS - 1) as f64;
        let height = pitch * (rows - 1) as f64;
        let [x, y] = [width / 2.0, height / 2.0];
        let mut terminals_mm = vec![[-x, y], [-x, -y], [x, -y], [x, y]];
        if rng.bool() {
            terminals_mm.extend([[0.0, -y], [0.0, y]]);
        }
        let place = |rng: &mut Rng| [x, y].map(|half| within(rng, -0.75, 0.75) * half);
        // A pad is moved over the sheet: at one place some faults do not show.
        let pad = |rng: &mut Rng| {
            let (from_mm, back) = (place(rng), within(rng, 0.4, 1.2));
            Pad {
                from_mm,
                to_mm: from_mm.map(|from| -back * from),
                farad: within(rng, 250e-12, 500e-12),
                haptic_v_rms: within(rng, 40.0, 350.0),
                haptic_hz: 1000.0,
            }
        };
        let pads = (0..rng.usize(1..5)).map(|_| pad(&mut rng)).collect();
        let film_ohm = within(&mut rng, 50.0, 300.0);
        let series = within(&mut rng, 0.5, 3.0);
        let mut device = Device {
            size_mm: [width, height],
            terminals_mm,
            ohm: film_ohm * 0.7,
            pads,
            rows,
            potentials: Vec::new(),
        };
        device.potentials =
            (0..device.terminals_mm.len()).map(|k| device.potential(k, series)).collect();
        device
    }

    /// The potential of terminal `k` at 1 V, behind `series` squares of the film.
    fn potential(&self, k: usize, series: f64) -> Vec<f64> {
        let (columns, rows) = (COLUMNS, self.rows);
        let node = |[x, y]: [f64; 2]| {
            let at = |x: f64, size: f64, count: usize| {
                ((x / size + 0.5) * (count - 1) as f64).round() as usize
            };
            at(y, self.size_mm[1], rows) * columns + at(x, self.size_mm[0], columns)
        };
        let terminals: Vec<usize> = self.terminals_mm.iter().map(|at| node(*at)).collect();
        let mut potential = vec![1.0 / terminals.len() as f64; columns * rows];
        for _ in 0..1500 {
            let mut change: f64 = 0.0;
            for index in 0..columns * rows {
                let (column, row) = (index % columns, index / columns);
                // A resistor along the edge is half as wide as one within.
                let along_x = if row == 0 || row + 1 == rows { 0.5 } else { 1.0 };
                let along_y = if column == 0 || column + 1 == columns { 0.5 } else { 1.0 };
                let (mut sum, mut conductance) = (0.0, 0.0);
                let mut add = |other: usize, by: f64| {
                    sum += by * potential[other];
                    conductance += by;
                };
                if column > 0 {
                    add(index - 1, along_x)
                }
                if column + 1 < columns {
                    add(index + 1, along_x)
                }
                if row > 0 {
                    add(index - columns, along_y)
                }
                if row + 1 < rows {
                    add(index + columns, along_y)
                }
                if let Some(terminal) = terminals.iter().position(|node| *node == index) {
                    sum += if terminal == k { 1.0 / series } else { 0.0 };
                    conductance += 1.0 / series;
                }
                let step = 1.9 * (sum / conductance - potential[index]);
                potential[index] += step;
                change = change.max(step.abs());
            }
            if change < 1e-10 {
                break;
            }
        }
        potential
    }

    /// Each terminal's share of the current of a pad at a place.
    pub fn shares(&self, [x, y]: [f64; 2]) -> Vec<f64> {
        let along = |x: f64, size: f64, count: usize| {
            let at = ((x / size + 0.5) * (count - 1) as f64).clamp(0.0, (count - 1) as f64);
            let cell = (at as usize).min(count - 2);
            (cell, at - cell as f64)
        };
        let ((column, u), (row, v)) =
            (along(x, self.size_mm[0], COLUMNS), along(y, self.size_mm[1], self.rows));
        let share = |potential: &Vec<f64>| {
            let at = |c: usize, r: usize| potential[(row + r) * COLUMNS + column + c];
            (1.0 - v) * ((1.0 - u) * at(0, 0) + u * at(1, 0))
                + v * ((1.0 - u) * at(0, 1) + u * at(1, 1))
        };
        self.potentials.iter().map(share).collect()
    }

    /// The admittance of a capacitance through the sheet: real and imaginary part, S.
    pub fn admittance(&self, farad: f64) -> [f64; 2] {
        let omega_c = TAU * CARRIER_HZ * farad;
        let drop = omega_c * self.ohm;
        [omega_c * drop, omega_c].map(|part| part / (1.0 + drop * drop))
    }

    /// Each terminal's current, A, in phase with the sensing voltage and a quarter turn ahead.
    pub fn currents(&self, farad: f64, at_mm: [f64; 2]) -> Vec<[f64; 2]> {
        let admittance = self.admittance(farad);
        self.shares(at_mm)
            .into_iter()
            .map(|share| admittance.map(|part| part * share * SENSING_V))
            .collect()
    }

    /// The sensing voltage, V peak.
    pub fn sensing_v(&self) -> f64 {
        SENSING_V
    }

    /// Where a pad is at a part of the recording, mm.
    pub fn at_mm(&self, pad: usize, part: f64) -> [f64; 2] {
        let Pad { from_mm, to_mm, .. } = &self.pads[pad];
        [0, 1].map(|axis| from_mm[axis] + part * (to_mm[axis] - from_mm[axis]))
    }
}
