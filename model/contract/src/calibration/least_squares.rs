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
    /// The numbers of neighbours across the raster's lines differ by so many.
    pitch: usize,
    /// The lines along which entries are numbered are the raster's columns.
    along_columns: bool,
    /// Of each entry: the coefficients of the normal equations with the `reach` entries before it,
    /// then its own.
    normal: Vec<f64>,
    /// Right-hand sides, one per layer.
    right: Vec<Vec<f64>>,
}

impl Fit {
    /// A table of `entries`, each of `layers` numbers.
    pub fn new(entries: usize, layers: usize) -> Self {
        Fit::banded((0..entries).collect(), (entries.saturating_sub(1), 1), layers)
    }

    /// A table of the entries of a raster, row after row, each of `layers` numbers. Equations may have
    /// entries that are two columns and two rows apart at most.
    pub fn of_raster([columns, rows]: [usize; 2], layers: usize) -> Self {
        let along_columns = columns > rows;
        let number = |entry: usize| match along_columns {
            true => entry % columns * rows + entry / columns,
            false => entry,
        };
        let (order, pitch) = ((0..columns * rows).map(number).collect(), columns.min(rows));
        Fit { along_columns, ..Fit::banded(order, (2 * pitch + 2, pitch), layers) }
    }

    fn banded(order: Vec<usize>, (reach, pitch): (usize, usize), layers: usize) -> Self {
        let entries = order.len();
        let (mut normal, right) = (Vec::new(), vec![vec![0.0; entries]; layers]);
        // Written, not asked for as zeros: pages that are read before they are written come from the system twice, and
        // the second time all threads wait for it.
        normal.resize(entries * (reach + 1), 0.0);
        Fit { order, reach, pitch, along_columns: false, normal, right }
    }

    /// Adds an equation: the weighted sum of some entries equals the values, one per layer.
    ///
    /// # Panics
    /// In debug builds, where entries are too far apart.
    pub fn ask<const N: usize>(
        &mut self,
        terms: [(usize, f64); N],
        values: &[f64],
        importance: f64,
    ) {
        let numbers = terms.map(|(entry, _)| self.order[entry]);
        for (n, (_, a)) in terms.into_iter().enumerate() {
            let a = importance * a;
            // A pair of entries once: its coefficient is kept with the later one.
            for m in 0..=n {
                let (row, column) = (numbers[n].max(numbers[m]), numbers[n].min(numbers[m]));
                let at = self.at(row, column);
                self.normal[at] += a * terms[m].1;
            }
            for (right, value) in self.right.iter_mut().zip(values) {
                right[numbers[n]] += a * value;
            }
        }
    }

    /// As [`Fit::ask`], many equations of nine entries of a raster: three of each of three rows from the
    /// `first` on. The weight of an entry is that of its row times that of its column; of the columns
    /// `across` has what the equations add up to.
    pub fn ask_square<const LAYERS: usize>(
        &mut self,
        first: usize,
        rows: [f64; 3],
        across: &Moments<LAYERS>,
    ) {
        let of_rows = rows.map(|a| rows.map(|b| a * b));
        let (lines, within) = match self.along_columns {
            true => (&across.products, &of_rows),
            false => (&of_rows, &across.products),
        };
        let first = self.order[first];
        for (p, of_line) in lines.iter().enumerate() {
            for (n, weights) in within.iter().enumerate() {
                let row = first + p * self.pitch + n;
                let own = self.at(row, row);
                for (q, by) in of_line[..p].iter().enumerate() {
                    let start = own - n - (p - q) * self.pitch;
                    add(&mut self.normal[start..start + 3], *by, weights);
                }
                add(&mut self.normal[own - n..=own], of_line[p], &weights[..=n]);
            }
        }
        let (down, along) = if self.along_columns { (1, self.pitch) } else { (self.pitch, 1) };
        for (right, values) in self.right.iter_mut().zip(&across.values) {
            for (p, row) in rows.iter().enumerate() {
                for (n, value) in values.iter().enumerate() {
                    right[first + p * down + n * along] += row * value;
                }
            }
        }
    }

