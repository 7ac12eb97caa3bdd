// SPDX-License-Identifier: MIT OR Apache-2.0
//! The exact split: Neumann functions tied together by the terminals.
//!
//! A unit current into the pad at p leaves as w_i through the terminals, so that the potential is
//! φ(r) = R_s·[N(r, p) − Σ w_j·N(r, t_j)] + c. Every terminal is grounded through R_i, φ(t_i) =
//! R_i·w_i, and Σ w = 1:
//!
//!   ⎡ R_s·N(t_i,t_j) + R_i·δ_ij   −1 ⎤ ⎡ w ⎤   ⎡ R_s·N(t_i,p) ⎤
//!   ⎣ 1 … 1                        0 ⎦ ⎣ c ⎦ = ⎣ 1            ⎦,    R_p = R_s·N(p,p) + c − Σ w_j·R_s·N(t_j,p)
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
    lines: Lines,
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
        let lines = Lines::of(&sheet.terminals_m);
        Analytic { sheet, neumann, inverse, lines }
    }

    /// A place, for [`Analytic::between`].
    pub fn source(&self, x_mm: f64, y_mm: f64) -> Source {
        let [x, y] = self.sheet.place_m(x_mm, y_mm);
        self.source_at([x, y], &self.to_columns(x), &self.to_rows(y))
    }

    /// N along x from each column of terminals.
    fn to_columns(&self, x: f64) -> Few<AlongX, MOST_TERMINALS> {
        self.lines.x.map(|there| self.neumann.along_x(there, x))
    }

    /// N along y from each row of terminals.
    fn to_rows(&self, y: f64) -> Few<AlongY, MOST_TERMINALS> {
        self.lines.y.map(|there| self.neumann.along_y(there, y))
    }

    /// A place from N along either axis.
    fn source_at(&self, at: [f64; 2], to_columns: &[AlongX], to_rows: &[AlongY]) -> Source {
        let terminals = &self.sheet.terminal_ohm;
        let none = Bordered::of(terminals.len() + 1, |_| ());
        // Filled where it stays: it is large to be moved.
        let mut source = Source { at, known: none, unknown: none };
        let near = self.sheet.terminal_radius_m;
        let connected = terminals.iter().map(|series| series.is_finite());
        for ((known, connected), &[column, row]) in
            source.known.iter_mut().zip(connected).zip(self.lines.of_terminal.iter())
        {
            let to_terminal = || self.neumann.join(&to_columns[column], &to_rows[row], near);
            *known = if connected { self.sheet.ohm_per_square * to_terminal() } else { 0.0 };
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
        Column { x, to_columns: self.to_columns(x), own: self.neumann.along_x(x, x) }
    }

    /// The places of this y, mm from the middle, for [`Analytic::crossing`].
    pub fn row(&self, y_mm: f64) -> Row {
        let [_, y] = self.sheet.place_m(0.0, y_mm);
        Row { y, to_rows: self.to_rows(y), own: self.neumann.along_y(y, y) }
    }

    /// The place where a column and a row of a raster cross, and [`Analytic::between`] of it with itself: to
    /// the bit as for a single place, in half the instructions.
    pub fn crossing(&self, column: &Column, row: &Row) -> (Source, f64) {
        let source = self.source_at([column.x, row.y], &column.to_columns, &row.to_rows);
        let own = self.neumann.join(&column.own, &row.own, self.sheet.disc_m());
        let ohm = self.ohm(own, &source, &source);
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

/// Places of one x, m, and what N takes from it: to each column of terminals, and to the place itself.
pub struct Column {
    x: f64,
    to_columns: Few<AlongX, MOST_TERMINALS>,
    own: AlongX,
}

/// The same of one y.
pub struct Row {
    y: f64,
    to_rows: Few<AlongY, MOST_TERMINALS>,
    own: AlongY,
}

/// Columns and rows that the terminals stand in: those at corners share theirs, so that N along an axis is
/// computed for fewer than all.
struct Lines {
    x: Few<f64, MOST_TERMINALS>,
    y: Few<f64, MOST_TERMINALS>,
    /// Column and row of each terminal.
    of_terminal: Few<[usize; 2], MOST_TERMINALS>,
}

impl Lines {
    fn of(terminals_m: &[[f64; 2]]) -> Self {
        let mut lines = [Vec::new(), Vec::new()];
        let mut place = |axis: usize, at: f64| {
            let line: &mut Vec<f64> = &mut lines[axis];
            line.iter().position(|there| *there == at).unwrap_or_else(|| {
                line.push(at);
                line.len() - 1
            })
        };
        let of_terminal =
            terminals_m.iter().map(|at| [0, 1].map(|axis| place(axis, at[axis]))).collect();
        let [x, y] = lines.map(|line| Few::from_slice(&line));
        Lines { x, y, of_terminal }
    }
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
