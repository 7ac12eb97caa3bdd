// SPDX-License-Identifier: MIT OR Apache-2.0
//! The exact split of a film of stripes across x, each uniform: what meshes are compared with.
//!
//! In modes cos κy, κ = πk/b, a stripe is a line of admittance Y₀ = κ/R_s. Seen from x, what lies
//! left of it is Y← and what lies right of it Y→, both 0 at the insulated ends:
//!
//!   K(x, x) = 1/(Y← + Y→),   K(x, x′) = K(x′, x′)·u(x)/u(x′) for x < x′,   G = Σ_k ε_k/b·cos κy·cos κy′·K
//!
//! with u the solution from the left. Between places of one stripe the same modes of a uniform film
//! are left out and its Neumann function is added. K of the mode k = 0 is −½|∫R_s dx|, since what is
//! fed in is all taken out.

use std::f64::consts::PI;

use super::linear::{Square, dot};
use super::neumann::Neumann;
use super::*;
use crate::few::Few;

const MODES: usize = 900;

/// A sheet whose film is of stripes.
pub(super) struct Stripes {
    sheet: Sheet,
    exact: Neumann,
    /// Where each stripe ends, and its ohms per square.
    stripes: Vec<(f64, f64)>,
}

impl Stripes {
    pub fn new(sheet: &Sheet, stripes: Vec<(f64, f64)>) -> Self {
        Stripes { sheet: sheet.clone(), exact: Neumann::exact(sheet.size_m), stripes }
    }

    fn stripe(&self, x: f64) -> usize {
        self.stripes.iter().position(|(end, _)| x <= *end).unwrap_or(self.stripes.len() - 1)
    }

    /// Ohms from the left end to x, of a strip as wide as it is long.
    fn across(&self, x: f64) -> f64 {
        let starts = std::iter::once(0.0).chain(self.stripes.iter().map(|stripe| stripe.0));
        starts
            .zip(&self.stripes)
            .map(|(start, (end, ohm))| ohm * (x.min(*end) - start).max(0.0))
            .sum()
    }

    /// Potential at one place for a unit current into another; `near` is as in [`Neumann::at`].
    fn between(&self, p: [f64; 2], q: [f64; 2], near: f64) -> f64 {
        let [_, b] = self.sheet.size_m;
        let stripe = self.stripe(q[0]);
        let same = (stripe == self.stripe(p[0])).then(|| self.stripes[stripe].1);
        let mode = |k: usize| {
            let per_m = PI * k as f64 / b;
            let ohm = coupled(&self.stripes, per_m, p[0], q[0]);
            let even = |ohm| coupled(&[(self.sheet.size_m[0], ohm)], per_m, p[0], q[0]);
            let left = ohm - same.map_or(0.0, even);
            2.0 / b * (per_m * p[1]).cos() * (per_m * q[1]).cos() * left
        };
        let slowest = -0.5 * (self.across(p[0]) - self.across(q[0])).abs() / b;
        let even = |ohm| ohm * (self.exact.at(p, q, near) - self.exact.slope(p[0], q[0]) / b);
        slowest + same.map_or(0.0, even) + (1..MODES).map(mode).sum::<f64>()
    }
}

impl Solver for Stripes {
    fn split(&self, x_mm: f64, y_mm: f64) -> Split {
        let (sheet, place) = (&self.sheet, self.sheet.place_m(x_mm, y_mm));
        let count = sheet.terminals();
        let near = sheet.terminal_radius_m;
        let at = |n: usize| sheet.terminals_m[n];
        let inverse = Square::of(count + 1, |i, j| match (i < count, j < count) {
            (true, true) => {
                self.between(at(i), at(j), near) + if i == j { sheet.terminal_ohm[i] } else { 0.0 }
            }
            (true, false) => -1.0,
            (false, j) => f64::from(u8::from(j)),
        })
        .invert();
        let mut right: Vec<f64> = (0..count).map(|n| self.between(at(n), place, near)).collect();
        right.push(1.0);
        let unknown: Vec<f64> = inverse.rows().map(|row| dot(row, &right)).collect();
        let free = self.between(place, place, sheet.disc_m());
        Split {
            share: Few::from_slice(&unknown[..count]),
            ohm: free + unknown[count] - dot(&unknown[..count], &right),
        }
    }
}

/// K of a mode between two places along x.
fn coupled(stripes: &[(f64, f64)], per_m: f64, x: f64, x1: f64) -> f64 {
    let (low, high) = (x.min(x1), x.max(x1));
    let width = stripes[stripes.len() - 1].0;
    let starts = std::iter::once(0.0).chain(stripes.iter().map(|stripe| stripe.0));
    let mut mirrored: Vec<(f64, f64)> =
        starts.zip(stripes).map(|(start, (_, ohm))| (width - start, *ohm)).collect();
    mirrored.reverse();
    let (left, grown) = seen(stripes, per_m, high);
    let (right, _) = seen(&mirrored, per_m, width - high);
    let (_, before) = seen(stripes, per_m, low);
    (before - grown).exp() / (left + right)
}

/// Y of what lies left of x, and the logarithm of u there.
fn seen(stripes: &[(f64, f64)], per_m: f64, x: f64) -> (f64, f64) {
    let (mut admittance, mut grown, mut start) = (0.0, 0.0, 0.0);
    for (end, ohm) in stripes {
        let line = per_m / ohm;
        let length = per_m * (x.min(*end) - start);
        if length <= 0.0 {
            break;
        }
        let (tanh, decayed) = (length.tanh(), (-2.0 * length).exp());
        grown += length + (0.5 * (1.0 + decayed) + 0.5 * admittance / line * (1.0 - decayed)).ln();
        admittance = line * (admittance + line * tanh) / (line + admittance * tanh);
        start = *end;
    }
    (admittance, grown)
}

#[test]
fn one_stripe_is_a_uniform_film() {
    let sheet = tests::sheet(30.0);
    let stripes = Stripes::new(&sheet, vec![(0.3, 150.0), (0.86, 150.0)]);
    let exact = analytic::Analytic::new(&sheet);
    for [x, y] in [[0.0, 0.0], [300.0, -150.0], [-410.0, 230.0]] {
        let [a, b] = [stripes.split(x, y), exact.split(x, y)];
        tests::assert_near("share", &a.share, &b.share, 1e-8);
        tests::assert_near("R_p", &[a.ohm], &[b.ohm], 1e-4);
    }
}
