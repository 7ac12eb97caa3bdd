// SPDX-License-Identifier: MIT OR Apache-2.0
//! The paper's picture: the sheet as a star of strips, R_i = R_in + R_s·(distance to terminal i)/(width of the pad).
//! R_p is their parallel combination. At the sheet's middle it gives 311 Ω for the paper's device.

use super::{Sheet, Solver, Split};
use crate::device::TERMINALS;

pub(super) struct Distance {
    sheet: Sheet,
}

impl Distance {
    pub fn new(sheet: &Sheet) -> Self {
        Distance { sheet: sheet.clone() }
    }

    fn conductance(&self, at: [f64; 2], terminal: [f64; 2]) -> f64 {
        let distance = (at[0] - terminal[0]).hypot(at[1] - terminal[1]);
        let strip = self.sheet.ohm_per_square * distance / (2.0 * self.sheet.pad_radius_m);
        1.0 / (self.sheet.terminal_ohm + strip)
    }
}

impl Solver for Distance {
    fn split(&self, x_mm: f64, y_mm: f64) -> Split {
        let [width, height] = self.sheet.size_m;
        let at = [width / 2.0 + x_mm * 1e-3, height / 2.0 + y_mm * 1e-3];
        let each: [f64; TERMINALS] = self.sheet.terminals_m.map(|terminal| self.conductance(at, terminal));
        let sum: f64 = each.iter().sum();
        Split { share: each.map(|conductance| conductance / sum), ohm: 1.0 / sum }
    }
}
