// SPDX-License-Identifier: MIT OR Apache-2.0
//! Blocks that are idle between tasks, whose clocks may then be skipped.

use hapticore_hdl::block::{Block, Interpretation, Registers, State};
use hapticore_hdl::signal::{Signal, is_set};

/// A block that is idle between tasks.
pub(super) trait Rests: Block {
    /// Whether a task is in progress: else, without inputs, a clock changes nothing.
    fn under_way<V: Interpretation>(&self, r: &Registers<Self, Signal<V>>) -> Signal<V>;

    /// The same of a state, where every bit is known.
    #[inline(always)]
    fn is_busy<V: Interpretation>(&self, state: &State<Self, V>) -> bool {
        is_set(self.under_way(&state.load(self)))
    }
}
