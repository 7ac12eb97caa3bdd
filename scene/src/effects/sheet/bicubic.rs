// SPDX-License-Identifier: MIT OR Apache-2.0
//! A table of the analytic split over the places a pad's centre can be, read by bicubic interpolation: four by four nodes
//! with Lagrange's weights, shifted inwards at the rim. The error falls with the fourth power of the spacing.

use super::analytic::Analytic;
use super::{Rung, Sheet, Split};
use crate::device::TERMINALS;

/// What a node holds: the shares and the resistance. Their interpolation weights sum to one, hence so do the shares.
type Node = [f64; TERMINALS + 1];

pub(super) struct Bicubic {
    axes: [Axis; 2],
    nodes: Vec<Node>,
}

impl Bicubic {
    pub fn new(sheet: &Sheet) -> Self {
        let exact = Analytic::new(sheet);
        let reach = sheet.size_m.map(|size| (size / 2.0 - sheet.pad_radius_m) * 1e3);
        let axes = [0, 1].map(|axis| Axis::new(reach[axis], sheet.table[axis]));
        let [columns, rows] = sheet.table;
        let place = |n: usize| (axes[0].place(n % columns), axes[1].place(n / columns));
        let node = |(x_mm, y_mm)| {
            let Split { share: [a, b, c, d, e, f], ohm } = exact.split(x_mm, y_mm);
            [a, b, c, d, e, f, ohm]
        };
        Bicubic { axes, nodes: (0..columns * rows).map(place).map(node).collect() }
    }
}

impl Rung for Bicubic {
    fn split(&self, x_mm: f64, y_mm: f64) -> Split {
        let (column, across) = self.axes[0].weights(x_mm);
        let (row, up) = self.axes[1].weights(y_mm);
        let mut sum: Node = [0.0; TERMINALS + 1];
        for (step, weight_y) in up.into_iter().enumerate() {
            let first = (row + step) * self.axes[0].count + column;
            for (node, weight_x) in self.nodes[first..first + 4].iter().zip(across) {
                let weight = weight_x * weight_y;
                sum.iter_mut().zip(node).for_each(|(sum, value)| *sum += weight * value);
            }
        }
        let [a, b, c, d, e, f, ohm] = sum;
        Split { share: [a, b, c, d, e, f], ohm }
    }
}

/// Evenly spaced nodes from −reach to reach.
#[derive(Clone, Copy, Debug)]
struct Axis {
    reach_mm: f64,
    per_mm: f64,
    count: usize,
}

impl Axis {
    fn new(reach_mm: f64, count: usize) -> Self {
        Axis { reach_mm, per_mm: (count - 1) as f64 / (2.0 * reach_mm), count }
    }

    fn place(&self, node: usize) -> f64 {
        node as f64 / self.per_mm - self.reach_mm
    }

    /// First of four nodes and the weight of each.
    fn weights(&self, mm: f64) -> (usize, [f64; 4]) {
        let at = ((mm + self.reach_mm) * self.per_mm).clamp(0.0, (self.count - 1) as f64);
        let first = (at as usize).saturating_sub(1).min(self.count - 4);
        let t = at - first as f64; // 0 to 3, between 1 and 2 except at the rim
        let [t1, t2, t3] = [t - 1.0, t - 2.0, t - 3.0];
        (first, [-t1 * t2 * t3 / 6.0, t * t2 * t3 / 2.0, -t * t1 * t3 / 2.0, t * t1 * t2 / 6.0])
    }
}
