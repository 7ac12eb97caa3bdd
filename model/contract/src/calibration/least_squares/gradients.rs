// SPDX-License-Identifier: MIT OR Apache-2.0
//! The normal equations of a raster solved by conjugate gradients, in some ten steps: what they are like is
//! solved exactly in each ([`Separable`]).
//!
//! Hestenes and Stiefel, Methods of conjugate gradients for solving linear systems, J. Res. NBS 49, 1952, with
//! a preconditioner. Layers are solved side by side, each with steps of its own.

use super::raster::{NEAR, Near, REACH};
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
    let like = Separable::like(size, normal)?;
    let zero = || {
        let mut zeros = Vec::new();
        zeros.resize(right.len(), [0.0; LAYERS]);
        zeros
    };
    // The direction has zeros before and after it, for neighbours that are not there.
    let beyond = REACH * size[0] + REACH;
    let mut direction = zero();
    direction.resize(right.len() + 2 * beyond, [0.0; LAYERS]);
    let inner = beyond..beyond + right.len();
    let (mut x, mut left, mut towards, mut change) = (zero(), right.to_vec(), zero(), zero());
    let (mut before, mut least) = ([0.0; LAYERS], [0.0; LAYERS]);
    for step in 0..STEPS {
        like.solve(&left, &mut towards);
        let now = dots(&left, &towards);
        if step == 0 {
            least = now.map(|now| LEFT * now);
        }
        if (0..LAYERS).all(|n| now[n] <= least[n]) {
            return Some(x);
        }
        let kept: [f64; LAYERS] = std::array::from_fn(|n| ratio(now[n], before[n]));
        for (direction, towards) in direction[inner.clone()].iter_mut().zip(&towards) {
            *direction = std::array::from_fn(|n| towards[n] + kept[n] * direction[n]);
        }
        multiply(size[0], normal, &direction, &mut change);
        let bend = dots(&direction[inner.clone()], &change);
        if !bend.iter().all(|bend| *bend >= 0.0) {
            return None;
        }
        let far: [f64; LAYERS] = std::array::from_fn(|n| ratio(now[n], bend[n]));
        for ((x, left), (direction, change)) in
            x.iter_mut().zip(&mut left).zip(direction[inner.clone()].iter().zip(&change))
        {
            for n in 0..LAYERS {
                x[n] += far[n] * direction[n];
                left[n] -= far[n] * change[n];
            }
        }
        before = now;
    }
    None
}

/// A quotient; 0 where there is nothing left to divide by.
fn ratio(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { 0.0 }
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
