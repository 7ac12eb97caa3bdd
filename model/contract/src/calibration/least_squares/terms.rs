// SPDX-License-Identifier: MIT OR Apache-2.0
//! Equations of any entries, term by term: what the faster ways of [`Moments`](super::Moments) and
//! [`RasterFit`](super::RasterFit) are compared with.

use super::band::Band;

/// A table of a few entries, which are sought; any of them may meet in an equation.
pub struct Fit {
    normal: Band,
    /// Right-hand sides, one per layer.
    right: Vec<Vec<f64>>,
}

impl Fit {
    /// A table of `entries`, each of `layers` numbers.
    pub fn new(entries: usize, layers: usize) -> Self {
        let normal = Band::new(entries, entries.saturating_sub(1));
        Fit { normal, right: vec![vec![0.0; entries]; layers] }
    }

    /// Adds an equation: the weighted sum of some entries equals the values, one per layer.
    pub fn ask<const N: usize>(
        &mut self,
        terms: [(usize, f64); N],
        values: &[f64],
        importance: f64,
    ) {
        for (n, (entry, a)) in terms.into_iter().enumerate() {
            let a = importance * a;
            // A pair of entries once: its coefficient is kept with the later one.
            for (other, b) in &terms[..=n] {
                *self.normal.at(entry.max(*other), entry.min(*other)) += a * b;
            }
            for (right, value) in self.right.iter_mut().zip(values) {
                right[entry] += a * value;
            }
        }
    }

    /// The entries: of each layer one after the other. None where what was asked does not settle them
    /// all.
    pub fn solve(self) -> Option<Vec<Vec<f64>>> {
        self.normal.solve(self.right)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
