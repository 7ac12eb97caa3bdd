// SPDX-License-Identifier: MIT OR Apache-2.0
//! The small dense systems that tie terminals and pads together, real or complex.

use faer::linalg::solvers::DenseSolveCore;
use faer::traits::ComplexField;

/// The inverse of a matrix that is not singular, by LU factorisation with row pivoting.
pub(crate) fn invert<const N: usize, T: ComplexField + Copy>(matrix: [[T; N]; N]) -> [[T; N]; N] {
    let inverse = faer::Mat::from_fn(N, N, |row, column| matrix[row][column]).partial_piv_lu().inverse();
    std::array::from_fn(|row| std::array::from_fn(|column| inverse[(row, column)]))
}

/// Scalar product over the shorter of both, without conjugation.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
