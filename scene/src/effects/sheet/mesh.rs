// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sheet as a mesh of resistors.
//!
//! A conductance of the mesh is (width of the strip that it stands for)/(its length·R_s), half as
//! wide along the rim. R_s is the film's mean along the strip, and strips of different R_s side by
//! side add their conductances. So currents sum to zero at every node to second order in the
//! spacing, also where a film's patches end between two nodes. A current into a place between nodes
//! goes to the four around it, by their weights in bilinear interpolation; a potential there is
//! read so.

use std::collections::BTreeMap;

use super::film::Film;

/// Nodes by column and row, and the weight of each.
pub(crate) type Spread = Vec<([usize; 2], f64)>;

/// Weights below this are rounding: the place is on the line of nodes.
const ON_NODE: f64 = 1e-9;

/// Nodes along the longer side of a part of a mesh that is dissected further, at least.
const LEAST_DISSECTED: usize = 4;

/// A mesh of nodes from rim to rim.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mesh {
    /// Along x and y; two more than a multiple of four, so that the edges' middles are nodes.
    pub cells: [usize; 2],
    pub step_m: [f64; 2],
}

impl Mesh {
    pub fn new(size_m: [f64; 2], spacing_m: f64) -> Self {
        let cells =
            size_m.map(|size| 4 * ((size / spacing_m - 2.0) / 4.0).round().max(1.0) as usize + 2);
        Mesh { cells, step_m: [0, 1].map(|axis| size_m[axis] / cells[axis] as f64) }
    }

    pub fn nodes(&self) -> usize {
        (self.cells[0] + 1) * (self.cells[1] + 1)
    }

    pub fn node(&self, column: usize, row: usize) -> usize {
        row * (self.cells[0] + 1) + column
    }

    pub fn place_m(&self, column: usize, row: usize) -> [f64; 2] {
        [column as f64 * self.step_m[0], row as f64 * self.step_m[1]]
    }

    /// Shares of a current into a place, in m from the bottom left corner, at the sixteen nodes
    /// around it. They are those of cubic interpolation along each axis of a function that goes on
    /// as its mirror image beyond a rim.
    pub fn spread(&self, place_m: [f64; 2]) -> Spread {
        let [columns, rows] = [0, 1].map(|axis| {
            let (cell, t) = self.locate(place_m, axis);
            let weights = [
                -t * (t - 1.0) * (t - 2.0) / 6.0,
                (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
                -(t + 1.0) * t * (t - 2.0) / 2.0,
                (t + 1.0) * t * (t - 1.0) / 6.0,
            ];
            let last = self.cells[axis];
            let folded = |n: usize| (cell + n).abs_diff(1).min((2 * last + 1).abs_diff(cell + n));
            [0, 1, 2, 3].map(|n| (folded(n), weights[n]))
        });
        let nodes = columns.iter().flat_map(|(column, along)| {
            rows.iter().map(move |(row, up)| ([*column, *row], along * up))
        });
        gathered(nodes.filter(|(_, weight)| weight.abs() > ON_NODE))
    }

    /// The same of a current that is shared evenly among many places: by bilinear interpolation.
    pub fn gather(&self, places_m: impl ExactSizeIterator<Item = [f64; 2]>) -> Spread {
        let each = 1.0 / places_m.len() as f64;
        gathered(places_m.flat_map(|place| {
            let [(column, x), (row, y)] = [0, 1].map(|axis| self.locate(place, axis));
            let along = |t: f64, step: usize| if step == 1 { t } else { 1.0 - t };
            [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(right, up)| {
                ([column + right, row + up], each * along(x, right) * along(y, up))
            })
        }))
    }

    /// All nodes in the order of a nested dissection: those of two halves, then of the line between.
    pub fn dissected(&self) -> Vec<usize> {
        let mut order = Vec::with_capacity(self.nodes());
        self.dissect([[0, self.cells[0] + 1], [0, self.cells[1] + 1]], &mut order);
        order
    }

    fn dissect(&self, range: [[usize; 2]; 2], order: &mut Vec<usize>) {
        let [columns, rows] = range.map(|[from, to]| to - from);
        let axis = usize::from(rows > columns);
        let [from, to] = range[axis];
        if to - from < LEAST_DISSECTED || columns == 1 || rows == 1 {
            let [columns, rows] = range.map(|[from, to]| from..to);
            order.extend(rows.flat_map(|row| columns.clone().map(move |c| self.node(c, row))));
            return;
        }
        let between = (from + to) / 2;
        for part in [[from, between], [between + 1, to], [between, between + 1]] {
            let mut half = range;
            half[axis] = part;
            self.dissect(half, order);
        }
    }

    /// The cell that a place lies in along an axis, and how far along it.
    fn locate(&self, place_m: [f64; 2], axis: usize) -> (usize, f64) {
        let at = (place_m[axis] / self.step_m[axis]).clamp(0.0, self.cells[axis] as f64);
        let cell = (at as usize).min(self.cells[axis] - 1);
        (cell, at - cell as f64)
    }

    /// The mesh's conductances: two nodes and siemens each.
    pub fn conductances(&self, film: &Film) -> Vec<(usize, usize, f64)> {
        let [columns, rows] = self.cells;
        let mut list = Vec::with_capacity(2 * self.nodes());
        for (column, row) in
            (0..=rows).flat_map(|row| (0..=columns).map(move |column| (column, row)))
        {
            for (axis, [c, r]) in [[column + 1, row], [column, row + 1]].into_iter().enumerate() {
                if c <= columns && r <= rows {
                    let ends = [self.place_m(column, row)[axis], self.place_m(c, r)[axis]];
                    let sides = self.strip_m(1 - axis, [row, column][axis]);
                    let siemens = film.siemens(axis, ends, sides);
                    list.push((self.node(column, row), self.node(c, r), siemens));
                }
            }
        }
        list
    }

    /// The strip that a line of nodes stands for: from where to where across an axis.
    fn strip_m(&self, axis: usize, line: usize) -> [f64; 2] {
        let side = |at: f64| at.clamp(0.0, self.cells[axis] as f64) * self.step_m[axis];
        [side(line as f64 - 0.5), side(line as f64 + 0.5)]
    }
}

/// Nodes with the sum of the weights of each.
fn gathered(list: impl Iterator<Item = ([usize; 2], f64)>) -> Spread {
    let mut nodes = BTreeMap::<_, f64>::new();
    list.for_each(|(node, weight)| *nodes.entry(node).or_default() += weight);
    nodes.into_iter().collect()
}
