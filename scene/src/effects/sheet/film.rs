// SPDX-License-Identifier: MIT OR Apache-2.0
//! The film's resistance per square: even, or sloping, with rectangles of another one.
//!
//! ```toml
//! [sheet]
//! ohm_per_square = 150
//! slope_percent = [10, -4]        # from left to right and from bottom to top, of the middle's
//! [[sheet.patch]]                 # the last one that covers a place holds
//! centre_mm = [200, 50]
//! size_mm = [120, 80]
//! ohm_per_square = 300
//! ```

use crate::effects::pad::FilmChange;
use crate::error::SceneError;
use crate::format::{Limits, Table};

/// Ohms per square over the sheet.
#[derive(Clone, Debug)]
pub(crate) struct Film {
    /// In the middle, leaving patches aside.
    pub ohm_per_square: f64,
    /// Rise along each axis, as a fraction, per metre.
    slope_per_m: [f64; 2],
    middle_m: [f64; 2],
    patches: Vec<Patch>,
    /// What an effect adds to the rise, patches included.
    change_per_m: [f64; 2],
}

#[derive(Clone, Debug)]
struct Patch {
    low_m: [f64; 2],
    high_m: [f64; 2],
    ohm_per_square: f64,
}

impl Film {
    /// The same everywhere.
    #[cfg(test)]
    pub fn uniform(ohm_per_square: f64) -> Film {
        Film {
            ohm_per_square,
            slope_per_m: [0.0; 2],
            middle_m: [0.0; 2],
            patches: Vec::new(),
            change_per_m: [0.0; 2],
        }
    }

    pub fn read(table: &Table, size_m: [f64; 2]) -> Result<Film, SceneError> {
        let slope_percent =
            table.pair("slope_percent", Limits::within(-90.0, 90.0))?.unwrap_or_default();
        let middle_m = size_m.map(|size| size / 2.0);
        let patches = table.tables("patch")?;
        Ok(Film {
            ohm_per_square: table.number_or("ohm_per_square", Limits::POSITIVE, 150.0)?,
            slope_per_m: [0, 1].map(|axis| slope_percent[axis] / 100.0 / size_m[axis]),
            middle_m,
            patches: patches
                .into_iter()
                .map(|patch| Patch::read(patch, middle_m))
                .collect::<Result<_, _>>()?,
            change_per_m: [0.0; 2],
        })
    }

    /// The film of a sheet of this size after a change.
    pub fn changed(&self, change: FilmChange, size_m: [f64; 2]) -> Film {
        let risen = 1.0 + change.rise;
        let patch =
            |patch: &Patch| Patch { ohm_per_square: patch.ohm_per_square * risen, ..patch.clone() };
        Film {
            ohm_per_square: self.ohm_per_square * risen,
            patches: self.patches.iter().map(patch).collect(),
            change_per_m: [0, 1].map(|axis| change.slope[axis] / risen / size_m[axis]),
            ..self.clone()
        }
    }

    /// Whether it is the same everywhere.
    pub fn is_uniform(&self) -> bool {
        [self.slope_per_m, self.change_per_m] == [[0.0; 2]; 2] && self.patches.is_empty()
    }

    /// Ohms per square at a place from the bottom left corner.
    pub fn at(&self, place_m: [f64; 2]) -> f64 {
        let along = |slope: [f64; 2]| {
            let rise = |axis: usize| slope[axis] * (place_m[axis] - self.middle_m[axis]);
            1.0 + rise(0) + rise(1)
        };
        let ohm = match self.patches.iter().rev().find(|patch| patch.covers(place_m)) {
            Some(patch) => patch.ohm_per_square,
            None => self.ohm_per_square * along(self.slope_per_m),
        };
        ohm * along(self.change_per_m)
    }
}

impl Patch {
    fn read(table: &Table, middle_m: [f64; 2]) -> Result<Patch, SceneError> {
        let centre_mm =
            table.require("centre_mm", "[x, y]", table.pair("centre_mm", Limits::ANY)?)?;
        let size_mm = table.require(
            "size_mm",
            "[width, height]",
            table.pair("size_mm", Limits::POSITIVE)?,
        )?;
        let ohm = table.number("ohm_per_square", Limits::POSITIVE)?;
        let side = |sign: f64| {
            [0, 1]
                .map(|axis| middle_m[axis] + 1e-3 * (centre_mm[axis] + sign * size_mm[axis] / 2.0))
        };
        Ok(Patch {
            low_m: side(-1.0),
            high_m: side(1.0),
            ohm_per_square: table.require("ohm_per_square", "a number above 0", ohm)?,
        })
    }

    fn covers(&self, place_m: [f64; 2]) -> bool {
        (0..2).all(|axis| (self.low_m[axis]..=self.high_m[axis]).contains(&place_m[axis]))
    }
}
