// SPDX-License-Identifier: MIT OR Apache-2.0
//! How a sheet splits a current, and what a way to find that offers.

use super::nodes::Values;
use crate::few::Few;
use crate::terminals::PerTerminal;

/// The sheet as a pad at one place sees it.
#[derive(Clone, Debug)]
pub(crate) struct Split {
    pub share: PerTerminal<f64>,
    pub ohm: f64,
}

impl Split {
    pub fn of_node(node: &Values) -> Split {
        let terminals = node.len() - 1;
        Split { share: Few::from_slice(&node[..terminals]), ohm: node[terminals] }
    }
}

/// One way to get the split at a place, x and y in mm from the centre.
pub(crate) trait Solver: Send + Sync {
    fn split(&self, x_mm: f64, y_mm: f64) -> Split;
}