    /// Where the coefficient of a row with an entry before it stands.
    fn at(&self, row: usize, column: usize) -> usize {
        debug_assert!(column <= row && row - column <= self.reach, "{row}, {column}");
        row * self.reach + self.reach + column
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

    /// The normal equations' factor L, M = L·Lᵀ, in their place: some columns are made, and what they
    /// add to M is taken from all that comes after them.
    fn factor(&mut self) -> Option<()> {
        let entries = self.order.len();
        let mut panel = [(); COLUMNS].map(|()| vec![0.0; self.reach + COLUMNS]);
        for first in (0..entries).step_by(COLUMNS) {
            let rows = (entries - first).min(self.reach + COLUMNS);
            let columns = rows.min(COLUMNS);
            for (n, column) in panel.iter_mut().enumerate().take(columns) {
                column.fill(0.0);
                let kept = self.column(first + n, rows - n);
                column[n..].iter_mut().zip(kept).for_each(|(of, at)| *of = self.normal[at]);
            }
            make(&mut panel[..columns], rows)?;
            for (n, column) in panel.iter().enumerate().take(columns) {
                let kept = self.column(first + n, rows - n);
                column[n..].iter().zip(kept).for_each(|(of, at)| self.normal[at] = *of);
            }
            for k in COLUMNS..rows {
                let row = first + k;
                let line = self.at(row, first + COLUMNS)..=self.at(row, row);
                take(&mut self.normal[line], &panel, k);
            }
        }
        Some(())
    }

    /// Where the coefficients of an entry with itself and with the entries after it stand: with so many
    /// at most.
    fn column(&self, entry: usize, most: usize) -> impl Iterator<Item = usize> + use<> {
        let (own, next) = (self.at(entry, entry), self.reach);
        (0..most.min(self.reach + 1)).map(move |k| own + k * next)
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

/// Equations of three neighbours in a row, one value per layer, added up: what they bring to the normal
/// equations and to the right-hand sides.
#[derive(Debug, Clone, Copy)]
pub struct Moments<const LAYERS: usize> {
    products: [[f64; 3]; 3],
    values: [[f64; 3]; LAYERS],
}

impl<const LAYERS: usize> Moments<LAYERS> {
    /// Of no equation.
    pub const NONE: Self = Moments { products: [[0.0; 3]; 3], values: [[0.0; 3]; LAYERS] };

    /// Adds an equation.
    #[inline(always)]
    pub fn add(&mut self, weights: [f64; 3], values: [f64; LAYERS], importance: f64) {
        let important = weights.map(|weight| importance * weight);
        self.products.iter_mut().zip(important).for_each(|(sums, by)| add(sums, by, &weights));
        self.values.iter_mut().zip(values).for_each(|(sums, by)| add(sums, by, &important));
    }
}

/// Adds weights to coefficients, each `by` times.
#[inline(always)]
fn add(coefficients: &mut [f64], by: f64, weights: &[f64]) {
    coefficients.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += by * weight);
}

/// Columns of L that are made at once: what comes after them is read and written once for all.
const COLUMNS: usize = 4;

/// The columns of L from those of M, less what the columns before them have added; the first number of
/// each that counts is the one on the diagonal.
fn make(panel: &mut [Vec<f64>], rows: usize) -> Option<()> {
    for n in 0..panel.len() {
        let (made, later) = panel.split_at_mut(n + 1);
        let made = &mut made[n][..rows];
        let root = Some(made[n].sqrt()).filter(|root| *root > 0.0)?;
        made[n..].iter_mut().for_each(|factor| *factor /= root);
        for (m, column) in later.iter_mut().enumerate() {
            let by = made[n + 1 + m];
            column[..rows].iter_mut().zip(&*made).for_each(|(left, factor)| *left -= by * factor);
        }
    }
    Some(())
}

/// Takes what the columns add to a row of M, from the first entry after them to row `k` of the panel
/// itself.
fn take(row: &mut [f64], panel: &[Vec<f64>; COLUMNS], k: usize) {
    let by = panel.each_ref().map(|column| column[k]);
    let [a, b, c, d] = panel.each_ref().map(|column| &column[COLUMNS..=k]);
    for ((((left, a), b), c), d) in row.iter_mut().zip(a).zip(b).zip(c).zip(d) {
        *left -= (by[0] * a + by[1] * b) + (by[2] * c + by[3] * d);
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
            fit.ask(terms, &entries.each_ref().map(value), 1.0 + random(state).abs());
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

    /// Wherever the square lies and whichever way entries are numbered.
    #[test]
    fn squares_of_entries_are_asked_as_nine_terms_each() {
        for size @ [columns, rows] in [[7, 5], [5, 7], [6, 6]] {
            let mut state = columns as u64;
            let [mut square, mut terms] = [0; 2].map(|_| Fit::of_raster(size, 2));
            for first in 0..columns * (rows - 2) {
                if first % columns + 2 >= columns {
                    continue;
                }
                let mut weights = || [0; 3].map(|_| random(&mut state));
                let (down, mut across) = (weights(), Moments::NONE);
                for values in [[0.3, -2.0], [-1.0, 0.7]] {
                    let right = weights();
                    let term =
                        |k: usize| (first + k / 3 * columns + k % 3, down[k / 3] * right[k % 3]);
                    across.add(right, values, 1.5);
                    terms.ask(std::array::from_fn::<_, 9, _>(term), &values, 1.5);
                }
                square.ask_square(first, down, &across);
            }
            let sums = |fit: &Fit| [fit.normal.clone(), fit.right.concat()].concat();
            for (a, b) in sums(&square).into_iter().zip(sums(&terms)) {
                assert!((a - b).abs() < 1e-12, "{size:?}: {a}, {b}");
            }
        }
    }

    /// Of contradicting equations the mean by importance is taken.
    #[test]
    fn contradictions_are_weighed() {
        let mut fit = Fit::new(1, 1);
        fit.ask([(0, 1.0)], &[1.0], 3.0);
        fit.ask([(0, 1.0)], &[5.0], 1.0);
        assert_eq!(fit.solve(), Some(vec![vec![2.0]]));
    }

    #[test]
    fn entries_that_nothing_settles_are_told() {
        let mut fit = Fit::new(2, 1);
        fit.ask([(0, 1.0)], &[1.0], 1.0);
        assert_eq!(fit.solve(), None);
        let mut fit = Fit::new(1, 1);
        fit.ask([(0, f64::NAN)], &[1.0], 1.0);
        assert_eq!(fit.solve(), None);
    }
}
