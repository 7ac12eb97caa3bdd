// SPDX-License-Identifier: MIT OR Apache-2.0
//! The film's resistance per square: even, or sloping, with rectangles of another one.

use super::disc::Disc;
use crate::effects::pad::FilmChange;
use crate::error::SceneError;
use crate::format::{Key, Limits, Table, keys};

/// What a film may have, Ω per square: metal foil to a film that no longer conducts. Farther apart, patches of a
/// mesh leave its matrix without a factor.
const OHM_PER_SQUARE: Limits = Limits::within(1e-3, 1e7);

keys! { KEYS:
    /// Resistance of the film, in its middle where it slopes.
    MIDDLE_OHM: f64 = Key::number("ohm_per_square", OHM_PER_SQUARE).or(150.0);
    /// Rise of the resistance from left to right and from bottom to top, of the middle's.
    SLOPE_PERCENT: [f64; 2] = Key::pair("slope_percent", Limits::within(-90.0, 90.0)).or(&[0.0; 2]);
}

keys! { PATCH_KEYS:
    /// Centre of the patch, from the sheet's.
    CENTRE_MM: [f64; 2] = Key::pair("centre_mm", Limits::within(-1e4, 1e4)).required("[x, y]");
    /// Width and height of the patch.
    SIZE_MM: [f64; 2] = Key::pair("size_mm", Limits::within(1e-3, 1e5)).required("[width, height]");
    /// Resistance of the film in the patch.
    PATCH_OHM: f64 = Key::number("ohm_per_square", OHM_PER_SQUARE).required("a number above 0");
}

/// Ohms per square over the sheet.
#[derive(Clone, Debug)]
pub(crate) struct Film {
    /// In the middle, leaving patches aside.
    pub ohm_per_square: f64,
    /// Rise along each axis, as a fraction, per metre.
    slope_per_m: [f64; 2],
    middle_m: [f64; 2],
    patches: Vec<Patch>,
    /// Where patches begin and end along each axis, in order.
    pub breaks_m: [Vec<f64>; 2],
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
            breaks_m: [const { Vec::new() }; 2],
            change_per_m: [0.0; 2],
        }
    }

    pub fn read(table: &Table, size_m: [f64; 2]) -> Result<Film, SceneError> {
        let slope_percent = table.get(&SLOPE_PERCENT)?;
        let middle_m = size_m.map(|size| size / 2.0);
        let patches = table.tables("patch")?;
        let patches: Vec<Patch> = patches
            .into_iter()
            .map(|patch| Patch::read(patch, middle_m))
            .collect::<Result<_, _>>()?;
        Ok(Film {
            ohm_per_square: table.get(&MIDDLE_OHM)?,
            slope_per_m: [0, 1].map(|axis| slope_percent[axis] / 100.0 / size_m[axis]),
            middle_m,
            breaks_m: [0, 1].map(|axis| breaks(&patches, axis)),
            patches,
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
        match self.patches.iter().rev().find(|patch| patch.covers(place_m)) {
            Some(patch) => patch.ohm_per_square * self.along(self.change_per_m, place_m),
            None => self.ohm_per_square * self.slope(place_m),
        }
    }

    /// What its slopes make of it at a place, leaving patches aside.
    pub fn slope(&self, place_m: [f64; 2]) -> f64 {
        self.along(self.slope_per_m, place_m) * self.along(self.change_per_m, place_m)
    }

    fn along(&self, slope: [f64; 2], place_m: [f64; 2]) -> f64 {
        let rise = |axis: usize| slope[axis] * (place_m[axis] - self.middle_m[axis]);
        1.0 + rise(0) + rise(1)
    }

    /// Its mean under a pad.
    pub(super) fn mean(&self, centre_m: [f64; 2], disc: &Disc) -> f64 {
        if self.patches.is_empty() {
            return self.at(centre_m); // slopes even out
        }
        let places = disc.at(centre_m);
        let count = places.len() as f64;
        places.map(|place| self.at(place)).sum::<f64>() / count
    }

    /// Conductance along an axis between two ends, of the strip between two sides across it.
    pub fn siemens(&self, axis: usize, ends_m: [f64; 2], sides_m: [f64; 2]) -> f64 {
        let ohm_m = |across: f64| {
            self.pieces(axis, ends_m).map(move |(at, length)| {
                let place = if axis == 0 { [at, across] } else { [across, at] };
                length * self.at(place)
            })
        };
        self.pieces(1 - axis, sides_m).map(|(at, width)| width / ohm_m(at).sum::<f64>()).sum()
    }

    /// Middle and length of each piece that patches cut a line along an axis into.
    fn pieces(&self, axis: usize, [from, to]: [f64; 2]) -> impl Iterator<Item = (f64, f64)> {
        let breaks = &self.breaks_m[axis];
        let [first, last] = [from, to].map(|end| breaks.partition_point(|at| *at <= end));
        let inside = &breaks[first..last];
        let starts = std::iter::once(from).chain(inside.iter().copied());
        let ends = inside.iter().copied().chain([to]);
        starts.zip(ends).map(|(start, end)| (0.5 * (start + end), end - start))
    }
}

fn breaks(patches: &[Patch], axis: usize) -> Vec<f64> {
    let ends = |patch: &Patch| [patch.low_m[axis], patch.high_m[axis]];
    let mut breaks: Vec<f64> = patches.iter().flat_map(ends).collect();
    breaks.sort_by(f64::total_cmp);
    breaks
}

impl Patch {
    fn read(table: &Table, middle_m: [f64; 2]) -> Result<Patch, SceneError> {
        let (centre_mm, size_mm) = (table.get(&CENTRE_MM)?, table.get(&SIZE_MM)?);
        let side = |sign: f64| {
            [0, 1]
                .map(|axis| middle_m[axis] + 1e-3 * (centre_mm[axis] + sign * size_mm[axis] / 2.0))
        };
        Ok(Patch { low_m: side(-1.0), high_m: side(1.0), ohm_per_square: table.get(&PATCH_OHM)? })
    }

    fn covers(&self, place_m: [f64; 2]) -> bool {
        (0..2).all(|axis| (self.low_m[axis]..=self.high_m[axis]).contains(&place_m[axis]))
    }
}
