// SPDX-License-Identifier: MIT OR Apache-2.0
//! Several values at each of many nodes, in one allocation.
//!
//! How many values a node has follows from the number of terminals, which is known at run time
//! only. They are kept four to a lane, so that the loops of a look-up have a fixed length whatever
//! that number is.

use crate::few::Few;
use crate::terminals::MOST_TERMINALS;
use crate::threads::in_parts;

/// Values to a lane.
const WIDTH: usize = 4;

/// Nodes that are worth a thread.
const LEAST: usize = 2000;

/// Values of a lane.
pub(super) type Lane = [f64; WIDTH];

/// The values of a node: at most a complex number for each terminal and one more, in whole lanes.
pub(crate) type Values = Few<f64, { (2 * (MOST_TERMINALS + 1)).next_multiple_of(WIDTH) }>;

/// Values at nodes.
pub(super) struct Nodes {
    /// Values of a node.
    values: usize,
    /// Lanes of a node.
    pub lanes: usize,
    /// Node by node; what fills the last lane of each up is none of its values.
    pub list: Vec<Lane>,
}

impl Nodes {
    /// Nodes of `values` values each, in rows from left to right, from their column and row.
    pub fn in_rows(
        values: usize,
        [columns, rows]: [usize; 2],
        node: impl Fn(usize, usize) -> Values + Sync,
    ) -> Self {
        let lanes = values.div_ceil(WIDTH);
        let list = in_parts(rows, LEAST.div_ceil(columns), |rows| {
            let mut list = Vec::with_capacity(lanes * columns * rows.len());
            for n in rows.start * columns..rows.end * columns {
                let node = node(n % columns, n / columns);
                let (all, _) = node.as_padded().as_chunks();
                list.extend_from_slice(&all[..lanes]);
            }
            list
        });
        Nodes { values, lanes, list }
    }

    /// Values of a place, from what each lane has there.
    pub fn gather(&self, lane: impl Fn(usize) -> Lane) -> Values {
        Values::of(self.values, |values| {
            values
                .chunks_exact_mut(WIDTH)
                .take(self.lanes)
                .enumerate()
                .for_each(|(n, part)| part.copy_from_slice(&lane(n)));
        })
    }

    /// A lane of a node.
    pub fn lane(&self, node: usize, lane: usize) -> &Lane {
        &self.list[node * self.lanes + lane]
    }

    /// Weighted sums over nodes, four after each of these.
    pub fn weighted(&self, first: [usize; 4], weights: &[Lane; 4]) -> Values {
        let rows = first.map(|node| &self.list[node * self.lanes..(node + WIDTH) * self.lanes]);
        self.gather(|lane| {
            let mut sum = [0.0; WIDTH];
            for (row, weights) in rows.iter().zip(weights) {
                for (n, weight) in weights.iter().enumerate() {
                    let node = &row[n * self.lanes + lane];
                    sum.iter_mut().zip(node).for_each(|(sum, value)| *sum += weight * value);
                }
            }
            sum
        })
    }
}
