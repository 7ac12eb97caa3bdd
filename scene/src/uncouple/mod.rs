// SPDX-License-Identifier: MIT OR Apache-2.0
//! Taking away what other pads did to a reading: a host's work, since it needs all pads' frames and the sheet's potential
//! between any two places, which no core holds.
//!
//! A frame says which ratios the terminals' currents had, and where a lone pad would have been read so. Wanted is the place x
//! at which a pad among the others has them, r(x among others) = r(read), by Newton's steps with the lone pad's slopes from
//! where it was read; the capacitance follows from how much of the sum the others take. Others' own frames, a round old, are
//! near enough: they enter in second order only.
//!
//! The sheet's potential is that of the nominal sheet, its film even; what a lone pad reads is that plus what the device's own
//! calibration found beyond it, and the coupling is as much stronger as the calibration's R_p is larger (`beyond`).

mod beyond;
#[cfg(test)]
mod tests;

use num_complex::Complex64;

use crate::device::Device;
use crate::effects::{Effects, Pad};
use crate::pad::lying;
use crate::ratios::Ratios;
use crate::truth::MapPoint;
use beyond::Beyond;
pub(crate) use beyond::RASTER;

/// Newton's steps; the third already changes nothing that could be measured.
const STEPS: usize = 5;

/// The longest of them, mm: near a corner slopes change quickly.
const LONGEST_MM: f64 = 6.0;

/// Over what slopes are taken, mm.
const SLOPE_MM: f64 = 0.25;

/// A pad as a frame tells of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lying {
    /// Millimetres right of the sheet's centre.
    pub x_mm: f64,
    /// Millimetres above it.
    pub y_mm: f64,
    /// Picofarads between pad and sheet.
    pub capacitance_pf: f64,
}

/// Takes away what other pads did to a reading.
pub struct Uncoupler {
    effects: Effects,
    device: Device,
    ratios: Ratios,
    beyond: Beyond,
}

impl Uncoupler {
    /// With the effects that split a current among the terminals of the nominal sheet, and what the device's calibration
    /// reads at [`beyond::RASTER`], as far out as a pad reaches.
    pub(crate) fn new(effects: Effects, device: Device, ratios: Ratios, calibration: &[MapPoint]) -> Self {
        let mut uncoupler = Uncoupler { effects, ratios, beyond: Beyond::none(device.reach_mm()), device };
        let places = calibration.iter().map(|point| {
            let nominal = uncoupler.on_sheet(&Lying { x_mm: point.x_mm, y_mm: point.y_mm, capacitance_pf: 1.0 });
            let [r_x, r_y] = uncoupler.ratios.of(&nominal.amplitudes());
            [point.r_x - r_x, point.r_y - r_y, point.sheet_ohm / nominal.sheet_ohm.re]
        });
        let places = places.collect();
        uncoupler.beyond = uncoupler.beyond.with(places);
        uncoupler
    }

    /// The pad that has these ratios among those others, and is read as `read`.
    pub fn uncouple(&mut self, read: Lying, ratios: [f64; 2], others: &[Lying]) -> Lying {
        let mut pad = read;
        self.hold(&mut pad);
        for _ in 0..STEPS {
            let (_, alone) = self.see(pad, &[]);
            let (seen, among) = self.see(pad, others);
            let [by_x, by_y, _] = self.beyond.at(pad.x_mm, pad.y_mm);
            let step = self.step(pad, [seen[0] + by_x - ratios[0], seen[1] + by_y - ratios[1]]);
            let longest = (LONGEST_MM / step[0].hypot(step[1])).min(1.0);
            pad.x_mm -= step[0] * longest;
            pad.y_mm -= step[1] * longest;
            pad.capacitance_pf = read.capacitance_pf * alone / among;
            self.hold(&mut pad);
        }
        pad
    }

    /// How far a lone pad would have to move for a change of its ratios.
    fn step(&mut self, pad: Lying, change: [f64; 2]) -> [f64; 2] {
        let mut slope = |x_mm: f64, y_mm: f64| {
            let [low, high] = [-1.0, 1.0].map(|sign| {
                let moved = Lying { x_mm: pad.x_mm + sign * x_mm, y_mm: pad.y_mm + sign * y_mm, ..pad };
                self.lone(moved)
            });
            [0, 1].map(|n| (high[n] - low[n]) / (2.0 * SLOPE_MM))
        };
        let (by_x, by_y) = (slope(SLOPE_MM, 0.0), slope(0.0, SLOPE_MM));
        let det = by_x[0] * by_y[1] - by_x[1] * by_y[0];
        [(change[0] * by_y[1] - change[1] * by_y[0]) / det, (change[1] * by_x[0] - change[0] * by_x[1]) / det]
    }

    /// Holds a pad where slopes can be taken.
    fn hold(&self, pad: &mut Lying) {
        let [x, y] = self.device.reach_mm().map(|reach| reach - SLOPE_MM);
        pad.x_mm = pad.x_mm.clamp(-x, x);
        pad.y_mm = pad.y_mm.clamp(-y, y);
    }

    /// Both ratios of a lone pad on the nominal sheet.
    fn lone(&mut self, pad: Lying) -> [f64; 2] {
        self.see(pad, &[]).0
    }

    /// Both ratios of a pad among others, and the amplitude of the sum of all terminals.
    fn see(&mut self, pad: Lying, others: &[Lying]) -> ([f64; 2], f64) {
        let others: Vec<_> = others.iter().map(|pad| self.on_sheet(pad)).collect();
        let mut pad = self.on_sheet(&pad);
        self.effects.on_pads(&mut pad, &others);
        (self.ratios.of(&pad.amplitudes()), pad.transfer(&self.device).iter().sum::<Complex64>().norm())
    }

    /// A pad on the nominal sheet, as coupled as it is on the device's: only ωCG counts, so that where the calibration has
    /// a larger R_p, a larger C does the same.
    fn on_sheet(&mut self, pad: &Lying) -> Pad {
        let [.., ohm] = self.beyond.at(pad.x_mm, pad.y_mm);
        let mut pad = lying([pad.x_mm, pad.y_mm], pad.capacitance_pf * ohm, &self.device);
        self.effects.on_pad(&mut pad);
        pad
    }
}
