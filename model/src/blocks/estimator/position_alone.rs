// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clocks of the estimator in which the position's program is all that is under way.

use super::{Estimator, In, Regs, TablePort, position, ratio};
use crate::blocks::rests::Rests;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::signal::{bit, is_set, zero};

impl Estimator {
    /// Whether the position's program is all that is under way, to interpretations that may skip what is not: most
    /// of a slot's clocks outside its window are such.
    #[inline(always)]
    pub(super) fn only_position<V: Interpretation>(
        &self,
        state: &State<Self, V>,
        r: &Regs<V>,
        i: &In<V>,
    ) -> bool {
        let within = &state.submodules;
        let by_eq8 = self.force_estimator.as_ref().zip(within.force_estimator.as_ref());
        let by_table = self.force_table.as_ref().zip(within.force_table.as_ref());
        V::DECIDES
            && bit::<V>(false).can_skip()
            && self.position.is_running(&within.position)
            && ![i.valid, i.clear, i.calibration.table.write, r.follow].into_iter().any(is_set)
            && !self.currents.is_busy(&within.currents)
            && !self.haptic_voltage.is_busy(&within.haptic_voltage)
            && !self.ratio.is_busy(&within.ratio)
            && !self.capacitance.is_busy(&within.capacitance)
            && !by_eq8.is_some_and(|(block, state)| block.is_busy(state))
            && !by_table.is_some_and(|(block, state)| block.is_busy(state))
            && !self.frames.is_busy(&within.frames)
    }

    /// A clock of the position's program alone.
    #[inline(always)]
    pub(super) fn clock_position<V: Interpretation>(&self, state: &mut State<Self, V>) {
        let nothing = ratio::Inputs::map(self.ratio.inputs(), zero);
        let within = &mut state.submodules;
        let ratio::Outputs { r_x, r_y, share, .. } = self.ratio.clock(&mut within.ratio, nothing);
        let table = TablePort::map(self.position.inputs().table, zero);
        let inputs = position::Inputs { start: bit(false), r_x, r_y, share, table };
        self.position.clock(&mut within.position, inputs);
    }
}
