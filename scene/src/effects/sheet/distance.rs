// SPDX-License-Identifier: MIT OR Apache-2.0
//! The paper's picture: the sheet as a star of strips, R_i = R_in + R_s·(distance to terminal
//! i)/(width of the pad). R_p is their parallel combination. At the sheet's middle it gives 311 Ω
//! for the paper's device.

use super::geometry::Sheet;
use super::split::{Solver, Split};
use crate::terminals::PerTerminal;

pub(super) struct Distance {
    sheet: Sheet,
}

impl Distance {
    pub fn new(sheet: &Sheet) -> Self {
        Distance { sheet: sheet.clone() }
    }

    fn conductance(&self, at: [f64; 2], terminal: usize) -> f64 {
        let there = self.sheet.terminals_m[terminal];
        let distance = (at[0] - there[0]).hypot(at[1] - there[1]);
        let strip = self.sheet.film.ohm_per_square * distance / (2.0 * self.sheet.pad_radius_m);
        1.0 / (self.sheet.terminal_ohm[terminal] + strip)
    }
}

impl Solver for Distance {
    fn split(&self, x_mm: f64, y_mm: f64) -> Split {
        let at = self.sheet.place_m(x_mm, y_mm);
        let terminals = 0..self.sheet.terminals();
        let each: PerTerminal<f64> =
            terminals.map(|terminal| self.conductance(at, terminal)).collect();
        let sum: f64 = each.iter().sum();
        Split { share: each.map(|conductance| conductance / sum), ohm: 1.0 / sum }
    }
}
