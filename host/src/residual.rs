// SPDX-License-Identifier: MIT OR Apache-2.0
//! How well a position table knows the places that it was fitted to.
//!
//! The places of the calibration are looked up in floating point: what is left is the table's own
//! error, which no frame shows.

use serde::Serialize;

/// Position errors of a calibration's own places.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Residual {
    /// Over all places, mm.
    pub rms_mm: f64,
    /// At the worst place, mm.
    pub worst_mm: f64,
    /// Position with the largest error, mm.
    pub at_mm: [f64; 2],
}

/// Above this rms a run warns, mm, where its scene has no limit of its own.
pub const LIMIT_MM: f64 = 1.0;

impl Residual {
    /// Of pairs of a place and where the table finds it, mm. An error that is no number counts as
    /// infinite.
    pub fn of(pairs: impl Iterator<Item = ([f64; 2], [f64; 2])>) -> Self {
        let (mut squares, mut count) = (0.0, 0u32);
        let mut worst = Residual { rms_mm: 0.0, worst_mm: 0.0, at_mm: [0.0; 2] };
        for (place, found) in pairs {
            let error = (found[0] - place[0]).hypot(found[1] - place[1]);
            let error = if error.is_finite() { error } else { f64::INFINITY };
            (squares, count) = (squares + error * error, count + 1);
            if error > worst.worst_mm {
                worst = Residual { worst_mm: error, at_mm: place, ..worst };
            }
        }
        Residual { rms_mm: (squares / f64::from(count.max(1))).sqrt(), ..worst }
    }

    /// The one with the larger rms.
    pub fn worse(self, other: Residual) -> Residual {
        if other.rms_mm > self.rms_mm { other } else { self }
    }

    /// What it says to a reader.
    pub fn text(&self) -> String {
        self.words(" over its own places")
    }

    /// The same of places that are not the table's own.
    pub fn errors(&self) -> String {
        self.words("")
    }

    fn words(&self, over: &str) -> String {
        let [x, y] = self.at_mm;
        format!(
            "{:.2} mm RMS{over}, {:.2} mm at most, at x = {x:.0}, y = {y:.0} mm",
            self.rms_mm, self.worst_mm
        )
    }

    /// What its user must know, where it is beyond a limit, mm.
    pub fn warning(&self, limit_mm: f64) -> Option<String> {
        let text = || {
            format!(
                "the position table does not fit this device: {}, where {limit_mm} mm RMS are allowed. Positions, and with them \
                 the sheet's resistance and the force, are off without a flag in the frames",
                self.text()
            )
        };
        (self.rms_mm > limit_mm).then(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_place_is_named_and_a_lost_one_is_no_small_error() {
        let pairs = [([0.0, 0.0], [0.0, 0.0]), ([10.0, 20.0], [13.0, 24.0])];
        let residual = Residual::of(pairs.into_iter());
        assert_eq!((residual.worst_mm, residual.at_mm), (5.0, [10.0, 20.0]));
        assert!((residual.rms_mm - 5.0 / 2f64.sqrt()).abs() < 1e-12);
        assert!(residual.warning(LIMIT_MM).expect("a warning").contains("x = 10, y = 20 mm"));
        assert_eq!(residual.warning(4.0), None);
        let lost = Residual::of([([1.0, 1.0], [f64::NAN, 0.0])].into_iter());
        assert_eq!(lost.rms_mm, f64::INFINITY);
    }
}
