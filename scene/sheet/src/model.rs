// SPDX-License-Identifier: MIT OR Apache-2.0
//! What pads on the nominal sheet of a device are measured as: what a host takes crosstalk out by.

use crate::analytic::{Analytic, Source};
use crate::coupling::{admittance, answered, apart, symmetric};
use crate::ratios::Ratios;
use crate::uniform::UniformSheet;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// A pad as a frame describes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PadEstimate {
    /// Millimetres right of the sheet's centre.
    pub x_mm: f64,
    /// Millimetres above the sheet's centre.
    pub y_mm: f64,
    /// Picofarads between pad and sheet.
    pub capacitance_pf: f64,
}

/// The nominal sheet of a device: how it splits the currents of pads among its terminals.
pub trait SheetModel: Send + Sync {
    /// Both ratios of an isolated pad, and the resistance R_p that it sees, Ω.
    fn isolated(&mut self, pad: &PadEstimate) -> ([f64; 2], f64);

    /// Both ratios of a pad among others, and the amplitude of the sum of all terminals' currents,
    /// in any unit.
    fn with_neighbours(&mut self, pad: &PadEstimate, others: &[PadEstimate]) -> ([f64; 2], f64);

    /// How far from the sheet's centre a pad's centre may be, mm.
    fn reach_mm(&self) -> [f64; 2];
}

/// A uniform sheet as the nominal one.
///
/// ```
/// use hapticore_sheet::{NominalSheet, PadEstimate, Ratios, SheetModel, UniformSheet};
///
/// let sheet = UniformSheet {
///     size_m: [0.86, 0.5],
///     ohm_per_square: 150.0,
///     pad_radius_m: 0.015,
///     terminals_m: vec![[0.0, 0.5], [0.0, 0.0], [0.86, 0.0], [0.86, 0.5]],
///     terminal_ohm: vec![0.0; 4],
///     terminal_radius_m: 1.7e-3,
/// };
/// let ratios = Ratios::new([vec![-1, -1, 1, 1], vec![1, -1, -1, 1]]);
/// let mut nominal = NominalSheet::new(sheet, 100e3, ratios);
/// let pad = PadEstimate { x_mm: 100.0, y_mm: 0.0, capacitance_pf: 760.0 };
/// let other = PadEstimate { x_mm: -100.0, ..pad };
/// let (([alone, _], ohm), ([with_neighbours, _], _)) = (nominal.isolated(&pad), nominal.with_neighbours(&pad, &[other]));
/// assert!(with_neighbours > alone, "the other one draws current from the left");
/// assert!((100.0..250.0).contains(&ohm));
/// ```
pub struct NominalSheet {
    analytic: Analytic,
    ratios: Ratios,
    carrier_rad_s: f64,
    pad_diameter_mm: f64,
    reach_mm: [f64; 2],
}

impl NominalSheet {
    /// Of a device with this carrier, whose ratios have these signs.
    pub fn new(sheet: UniformSheet, carrier_hz: f64, ratios: Ratios) -> Self {
        NominalSheet {
            carrier_rad_s: TAU * carrier_hz,
            pad_diameter_mm: 2e3 * sheet.pad_radius_m,
            reach_mm: sheet.size_m.map(|size| 1e3 * (size / 2.0 - sheet.pad_radius_m)),
            analytic: Analytic::new(sheet),
            ratios,
        }
    }

    fn source(&self, pad: &PadEstimate) -> Source {
        let [x, y] = self.reach_mm;
        self.analytic.source(pad.x_mm.clamp(-x, x), pad.y_mm.clamp(-y, y))
    }

    /// What a pad has in its own way: its capacitance, and the sheet's resistance at its place.
    fn own_ohm(&self, pad: &PadEstimate, source: &Source) -> Complex64 {
        let sheet_ohm = self.analytic.between(source, source).into();
        admittance(self.carrier_rad_s, 1e-12 * pad.capacitance_pf, sheet_ohm).inv()
    }
}

impl SheetModel for NominalSheet {
    fn isolated(&mut self, pad: &PadEstimate) -> ([f64; 2], f64) {
        let source = self.source(pad);
        let amplitudes: Vec<f64> = source.shares().iter().map(|share| share.abs()).collect();
        (self.ratios.of_amplitudes(&amplitudes), self.analytic.between(&source, &source))
    }

    fn with_neighbours(&mut self, pad: &PadEstimate, others: &[PadEstimate]) -> ([f64; 2], f64) {
        let place = |pad: &PadEstimate| [pad.x_mm, pad.y_mm];
        let (places, _) =
            apart(place(pad), others.iter().map(place), self.reach_mm, self.pad_diameter_mm);
        let apart: Vec<_> = places.iter().map(|[x, y]| self.analytic.source(*x, *y)).collect();
        let mut ohm =
            symmetric(apart.len(), |k, l| self.analytic.between(&apart[k], &apart[l]).into());
        let pads: Vec<_> = std::iter::once(pad).chain(others).collect();
        let sources: Vec<_> = pads.iter().map(|pad| self.source(pad)).collect();
        (0..pads.len()).for_each(|k| ohm[k][k] = self.own_ohm(pads[k], &sources[k]));
        let currents = answered(ohm);
        let into = |terminal: usize| -> Complex64 {
            sources
                .iter()
                .zip(&currents)
                .map(|(source, current)| current * source.shares()[terminal])
                .sum()
        };
        let into: Vec<_> = (0..sources[0].shares().len()).map(into).collect();
        let amplitudes: Vec<_> = into.iter().map(|current| current.norm()).collect();
        (self.ratios.of_amplitudes(&amplitudes), into.iter().sum::<Complex64>().norm())
    }

    fn reach_mm(&self) -> [f64; 2] {
        self.reach_mm
    }
}
