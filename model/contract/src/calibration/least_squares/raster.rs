// SPDX-License-Identifier: MIT OR Apache-2.0
//! Least squares over the entries of a raster, of which equations have neighbours only.

use super::band::Band;
use super::moments::{Moments, add};
use super::near::{NEAR, Near, REACH};

/// A raster of entries, each of `LAYERS` numbers, which are sought.
pub struct RasterFit<const LAYERS: usize> {
    /// Columns and rows.
    size: [usize; 2],
    /// The normal equations: of each entry, row after row.
    normal: Vec<Near>,
    /// Right-hand sides, one per layer.
    right: Vec<[f64; LAYERS]>,
}

impl<const LAYERS: usize> RasterFit<LAYERS> {
    /// A raster of `columns` by `rows` entries.
    pub fn new(size @ [columns, rows]: [usize; 2]) -> Self {
        let entries = columns * rows;
        let (mut normal, mut right) = (Vec::new(), Vec::new());
        // Written, not asked for as zeros, as a band is.
        normal.resize(entries, [[0.0; NEAR]; NEAR]);
        right.resize(entries, [0.0; LAYERS]);
        RasterFit { size, normal, right }
    }

    /// Adds an equation: the weighted sum of three neighbours equals 0. They are those from the `first` on
    /// whose numbers differ by `step`, 1 along a row, the raster's columns along a column.
    pub fn ask_line(&mut self, first: usize, step: usize, weights: [f64; 3], importance: f64) {
        let along_row = step == 1;
        for (p, a) in weights.into_iter().enumerate() {
            let near = &mut self.normal[first + p * step];
            for (q, b) in weights.into_iter().enumerate() {
                let other = REACH + q - p;
                let [row, column] = if along_row { [REACH, other] } else { [other, REACH] };
                near[row][column] += importance * a * b;
            }
        }
    }

    /// Adds many equations of nine entries: three of each of three rows from the `first` on. The weight of
    /// an entry is that of its row times that of its column; of the columns `across` has what the equations
    /// add up to.
    pub fn ask_square(&mut self, first: usize, rows: [f64; 3], across: &Moments<LAYERS>) {
        for (p, row) in rows.into_iter().enumerate() {
            for n in 0..3 {
                let entry = first + p * self.size[0] + n;
                for (q, other) in rows.into_iter().enumerate() {
                    let line = &mut self.normal[entry][REACH + q - p];
                    add(&mut line[REACH - n..][..3], row * other, &across.products[n]);
                }
                let right = self.right[entry].iter_mut().zip(&across.values);
                right.for_each(|(sum, values)| *sum += row * values[n]);
            }
        }
    }

    /// The entries: of each layer one after the other. None where what was asked does not settle them
    /// all.
    pub fn solve(self) -> Option<[Vec<f64>; LAYERS]> {
        let [columns, rows] = self.size;
        // Numbered along the shorter side, the band is as narrow as can be.
        let number = |entry: usize| match columns > rows {
            true => entry % columns * rows + entry / columns,
            false => entry,
        };
        let entries = columns * rows;
        let mut band = Band::new(entries, REACH * columns.min(rows) + REACH);
        let mut right = vec![vec![0.0; entries]; LAYERS];
        for (entry, near) in self.normal.iter().enumerate() {
            for (other, coefficient) in about(self.size, entry, near) {
                let (row, column) = (number(entry), number(other));
                if column <= row {
                    *band.at(row, column) = coefficient;
                }
            }
            for (layer, value) in right.iter_mut().zip(self.right[entry]) {
                layer[number(entry)] = value;
            }
        }
        let found = band.solve(right)?;
        let in_order = |layer: &Vec<f64>| (0..entries).map(|entry| layer[number(entry)]).collect();
        let layers: Vec<Vec<f64>> = found.iter().map(in_order).collect();
        Some(layers.try_into().expect("one per right-hand side"))
    }
}

