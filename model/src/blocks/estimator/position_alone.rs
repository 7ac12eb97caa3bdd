// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clocks of the estimator in which the position's program is all that is under way: most of those outside a
//! window.

use super::{Estimator, In, Out, Regs, TablePort, position, ratio};
use crate::blocks::rests::Rests;
use hapticore_hdl::block::{Block, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::signal::{Clocked, bit, is_clear, is_set, zero};

impl Estimator {
    /// Whether the position's program is all that is under way, while nothing is given.
    fn only_position(&self, state: &State<Self, Clocked>, r: &Regs<Clocked>) -> bool {
        let within = &state.submodules;
        let by_eq8 = self.force_estimator.as_ref().zip(within.force_estimator.as_ref());
        let by_table = self.force_table.as_ref().zip(within.force_table.as_ref());
        self.position.is_running(&within.position)
            && !is_set(r.follow)
            && !self.currents.is_busy(&within.currents)
            && !self.haptic_voltage.is_busy(&within.haptic_voltage)
            && !self.ratio.is_busy(&within.ratio)
            && !self.capacitance.is_busy(&within.capacitance)
            && !by_eq8.is_some_and(|(block, state)| block.is_busy(state))
            && !by_table.is_some_and(|(block, state)| block.is_busy(state))
            && !self.frames.is_busy(&within.frames)
    }

    /// Clocks, `most` at most, in which nothing is given, and at most the position's program is under way: how many
    /// there were. Outputs are [held](Self::held).
    #[inline(never)]
    pub(in crate::blocks) fn run_position(
        &self,
        state: &mut State<Self, Clocked>,
        most: u64,
    ) -> u64 {
        let r = state.load(self);
        if is_clear(r.busy) {
            return most;
        }
        if !self.only_position(state, &r) {
            return 0;
        }
        let within = &mut state.submodules;
        let nothing = ratio::Inputs::map(self.ratio.inputs(), zero);
        let ratio::Outputs { r_x, r_y, share, .. } = self.ratio.clock(&mut within.ratio, nothing);
        let table = TablePort::map(self.position.inputs().table, zero);
        let inputs = position::Inputs { start: bit(false), r_x, r_y, share, table };
        self.position.run(&mut within.position, &inputs, most)
    }

    /// The outputs while at most the position's program is under way.
    #[inline(always)]
    pub(in crate::blocks) fn held(
        &self,
        state: &State<Self, Clocked>,
        i: &In<Clocked>,
    ) -> Out<Clocked> {
        self.quiet(state, state.load(self), i)
    }
}
