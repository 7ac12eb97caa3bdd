// SPDX-License-Identifier: MIT OR Apache-2.0
//! Neumann function of the mesh of a uniform rectangle, per ohm per square: what [`super::neumann`]
//! is to the sheet itself. The difference between the two for a source, times the film's resistance
//! there, is the mesh's error for that source. Put in series, it removes the effect of the spacing
//! to second order, at rims and in corners as well.
//!
//! With θ_k = πk/n_y, columns c and rows r; 1/ν_k = 1/n_y for k = 0 and n_y, else 2/n_y. The
//! conductances are g_x = h_y/h_x, g_y = h_x/h_y, and cosh μ_k = 1 + (g_y/g_x)(1 − cos θ_k):
//!
//!   N = Σ_k cos(θ_k·r)·cos(θ_k·r′)·K_k(c, c′)/ν_k,
//!   K_k = cosh(μ_k·c<)·cosh(μ_k·(n_x − c>))/(g_x·sinh μ_k·sinh(μ_k·n_x)),
//!   K_0 = [(c² + c′²)/2n_x − max(c, c′) + n_x/3 − 1/12n_x]/g_x

use std::f64::consts::PI;

use super::mesh::{Mesh, Spread};

/// The mesh of a uniform rectangle.
pub(super) struct Lattice {
    cells: [usize; 2],
    /// Conductances between neighbours along x and along y, of a film of 1 Ω per square.
    siemens: [f64; 2],
    /// cos(π·i/n_y) for i below 2n_y.
    cosine: Vec<f64>,
}

impl Lattice {
    pub fn new(mesh: &Mesh) -> Self {
        let [x, y] = mesh.step_m;
        let rows = mesh.cells[1];
        let cosine = (0..2 * rows).map(|n| (PI * n as f64 / rows as f64).cos()).collect();
        Lattice { cells: mesh.cells, siemens: [y / x, x / y], cosine }
    }

    /// The potential of a source in its mean over itself: fᵀ·N·f.
    pub fn energy(&self, source: &Spread) -> f64 {
        let columns = Columns::new(source);
        let rows = self.cells[1];
        let modes = (1..=rows).map(|mode| {
            let norm = if mode == rows { 1.0 } else { 2.0 };
            norm * self.mode(mode, &columns)
        });
        (self.slowest(&columns) + modes.sum::<f64>()) / rows as f64
    }

    /// The potential of one source in its mean over another: fᵀ·N·g.
    pub fn between(&self, f: &Spread, g: &Spread) -> f64 {
        let both: Spread = f.iter().chain(g).copied().collect();
        0.5 * (self.energy(&both) - self.energy(f) - self.energy(g))
    }

    /// ΣF·F′·K_0
    fn slowest(&self, columns: &Columns) -> f64 {
        let n = self.cells[0] as f64;
        let total: Vec<_> = columns.sums(0, &self.cosine).map(|(c, f)| (c as f64, f)).collect();
        let potential = |x: f64, x1: f64| {
            (x * x + x1 * x1) / (2.0 * n) - x.max(x1) + n / 3.0 - 1.0 / (12.0 * n)
        };
        let pairs = total.iter().flat_map(|a| total.iter().map(move |b| (a, b)));
        pairs.map(|((x, f), (x1, f1))| f * f1 * potential(*x, *x1)).sum::<f64>() / self.siemens[0]
    }

    /// ΣF·F′·K_k: from left to right, each column meets the sum of those before it.
    fn mode(&self, mode: usize, columns: &Columns) -> f64 {
        let [along, across] = self.siemens;
        let rise = across / along * (1.0 - self.cosine[mode]);
        let sinh = (rise * (rise + 2.0)).sqrt();
        let decay = 1.0 + rise - sinh; // e^(−μ)
        let power = |cells: usize| decay.powi(cells as i32);
        let width = self.cells[0];
        let Some(mut last) = columns.list.first().map(|first| first.0) else { return 0.0 };
        // What the images in the left and in the right end add to a column.
        let (mut left, mut right) = (power(2 * last), power(2 * (width - last)));
        let (mut before, mut sum) = (0.0, 0.0);
        for (column, value) in columns.sums(mode, &self.cosine) {
            if column == last + 1 {
                (before, left) = (before * decay, left * decay * decay);
                right = right / decay / decay;
            } else {
                before *= power(column - last);
                (left, right) = (power(2 * column), power(2 * (width - column)));
            }
            last = column;
            let own = value * (1.0 + left);
            sum += value * (1.0 + right) * (2.0 * before + own);
            before += own;
        }
        0.5 * sum / (along * sinh * (1.0 - power(2 * width)))
    }
}

/// A source by columns of the mesh: the first row of each, and the weights from there on.
struct Columns {
    list: Vec<(usize, usize, Vec<f64>)>,
}

impl Columns {
    fn new(source: &Spread) -> Self {
        let mut list: Vec<(usize, usize, Vec<f64>)> = Vec::new();
        let mut sorted = source.clone();
        sorted.sort_by_key(|(node, _)| *node);
        for ([column, row], weight) in sorted {
            match list.last_mut().filter(|last| last.0 == column) {
                Some((_, first, weights)) => {
                    weights.resize(weights.len().max(row - *first + 1), 0.0);
                    weights[row - *first] += weight;
                }
                None => list.push((column, row, vec![weight])),
            }
        }
        Columns { list }
    }

    /// Each column, and the sum of its weights times the mode's cosine at their rows.
    fn sums(&self, mode: usize, cosine: &[f64]) -> impl Iterator<Item = (usize, f64)> {
        self.list.iter().map(move |(column, first, weights)| {
            let mut at = mode * first % cosine.len();
            let mut sum = 0.0;
            for weight in weights {
                sum += weight * cosine[at];
                at += mode;
                at -= if at < cosine.len() { 0 } else { cosine.len() };
            }
            (*column, sum)
        })
    }
}