/// The entries that one meets, each with the coefficient of the two.
fn about(
    [columns, rows]: [usize; 2],
    entry: usize,
    near: &Near,
) -> impl Iterator<Item = (usize, f64)> {
    let (column, row) = (entry % columns, entry / columns);
    let beside = |at: usize, count: usize| {
        (0..NEAR).filter_map(move |n| {
            (at + n).checked_sub(REACH).filter(|to| *to < count).map(|to| (n, to))
        })
    };
    beside(row, rows).flat_map(move |(n, row)| {
        beside(column, columns).map(move |(m, column)| (row * columns + column, near[n][m]))
    })
}

#[cfg(test)]
mod tests {
    use super::super::terms::Fit;
    use super::*;

    /// A number without a pattern, within ± 1.
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (*state >> 11) as f64 / 2f64.powi(52) - 1.0
    }

    fn some<const N: usize>(state: &mut u64) -> [f64; N] {
        [0; N].map(|_| random(state))
    }

    /// Weights of the quadratic B-splines about a place.
    fn splines(state: &mut u64) -> [f64; 3] {
        let t = (random(state) + 1.0) / 2.0;
        [(1.0 - t).powi(2) / 2.0, 0.5 + t - t * t, t * t / 2.0]
    }

    /// Where a square of nine entries may begin.
    fn corners([columns, rows]: [usize; 2]) -> impl Iterator<Item = usize> {
        (0..rows - 2)
            .flat_map(move |row| (0..columns - 2).map(move |column| row * columns + column))
    }

    /// Equations about every square of a raster, that these entries satisfy; the weight of an equation rises with the
    /// number of the entry, from 1 to `times`.
    fn asked(
        size: [usize; 2],
        entries: &[Vec<f64>; 2],
        weights: impl Fn(&mut u64) -> [f64; 3],
        times: f64,
    ) -> RasterFit<2> {
        let (mut fit, mut state) = (RasterFit::new(size), size[0] as u64);
        for first in corners(size).flat_map(|first| [first; 12]) {
            let (rows, columns, mut across) =
                (weights(&mut state), weights(&mut state), Moments::NONE);
            let value = |of: &Vec<f64>| {
                (0..9)
                    .map(|k| rows[k / 3] * columns[k % 3] * of[first + k / 3 * size[0] + k % 3])
                    .sum()
            };
            let importance = times.powf(first as f64 / (size[0] * size[1]) as f64);
            across.add(columns, entries.each_ref().map(value), importance);
            fit.ask_square(first, rows, &across);
        }
        fit
    }

    fn entries(size: [usize; 2]) -> [Vec<f64>; 2] {
        let mut state = size[1] as u64;
        [0; 2].map(|_| (0..size[0] * size[1]).map(|_| random(&mut state)).collect())
    }

    const SIZES: [[usize; 2]; 5] = [[3, 3], [9, 4], [4, 9], [12, 12], [51, 27]];

    fn check(found: &[Vec<f64>; 2], expected: &[Vec<f64>; 2], within: f64, case: &str) {
        for (found, entry) in found.iter().flatten().zip(expected.iter().flatten()) {
            assert!((found - entry).abs() < within, "{case}: {found} for {entry}");
        }
    }

    #[test]
    fn entries_that_satisfy_all_equations_are_found_whatever_the_shape() {
        for size in SIZES {
            let (entries, case) = (entries(size), format!("{size:?}"));
            let of_splines = asked(size, &entries, splines, 100.0);
            check(&of_splines.solve().expect("settled"), &entries, 1e-9, &case);
            // Weights that do not sum to one.
            let of_any = asked(size, &entries, some, 100.0);
            check(&of_any.solve().expect("settled"), &entries, 1e-9, &case);
        }
    }

    /// Points in one half alone: smoothness continues what they say.
    #[test]
    fn entries_that_smoothness_alone_settles_are_found() {
        for size @ [columns, rows] in [[24, 9], [9, 24], [40, 30]] {
            let rising: [Vec<f64>; 2] = [1.0, -0.3].map(|slope| {
                (0..columns * rows).map(|k| slope * (k % columns) as f64 + 0.1).collect()
            });
            let mut fit = RasterFit::new(size);
            let half = corners(size).filter(|first| first % columns < columns / 2);
            let mut state = 7;
            for first in half.flat_map(|first| [first; 4]) {
                let (rows, weights) = (splines(&mut state), splines(&mut state));
                let value = |of: &Vec<f64>| {
                    (0..9)
                        .map(|k| rows[k / 3] * weights[k % 3] * of[first + k / 3 * columns + k % 3])
                        .sum()
                };
                let mut across = Moments::NONE;
                across.add(weights, rising.each_ref().map(value), 1.0);
                fit.ask_square(first, rows, &across);
            }
            for first in 0..columns * rows {
                if first % columns + 2 < columns {
                    fit.ask_line(first, 1, [1.0, -2.0, 1.0], 1e-7);
                }
                if first / columns + 2 < rows {
                    fit.ask_line(first, columns, [1.0, -2.0, 1.0], 1e-7);
                }
            }
            check(&fit.solve().expect("settled"), &rising, 1e-3, &format!("{size:?}"));
        }
    }

    /// Wherever the square lies.
    #[test]
    fn squares_of_entries_are_asked_as_nine_terms_each() {
        for size @ [columns, rows] in [[4, 3], [3, 4], [5, 4]] {
            let mut state = columns as u64;
            let (mut square, mut terms) = (RasterFit::<2>::new(size), Fit::new(columns * rows, 2));
            for first in corners(size) {
                let (down, mut across) = (some::<3>(&mut state), Moments::NONE);
                // As often as there are entries, so that they are settled.
                for _ in 0..9 {
                    let (right, values) = (some::<3>(&mut state), some::<2>(&mut state));
                    let term =
                        |k: usize| (first + k / 3 * columns + k % 3, down[k / 3] * right[k % 3]);
                    across.add(right, values, 1.5);
                    terms.ask(std::array::from_fn::<_, 9, _>(term), &values, 1.5);
                }
                square.ask_square(first, down, &across);
            }
            for entry in 0..columns * rows {
                square.normal[entry][REACH][REACH] += 1.0;
                terms.ask([(entry, 1.0)], &[0.0; 2], 1.0);
            }
            let terms: [Vec<f64>; 2] = terms.solve().expect("settled").try_into().expect("two");
            check(&square.solve().expect("settled"), &terms, 1e-11, &format!("{size:?}"));
        }
    }

    #[test]
    fn lines_of_entries_are_asked_as_three_terms_each() {
        let size @ [columns, rows] = [5, 4];
        let (mut line, mut terms) = (RasterFit::<1>::new(size), Fit::new(columns * rows, 1));
        for (first, step) in [(0, 1), (7, 1), (17, 1), (0, columns), (9, columns)] {
            let weights = [1.0, -2.0, 0.5];
            line.ask_line(first, step, weights, 1.5);
            terms.ask([0, 1, 2].map(|n| (first + n * step, weights[n])), &[0.0], 1.5);
        }
        for entry in 0..columns * rows {
            line.normal[entry][REACH][REACH] += 1.0;
            line.right[entry] = [entry as f64];
            terms.ask([(entry, 1.0)], &[entry as f64], 1.0);
        }
        let [line] = line.solve().expect("settled");
        let terms = terms.solve().expect("settled").concat();
        for (a, b) in line.iter().zip(&terms) {
            assert!((a - b).abs() < 1e-12, "{a}, {b}");
        }
    }

    #[test]
    fn entries_that_nothing_settles_are_told() {
        let size = [6, 5];
        assert!(RasterFit::<2>::new(size).solve().is_none());
        let mut fit = asked(size, &entries(size), splines, 1.0);
        fit.normal[7][REACH][REACH] = f64::NAN;
        assert!(fit.solve().is_none());
    }
}
