// SPDX-License-Identifier: MIT OR Apache-2.0
//! Places that lie anywhere, brought onto a raster: polyharmonic splines of what they differ by from an even sheet.
//!
//!   f(p) = e(p) + Σ a_i·|p − p_i|³ + b·p + c,   f(p_i) = f_i,   Σ a_i = Σ a_i·p_i = 0
//!
//! e is what an even sheet has there, where the setup says enough, else 0. Source: Duchon, "Splines minimizing
//! rotation-invariant semi-norms in Sobolev spaces", 1977 (kernel r³ in the plane).

use anyhow::{Result, anyhow};
use nalgebra::{DMatrix, DVector};

/// A place, `[x_mm, y_mm, r_x, r_y, sheet_ohm]`.
pub type Row = [f64; 5];

/// What is read at a place: both ratios, the sheet's resistance.
pub type Values = [f64; 3];

/// Columns and rows of the raster: as many as those of a simulated device.
const RASTER: [usize; 2] = [121, 71];

/// 1, x and y.
const LINEAR: usize = 3;

/// The raster about the places: its columns and its places. `even` is what an even sheet has at places, mm.
///
/// # Errors
/// Places on a line, or one twice.
pub fn raster(places: &[Row], even: impl Fn(&[[f64; 2]]) -> Vec<Values>) -> Result<(usize, Vec<Row>)> {
    let at: Vec<_> = places.iter().map(|place| [place[0], place[1]]).collect();
    let [xs, ys] = [0, 1].map(|axis| along(at.iter().map(|place| place[axis]), RASTER[axis]));
    let raster: Vec<_> = ys.iter().flat_map(|y| xs.iter().map(|x| [*x, *y])).collect();
    let expected = even(&at);
    let spline = Spline::of(&at, |k, value| places[k][2 + value] - expected[k][value])?;
    let place = |(at, expected): (&[f64; 2], Values)| {
        let differs = spline.at(*at);
        let value = |k: usize| expected[k] + differs[k];
        [at[0], at[1], value(0), value(1), value(2)]
    };
    Ok((RASTER[0], raster.iter().zip(even(&raster)).map(place).collect()))
}

/// Evenly from the least to the greatest.
fn along(values: impl Iterator<Item = f64>, count: usize) -> Vec<f64> {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    (0..count).map(|k| low + (high - low) * k as f64 / (count - 1) as f64).collect()
}

/// A spline of several values.
struct Spline {
    centres: Vec<[f64; 2]>,
    weights: DMatrix<f64>,
    unit_mm: f64,
}

impl Spline {
    fn of(centres: &[[f64; 2]], value: impl Fn(usize, usize) -> f64) -> Result<Spline> {
        let (count, unit_mm) = (centres.len(), centres.iter().map(|at| at[0].hypot(at[1])).fold(1.0, f64::max));
        let entry = |row: usize, column: usize| match (row < count, column < count) {
            (true, true) => kernel(centres[row], centres[column], unit_mm),
            (true, false) => linear(centres[row], unit_mm)[column - count],
            (false, true) => linear(centres[column], unit_mm)[row - count],
            (false, false) => 0.0,
        };
        let matrix = DMatrix::from_fn(count + LINEAR, count + LINEAR, entry);
        let known = |row: usize, k: usize| if row < count { value(row, k) } else { 0.0 };
        let known = DMatrix::from_fn(count + LINEAR, 3, known);
        let weights = matrix.lu().solve(&known).filter(|weights| weights.iter().all(|weight| weight.is_finite()));
        let weights = weights.ok_or_else(|| anyhow!("expected places that span an area, each of them once"))?;
        Ok(Spline { centres: centres.to_vec(), weights, unit_mm })
    }

    fn at(&self, place: [f64; 2]) -> Values {
        let kernels = self.centres.iter().map(|centre| kernel(*centre, place, self.unit_mm));
        let terms = kernels.chain(linear(place, self.unit_mm));
        let terms = DVector::from_iterator(self.centres.len() + LINEAR, terms);
        let values = self.weights.tr_mul(&terms);
        [values[0], values[1], values[2]]
    }
}

fn kernel(a: [f64; 2], b: [f64; 2], unit_mm: f64) -> f64 {
    ((a[0] - b[0]).hypot(a[1] - b[1]) / unit_mm).powi(3)
}

fn linear(place: [f64; 2], unit_mm: f64) -> [f64; LINEAR] {
    [1.0, place[0] / unit_mm, place[1] / unit_mm]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(count: u32, f: impl Fn([f64; 2]) -> Values) -> Vec<Row> {
        // Places without a pattern: multiples of irrational numbers, modulo the sheet.
        let at = |k: u32| [3f64.sqrt(), 7f64.sqrt()].map(|step| 200.0 * (f64::from(k) * step).fract() - 100.0);
        (0..count).map(at).map(|at| (at, f(at))).map(|([x, y], [a, b, c])| [x, y, a, b, c]).collect()
    }

    #[test]
    fn a_plane_comes_back_exactly_and_a_hill_nearly() {
        let hill = |[x, y]: [f64; 2]| (-(x * x + y * y) / 1e4).exp();
        let of = |[x, y]: [f64; 2]| [0.01 * x - 0.002 * y + 0.1, hill([x, y]), 5.0];
        let (columns, raster) = raster(&places(200, of), |places| vec![[0.0; 3]; places.len()]).unwrap();
        assert_eq!((columns, raster.len()), (RASTER[0], RASTER[0] * RASTER[1]));
        for [x, y, a, b, c] in raster {
            let [plane, hill, constant] = of([x, y]);
            assert!((a - plane).abs() < 1e-8 && (c - constant).abs() < 1e-8, "{x} {y}");
            // In the corners, beyond all places, splines go on as they may.
            let most = if x.abs().max(y.abs()) < 85.0 { 0.005 } else { 0.05 };
            assert!((b - hill).abs() < most, "{x} {y}: {b} for {hill}");
        }
    }

    #[test]
    fn what_an_even_sheet_has_comes_back_exactly() {
        let of = |[x, y]: [f64; 2]| [(x / 20.0).sin(), (y / 20.0).cos(), 1.0];
        let even = |places: &[[f64; 2]]| places.iter().map(|place| of(*place)).collect();
        let (_, raster) = raster(&places(20, of), even).unwrap();
        assert!(raster.iter().all(|[x, y, a, b, _]| (a - of([*x, *y])[0]).hypot(b - of([*x, *y])[1]) < 1e-9));
    }

    #[test]
    fn places_on_a_line_are_refused() {
        let line: Vec<_> = (0..20).map(|k| [f64::from(k), 2.0 * f64::from(k), 0.0, 0.0, 0.0]).collect();
        assert!(raster(&line, |places| vec![[0.0; 3]; places.len()]).is_err());
    }
}
