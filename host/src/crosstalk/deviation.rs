// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a device's calibration found beyond the nominal sheet, over a raster and bilinear between:
//! how much more both ratios of an isolated pad are, and how many times its R_p is the nominal one.

/// Deviations from the nominal sheet, over the places that a pad's centre reaches.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Deviation {
    reach_mm: [f64; 2],
    /// Places in a row.
    columns: usize,
    /// Row by row from the bottom left; none where the device is the nominal one.
    places: Vec<[f64; 3]>,
}

impl Deviation {
    /// No deviation from the nominal sheet.
    pub fn none(reach_mm: [f64; 2]) -> Self {
        Deviation { reach_mm, columns: 0, places: Vec::new() }
    }

    /// These at the raster's places: differences of r_x and r_y, quotient of R_p.
    pub fn with(self, columns: usize, places: Vec<[f64; 3]>) -> Self {
        assert!(
            columns >= 2 && places.len() >= 2 * columns && places.len().is_multiple_of(columns),
            "whole rows"
        );
        Deviation { columns, places, ..self }
    }

    /// The same at a place, mm from the sheet's centre.
    pub fn at(&self, x_mm: f64, y_mm: f64) -> [f64; 3] {
        if self.places.is_empty() {
            return [0.0, 0.0, 1.0];
        }
        let ([column, x], [row, y]) = (self.cell(0, x_mm), self.cell(1, y_mm));
        let node =
            |column: f64, row: f64| self.places[row as usize * self.columns + column as usize];
        let along = |row: f64| mix(node(column, row), node(column + 1.0, row), x);
        mix(along(row), along(row + 1.0), y)
    }

    /// The cell along an axis, and how far into it.
    fn cell(&self, axis: usize, mm: f64) -> [f64; 2] {
        let points = [self.columns, self.places.len() / self.columns];
        let last = (points[axis] - 1) as f64;
        let at = (0.5 * last * (mm / self.reach_mm[axis] + 1.0)).clamp(0.0, last);
        let cell = at.floor().min(last - 1.0);
        [cell, at - cell]
    }
}

fn mix(from: [f64; 3], to: [f64; 3], share: f64) -> [f64; 3] {
    [0, 1, 2].map(|n| from[n] + share * (to[n] - from[n]))
}
