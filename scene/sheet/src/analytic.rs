// SPDX-License-Identifier: MIT OR Apache-2.0
//! The exact split: Neumann functions tied together by the terminals.
//!
//! A unit current into the pad at p leaves as w_i through the terminals, so that the potential is
//! φ(r) = R_s·[N(r, p) − Σ w_j·N(r, t_j)] + c. Every terminal is grounded through R_i, φ(t_i) =
//! R_i·w_i, and Σ w = 1:
//!
//!   ⎡ R_s·N(t_i, t_j) + R_i·δ_ij   −1 ⎤ ⎡ w ⎤   ⎡ R_s·N(t_i, p) ⎤
//!   ⎣ 1 … 1                         0 ⎦ ⎣ c ⎦ = ⎣ 1             ⎦,    R_p = R_s·N(p, p) + c − Σ w_j·R_s·N(t_j, p)
//!
//! An open terminal's row says w_i = 0. The matrix is inverted once. A disc of even current has the
//! split of its centre; only N(p, p) sees its size, through R_eff = R·e^(−1/4).

use crate::MOST_TERMINALS;
use crate::few::Few;
use crate::linear::{Square, dot};
use crate::neumann::Neumann;
use crate::uniform::UniformSheet;

/// Of the bordered system: a number for each terminal, then the border's.
type Bordered = Few<f64, { MOST_TERMINALS + 1 }>;

/// A uniform sheet, exactly.
pub struct Analytic {
    sheet: UniformSheet,
    neumann: Neumann,
    inverse: Square<f64>,
}

impl Analytic {
    /// The solution for a sheet.
    pub fn new(sheet: impl Into<UniformSheet>) -> Self {
        let sheet = sheet.into();
        let neumann = Neumann::exact(sheet.size_m);
        Analytic::with(sheet, neumann)
    }

    /// Of a sheet, with another number of images.
    pub fn with(sheet: impl Into<UniformSheet>, neumann: Neumann) -> Self {
        let sheet = sheet.into();
        let inverse = bordered(&sheet, &neumann).invert();
        Analytic { sheet, neumann, inverse }
    }

    /// R_s·N from a position to each terminal, Ω, then the border's 1.
    fn to_terminals(&self, at: [f64; 2]) -> Bordered {
        let sheet = &self.sheet;
        let ohm =
            |there| sheet.ohm_per_square * self.neumann.at(there, at, sheet.terminal_radius_m);
        let terminals = sheet.terminals_m.iter().zip(&sheet.terminal_ohm);
        let known =
            terminals.map(|(there, series)| if series.is_finite() { ohm(*there) } else { 0.0 });
        known.chain([1.0]).collect()
    }

    /// A place, for [`Analytic::between`].
    pub fn source(&self, x_mm: f64, y_mm: f64) -> Source {
        let at = self.sheet.place_m(x_mm, y_mm);
        let known = self.to_terminals(at);
        let unknown = self.inverse.rows().map(|row| dot(row, &known)).collect();
        Source { at, known, unknown }
    }

    /// Potential at one place for a unit current into another, Ω; where both are the same, that of
    /// the pad's own disc.
    pub fn between(&self, a: &Source, b: &Source) -> f64 {
        let free = self.sheet.ohm_per_square * self.neumann.at(a.at, b.at, self.sheet.disc_m());
        let terminals = self.sheet.terminals();
        free + b.unknown[terminals] - dot(&b.unknown[..terminals], &a.known)
    }
}

/// A place on the sheet: R_s·N to the terminals, and the shares and the constant for a current into
/// it.
pub struct Source {
    at: [f64; 2],
    known: Bordered,
    unknown: Bordered,
}

impl Source {
    /// Share of each terminal in a current into the place.
    pub fn shares(&self) -> &[f64] {
        &self.unknown[..self.unknown.len() - 1]
    }
}

fn bordered(sheet: &UniformSheet, neumann: &Neumann) -> Square<f64> {
    let border = sheet.terminals();
    let ohm = |i: usize, j: usize| {
        let between =
            neumann.at(sheet.terminals_m[i], sheet.terminals_m[j], sheet.terminal_radius_m);
        sheet.ohm_per_square * between + if i == j { sheet.terminal_ohm[i] } else { 0.0 }
    };
    let closed = |terminal: usize| terminal < border && sheet.terminal_ohm[terminal].is_finite();
    Square::of(border + 1, |i, j| match (i, j) {
        (i, j) if i < border && !closed(i) => f64::from(u8::from(i == j)),
        (i, j) if i < border && j < border => ohm(i, j),
        (i, _) if i < border => -1.0,
        (_, j) => f64::from(u8::from(closed(j))),
    })
}
