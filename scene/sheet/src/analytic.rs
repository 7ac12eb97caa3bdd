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
use crate::neumann::{AlongX, AlongY, Neumann};
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

    /// A place, for [`Analytic::between`].
    pub fn source(&self, x_mm: f64, y_mm: f64) -> Source {
        let (at, sheet) = (self.sheet.place_m(x_mm, y_mm), &self.sheet);
        self.source_at(at, |n| self.neumann.at(sheet.terminals_m[n], at, sheet.terminal_radius_m))
    }

    /// A place from N to each terminal.
    fn source_at(&self, at: [f64; 2], to_terminal: impl Fn(usize) -> f64) -> Source {
        let terminals = &self.sheet.terminal_ohm;
        let none = Bordered::of(terminals.len() + 1, |_| ());
        // Filled where it stays: it is large to be moved.
        let mut source = Source { at, known: none, unknown: none };
        for (n, (known, series)) in source.known.iter_mut().zip(terminals).enumerate() {
            let connected = series.is_finite();
            *known = if connected { self.sheet.ohm_per_square * to_terminal(n) } else { 0.0 };
        }
        source.known[terminals.len()] = 1.0; // The border's.
        for (unknown, row) in source.unknown.iter_mut().zip(self.inverse.rows()) {
            *unknown = dot(row, &source.known);
        }
        source
    }

    /// The places of this x, mm from the middle, for [`Analytic::crossing`].
    pub fn column(&self, x_mm: f64) -> Column {
        let [x, _] = self.sheet.place_m(x_mm, 0.0);
        let to = |[there, _]: &[f64; 2]| self.neumann.along_x(*there, x);
        let to_terminals = self.sheet.terminals_m.iter().map(to).collect();
        Column { x, to_terminals, own: self.neumann.along_x(x, x) }
    }

    /// The places of this y, mm from the middle, for [`Analytic::crossing`].
    pub fn row(&self, y_mm: f64) -> Row {
        let [_, y] = self.sheet.place_m(0.0, y_mm);
        let to = |[_, there]: &[f64; 2]| self.neumann.along_y(*there, y);
        let to_terminals = self.sheet.terminals_m.iter().map(to).collect();
        Row { y, to_terminals, own: self.neumann.along_y(y, y) }
    }

    /// The place where a column and a row of a raster cross, and [`Analytic::between`] of it with itself: to
    /// the bit as for a single place, in half the instructions.
    pub fn crossing(&self, column: &Column, row: &Row) -> (Source, f64) {
        let join = |x, y, near| self.neumann.join(x, y, near);
        let source = self.source_at([column.x, row.y], |n| {
            join(&column.to_terminals[n], &row.to_terminals[n], self.sheet.terminal_radius_m)
        });
        let ohm = self.ohm(join(&column.own, &row.own, self.sheet.disc_m()), &source, &source);
        (source, ohm)
    }

    /// Potential at one place for a unit current into another, Ω; where both are the same, that of
    /// the pad's own disc.
    pub fn between(&self, a: &Source, b: &Source) -> f64 {
        self.ohm(self.neumann.at(a.at, b.at, self.sheet.disc_m()), a, b)
    }

    /// The same from N between the two.
    fn ohm(&self, between: f64, a: &Source, b: &Source) -> f64 {
        let terminals = self.sheet.terminals();
        let free = self.sheet.ohm_per_square * between;
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

/// Places of one x, m, and what N takes from it: to each terminal, and to the place itself.
pub struct Column {
    x: f64,
    to_terminals: Vec<AlongX>,
    own: AlongX,
}

/// The same of one y.
pub struct Row {
    y: f64,
    to_terminals: Vec<AlongY>,
    own: AlongY,
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Of places on a raster, on the rim too, with a terminal that is open.
    #[test]
    fn where_a_column_and_a_row_cross_is_the_single_place_to_the_bit() {
        let exact = Analytic::new(UniformSheet {
            size_m: [0.86, 0.5],
            ohm_per_square: 150.0,
            pad_radius_m: 0.015,
            terminals_m: vec![[0.0, 0.5], [0.0, 0.0], [0.86, 0.0], [0.86, 0.5], [0.43, 0.0]],
            terminal_ohm: vec![0.0, 20.0, 0.0, crate::uniform::OPEN, 5.0],
            terminal_radius_m: 1.7e-3,
        });
        for x in [-430.0, -17.3, 0.0, 200.0, 430.0] {
            for y in [-250.0, -0.1, 33.0, 250.0] {
                let single = exact.source(x, y);
                let (source, ohm) = exact.crossing(&exact.column(x), &exact.row(y));
                assert_eq!(source.shares(), single.shares(), "{x}, {y}");
                assert_eq!(ohm, exact.between(&single, &single), "{x}, {y}");
            }
        }
    }
}
