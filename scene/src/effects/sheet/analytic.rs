// SPDX-License-Identifier: MIT OR Apache-2.0
//! The exact split: Neumann functions tied together by the terminals.
//!
//! A unit current into the pad at p leaves as w_i through the terminals, so that the potential is
//! φ(r) = R_s·[N(r, p) − Σ w_j·N(r, t_j)] + c. Every terminal is grounded through R_in, φ(t_i) = R_in·w_i, and Σ w = 1:
//!
//!   ⎡ R_s·N(t_i, t_j) + R_in·δ_ij   −1 ⎤ ⎡ w ⎤   ⎡ R_s·N(t_i, p) ⎤
//!   ⎣ 1 … 1                          0 ⎦ ⎣ c ⎦ = ⎣ 1             ⎦,    R_p = R_s·N(p, p) + c − Σ w_j·R_s·N(t_j, p)
//!
//! The matrix is inverted once. A disc of even current has the split of its centre; only N(p, p) sees its size, through
//! R_eff = R·e^(−1/4).

use std::f64::consts::PI;

use super::neumann::Neumann;
use super::{Sheet, Solver, Split};
use crate::device::TERMINALS;

/// What is left of the first image that the Neumann function leaves out; 2 images for the paper's sheet.
const CUT_OFF: f64 = 1e-9;

/// Unknowns of the bordered system: a current for each terminal and the potential's constant.
const UNKNOWNS: usize = TERMINALS + 1;

type Matrix = [[f64; UNKNOWNS]; UNKNOWNS];

pub(super) struct Analytic {
    sheet: Sheet,
    neumann: Neumann,
    inverse: Matrix,
}

impl Analytic {
    pub fn new(sheet: &Sheet) -> Self {
        let [width, height] = sheet.size_m;
        let images = (CUT_OFF.ln() / (-2.0 * PI * width / height)).ceil();
        Analytic::with_images(sheet, images as i32)
    }

    pub fn with_images(sheet: &Sheet, images: i32) -> Self {
        let neumann = Neumann::new(sheet.size_m, images);
        Analytic { sheet: sheet.clone(), neumann, inverse: invert(bordered(sheet, &neumann)) }
    }
}

impl Solver for Analytic {
    fn split(&self, x_mm: f64, y_mm: f64) -> Split {
        let Sheet { size_m: [width, height], ohm_per_square, terminal_radius_m, .. } = self.sheet;
        let at = [width / 2.0 + x_mm * 1e-3, height / 2.0 + y_mm * 1e-3];
        let mut known = [1.0; UNKNOWNS];
        for (value, terminal) in known.iter_mut().zip(self.sheet.terminals_m) {
            *value = ohm_per_square * self.neumann.at(terminal, at, terminal_radius_m);
        }
        let unknown = self.inverse.map(|row| dot(&row, &known));
        let share: [f64; TERMINALS] = std::array::from_fn(|terminal| unknown[terminal]);
        let disc_m = self.sheet.pad_radius_m * (-0.25f64).exp();
        let own = ohm_per_square * self.neumann.at(at, at, disc_m);
        Split { share, ohm: own + unknown[TERMINALS] - dot(&share, &known) }
    }
}

fn bordered(sheet: &Sheet, neumann: &Neumann) -> Matrix {
    let mut matrix = [[0.0; UNKNOWNS]; UNKNOWNS];
    for (i, to) in sheet.terminals_m.into_iter().enumerate() {
        for (j, from) in sheet.terminals_m.into_iter().enumerate() {
            matrix[i][j] = sheet.ohm_per_square * neumann.at(to, from, sheet.terminal_radius_m);
        }
        matrix[i][i] += sheet.terminal_ohm;
        matrix[i][TERMINALS] = -1.0;
        matrix[TERMINALS][i] = 1.0;
    }
    matrix
}

/// Scalar product over the shorter of both.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Gauss–Jordan with row pivoting; the bordered matrix of a connected sheet is never singular.
fn invert(mut matrix: Matrix) -> Matrix {
    let mut inverse: Matrix = std::array::from_fn(|row| std::array::from_fn(|column| f64::from(row == column)));
    for pivot in 0..UNKNOWNS {
        let rows = pivot..UNKNOWNS;
        let largest = rows.max_by(|i, j| matrix[*i][pivot].abs().total_cmp(&matrix[*j][pivot].abs())).unwrap_or(pivot);
        matrix.swap(pivot, largest);
        inverse.swap(pivot, largest);
        let scale = 1.0 / matrix[pivot][pivot];
        matrix[pivot] = matrix[pivot].map(|value| value * scale);
        inverse[pivot] = inverse[pivot].map(|value| value * scale);
        for row in (0..UNKNOWNS).filter(|row| *row != pivot) {
            let factor = matrix[row][pivot];
            for column in 0..UNKNOWNS {
                matrix[row][column] -= factor * matrix[pivot][column];
                inverse[row][column] -= factor * inverse[pivot][column];
            }
        }
    }
    inverse
}
