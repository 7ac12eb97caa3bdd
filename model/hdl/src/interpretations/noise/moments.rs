// SPDX-License-Identifier: MIT OR Apache-2.0
//! Mean, variance and bound of an error.

use crate::signal::Rounding;

/// An error: of what is rounded so, or of a signal.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Moments {
    /// Mean.
    pub mean: f64,
    /// Variance.
    pub variance: f64,
    /// The largest magnitude.
    pub bound: f64,
}

impl Moments {
    /// Of an error that is known.
    pub fn known(error: f64) -> Self {
        Moments { mean: error, variance: 0.0, bound: error.abs() }
    }

    /// Of a rounding that drops `dropped` bits, in steps of `lsb`.
    pub(super) fn of_rounding(rounding: Rounding, dropped: u8, lsb: f64) -> Self {
        let part = 0.5f64.powi(dropped.into());
        let (mean, variance, bound) = match rounding {
            Rounding::Floor => (-0.5 * (1.0 - part), (1.0 - part * part) / 12.0, 1.0 - part),
            _ => (0.0, (1.0 + 2.0 * part * part) / 12.0, 0.5),
        };
        Moments { mean, variance, bound }.times(lsb)
    }

    /// Of a quotient or a root, which has no last bit to drop.
    pub(super) fn of_result(lsb: f64) -> Self {
        Moments { mean: 0.0, variance: 1.0 / 12.0, bound: 0.5 }.times(lsb)
    }

    /// Of this error with a gain.
    pub fn times(self, gain: f64) -> Self {
        Moments {
            mean: gain * self.mean,
            variance: gain * gain * self.variance,
            bound: gain.abs() * self.bound,
        }
    }

    /// Of this error and one that is independent of it, together.
    pub fn plus(self, other: Self) -> Self {
        Moments {
            mean: self.mean + other.mean,
            variance: self.variance + other.variance,
            bound: self.bound + other.bound,
        }
    }

    /// Root of the mean square.
    pub fn rms(self) -> f64 {
        (self.mean * self.mean + self.variance).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::Format;
    use crate::signal::{Floor, HalfEven, Proved, Signal, Value};

    /// The errors of every code, as often as each other, against the formulas.
    #[test]
    fn roundings_have_the_moments_of_the_bits_that_they_drop() {
        for (rounding, dropped) in
            [HalfEven, Floor].into_iter().flat_map(|r| (1..7).map(move |d| (r, d)))
        {
            let (fine, coarse) = (Format::signed(12, 6), Format::signed(12, 6 - dropped));
            let codes = -(4i64 << dropped)..4 << dropped;
            let error = |code: i64| {
                let rounded =
                    i64::quantize(Signal { value: code, format: fine }, coarse, rounding, Proved);
                coarse.real(rounded) - fine.real(code)
            };
            let count = codes.clone().count() as f64;
            let mean = codes.clone().map(error).sum::<f64>() / count;
            let square = codes.clone().map(|code| error(code).powi(2)).sum::<f64>() / count;
            let bound = codes.map(|code| error(code).abs()).fold(0.0, f64::max);
            let moments = Moments::of_rounding(rounding, dropped as u8, coarse.lsb());
            assert!((moments.mean - mean).abs() < 1e-12, "{rounding:?} {dropped}");
            assert!((moments.rms().powi(2) - square).abs() < 1e-12, "{rounding:?} {dropped}");
            assert!((moments.bound - bound).abs() < 1e-12, "{rounding:?} {dropped}");
        }
    }
}
