// SPDX-License-Identifier: MIT OR Apache-2.0
//! Equations of a raster that are nearly a product of one matrix along rows and one along columns.
//!
//! B-splines sum to one. What equations about splines add up to over the rows of a raster is therefore the
//! Gram matrix G_x of the splines along x, over its columns G_y, and over both what all equations count
//! together. For a raster of points that all count alike M = G_x ⊗ G_y up to a factor. Where they do not, the
//! diagonal says how much those about an entry count: M ≈ D·(G_x ⊗ G_y)·D with D_e² = M_ee/(G_x ⊗ G_y)_ee.

use super::raster::{NEAR, Near, REACH};

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
        x.chunks_exact_mut(self.along.entries()).for_each(|row| self.along.solve_line(row));
        self.down.solve_lines(x, self.along.entries());
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

    /// Solves for one number per layer and entry, in their place.
    fn solve_line<const LAYERS: usize>(&self, x: &mut [[f64; LAYERS]]) {
        let take = |x: &mut [f64; LAYERS], by: f64, of: &[f64; LAYERS]| {
            x.iter_mut().zip(of).for_each(|(x, of)| *x -= by * of);
        };
        let [mut last, mut second] = [[0.0; LAYERS]; 2];
        for (x, [close, far]) in x.iter_mut().zip(&self.before) {
            take(x, *far, &second);
            take(x, *close, &last);
            (second, last) = (last, *x);
        }
        let ([mut next, mut after], [mut of_next, mut of_after]) =
            ([[0.0; LAYERS]; 2], [[0.0; 2]; 2]);
        for (x, (before, inverse)) in x.iter_mut().zip(self.before.iter().zip(&self.inverse)).rev()
        {
            *x = x.map(|x| x * inverse);
            take(x, of_after[1], &after);
            take(x, of_next[0], &next);
            (after, next) = (next, *x);
            (of_after, of_next) = (of_next, *before);
        }
    }

    /// The same for whole rows of numbers, one row of so many per entry.
    fn solve_lines<const LAYERS: usize>(&self, x: &mut [[f64; LAYERS]], width: usize) {
        let count = self.entries();
        for (n, [close, far]) in self.before.iter().enumerate() {
            if n > 1 {
                take(x, (n, n - 2), *far, width);
            }
            if n > 0 {
                take(x, (n, n - 1), *close, width);
            }
        }
        for (x, inverse) in x.chunks_exact_mut(width).zip(&self.inverse) {
            x.iter_mut().for_each(|x| *x = x.map(|x| x * inverse));
        }
        for n in (0..count).rev() {
            if n + 2 < count {
                take(x, (n, n + 2), self.before[n + 2][1], width);
            }
            if n + 1 < count {
                take(x, (n, n + 1), self.before[n + 1][0], width);
            }
        }
    }
}

/// Takes `by` times a row of numbers from another.
fn take<const LAYERS: usize>(
    x: &mut [[f64; LAYERS]],
    (from, of): (usize, usize),
    by: f64,
    width: usize,
) {
    let (first, second) = x.split_at_mut(from.max(of) * width);
    let (near, far) = (&mut first[from.min(of) * width..][..width], &mut second[..width]);
    let (from, of) = if from < of { (near, far) } else { (far, near) };
    for (from, of) in from.iter_mut().zip(of) {
        from.iter_mut().zip(of).for_each(|(from, of)| *from -= by * *of);
    }
}
