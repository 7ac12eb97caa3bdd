// SPDX-License-Identifier: MIT OR Apache-2.0
//! The normal equations of a raster solved by conjugate gradients, in some ten steps: what they are like is
//! solved exactly in each ([`Separable`]).
//!
//! Hestenes and Stiefel, Methods of conjugate gradients for solving linear systems, J. Res. NBS 49, 1952, with
//! a preconditioner. Layers are solved side by side, each with steps of its own.

use std::ops::Range;

use super::near::{NEAR, Near, REACH};
use super::separable::Separable;

/// Steps at most: points on a raster need some ten.
const STEPS: usize = 40;

/// The square of what is left, of what there was: rounding leaves about as much.
const LEFT: f64 = 1e-28;

/// Of each entry a number per layer.
type Entries<const LAYERS: usize> = Vec<[f64; LAYERS]>;

/// The entries of a raster of so many columns and rows; none where they were not found in so many steps.
pub fn solve<const LAYERS: usize>(
    size: [usize; 2],
    normal: &[Near],
    right: &[[f64; LAYERS]],
) -> Option<Entries<LAYERS>> {
    let mut search = Search::new(size, normal, right)?;
    let mut left = search.left();
    let least = left.map(|left| LEFT * left);
    search.turn([0.0; LAYERS]);
    for _ in 0..STEPS {
        if (0..LAYERS).all(|n| left[n] <= least[n]) {
            return Some(search.x);
        }
        let bend = search.bend()?;
        search.go(ratios(left, bend));
        let before = std::mem::replace(&mut left, search.left());
        search.turn(ratios(left, before));
    }
    None
}

/// The entries as they were found so far, and where to go from there.
struct Search<'a, const LAYERS: usize> {
    columns: usize,
    normal: &'a [Near],
    like: Separable,
    x: Entries<LAYERS>,
    /// What the entries leave of the right-hand sides.
    left: Entries<LAYERS>,
    /// Where the entries would be, by what the equations are like.
    towards: Entries<LAYERS>,
    /// Along which they go, with zeros before and after it, for neighbours that are not there.
    direction: Entries<LAYERS>,
    /// What a step along it takes from what is left.
    change: Entries<LAYERS>,
}

impl<'a, const LAYERS: usize> Search<'a, LAYERS> {
    fn new(size: [usize; 2], normal: &'a [Near], right: &[[f64; LAYERS]]) -> Option<Self> {
        let zeros = |count: usize| {
            let mut zeros = Vec::new();
            zeros.resize(count, [0.0; LAYERS]);
            zeros
        };
        let entries = right.len();
        Some(Search {
            columns: size[0],
            normal,
            like: Separable::like(size, normal)?,
            x: zeros(entries),
            left: right.to_vec(),
            towards: zeros(entries),
            direction: zeros(entries + 2 * beyond(size[0])),
            change: zeros(entries),
        })
    }

    fn inner(&self) -> Range<usize> {
        beyond(self.columns)..beyond(self.columns) + self.x.len()
    }

    /// How much is left of each layer, as a square.
    fn left(&mut self) -> [f64; LAYERS] {
        self.like.solve(&self.left, &mut self.towards);
        dots(&self.left, &self.towards)
    }

    /// Turns the direction towards where the entries would be; so much of the one before is kept.
    fn turn(&mut self, kept: [f64; LAYERS]) {
        let inner = self.inner();
        for (direction, towards) in self.direction[inner].iter_mut().zip(&self.towards) {
            *direction = std::array::from_fn(|n| towards[n] + kept[n] * direction[n]);
        }
    }

    /// How fast a step along the direction has less and less effect; none where it has more and more, which no sum of
    /// squares has.
    fn bend(&mut self) -> Option<[f64; LAYERS]> {
        multiply(self.columns, self.normal, &self.direction, &mut self.change);
        let bend = dots(&self.direction[self.inner()], &self.change);
        bend.iter().all(|bend| *bend >= 0.0).then_some(bend)
    }

    /// Goes so far along the direction.
    fn go(&mut self, far: [f64; LAYERS]) {
        let inner = self.inner();
        let steps = self.direction[inner].iter().zip(&self.change);
        for ((x, left), (direction, change)) in self.x.iter_mut().zip(&mut self.left).zip(steps) {
            for n in 0..LAYERS {
                x[n] += far[n] * direction[n];
                left[n] -= far[n] * change[n];
            }
        }
    }
}

/// Entries that a neighbour may lie before the first or after the last one.
fn beyond(columns: usize) -> usize {
    REACH * columns + REACH
}

/// Quotients; 0 where there is nothing left to divide by.
fn ratios<const LAYERS: usize>(a: [f64; LAYERS], b: [f64; LAYERS]) -> [f64; LAYERS] {
    std::array::from_fn(|n| if b[n] > 0.0 { a[n] / b[n] } else { 0.0 })
}

fn dots<const LAYERS: usize>(a: &[[f64; LAYERS]], b: &[[f64; LAYERS]]) -> [f64; LAYERS] {
    let mut sums = [0.0; LAYERS];
    for (a, b) in a.iter().zip(b) {
        (0..LAYERS).for_each(|n| sums[n] += a[n] * b[n]);
    }
    sums
}

/// The equations' left-hand sides for a vector with zeros before and after it.
fn multiply<const LAYERS: usize>(
    columns: usize,
    normal: &[Near],
    x: &[[f64; LAYERS]],
    product: &mut [[f64; LAYERS]],
) {
    for (entry, (near, product)) in normal.iter().zip(product).enumerate() {
        let mut sum = [0.0; LAYERS];
        for (n, line) in near.iter().enumerate() {
            let x = &x[entry + n * columns..][..NEAR];
            for (coefficient, x) in line.iter().zip(x) {
                (0..LAYERS).for_each(|n| sum[n] += coefficient * x[n]);
            }
        }
        *product = sum;
    }
}
