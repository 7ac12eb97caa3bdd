// SPDX-License-Identifier: MIT OR Apache-2.0
//! Crosstalk cancellation: takes out of a pad's measurement what the other pads did to it. It is a
//! host's work, since it needs all pads' frames and the sheet's potential between any two places,
//! which no core holds.
//!
//! A frame says which ratios the terminals' currents had, and where an isolated pad would have been
//! measured so. The canceller solves r(x among others) = r(measured) for the place x of the pad
//! among the others, by Newton's steps with the isolated pad's slopes from where it was measured.
//! The capacitance follows from how much of the sum the others take. Others' own frames, a round
//! old, are near enough: they enter in second order only.
//!
//! The sheet's potential is that of the nominal sheet ([`SheetModel`]), its film uniform. An
//! isolated pad's ratios are the nominal ones plus the deviation that the device's own calibration
//! found. The coupling is scaled by the calibration's R_p over the nominal R_p.
//!
//! The force goes with the square of the capacitance, by eq. 8: it must have no memory beyond the
//! slot.

mod deviation;

use crate::device::DeviceCalibration;
use crate::quantities::Quantities;
use deviation::Deviation;

pub use hapticore_sheet::{NominalSheet, PadEstimate, Ratios, SheetModel, UniformSheet};

/// Newton's steps; the third already changes nothing that could be measured.
const STEPS: usize = 5;

/// The longest of them, mm: near a corner slopes change quickly.
const LONGEST_MM: f64 = 6.0;

/// Over what slopes are taken, mm.
const SLOPE_MM: f64 = 0.25;

impl From<&Quantities> for PadEstimate {
    /// The pad as measured.
    fn from(measured: &Quantities) -> Self {
        let Quantities { x_mm, y_mm, capacitance_pf, .. } = *measured;
        PadEstimate { x_mm, y_mm, capacitance_pf }
    }
}

/// Takes out of each pad's measurements what the others did to them, as far as their latest frames
/// tell.
///
/// ```
/// use hapticore_host::{CrosstalkCanceller, NominalSheet, PadEstimate, Ratios, SheetModel, UniformSheet};
///
/// // The paper's display.
/// let sheet = UniformSheet {
///     size_m: [0.86, 0.5],
///     ohm_per_square: 150.0,
///     pad_radius_m: 0.015,
///     terminals_m: vec![[0.0, 0.5], [0.0, 0.0], [0.86, 0.0], [0.86, 0.5], [0.43, 0.0], [0.43, 0.5]],
///     terminal_ohm: vec![0.0; 6],
///     terminal_radius_m: 1.7e-3,
/// };
/// let ratios = Ratios::new([vec![-1, -1, 1, 1, 0, 0], vec![1, -1, -1, 1, -1, 1]]);
/// let mut nominal = NominalSheet::new(sheet.clone(), 100e3, ratios.clone());
/// let pad = PadEstimate { x_mm: 100.0, y_mm: 20.0, capacitance_pf: 760.0 };
/// let other = PadEstimate { x_mm: -50.0, y_mm: -10.0, ..pad };
/// let (measured, _) = nominal.with_neighbours(&pad, &[other]);
///
/// let mut canceller = CrosstalkCanceller::nominal(nominal);
/// let isolated = canceller.cancel(PadEstimate { x_mm: 103.0, ..pad }, measured, &[other]);
/// assert!((isolated.x_mm - 100.0).abs() < 1e-3 && (isolated.y_mm - 20.0).abs() < 1e-3);
/// ```
pub struct CrosstalkCanceller {
    sheet: Box<dyn SheetModel>,
    deviation: Deviation,
    latest: Vec<Option<PadEstimate>>,
}

impl CrosstalkCanceller {
    /// For a device that is its nominal sheet.
    pub fn nominal(sheet: impl SheetModel + 'static) -> Self {
        let deviation = Deviation::none(sheet.reach_mm());
        CrosstalkCanceller { sheet: Box::new(sheet), deviation, latest: Vec::new() }
    }

    /// For a device whose calibration is known; of the nominal sheet the places of its map are
    /// those that a pad reaches.
    pub fn calibrated(sheet: impl SheetModel + 'static, device: &DeviceCalibration) -> Self {
        CrosstalkCanceller::with_map(sheet, device.map.columns, &device.map.places)
    }

