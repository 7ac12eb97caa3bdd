// SPDX-License-Identifier: MIT OR Apache-2.0
//! The small dense systems that tie terminals and pads together, real or complex. Written out,
//! since a library that chooses its instructions by the processor rounds differently from one
//! machine to the next.

use std::ops::{Div, Mul, Sub};

use num_complex::Complex64;

/// A number that a system can be of.
pub trait Scalar:
    Copy + From<f64> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// Its magnitude: the largest of a column is the pivot.
    fn size(self) -> f64;
}

impl Scalar for f64 {
    fn size(self) -> f64 {
        self.abs()
    }
}

impl Scalar for Complex64 {
    fn size(self) -> f64 {
        self.norm()
    }
}

/// X of A·X = B by Gauss and Jordan, A not singular; B by its rows.
pub fn solve<T: Scalar>(mut a: Vec<Vec<T>>, mut b: Vec<Vec<T>>) -> Vec<Vec<T>> {
    for pivot in 0..a.len() {
        let rows = pivot..a.len();
        let largest = rows
            .max_by(|i, j| a[*i][pivot].size().total_cmp(&a[*j][pivot].size()))
            .unwrap_or(pivot);
        a.swap(pivot, largest);
        b.swap(pivot, largest);
        let scale = T::from(1.0) / a[pivot][pivot];
        a[pivot].iter_mut().chain(&mut b[pivot]).for_each(|value| *value = *value * scale);
        let (a_row, b_row) = (a[pivot].clone(), b[pivot].clone());
        for row in (0..a.len()).filter(|row| *row != pivot) {
            let factor = a[row][pivot];
            a[row]
                .iter_mut()
                .zip(&a_row)
                .for_each(|(value, known)| *value = *value - factor * *known);
            b[row]
                .iter_mut()
                .zip(&b_row)
                .for_each(|(value, known)| *value = *value - factor * *known);
        }
    }
    b
}

/// A square matrix in one allocation, row by row.
#[derive(Clone, Debug)]
pub struct Square<T> {
    order: usize,
    values: Vec<T>,
}

impl<T: Scalar> Square<T> {
    /// From each row's and column's value.
    pub fn of(order: usize, value: impl Fn(usize, usize) -> T) -> Self {
        Square { order, values: (0..order * order).map(|n| value(n / order, n % order)).collect() }
    }

    /// Row by row.
    pub fn rows(&self) -> impl Iterator<Item = &[T]> {
        self.values.chunks_exact(self.order)
    }

    /// The value of a row and a column.
    pub fn at(&self, row: usize, column: usize) -> T {
        self.values[row * self.order + column]
    }

    /// The inverse of a matrix that is not singular.
    pub fn invert(&self) -> Self {
        let unit =
            Square::of(self.order, |row, column| T::from(f64::from(u8::from(row == column))));
        let [matrix, unit] = [self, &unit].map(|square| square.rows().map(<[T]>::to_vec).collect());
        let inverse = solve(matrix, unit);
        Square::of(self.order, |row, column| inverse[row][column])
    }
}

/// Scalar product over the shorter of both.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_that_needs_its_rows_swapped_times_its_inverse_is_one() {
        let j = Complex64::I;
        let one = Complex64::ONE;
        let matrix = [[one * 0.0, one * 2.0, j], [one, j * 3.0, one * -1.0], [j, one, one * 5.0]];
        let inverse = Square::of(3, |row, column| matrix[row][column]).invert();
        for (row, column) in (0..3).flat_map(|row| (0..3).map(move |column| (row, column))) {
            let product: Complex64 = (0..3).map(|k| matrix[row][k] * inverse.at(k, column)).sum();
            assert!((product - f64::from(u8::from(row == column))).norm() < 1e-15);
        }
    }
}
