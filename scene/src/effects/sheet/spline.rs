// SPDX-License-Identifier: MIT OR Apache-2.0
//! A bicubic spline of several values over a rectangle, from its nodes and the slopes at its rim.
//!
//! The spline is kept as coefficients c of B-splines, so that a look-up is a weighted sum of four
//! by four of them:
//!
//!   f(i + t) = [(1−t)³ c_(i−1) + (3t³−6t²+4) c_i + (−3t³+3t²+3t+1) c_(i+1) + t³ c_(i+2)]/6
//!
//! The weights sum to one, hence what sums to one at the nodes does so everywhere. The error falls
//! with the fourth power of the spacing, a ninth of what four-point interpolation of the same nodes
//! leaves.

use super::nodes::{Lane, Nodes, Values};

/// Evenly spaced nodes along an axis, mm.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    pub first_mm: f64,
    pub last_mm: f64,
    pub nodes: usize,
}

impl Axis {
    /// Nodes from −reach to reach.
    pub fn symmetric(reach_mm: f64, nodes: usize) -> Self {
        Axis { first_mm: -reach_mm, last_mm: reach_mm, nodes }
    }

    /// Where a node is.
    fn node_mm(&self, node: usize) -> f64 {
        self.first_mm + node as f64 * self.spacing_mm()
    }

    /// Where the nodes are.
    pub fn nodes_mm(&self) -> impl Iterator<Item = f64> + use<> {
        let axis = *self;
        (0..axis.nodes).map(move |node| axis.node_mm(node))
    }

    fn spacing_mm(&self) -> f64 {
        (self.last_mm - self.first_mm) / (self.nodes - 1) as f64
    }

    /// The interval that a place lies in, and how far along it; held at the ends.
    pub fn locate(&self, mm: f64) -> (usize, f64) {
        let at = ((mm - self.first_mm) / self.spacing_mm()).clamp(0.0, (self.nodes - 1) as f64);
        let interval = (at as usize).min(self.nodes - 2);
        (interval, at - interval as f64)
    }

    /// Where a spline asks for its function, each place prepared: at the nodes, and before and after those
    /// for a slope.
    fn asked<T>(&self, prepare: impl Fn(f64) -> T) -> Vec<Asked<T>> {
        let slope = |at: f64| Asked::Slope([at + STEP_MM, at - STEP_MM].map(&prepare));
        let nodes = self.nodes_mm().map(|at| Asked::Node(prepare(at)));
        [slope(self.first_mm)].into_iter().chain(nodes).chain([slope(self.last_mm)]).collect()
    }

    /// A function as a spline takes it: its value at a node, or its slope per spacing.
    fn ask<T>(&self, asked: &Asked<T>, f: impl Fn(&T) -> Values) -> Values {
        match asked {
            Asked::Node(at) => f(at),
            Asked::Slope([after, before]) => {
                let rise =
                    f(after).into_iter().zip(f(before)).map(|(after, before)| after - before);
                rise.map(|value| value * self.spacing_mm() / (2.0 * STEP_MM)).collect()
            }
        }
    }

    /// First of four coefficients and the weight of each.
    fn weights(&self, mm: f64) -> (usize, [f64; 4]) {
        let (first, t) = self.locate(mm);
        let s = 1.0 - t;
        let outer = |t: f64| t * t * t / 6.0;
        let inner = |t: f64| ((0.5 * t - 1.0) * t * t) + 2.0 / 3.0;
        (first, [outer(s), inner(t), inner(s), outer(t)])
    }
}

/// How far before and after the rim a function is asked for its slope there.
const STEP_MM: f64 = 0.02;

/// Where a function is asked for along an axis.
enum Asked<T> {
    Node(T),
    /// After and before the rim.
    Slope([T; 2]),
}

/// What prepares a coordinate.
type Prepare = fn(f64) -> f64;

/// For a function that needs x and y themselves.
pub(crate) const AS_IT_IS: (Prepare, Prepare) = (|x| x, |y| y);

/// A bicubic spline of several values.
pub(crate) struct Spline {
    axes: [Axis; 2],
    /// Row by row, one coefficient beyond the nodes on every side.
    coefficients: Nodes,
}

impl Spline {
    /// Through a function of `values` values at the nodes, with its slopes at the rim. What the function
    /// needs of an x or of a y alone is prepared once for all places that have it.
    pub fn of<X: Sync, Y: Sync>(
        axes: [Axis; 2],
        values: usize,
        (x, y): (impl Fn(f64) -> X, impl Fn(f64) -> Y),
        f: impl Fn(&X, &Y) -> Values + Sync,
    ) -> Self {
        let (columns, rows) = (axes[0].asked(x), axes[1].asked(y));
        Spline::filtered(axes, values, |column, row| {
            axes[0].ask(&columns[column], |x| axes[1].ask(&rows[row], |y| f(x, y)))
        })
    }

