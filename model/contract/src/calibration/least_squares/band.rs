// SPDX-License-Identifier: MIT OR Apache-2.0
//! Symmetric equations within a band, solved by Cholesky's factor, which stays within it.

/// The coefficients of symmetric equations, each of which has entries near its own only.
pub struct Band {
    entries: usize,
    /// Entries whose numbers differ by more never meet in an equation.
    reach: usize,
    /// Of each entry: the coefficients with the `reach` entries before it, then its own.
    coefficients: Vec<f64>,
}

impl Band {
    /// Equations of `entries` entries, all coefficients 0.
    pub fn new(entries: usize, reach: usize) -> Self {
        let mut coefficients = Vec::new();
        // Written, not asked for as zeros: pages that are read before they are written come from the system twice, and
        // the second time all threads wait for it.
        coefficients.resize(entries * (reach + 1), 0.0);
        Band { entries, reach, coefficients }
    }

    /// The coefficient of a row with an entry before it, or its own.
    pub fn at(&mut self, row: usize, column: usize) -> &mut f64 {
        let place = self.place(row, column);
        &mut self.coefficients[place]
    }

    fn place(&self, row: usize, column: usize) -> usize {
        debug_assert!(column <= row && row - column <= self.reach, "{row}, {column}");
        row * self.reach + self.reach + column
    }

    /// The entries for each of these right-hand sides; none where the equations do not settle them.
    pub fn solve(mut self, mut right: Vec<Vec<f64>>) -> Option<Vec<Vec<f64>>> {
        self.factor()?;
        right.iter_mut().for_each(|layer| self.substitute(layer));
        Some(right)
    }

    /// The factor L, M = L·Lᵀ, in place of M: computes some columns of L, then subtracts what they add to M from all
    /// columns after them.
    fn factor(&mut self) -> Option<()> {
        let mut panel = [(); COLUMNS].map(|()| vec![0.0; self.reach + COLUMNS]);
        for first in (0..self.entries).step_by(COLUMNS) {
            let rows = (self.entries - first).min(self.reach + COLUMNS);
            let columns = rows.min(COLUMNS);
            for (n, column) in panel.iter_mut().enumerate().take(columns) {
                column.fill(0.0);
                let kept = self.column(first + n, rows - n);
                column[n..].iter_mut().zip(kept).for_each(|(of, at)| *of = self.coefficients[at]);
            }
            make(&mut panel[..columns], rows)?;
            for (n, column) in panel.iter().enumerate().take(columns) {
                let kept = self.column(first + n, rows - n);
                column[n..].iter().zip(kept).for_each(|(of, at)| self.coefficients[at] = *of);
            }
            for k in COLUMNS..rows {
                let row = first + k;
                let line = self.place(row, first + COLUMNS)..=self.place(row, row);
                take(&mut self.coefficients[line], &panel, k);
            }
        }
        Some(())
    }

    /// Where the coefficients of an entry with itself and with the entries after it stand: `most` of them at most.
    fn column(&self, entry: usize, most: usize) -> impl Iterator<Item = usize> + use<> {
        let (own, next) = (self.place(entry, entry), self.reach);
        (0..most.min(self.reach + 1)).map(move |k| own + k * next)
    }

    /// The first entry within a row's reach.
    fn first(&self, row: usize) -> usize {
        row.saturating_sub(self.reach)
    }

    /// The solution of L·Lᵀ·x = right, in its place.
    fn substitute(&self, x: &mut [f64]) {
        for row in 0..x.len() {
            let line = &self.coefficients[self.place(row, self.first(row))..=self.place(row, row)];
            let (own, before) = line.split_last().expect("a row has itself");
            let known: f64 = before.iter().zip(&x[self.first(row)..row]).map(|(l, x)| l * x).sum();
            x[row] = (x[row] - known) / own;
        }
        for row in (0..x.len()).rev() {
            let first = self.first(row);
            let line = &self.coefficients[self.place(row, first)..=self.place(row, row)];
            let (own, before) = line.split_last().expect("a row has itself");
            let found = x[row] / own;
            x[row] = found;
            x[first..row].iter_mut().zip(before).for_each(|(x, l)| *x -= l * found);
        }
    }
}

/// Columns of L per pass: the columns after them are read and written once per pass.
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