    /// The same with a map `[x_mm, y_mm, r_x, r_y, sheet_ohm]` of whole rows, from one end of a
    /// pad's reach to the other.
    ///
    /// # Panics
    /// If the rows are not whole.
    pub fn with_map(sheet: impl SheetModel + 'static, columns: usize, places: &[[f64; 5]]) -> Self {
        let mut canceller = CrosstalkCanceller::nominal(sheet);
        let beyond = places.iter().map(|&[x_mm, y_mm, r_x, r_y, sheet_ohm]| {
            let (nominal, ohm) =
                canceller.sheet.isolated(&PadEstimate { x_mm, y_mm, capacitance_pf: 1.0 });
            [r_x - nominal[0], r_y - nominal[1], sheet_ohm / ohm]
        });
        let beyond = beyond.collect();
        canceller.deviation = canceller.deviation.with(columns, beyond);
        canceller
    }

    /// Corrects a pad's measurement: its place, its capacitance, and the force that goes with its
    /// square. Its ratios stay as they were measured.
    pub fn apply(&mut self, pad: usize, measured: &mut Quantities) {
        self.latest.resize(self.latest.len().max(pad + 1), None);
        let others: Vec<_> = (0..self.latest.len())
            .filter(|other| *other != pad)
            .filter_map(|n| self.latest[n])
            .collect();
        let before = PadEstimate::from(&*measured);
        let isolated = self.cancel(before, [measured.r_x, measured.r_y], &others);
        self.latest[pad] = Some(isolated);
        if before.capacitance_pf > 0.0 {
            measured.force_n *= (isolated.capacitance_pf / before.capacitance_pf).powi(2);
        }
        PadEstimate {
            x_mm: measured.x_mm,
            y_mm: measured.y_mm,
            capacitance_pf: measured.capacitance_pf,
        } = isolated;
    }

    /// The pad that has these ratios among those others, and is measured as `measured`.
    pub fn cancel(
        &mut self,
        measured: PadEstimate,
        ratios: [f64; 2],
        others: &[PadEstimate],
    ) -> PadEstimate {
        let mut pad = measured;
        self.hold(&mut pad);
        for _ in 0..STEPS {
            let (_, alone) = self.with_neighbours(pad, &[]);
            let (seen, with_neighbours) = self.with_neighbours(pad, others);
            let [by_x, by_y, _] = self.deviation.at(pad.x_mm, pad.y_mm);
            let step = self.step(pad, [seen[0] + by_x - ratios[0], seen[1] + by_y - ratios[1]]);
            let longest = (LONGEST_MM / step[0].hypot(step[1])).min(1.0);
            pad.x_mm -= step[0] * longest;
            pad.y_mm -= step[1] * longest;
            pad.capacitance_pf = measured.capacitance_pf * alone / with_neighbours;
            self.hold(&mut pad);
        }
        pad
    }

    /// How far an isolated pad would have to move for a change of its ratios.
    fn step(&mut self, pad: PadEstimate, change: [f64; 2]) -> [f64; 2] {
        let mut slope = |x_mm: f64, y_mm: f64| {
            let [low, high] = [-1.0, 1.0].map(|sign| {
                let moved = PadEstimate {
                    x_mm: pad.x_mm + sign * x_mm,
                    y_mm: pad.y_mm + sign * y_mm,
                    ..pad
                };
                self.with_neighbours(moved, &[]).0
            });
            [0, 1].map(|n| (high[n] - low[n]) / (2.0 * SLOPE_MM))
        };
        let (by_x, by_y) = (slope(SLOPE_MM, 0.0), slope(0.0, SLOPE_MM));
        let det = by_x[0] * by_y[1] - by_x[1] * by_y[0];
        [
            (change[0] * by_y[1] - change[1] * by_y[0]) / det,
            (change[1] * by_x[0] - change[0] * by_x[1]) / det,
        ]
    }

    /// Holds a pad where slopes can be taken.
    fn hold(&self, pad: &mut PadEstimate) {
        let [x, y] = self.sheet.reach_mm().map(|reach| reach - SLOPE_MM);
        pad.x_mm = pad.x_mm.clamp(-x, x);
        pad.y_mm = pad.y_mm.clamp(-y, y);
    }

    /// Both ratios of a pad among others on the nominal sheet, and the amplitude of the sum.
    fn with_neighbours(&mut self, pad: PadEstimate, others: &[PadEstimate]) -> ([f64; 2], f64) {
        let others: Vec<_> = others.iter().map(|pad| self.as_coupled(*pad)).collect();
        self.sheet.with_neighbours(&self.as_coupled(pad), &others)
    }

    /// A pad that is as coupled on the nominal sheet as this one is on the device's: only ωCG
    /// counts, so that where the calibration has a larger R_p, a larger C does the same.
    fn as_coupled(&self, pad: PadEstimate) -> PadEstimate {
        let [.., ohm] = self.deviation.at(pad.x_mm, pad.y_mm);
        PadEstimate { capacitance_pf: pad.capacitance_pf * ohm, ..pad }
    }
}
