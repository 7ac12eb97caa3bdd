// SPDX-License-Identifier: MIT OR Apache-2.0
//! Linear least squares with 95 % confidence intervals.
//!
//!   y_i = Σ β_k·x_ik + ε_i,   ε independent and normal, all of one unknown variance; x without error
//!
//! σ² = Σ r²/(n − p) of the residuals r, and β_k ± t(0.975; n − p)·σ·√((XᵀX)⁻¹)_kk with Student's
//! t.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// The share of intervals that hold the truth.
pub const CONFIDENCE: f64 = 0.95;

/// Columns whose normal matrix, their lengths taken out, has a smaller determinant are not told
/// apart.
const ALIKE: f64 = 1e-4;

/// A number with its 95 % confidence interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Estimate {
    /// The most likely one.
    pub value: f64,
    /// Ends of the 95 % interval.
    pub interval: [f64; 2],
}

/// What a measurement depends on, and the measurement.
pub type Row<const P: usize> = ([f64; P], f64);

/// A fit of `P` coefficients.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit<const P: usize> {
    /// Estimated coefficients with their intervals.
    pub estimates: [Estimate; P],
    /// What they leave of each measurement.
    pub residuals: Vec<f64>,
    /// The standard deviation of a measurement's noise.
    pub noise: f64,
}

/// Measurements that no coefficients can be had from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unfit {
    /// Fewer than this many.
    Few(usize),
    /// A column of zeros.
    Zero(usize),
    /// Columns that rise and fall together.
    Alike,
}

impl<const P: usize> Fit<P> {
    /// Fits rows of `x` and their `y`.
    ///
    /// # Errors
    /// Fewer than two rows more than coefficients, or columns that do not tell the coefficients.
    pub fn of(rows: &[Row<P>]) -> Result<Fit<P>, Unfit> {
        if rows.len() < P + 2 {
            return Err(Unfit::Few(P + 2));
        }
        let length = |k: usize| rows.iter().map(|(x, _)| x[k] * x[k]).sum::<f64>().sqrt();
        let lengths: [f64; P] = std::array::from_fn(length);
        if let Some(zero) = lengths.iter().position(|length| *length == 0.0) {
            return Err(Unfit::Zero(zero));
        }
        let sum = |f: &dyn Fn(&Row<P>) -> f64| rows.iter().map(f).sum::<f64>();
        let normal: [[f64; P]; P] = std::array::from_fn(|i| {
            std::array::from_fn(|k| sum(&|(x, _)| x[i] / lengths[i] * x[k] / lengths[k]))
        });
        let inverse = inverse(normal).ok_or(Unfit::Alike)?;
        let products: [f64; P] = std::array::from_fn(|k| sum(&|(x, y)| x[k] / lengths[k] * y));
        let solve =
            |i: usize| (0..P).map(|k| inverse[i][k] * products[k]).sum::<f64>() / lengths[i];
        let values: [f64; P] = std::array::from_fn(solve);
        let residual =
            |(x, y): &Row<P>| y - x.iter().zip(values).map(|(x, value)| x * value).sum::<f64>();
        let residuals: Vec<_> = rows.iter().map(residual).collect();
        let freedom = (rows.len() - P) as f64;
        let noise = (residuals.iter().map(|r| r * r).sum::<f64>() / freedom).sqrt();
        let t = student(freedom);
        let estimates = std::array::from_fn(|k| {
            let half = t * noise * inverse[k][k].sqrt() / lengths[k];
            Estimate { value: values[k], interval: [values[k] - half, values[k] + half] }
        });
        Ok(Fit { estimates, residuals, noise })
    }
}

impl Estimate {
    /// The same times a factor above 0.
    pub fn scaled(self, factor: f64) -> Self {
        Estimate { value: self.value * factor, interval: self.interval.map(|end| end * factor) }
    }
}

/// What the interval's half is in standard errors.
fn student(freedom: f64) -> f64 {
    let distribution = StudentsT::new(0.0, 1.0, freedom).expect("degrees of freedom above 0");
    distribution.inverse_cdf((1.0 + CONFIDENCE) / 2.0)
}

/// Of a matrix with ones on its diagonal; none where its columns are alike.
fn inverse<const P: usize>(mut a: [[f64; P]; P]) -> Option<[[f64; P]; P]> {
    let mut b: [[f64; P]; P] =
        std::array::from_fn(|i| std::array::from_fn(|k| f64::from(u8::from(i == k))));
    let mut determinant = 1.0;
    for pivot in 0..P {
        let scale = a[pivot][pivot];
        determinant *= scale;
        if determinant.is_nan() || determinant < ALIKE {
            return None;
        }
        for k in 0..P {
            a[pivot][k] /= scale;
            b[pivot][k] /= scale;
        }
        for row in (0..P).filter(|row| *row != pivot) {
            let factor = a[row][pivot];
            for k in 0..P {
                a[row][k] -= factor * a[pivot][k];
                b[row][k] -= factor * b[pivot][k];
            }
        }
    }
    Some(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_through_three_points_as_by_hand() {
        // y = 1, 2, 4 at x = 1, 2, 3: β = 17/14, σ² = (21 − 17²/14)/2, t(0.975; 2) = 4.3027 of any
        // table.
        let fit = Fit::of(&[([1.0], 1.0), ([2.0], 2.0), ([3.0], 4.0)]).unwrap();
        let noise = ((21.0 - 289.0 / 14.0) / 2.0f64).sqrt();
        let [Estimate { value, interval: [low, high] }] = fit.estimates;
        assert!((value - 17.0 / 14.0).abs() < 1e-12 && (fit.noise - noise).abs() < 1e-12);
        assert!(((high - low) / 2.0 - 4.3027 * noise / 14f64.sqrt()).abs() < 1e-4);
    }

    #[test]
    fn two_coefficients_come_back_and_their_residuals_are_orthogonal_to_both() {
        let rows: Vec<_> = (0..9)
            .map(|k| {
                ([1.0, f64::from(k)], 3.0 - 0.5 * f64::from(k) + [0.1, -0.1, 0.0][k as usize % 3])
            })
            .collect();
        let fit = Fit::of(&rows).unwrap();
        for k in 0..2 {
            let product: f64 = rows.iter().zip(&fit.residuals).map(|((x, _), r)| x[k] * r).sum();
            assert!(product.abs() < 1e-12, "{product}");
        }
        assert!(
            (fit.estimates[0].value - 3.0).abs() < 0.1
                && (fit.estimates[1].value + 0.5).abs() < 0.02
        );
    }

    #[test]
    fn what_cannot_be_fitted_says_why() {
        assert_eq!(Fit::of(&[([1.0], 1.0), ([2.0], 2.0)]), Err(Unfit::Few(3)));
        assert_eq!(Fit::of(&[([0.0], 1.0); 5]), Err(Unfit::Zero(0)));
        assert_eq!(Fit::of(&[([1.0, 2.0], 1.0); 5]), Err(Unfit::Alike));
    }
}
