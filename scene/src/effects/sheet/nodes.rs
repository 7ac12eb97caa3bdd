// SPDX-License-Identifier: MIT OR Apache-2.0
//! Several values at each of many nodes, in one allocation.
//!
//! How many values a node has follows from the number of terminals, which is known at run time
//! only. They are kept four to a lane, so that the loops of a look-up have a fixed length whatever
//! that number is.

use crate::few::Few;
use crate::terminals::MOST_TERMINALS;

/// Values to a lane.
const WIDTH: usize = 4;

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
    /// Nodes of so many values each.
    pub fn new(values: usize, nodes: impl Iterator<Item = Values>) -> Self {
        let lanes = values.div_ceil(WIDTH);
        let lane = |node: &Values, lane: usize| {
            std::array::from_fn(|n| node.get(lane * WIDTH + n).copied().unwrap_or_default())
        };
        let list = nodes.flat_map(|node| (0..lanes).map(move |n| lane(&node, n))).collect();
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
        self.gather(|lane| {
            let mut sum = [0.0; WIDTH];
            for (first, weights) in first.into_iter().zip(weights) {
                let nodes = self.list[first * self.lanes..][lane..].iter().step_by(self.lanes);
                for (node, weight) in nodes.zip(weights) {
                    sum.iter_mut().zip(node).for_each(|(sum, value)| *sum += weight * value);
                }
            }
            sum
        })
    }
}
