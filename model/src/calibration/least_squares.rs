// SPDX-License-Identifier: MIT OR Apache-2.0
//! Least squares over tables: which entries make interpolation come nearest to given values.

use nalgebra::DMatrix;
use nalgebra_sparse::factorization::CscCholesky;
use nalgebra_sparse::{CooMatrix, CscMatrix};

/// A table whose entries are sought.
pub struct Fit {
    normal: CooMatrix<f64>,
    right: DMatrix<f64>,
}

impl Fit {
    /// A table of `entries`, each of `layers` numbers.
    pub fn new(entries: usize, layers: usize) -> Self {
        Fit { normal: CooMatrix::new(entries, entries), right: DMatrix::zeros(entries, layers) }
    }

    /// Asks that the weighted sum of some entries be near to the values, one a layer.
    pub fn ask(&mut self, terms: &[(usize, f64)], values: &[f64], importance: f64) {
        for &(row, a) in terms {
            for &(column, b) in terms {
                self.normal.push(row, column, importance * a * b);
            }
            for (layer, value) in values.iter().enumerate() {
                self.right[(row, layer)] += importance * a * value;
            }
        }
    }

    /// The entries: a row each, a column a layer. None where what was asked does not settle them all.
    pub fn solve(self) -> Option<DMatrix<f64>> {
        let factor = CscCholesky::factor(&CscMatrix::from(&self.normal)).ok()?;
        Some(factor.solve(&self.right))
    }
}
