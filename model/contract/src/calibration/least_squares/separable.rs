// SPDX-License-Identifier: MIT OR Apache-2.0
//! Equations of a raster that are nearly a product of one matrix along rows and one along columns.
//!
//! B-splines sum to one. What equations about splines add up to over the rows of a raster is therefore the
//! Gram matrix G_x of the splines along x, over its columns G_y, and over both what all equations count
//! together. For a raster of points that all count alike M = G_x ⊗ G_y up to a factor. Where they do not, the
//! diagonal says how much those about an entry count: M ≈ D·(G_x ⊗ G_y)·D with D_e² = M_ee/(G_x ⊗ G_y)_ee.

use super::near::{NEAR, Near, REACH};

/// M approached, ready to be solved.
pub struct Separable {
    along: Factor,
    down: Factor,
    /// 1/D of each entry.
    scale: Vec<f64>,
}

impl Separable {
    /// What the equations of a raster of so many columns and rows are like; none where those along a side
    /// do not settle its entries.
    pub fn like([columns, rows]: [usize; 2], normal: &[Near]) -> Option<Self> {
        let (mut along, mut down) = (vec![[0.0; NEAR]; columns], vec![[0.0; NEAR]; rows]);
        for (entry, near) in normal.iter().enumerate() {
            for (n, line) in near.iter().enumerate() {
                let along = &mut along[entry % columns];
                along.iter_mut().zip(line).for_each(|(sum, coefficient)| *sum += coefficient);
                down[entry / columns][n] += line.iter().sum::<f64>();
            }
        }
        let own = |entry: usize| along[entry % columns][REACH] * down[entry / columns][REACH];
        let scale = |(entry, near): (usize, &Near)| (own(entry) / near[REACH][REACH]).sqrt();
        let scale = normal.iter().enumerate().map(scale).collect();
        Some(Separable { scale, along: Factor::of(&along)?, down: Factor::of(&down)? })
    }

    /// The solution for right-hand sides, one per layer.
    pub fn solve<const LAYERS: usize>(&self, right: &[[f64; LAYERS]], x: &mut [[f64; LAYERS]]) {
        for ((x, right), scale) in x.iter_mut().zip(right).zip(&self.scale) {
            *x = right.map(|right| scale * right);
        }
        x.chunks_exact_mut(self.along.entries()).for_each(|row| self.along.solve(row, 1));
        self.down.solve(x, self.along.entries());
        for (x, scale) in x.iter_mut().zip(&self.scale) {
            *x = x.map(|x| scale * x);
        }
    }
}

/// L·D·Lᵀ of a symmetric matrix whose entries meet those up to two before and after them.
struct Factor {
    /// Of each entry: L with the one before it and the one before that.
    before: Vec<[f64; REACH]>,
    /// 1/D.
    inverse: Vec<f64>,
}

impl Factor {
    fn of(matrix: &[[f64; NEAR]]) -> Option<Self> {
        let (mut before, mut inverse) = (Vec::<[f64; REACH]>::new(), Vec::<f64>::new());
        let mut pivots = [0.0; REACH];
        for (n, near) in matrix.iter().enumerate() {
            let [far, close, own, ..] = *near;
            let last = before.last().map_or(0.0, |[close, _]| *close);
            let reciprocal = |back: usize| n.checked_sub(back).map_or(0.0, |at| inverse[at]);
            let far = far * reciprocal(2);
            let close = (close - far * pivots[1] * last) * reciprocal(1);
            let pivot = own - far * far * pivots[1] - close * close * pivots[0];
            (pivot > 0.0).then_some(())?;
            pivots = [pivot, pivots[0]];
            before.push([close, far]);
            inverse.push(1.0 / pivot);
        }
        Some(Factor { before, inverse })
    }

    fn entries(&self) -> usize {
        self.inverse.len()
    }

    /// Solves for right-hand sides side by side, in their place: so many numbers per layer and entry.
    fn solve<const LAYERS: usize>(&self, x: &mut [[f64; LAYERS]], width: usize) {
        let count = self.entries();
        let take = |x: &mut [[f64; LAYERS]], from: usize, by: f64, of: usize| {
            (0..LAYERS).for_each(|n| x[from][n] -= by * x[of][n]);
        };
        for (n, [close, far]) in self.before.iter().enumerate() {
            for at in n * width..(n + 1) * width {
                if n > 1 {
                    take(x, at, *far, at - 2 * width);
                }
                if n > 0 {
                    take(x, at, *close, at - width);
                }
            }
        }
        for n in (0..count).rev() {
            for at in n * width..(n + 1) * width {
                x[at] = x[at].map(|x| x * self.inverse[n]);
                if n + 2 < count {
                    take(x, at, self.before[n + 2][1], at + 2 * width);
                }
                if n + 1 < count {
                    take(x, at, self.before[n + 1][0], at + width);
                }
            }
        }
    }
}
