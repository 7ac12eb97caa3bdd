// SPDX-License-Identifier: MIT OR Apache-2.0
//! Least squares over tables: which entries make interpolation come nearest to given values.
//!
//! Interpolation is local, so that the normal equations of a raster have a narrow band, as wide as two lines
//! along its shorter side. Cholesky's factor stays within it. Why the band is ours, with figures:
//! docs/decisions.md §7.

/// A table whose entries are sought.
pub struct Fit {
    /// The number of each entry in the equations below.
    order: Vec<usize>,
    /// Entries whose numbers differ by more never meet in an equation.
    reach: usize,
    /// Of each entry: the coefficients of the normal equations with the `reach` entries before it,
    /// then its own.
    normal: Vec<f64>,
    /// Right-hand sides, one per layer.
    right: Vec<Vec<f64>>,
}

impl Fit {
    /// A table of `entries`, each of `layers` numbers.
    pub fn new(entries: usize, layers: usize) -> Self {
        Fit::banded((0..entries).collect(), entries.saturating_sub(1), layers)
    }

    /// A table of the entries of a raster, row after row, each of `layers` numbers. Equations may have
    /// entries that are two columns and two rows apart at most.
    pub fn of_raster([columns, rows]: [usize; 2], layers: usize) -> Self {
        let along_rows = |entry: usize| entry;
        let along_columns = |entry: usize| entry % columns * rows + entry / columns;
        let entries = 0..columns * rows;
        let order = match columns <= rows {
            true => entries.map(along_rows).collect(),
            false => entries.map(along_columns).collect(),
        };
        Fit::banded(order, 2 * columns.min(rows) + 2, layers)
    }

    fn banded(order: Vec<usize>, reach: usize, layers: usize) -> Self {
        let entries = order.len();
        let (normal, right) = (vec![0.0; entries * (reach + 1)], vec![vec![0.0; entries]; layers]);
        Fit { order, reach, normal, right }
    }

    /// Adds an equation: the weighted sum of some entries equals the values, one per layer.
    ///
    /// # Panics
    /// In debug builds, where entries are too far apart.
    pub fn ask(&mut self, terms: &[(usize, f64)], values: &[f64], importance: f64) {
        for &(entry, a) in terms {
            let row = self.order[entry];
            let (a, own) = (importance * a, self.at(row, row));
            for &(entry, b) in terms {
                let column = self.order[entry];
                if column <= row {
                    debug_assert!(row - column <= self.reach, "{row}, {column}");
                    self.normal[own + column - row] += a * b;
                }
            }
            for (right, value) in self.right.iter_mut().zip(values) {
                right[row] += a * value;
            }
        }
    }

    /// Where the coefficient of a row with an entry before it stands.
    fn at(&self, row: usize, column: usize) -> usize {
        debug_assert!(column <= row && row - column <= self.reach, "{row}, {column}");
        row * (self.reach + 1) + self.reach + column - row
    }

    /// The entries: of each layer one after the other. None where what was asked does not settle them
    /// all.
    pub fn solve(mut self) -> Option<Vec<Vec<f64>>> {
        self.factor()?;
        let mut right = std::mem::take(&mut self.right);
        right.iter_mut().for_each(|layer| self.substitute(layer));
        let in_order = |layer: &Vec<f64>| self.order.iter().map(|&number| layer[number]).collect();
        Some(right.iter().map(in_order).collect())
    }

    /// The normal equations' factor L, M = L·Lᵀ, in their place.
    fn factor(&mut self) -> Option<()> {
        for row in 0..self.order.len() {
            let (first, start) = (self.first(row), self.at(row, self.first(row)));
            let (above, line) = self.normal.split_at_mut(start);
            let above = Above { lines: above, reach: self.reach, first };
            let own = row - first;
            let blocks = own / COLUMNS;
            (0..blocks).for_each(|block| above.factors::<COLUMNS>(line, block * COLUMNS));
            (blocks * COLUMNS..own).for_each(|known| above.factors::<1>(line, known));
            let square = line[own] - line[..own].iter().map(|l| l * l).sum::<f64>();
            line[own] = Some(square.sqrt()).filter(|root| *root > 0.0)?;
        }
        Some(())
    }

    /// The first entry within a row's reach.
    fn first(&self, row: usize) -> usize {
        row.saturating_sub(self.reach)
    }

