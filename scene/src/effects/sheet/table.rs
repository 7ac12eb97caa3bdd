// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tables of the analytic split over the places a pad's centre can be.
//!
//! Errors are largest in front of the terminals at the edges' middles. They fall with the second
//! power of the spacing for the bilinear table and with the fourth for the bicubic one.

use super::analytic::{Analytic, Column, Row};
use super::geometry::Sheet;
use super::nodes::{Nodes, Values};
use super::spline::{Axis, Spline};
use super::split::{Solver, Split};

fn axes(sheet: &Sheet, nodes: [usize; 2]) -> [Axis; 2] {
    let reach_mm = sheet.reach_mm();
    [0, 1].map(|axis| Axis::symmetric(reach_mm[axis], sheet.table[axis].unwrap_or(nodes[axis])))
}

/// The split where a column and a row of nodes cross.
fn node(exact: &Analytic, column: &Column, row: &Row) -> Values {
    let (source, ohm) = exact.crossing(column, row);
    let shares = source.shares();
    Values::of(shares.len() + 1, |values| {
        values[..shares.len()].copy_from_slice(shares);
        values[shares.len()] = ohm;
    })
}

/// A bicubic spline with the exact slopes at its rim.
pub(super) struct Bicubic(Spline);

impl Bicubic {
    pub fn new(sheet: &Sheet, nodes: [usize; 2]) -> Self {
        let exact = Analytic::new(sheet);
        let prepare = (|x| exact.column(x), |y| exact.row(y));
        Bicubic(Spline::of(axes(sheet, nodes), sheet.terminals() + 1, prepare, |column, row| {
            node(&exact, column, row)
        }))
    }
}

impl Solver for Bicubic {
    fn split(&self, x_mm: f64, y_mm: f64) -> Split {
        Split::of_node(&self.0.at(x_mm, y_mm))
    }
}

/// Linear between four nodes.
pub(super) struct Bilinear {
    axes: [Axis; 2],
    nodes: Nodes,
}

impl Bilinear {
    pub fn new(sheet: &Sheet, nodes: [usize; 2]) -> Self {
        let (exact, axes) = (Analytic::new(sheet), axes(sheet, nodes));
        let columns: Vec<_> = axes[0].nodes_mm().map(|x| exact.column(x)).collect();
        let rows: Vec<_> = axes[1].nodes_mm().map(|y| exact.row(y)).collect();
        let node = |column: usize, row: usize| node(&exact, &columns[column], &rows[row]);
        let size = axes.map(|axis| axis.nodes);
        Bilinear { axes, nodes: Nodes::in_rows(sheet.terminals() + 1, size, node) }
    }
}

impl Solver for Bilinear {
    fn split(&self, x_mm: f64, y_mm: f64) -> Split {
        let (column, x) = self.axes[0].locate(x_mm);
        let (row, y) = self.axes[1].locate(y_mm);
        let below = row * self.axes[0].nodes + column;
        let above = below + self.axes[0].nodes;
        let values = self.nodes.gather(|lane| {
            let [a, b, c, d] =
                [below, below + 1, above, above + 1].map(|node| self.nodes.lane(node, lane));
            let mix = |n: usize| {
                (1.0 - y) * ((1.0 - x) * a[n] + x * b[n]) + y * ((1.0 - x) * c[n] + x * d[n])
            };
            std::array::from_fn(mix)
        });
        Split::of_node(&values)
    }
}
