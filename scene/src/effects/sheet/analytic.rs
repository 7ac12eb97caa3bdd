// SPDX-License-Identifier: MIT OR Apache-2.0
//! The exact split: Neumann functions tied together by the terminals.
//!
//! A unit current into the pad at p leaves as w_i through the terminals, so that the potential is
//! φ(r) = R_s·[N(r, p) − Σ w_j·N(r, t_j)] + c. Every terminal is grounded through R_i, φ(t_i) = R_i·w_i, and Σ w = 1:
//!
//!   ⎡ R_s·N(t_i, t_j) + R_i·δ_ij   −1 ⎤ ⎡ w ⎤   ⎡ R_s·N(t_i, p) ⎤
//!   ⎣ 1 … 1                         0 ⎦ ⎣ c ⎦ = ⎣ 1             ⎦,    R_p = R_s·N(p, p) + c − Σ w_j·R_s·N(t_j, p)
//!
//! An open terminal's row says w_i = 0. The matrix is inverted once. A disc of even current has the split of its centre;
//! only N(p, p) sees its size, through R_eff = R·e^(−1/4).

use super::linear::{dot, invert};
use super::neumann::Neumann;
use super::{Sheet, Solver, Split};
use crate::device::TERMINALS;

/// Unknowns of the bordered system: a current for each terminal and the potential's constant.
const UNKNOWNS: usize = TERMINALS + 1;

type Matrix = [[f64; UNKNOWNS]; UNKNOWNS];

/// An even sheet, exactly.
pub(crate) struct Analytic {
    sheet: Sheet,
    neumann: Neumann,
    inverse: Matrix,
}

impl Analytic {
    pub fn new(sheet: &Sheet) -> Self {
        Analytic::with(sheet, Neumann::exact(sheet.size_m))
    }

    pub fn with(sheet: &Sheet, neumann: Neumann) -> Self {
        Analytic { sheet: sheet.clone(), neumann, inverse: invert(bordered(sheet, &neumann)) }
    }

    /// R_s·N from a place to each terminal, then the border's 1.
    fn known(&self, at: [f64; 2]) -> [f64; UNKNOWNS] {
        let mut known = [1.0; UNKNOWNS];
        for (terminal, value) in known.iter_mut().enumerate().take(TERMINALS) {
            let there = self.sheet.terminals_m[terminal];
            let closed = self.sheet.terminal_ohm[terminal].is_finite();
            let ohm = || self.sheet.film.ohm_per_square * self.neumann.at(there, at, self.sheet.terminal_radius_m);
            *value = if closed { ohm() } else { 0.0 };
        }
        known
    }

    /// A place, for [`Analytic::between`].
    pub fn source(&self, x_mm: f64, y_mm: f64) -> Source {
        let at = self.sheet.place_m(x_mm, y_mm);
        let known = self.known(at);
        Source { at, known, unknown: self.inverse.map(|row| dot(&row, &known)) }
    }

    /// Potential at one place for a unit current into another, Ω; where both are the same, that of the pad's own disc.
    pub fn between(&self, a: &Source, b: &Source) -> f64 {
        let free = self.sheet.film.ohm_per_square * self.neumann.at(a.at, b.at, self.sheet.disc_m());
        free + b.unknown[TERMINALS] - dot(&b.unknown[..TERMINALS], &a.known)
    }
}

/// A place on the sheet: R_s·N to the terminals, and the shares and the constant for a current into it.
pub(crate) struct Source {
    at: [f64; 2],
    known: [f64; UNKNOWNS],
    unknown: [f64; UNKNOWNS],
}

impl Solver for Analytic {
    fn split(&self, x_mm: f64, y_mm: f64) -> Split {
        let source = self.source(x_mm, y_mm);
        let share = std::array::from_fn(|terminal| source.unknown[terminal]);
        Split { share, ohm: self.between(&source, &source) }
    }
}

fn bordered(sheet: &Sheet, neumann: &Neumann) -> Matrix {
    let mut matrix = [[0.0; UNKNOWNS]; UNKNOWNS];
    for (i, to) in sheet.terminals_m.into_iter().enumerate() {
        if sheet.terminal_ohm[i].is_infinite() {
            matrix[i][i] = 1.0;
            continue;
        }
        for (j, from) in sheet.terminals_m.into_iter().enumerate() {
            matrix[i][j] = sheet.film.ohm_per_square * neumann.at(to, from, sheet.terminal_radius_m);
        }
        matrix[i][i] += sheet.terminal_ohm[i];
        matrix[i][TERMINALS] = -1.0;
        matrix[TERMINALS][i] = 1.0;
    }
    matrix
}
