// SPDX-License-Identifier: MIT OR Apache-2.0
//! Taking away what other pads did to a reading: a host's work, since it needs all pads' frames and the sheet's potential
//! between any two places, which no core holds.
//!
//! A frame says which ratios the terminals' currents had, and where a lone pad would have been read so. Wanted is the place x
//! at which a pad among the others has them, r(x among others) = r(read), by Newton's steps with the lone pad's slopes from
//! where it was read; the capacitance follows from how much of the sum the others take. Others' own frames, a round old, are
//! near enough: they enter in second order only.

use num_complex::Complex64;

use crate::device::Device;
use crate::effects::Effects;
use crate::pad::lying;
use crate::truth::ratios;

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
}

impl Uncoupler {
    /// With those effects of a scene that split a current among the terminals.
    pub(crate) fn new(effects: Effects, device: Device) -> Self {
        Uncoupler { effects, device }
    }

    /// The pad that has these ratios (eqs. 2 and 3) among those others, and is read as `read`.
    pub fn uncouple(&mut self, read: Lying, ratios: [f64; 2], others: &[Lying]) -> Lying {
        let mut pad = read;
        self.hold(&mut pad);
        for _ in 0..STEPS {
            let (_, alone) = self.see(pad, &[]);
            let (seen, among) = self.see(pad, others);
            let step = self.step(pad, [seen[0] - ratios[0], seen[1] - ratios[1]]);
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
                self.see(moved, &[]).0
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

    /// Both ratios of a pad among others, and the amplitude of the sum of all terminals.
    fn see(&mut self, pad: Lying, others: &[Lying]) -> ([f64; 2], f64) {
        let mut on_sheet = |pad: &Lying| {
            let mut pad = lying([pad.x_mm, pad.y_mm], pad.capacitance_pf, &self.device);
            self.effects.on_pad(&mut pad);
            pad
        };
        let others: Vec<_> = others.iter().map(&mut on_sheet).collect();
        let mut pad = on_sheet(&pad);
        self.effects.on_pads(&mut pad, &others);
        let (r_x, r_y) = ratios(&pad.amplitudes());
        ([r_x, r_y], pad.transfer(&self.device).iter().sum::<Complex64>().norm())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::coupling::tests::{place_of, placements};
    use crate::effects::sheet::analytic::Analytic;
    use crate::effects::sheet::tests::sheet;
    use crate::plant::Plant;
    use crate::scene::Scene;
    use crate::timing::Timing;

    const TIMING: Timing =
        Timing { pads: 4, slot_samples: 200, window_start: 0, window_samples: 200, samples_per_period: 10.0 };

    fn plant(places: &[[f64; 2]]) -> Plant {
        let pad = |[x, y]: &[f64; 2]| format!("[[pad]]\nposition_mm = [{x}, {y}]\ncapacitance_pf = 760\n");
        let pads: String = places.iter().map(pad).collect();
        let text = format!("title = \"t\"\nuncouple = true\n{pads}[sheet]\nrung = \"analytic\"\n[coupling]\n");
        Plant::new(&Scene::parse(&text, "s.toml", &[]).unwrap(), 0, &TIMING).unwrap()
    }

    /// What an ideal core reads of each pad: the place where a lone one would have its ratios, and its amplitude.
    fn read(plant: &mut Plant, uncoupler: &mut Uncoupler, places: &[[f64; 2]]) -> Vec<(Lying, [f64; 2])> {
        let exact = Analytic::new(&sheet(0.0));
        let pads: Vec<_> = places.iter().map(|[x, y]| Lying { x_mm: *x, y_mm: *y, capacitance_pf: 760.0 }).collect();
        let one = |slot: usize| {
            let truth = plant.truth(slot);
            let [x_mm, y_mm] = place_of(&exact, (truth.r_x, truth.r_y), places[slot]);
            let others: Vec<_> = (0..pads.len()).filter(|n| *n != slot).map(|n| pads[n]).collect();
            let amplitude = uncoupler.see(pads[slot], &others).1 / uncoupler.see(pads[slot], &[]).1;
            (Lying { x_mm, y_mm, capacitance_pf: 760.0 * amplitude }, [truth.r_x, truth.r_y])
        };
        (0..places.len()).map(one).collect()
    }

    #[test]
    fn a_centimetre_of_shift_among_four_pads_of_760_pf_is_taken_out_to_a_millimetre() {
        let (mut raw, mut left, mut capacitance) = (0.0f64, 0.0f64, 0.0f64);
        for places in placements(300, 20.0) {
            let mut plant = plant(&places);
            let mut uncoupler = plant.uncoupler().unwrap();
            let read = read(&mut plant, &mut uncoupler, &places);
            let mut known: Vec<_> = read.iter().map(|(pad, _)| *pad).collect();
            for slot in 0..12 {
                let others: Vec<_> = (0..4).filter(|n| *n != slot % 4).map(|n| known[n]).collect();
                let (pad, ratios) = read[slot % 4];
                known[slot % 4] = uncoupler.uncouple(pad, ratios, &others);
            }
            for (((read, _), known), [x, y]) in read.iter().zip(&known).zip(places) {
                raw = raw.max((read.x_mm - x).hypot(read.y_mm - y));
                left = left.max((known.x_mm - x).hypot(known.y_mm - y));
                capacitance = capacitance.max((known.capacitance_pf / 760.0 - 1.0).abs());
            }
        }
        assert!(raw > 10.0 && left < 1.0 && capacitance < 1e-3, "{raw} mm, {left} mm left, {capacitance}");
    }

    #[test]
    fn a_pad_alone_stays_as_it_is_read() {
        let read = Lying { x_mm: 120.0, y_mm: -60.0, capacitance_pf: 318.0 };
        let mut uncoupler = plant(&[[0.0, 0.0]]).uncoupler().unwrap();
        let (ratios, _) = uncoupler.see(read, &[]);
        let freed = uncoupler.uncouple(read, ratios, &[]);
        assert!((freed.x_mm - 120.0).abs() < 1e-9 && (freed.capacitance_pf - 318.0).abs() < 1e-9, "{freed:?}");
    }
}