    /// Through values at the nodes, level at the rim: what is insulated there.
    pub fn level(
        axes: [Axis; 2],
        values: usize,
        node: impl Fn(usize, usize) -> Values + Sync,
    ) -> Self {
        let inside = |n: usize, axis: usize| (1..=axes[axis].nodes).contains(&n);
        let sample = |column, row| match inside(column, 0) && inside(row, 1) {
            true => node(column - 1, row - 1),
            false => Values::default(),
        };
        Spline::filtered(axes, values, sample)
    }

    /// Through values at the nodes, with the slopes at the rim that a parabola through three of
    /// them has.
    pub fn free(
        axes: [Axis; 2],
        values: usize,
        node: impl Fn(usize, usize) -> Values + Sync,
    ) -> Self {
        let along = |n: usize, axis: usize, f: &dyn Fn(usize) -> Values| {
            let last = axes[axis].nodes - 1;
            let slope = |a: usize, b: usize, c: usize, sign: f64| {
                let [a, b, c] = [f(a), f(b), f(c)];
                (0..values).map(|n| sign * (2.0 * b[n] - 1.5 * a[n] - 0.5 * c[n])).collect()
            };
            match n {
                0 => slope(0, 1, 2, 1.0),
                beyond if beyond == last + 2 => slope(last, last - 1, last - 2, -1.0),
                n => f(n - 1),
            }
        };
        Spline::filtered(axes, values, |column, row| {
            along(column, 0, &|x| along(row, 1, &|y| node(x, y)))
        })
    }

    fn filtered(
        axes: [Axis; 2],
        values: usize,
        sample: impl Fn(usize, usize) -> Values + Sync,
    ) -> Self {
        let (columns, rows) = (axes[0].nodes + 2, axes[1].nodes + 2);
        let mut coefficients = Nodes::in_rows(values, [columns, rows], sample);
        let (lanes, list) = (coefficients.lanes, &mut coefficients.list);
        list.chunks_exact_mut(columns * lanes).for_each(|row| filter(row, lanes));
        filter(list, columns * lanes);
        Spline { axes, coefficients }
    }

    /// The values at a place; beyond the rim those at the rim.
    pub fn at(&self, x_mm: f64, y_mm: f64) -> Values {
        let (column, across) = self.axes[0].weights(x_mm);
        let (row, up) = self.axes[1].weights(y_mm);
        let first = [0, 1, 2, 3].map(|step| (row + step) * (self.axes[0].nodes + 2) + column);
        self.coefficients
            .weighted(first, &up.map(|weight_y| across.map(|weight_x| weight_x * weight_y)))
    }
}

/// `a + factor·b`
fn add(a: Lane, factor: f64, b: Lane) -> Lane {
    std::array::from_fn(|n| a[n] + factor * b[n])
}

/// Turns values between two end slopes into B-spline coefficients, in place: `lanes` lanes of each node,
/// node after node.
///
/// (c_(i−1) + 4c_i + c_(i+1))/6 = f_i inside, (c_1 − c_(−1))/2 = f′ at the ends: tridiagonal once
/// the ends are folded in.
fn filter(values: &mut [Lane], lanes: usize) {
    let count = values.len() / lanes;
    let last = count - 2;
    let mut upper = vec![0.0; count];
    for n in 1..=last {
        let (below, above) = (if n == last { 2.0 } else { 1.0 }, if n == 1 { 2.0 } else { 1.0 });
        let (pivot, below) = if n == 1 { (4.0, 0.0) } else { (4.0 - below * upper[n - 1], below) };
        upper[n] = if n == last { 0.0 } else { above / pivot };
        for at in n * lanes..(n + 1) * lanes {
            let mut right = values[at].map(|value| 6.0 * value);
            if n == 1 {
                right = add(right, 2.0, values[at - lanes]);
            }
            if n == last {
                right = add(right, -2.0, values[at + lanes]);
            }
            right = add(right, -below, values[at - lanes]);
            values[at] = right.map(|value| value / pivot);
        }
    }
    for n in (1..last).rev() {
        for at in n * lanes..(n + 1) * lanes {
            values[at] = add(values[at], -upper[n], values[at + lanes]);
        }
    }
    let end = (count - 1) * lanes;
    for lane in 0..lanes {
        values[lane] = add(values[2 * lanes + lane], -2.0, values[lane]);
        values[end + lane] = add(values[end + lane - 2 * lanes], 2.0, values[end + lane]);
    }
}
