// SPDX-License-Identifier: MIT OR Apache-2.0
//! Places that lie anywhere, brought onto a raster: polyharmonic splines of what they differ by
//! from a uniform sheet.
//!
//!   f(p) = e(p) + Σ a_i·|p − p_i|³ + b·p + c,   f(p_i) + λ·a_i = f_i,   Σ a_i = Σ a_i·p_i = 0
//!
//! e is what a uniform sheet has there, where the setup says enough, else 0. Measurements have
//! noise, which a spline through all of them would follow: λ minimises the leave-one-out error of
//! the measurements. Sources: Duchon, "Splines minimizing rotation-invariant semi-norms in Sobolev
//! spaces", 1977 (kernel r³ in the plane); Wahba, "Spline models for observational data", 1990, ch.
//! 4 (leaving one out).

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

/// The λ that are tried.
const LAMBDAS: [f64; 9] = [0.0, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];

/// At most this many places are left out one by one: the best λ depends on the noise, not on their
/// number.
const LEFT_OUT: usize = 400;

/// The raster about the places: its columns and its places. `uniform` is what a uniform sheet has
/// at positions, mm.
///
/// # Errors
/// Places on a line, or one twice.
pub fn raster(
    places: &[Row],
    uniform: impl Fn(&[[f64; 2]]) -> Vec<Values>,
) -> Result<(usize, Vec<Row>)> {
    let at: Vec<_> = places.iter().map(|place| [place[0], place[1]]).collect();
    let [xs, ys] = [0, 1].map(|axis| along(at.iter().map(|place| place[axis]), RASTER[axis]));
    let raster: Vec<_> = ys.iter().flat_map(|y| xs.iter().map(|x| [*x, *y])).collect();
    let expected = uniform(&at);
    let spline = Spline::of(&at, |k, value| places[k][2 + value] - expected[k][value])?;
    let place = |(at, expected): (&[f64; 2], Values)| {
        let differs = spline.at(*at);
        let value = |k: usize| expected[k] + differs[k];
        [at[0], at[1], value(0), value(1), value(2)]
    };
    Ok((RASTER[0], raster.iter().zip(uniform(&raster)).map(place).collect()))
}

/// Rows of a map with a spline of what differs from it at some places, `[x_mm, y_mm, Δr_x, Δr_y, Δsheet_ohm]`.
///
/// # Errors
/// Places on a line, or one twice.
pub fn corrected(map: &[Row], differs: &[Row]) -> Result<Vec<Row>> {
    let at: Vec<_> = differs.iter().map(|place| [place[0], place[1]]).collect();
    let spline = Spline::of(&at, |k, value| differs[k][2 + value])?;
    let place = |&[x, y, r_x, r_y, ohm]: &Row| {
        let differs = spline.at([x, y]);
        [x, y, r_x + differs[0], r_y + differs[1], ohm + differs[2]]
    };
    Ok(map.iter().map(place).collect())
}