    /// The solution of L·Lᵀ·x = right, in its place.
    fn substitute(&self, x: &mut [f64]) {
        for row in 0..x.len() {
            let line = &self.normal[self.at(row, self.first(row))..=self.at(row, row)];
            let (own, before) = line.split_last().expect("a row has itself");
            let known: f64 = before.iter().zip(&x[self.first(row)..row]).map(|(l, x)| l * x).sum();
            x[row] = (x[row] - known) / own;
        }
        for row in (0..x.len()).rev() {
            let first = self.first(row);
            let line = &self.normal[self.at(row, first)..=self.at(row, row)];
            let (own, before) = line.split_last().expect("a row has itself");
            let found = x[row] / own;
            x[row] = found;
            x[first..row].iter_mut().zip(before).for_each(|(x, l)| *x -= l * found);
        }
    }
}

/// Factors of a row that are made at once: their sums do not wait for each other.
const COLUMNS: usize = 4;

/// The lines of L above a row.
struct Above<'a> {
    lines: &'a [f64],
    reach: usize,
    /// The first entry within the row's reach.
    first: usize,
}

impl Above<'_> {
    /// The line of an entry from the first entry within the row's reach to itself.
    fn line(&self, entry: usize) -> &[f64] {
        let own = entry * (self.reach + 1) + self.reach;
        &self.lines[own + self.first - entry..=own]
    }

    /// The next N factors of a row whose first `known` are known:
    /// L[row, c] = (M[row, c] − Σ L[row, k]·L[c, k]) / L[c, c], over the entries k before c.
    fn factors<const N: usize>(&self, row: &mut [f64], known: usize) {
        let lines: [&[f64]; N] = std::array::from_fn(|n| self.line(self.first + known + n));
        let before = lines.map(|line| &line[..known]);
        let mut sums = [0.0; N];
        for (k, factor) in row[..known].iter().enumerate() {
            for (sum, line) in sums.iter_mut().zip(before) {
                *sum += factor * line[k];
            }
        }
        for (n, line) in lines.into_iter().enumerate() {
            let here = row[known..known + n].iter().zip(&line[known..]);
            let sum = here.fold(sums[n], |sum, (a, b)| sum + a * b);
            row[known + n] = (row[known + n] - sum) / line[known + n];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number without a pattern, within ± 1.
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (*state >> 11) as f64 / 2f64.powi(52) - 1.0
    }

    /// Equations of nine entries about a place, more than there are entries.
    fn ask(fit: &mut Fit, [columns, rows]: [usize; 2], entries: &[Vec<f64>; 2], state: &mut u64) {
        for _ in 0..20 * columns * rows {
            let mut place =
                |size: usize| ((random(state) + 1.0) / 2.0 * (size - 2) as f64) as usize;
            let corner = place(rows) * columns + place(columns);
            let terms: [_; 9] =
                std::array::from_fn(|k| (corner + k / 3 * columns + k % 3, random(state)));
            let value = |of: &Vec<f64>| terms.iter().map(|(entry, by)| by * of[*entry]).sum();
            fit.ask(&terms, &entries.each_ref().map(value), 1.0 + random(state).abs());
        }
    }

    #[test]
    fn entries_that_satisfy_all_equations_are_found_whatever_the_shape() {
        for size in [[3, 3], [9, 4], [4, 9], [12, 12], [51, 27]] {
            let (mut state, count) = (size[0] as u64, size[0] * size[1]);
            let entries =
                [0; 2].map(|_| (0..count).map(|_| random(&mut state)).collect::<Vec<_>>());
            for mut fit in [Fit::of_raster(size, 2), Fit::new(count, 2)] {
                if fit.reach > 200 {
                    continue; // Dense: the small ones show it.
                }
                ask(&mut fit, size, &entries, &mut state);
                let found = fit.solve().expect("settled");
                for (found, entry) in found.iter().flatten().zip(entries.iter().flatten()) {
                    assert!((found - entry).abs() < 1e-9, "{size:?}: {found} for {entry}");
                }
            }
        }
    }

    /// Of contradicting equations the mean by importance is taken.
    #[test]
    fn contradictions_are_weighed() {
        let mut fit = Fit::new(1, 1);
        fit.ask(&[(0, 1.0)], &[1.0], 3.0);
        fit.ask(&[(0, 1.0)], &[5.0], 1.0);
        assert_eq!(fit.solve(), Some(vec![vec![2.0]]));
    }

    #[test]
    fn entries_that_nothing_settles_are_told() {
        let mut fit = Fit::new(2, 1);
        fit.ask(&[(0, 1.0)], &[1.0], 1.0);
        assert_eq!(fit.solve(), None);
        let mut fit = Fit::new(1, 1);
        fit.ask(&[(0, f64::NAN)], &[1.0], 1.0);
        assert_eq!(fit.solve(), None);
    }
}
