// SPDX-License-Identifier: MIT OR Apache-2.0
//! Least squares over tables: which entries make interpolation come nearest to given values.

use nalgebra::DMatrix;
use nalgebra_sparse::factorization::CscCholesky;
use nalgebra_sparse::{CooMatrix, CscMatrix};

/// A table whose entries are sought.
pub struct Fit {
    /// Of each entry the others that it meets, with the normal equations' coefficients: few, as
    /// interpolation is local.
    normal: Vec<Vec<(usize, f64)>>,
    right: DMatrix<f64>,
}

impl Fit {
    /// A table of `entries`, each of `layers` numbers.
    pub fn new(entries: usize, layers: usize) -> Self {
        Fit { normal: vec![Vec::new(); entries], right: DMatrix::zeros(entries, layers) }
    }

    /// Adds an equation: the weighted sum of some entries equals the values, one per layer.
    pub fn ask(&mut self, terms: &[(usize, f64)], values: &[f64], importance: f64) {
        for &(row, a) in terms {
            for &(column, b) in terms {
                self.add(row, column, importance * a * b);
            }
            for (layer, value) in values.iter().enumerate() {
                self.right[(row, layer)] += importance * a * value;
            }
        }
    }

    fn add(&mut self, row: usize, column: usize, by: f64) {
        let row = &mut self.normal[row];
        match row.iter_mut().find(|(known, _)| *known == column) {
            Some((_, sum)) => *sum += by,
            None => row.push((column, by)),
        }
    }

    /// The entries: a row each, a column a layer. None where what was asked does not settle them
    /// all.
    pub fn solve(self) -> Option<DMatrix<f64>> {
        let entries = self.normal.len();
        let mut normal = CooMatrix::new(entries, entries);
        for (row, columns) in self.normal.iter().enumerate() {
            columns.iter().for_each(|&(column, sum)| normal.push(row, column, sum));
        }
        let factor = CscCholesky::factor(&CscMatrix::from(&normal)).ok()?;
        Some(factor.solve(&self.right))
    }
}