/// Evenly from the least to the greatest.
fn along(values: impl Iterator<Item = f64>, count: usize) -> Vec<f64> {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
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
        let (count, unit_mm) =
            (centres.len(), centres.iter().map(|at| at[0].hypot(at[1])).fold(1.0, f64::max));
        let every = count.div_ceil(LEFT_OUT);
        let some: Vec<_> = centres.iter().copied().step_by(every).collect();
        let mut weights = DMatrix::zeros(count + LINEAR, 3);
        for k in 0..3 {
            let known =
                DVector::from_fn(
                    count + LINEAR,
                    |row, _| if row < count { value(row, k) } else { 0.0 },
                );
            let of_some = DVector::from_fn(some.len() + LINEAR, |row, _| {
                if row < some.len() { known[row * every] } else { 0.0 }
            });
            let left = LAMBDAS.map(|lambda| left_out(system(&some, unit_mm, lambda), &of_some));
            let best = (0..LAMBDAS.len())
                .min_by(|a, b| left[*a].total_cmp(&left[*b]))
                .expect("some are tried");
            let solved = system(centres, unit_mm, LAMBDAS[best]).lu().solve(&known);
            let solved = solved.filter(|weights| weights.iter().all(|weight| weight.is_finite()));
            let solved = solved
                .ok_or_else(|| anyhow!("expected places that span an area, each of them once"))?;
            weights.set_column(k, &solved);
        }
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

/// The equations of the weights a, b and c.
fn system(centres: &[[f64; 2]], unit_mm: f64, lambda: f64) -> DMatrix<f64> {
    let count = centres.len();
    let entry = |row: usize, column: usize| match (row < count, column < count) {
        (true, true) => {
            kernel(centres[row], centres[column], unit_mm)
                + if row == column { lambda } else { 0.0 }
        }
        (true, false) => linear(centres[row], unit_mm)[column - count],
        (false, true) => linear(centres[column], unit_mm)[row - count],
        (false, false) => 0.0,
    };
    DMatrix::from_fn(count + LINEAR, count + LINEAR, entry)
}

/// The sum of the squares of what a spline through all other values leaves of each; infinite where
/// there is none.
fn left_out(system: DMatrix<f64>, known: &DVector<f64>) -> f64 {
    let Some(inverse) = system.try_inverse() else { return f64::INFINITY };
    let weights = &inverse * known;
    let squares = (0..known.len() - LINEAR).map(|k| (weights[k] / inverse[(k, k)]).powi(2));
    Some(squares.sum()).filter(|sum: &f64| sum.is_finite()).unwrap_or(f64::INFINITY)
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
        let at = |k: u32| {
            [3f64.sqrt(), 7f64.sqrt()].map(|step| 200.0 * (f64::from(k) * step).fract() - 100.0)
        };
        (0..count)
            .map(at)
            .map(|at| (at, f(at)))
            .map(|([x, y], [a, b, c])| [x, y, a, b, c])
            .collect()
    }

    #[test]
    fn a_plane_comes_back_exactly_and_a_hill_nearly() {
        let hill = |[x, y]: [f64; 2]| (-(x * x + y * y) / 1e4).exp();
        let of = |[x, y]: [f64; 2]| [0.01 * x - 0.002 * y + 0.1, hill([x, y]), 5.0];
        let (columns, raster) =
            raster(&places(200, of), |places| vec![[0.0; 3]; places.len()]).unwrap();
        assert_eq!((columns, raster.len()), (RASTER[0], RASTER[0] * RASTER[1]));
        for [x, y, a, b, c] in raster {
            let [plane, hill, constant] = of([x, y]);
            assert!((a - plane).abs() < 1e-8 && (c - constant).abs() < 1e-8, "{x} {y}");
            // In the corners, beyond all places, splines go on as they may.
            let most = if x.abs().max(y.abs()) < 85.0 { 0.005 } else { 0.05 };
            assert!((b - hill).abs() < most, "{x} {y}: {b} for {hill}");
        }
    }

    /// With measurements that are noise in part, what is between the places is nearer to the truth
    /// than the measurements are.
    #[test]
    fn noise_is_smoothed_away() {
        let noise = |k: usize| 0.1 * ((1e4 * (k as f64 * 5f64.sqrt()).sin()).rem_euclid(1.0) - 0.5);
        let hill = |[x, y]: [f64; 2]| (-(x * x + y * y) / 1e4).exp();
        let mut read = places(400, |at| [hill(at), hill(at), hill(at)]);
        read.iter_mut().enumerate().for_each(|(k, place)| place[2] += noise(k));
        let (_, raster) = raster(&read, |places| vec![[0.0; 3]; places.len()]).unwrap();
        let off = |[x, y, a, _, _]: &Row| {
            (x.abs().max(y.abs()) < 85.0).then(|| (a - hill([*x, *y])).powi(2))
        };
        let squares: Vec<f64> = raster.iter().filter_map(off).collect();
        let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
        assert!(rms < 0.1 / 12f64.sqrt() / 2.5, "{rms}");
    }

    #[test]
    fn what_an_even_sheet_has_comes_back_exactly() {
        let of = |[x, y]: [f64; 2]| [(x / 20.0).sin(), (y / 20.0).cos(), 1.0];
        let uniform = |places: &[[f64; 2]]| places.iter().map(|place| of(*place)).collect();
        let (_, raster) = raster(&places(20, of), uniform).unwrap();
        assert!(
            raster
                .iter()
                .all(|[x, y, a, b, _]| (a - of([*x, *y])[0]).hypot(b - of([*x, *y])[1]) < 1e-9)
        );
    }

    #[test]
    fn places_on_a_line_are_refused() {
        let line: Vec<_> =
            (0..20).map(|k| [f64::from(k), 2.0 * f64::from(k), 0.0, 0.0, 0.0]).collect();
        assert!(raster(&line, |places| vec![[0.0; 3]; places.len()]).is_err());
    }
}
