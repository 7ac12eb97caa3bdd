// SPDX-License-Identifier: MIT OR Apache-2.0
//! A table of the analytic split over the places a pad's centre can be: a bicubic spline with the exact slopes at its rim.
//!
//! The spline is kept as coefficients c of B-splines, so that a look-up weighs four by four of them:
//!
//!   f(i + t) = [(1−t)³ c_(i−1) + (3t³−6t²+4) c_i + (−3t³+3t²+3t+1) c_(i+1) + t³ c_(i+2)]/6
//!
//! The weights sum to one, hence so do the shares. The error falls with the fourth power of the spacing, a ninth of what
//! four-point interpolation of the same nodes leaves; it is largest in front of the terminals at the edges' middles.

use super::analytic::Analytic;
use super::{Sheet, Solver, Split};
use crate::device::TERMINALS;

/// What a node holds: the shares and the resistance.
type Node = [f64; TERMINALS + 1];

pub(super) struct Bicubic {
    axes: [Axis; 2],
    /// Row by row, one coefficient beyond the nodes on every side.
    coefficients: Vec<Node>,
}

impl Bicubic {
    pub fn new(sheet: &Sheet) -> Self {
        let exact = Analytic::new(sheet);
        let axes = [0, 1].map(|axis| Axis {
            reach_mm: 1e3 * (sheet.size_m[axis] / 2.0 - sheet.pad_radius_m),
            nodes: sheet.table[axis],
        });
        let (columns, rows) = (axes[0].nodes + 2, axes[1].nodes + 2);
        let sample =
            |n: usize| axes[0].sample(n % columns, |x| axes[1].sample(n / columns, |y| node(exact.split(x, y))));
        let mut coefficients: Vec<Node> = (0..columns * rows).map(sample).collect();
        (0..rows).for_each(|row| filter(&mut coefficients, row * columns, 1, columns));
        (0..columns).for_each(|column| filter(&mut coefficients, column, columns, rows));
        Bicubic { axes, coefficients }
    }
}

impl Solver for Bicubic {
    fn split(&self, x_mm: f64, y_mm: f64) -> Split {
        let (column, across) = self.axes[0].weights(x_mm);
        let (row, up) = self.axes[1].weights(y_mm);
        let mut sum: Node = [0.0; TERMINALS + 1];
        for (step, weight_y) in up.into_iter().enumerate() {
            let first = (row + step) * (self.axes[0].nodes + 2) + column;
            for (node, weight_x) in self.coefficients[first..first + 4].iter().zip(across) {
                let weight = weight_x * weight_y;
                sum.iter_mut().zip(node).for_each(|(sum, value)| *sum += weight * value);
            }
        }
        let [a, b, c, d, e, f, ohm] = sum;
        Split { share: [a, b, c, d, e, f], ohm }
    }
}

fn node(Split { share: [a, b, c, d, e, f], ohm }: Split) -> Node {
    [a, b, c, d, e, f, ohm]
}

/// `a + factor·b`
fn add(a: Node, factor: f64, b: Node) -> Node {
    std::array::from_fn(|n| a[n] + factor * b[n])
}

/// Evenly spaced nodes from −reach to reach.
#[derive(Clone, Copy, Debug)]
struct Axis {
    reach_mm: f64,
    nodes: usize,
}

impl Axis {
    fn spacing_mm(&self) -> f64 {
        2.0 * self.reach_mm / (self.nodes - 1) as f64
    }

    /// What the filter starts from: `f` at the nodes 1 to n, at 0 and n + 1 its slope at the rim, per spacing.
    fn sample(&self, index: usize, f: impl Fn(f64) -> Node) -> Node {
        const STEP_MM: f64 = 0.02;
        let slope = |at: f64| {
            let rise = add(f(at + STEP_MM), -1.0, f(at - STEP_MM));
            rise.map(|value| value * self.spacing_mm() / (2.0 * STEP_MM))
        };
        match index {
            0 => slope(-self.reach_mm),
            last if last == self.nodes + 1 => slope(self.reach_mm),
            node => f((node - 1) as f64 * self.spacing_mm() - self.reach_mm),
        }
    }

    /// First of four coefficients and the weight of each.
    fn weights(&self, mm: f64) -> (usize, [f64; 4]) {
        let at = ((mm + self.reach_mm) / self.spacing_mm()).clamp(0.0, (self.nodes - 1) as f64);
        let first = (at as usize).min(self.nodes - 2);
        let t = at - first as f64;
        let s = 1.0 - t;
        let outer = |t: f64| t * t * t / 6.0;
        let inner = |t: f64| ((0.5 * t - 1.0) * t * t) + 2.0 / 3.0;
        (first, [outer(s), inner(t), inner(s), outer(t)])
    }
}

/// Turns values between two end slopes into B-spline coefficients, in place: `count` nodes from `first`, `stride` apart.
///
/// (c_(i−1) + 4c_i + c_(i+1))/6 = f_i inside, (c_1 − c_(−1))/2 = f′ at the ends: tridiagonal once the ends are folded in.
fn filter(values: &mut [Node], first: usize, stride: usize, count: usize) {
    let at = |n: usize| first + n * stride;
    let last = count - 2;
    let mut upper = vec![0.0; count];
    for n in 1..=last {
        let (below, above) = (if n == last { 2.0 } else { 1.0 }, if n == 1 { 2.0 } else { 1.0 });
        let mut right = values[at(n)].map(|value| 6.0 * value);
        if n == 1 {
            right = add(right, 2.0, values[at(0)]);
        }
        if n == last {
            right = add(right, -2.0, values[at(count - 1)]);
        }
        let (pivot, below) = if n == 1 { (4.0, 0.0) } else { (4.0 - below * upper[n - 1], below) };
        right = add(right, -below, values[at(n - 1)]);
        upper[n] = if n == last { 0.0 } else { above / pivot };
        values[at(n)] = right.map(|value| value / pivot);
    }
    for n in (1..last).rev() {
        values[at(n)] = add(values[at(n)], -upper[n], values[at(n + 1)]);
    }
    values[at(0)] = add(values[at(2)], -2.0, values[at(0)]);
    values[at(count - 1)] = add(values[at(last - 1)], 2.0, values[at(count - 1)]);
}
