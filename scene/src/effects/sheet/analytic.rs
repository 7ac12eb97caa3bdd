// SPDX-License-Identifier: MIT OR Apache-2.0
//! The exact split of a uniform sheet, as [`hapticore_sheet`] has it.

use super::geometry::Sheet;
use super::split::{Solver, Split};
use crate::few::Few;
pub(super) use hapticore_sheet::analytic::{Column, Row};
pub(crate) use hapticore_sheet::{Analytic, Source, UniformSheet};

impl From<&Sheet> for UniformSheet {
    fn from(sheet: &Sheet) -> Self {
        UniformSheet {
            size_m: sheet.size_m,
            ohm_per_square: sheet.film.ohm_per_square,
            pad_radius_m: sheet.pad_radius_m,
            terminals_m: sheet.terminals_m.clone(),
            terminal_ohm: sheet.terminal_ohm.clone(),
            terminal_radius_m: sheet.terminal_radius_m,
        }
    }
}

impl Solver for Analytic {
    fn split(&self, x_mm: f64, y_mm: f64) -> Split {
        let source = self.source(x_mm, y_mm);
        Split { share: Few::from_slice(source.shares()), ohm: self.between(&source, &source) }
    }
}
