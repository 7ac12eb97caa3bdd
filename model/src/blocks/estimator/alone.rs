// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clocks of the estimator in which only one of its blocks is busy: most of those outside a window.

use super::{Estimator, In, Out, Regs, TablePort, capacitance, currents, position, ratio};
use crate::blocks::rests::Rests;
use hapticore_hdl::block::{Block, Inputs, Registers, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::signal::{Clocked, Signal, bit, is_clear, zero};

/// Clocks of a block, `most` at most, up to that in which it gives its results: how many there were.
#[inline(always)]
fn clock_alone<B: Block>(
    block: &B,
    state: &mut State<B, Clocked>,
    i: Inputs<B, Signal<Clocked>>,
    most: u64,
    gives_results: impl Fn(&Registers<B, Clocked>) -> bool,
) -> u64 {
    let (mut own, mut clocks) = (state.take_out(), 0);
    while clocks < most && !gives_results(&own.registers) {
        block.clock(&mut own, i);
        clocks += 1;
    }
    state.put_back(own);
    clocks
}

impl Estimator {
    /// Clocks, `most` at most, without inputs, while at most one block is busy: how many there were. Outputs are
    /// [held](Self::held). `gain` is the calibration's, of the capacitance.
    #[inline(never)]
    pub(in crate::blocks) fn run_alone(
        &self,
        state: &mut State<Self, Clocked>,
        gain: Signal<Clocked>,
        most: u64,
    ) -> u64 {
        let r = state.load(self);
        if is_clear(r.busy) {
            return most;
        }
        let within = &state.submodules;
        if self.others_are_busy(state) {
            return 0;
        }
        match [
            self.currents.is_busy(&within.currents),
            self.ratio.is_busy(&within.ratio),
            self.position.is_running(&within.position),
            self.capacitance.is_busy(&within.capacitance),
        ] {
            [true, false, false, false] => self.currents_alone(state, most),
            [false, true, false, false] => self.ratio_alone(state, most),
            [false, false, true, false] => self.position_alone(state, most),
            [false, false, false, true] => self.capacitance_alone(state, &r, gain, most),
            _ => 0,
        }
    }

    /// Whether a block is busy that has no clocks alone.
    fn others_are_busy(&self, state: &State<Self, Clocked>) -> bool {
        let within = &state.submodules;
        let by_eq8 = self.force_estimator.as_ref().zip(within.force_estimator.as_ref());
        let by_table = self.force_table.as_ref().zip(within.force_table.as_ref());
        self.haptic_voltage.is_busy(&within.haptic_voltage)
            || by_eq8.is_some_and(|(block, state)| block.is_busy(state))
            || by_table.is_some_and(|(block, state)| block.is_busy(state))
            || self.frames.is_busy(&within.frames)
    }

    #[inline(never)]
    fn currents_alone(&self, state: &mut State<Self, Clocked>, most: u64) -> u64 {
        let (block, within) = (&self.currents, &mut state.submodules.currents);
        let nothing = currents::Inputs::map(block.inputs(), zero);
        clock_alone(block, within, nothing, most, |r| r.done != 0)
    }

    #[inline(never)]
    fn ratio_alone(&self, state: &mut State<Self, Clocked>, most: u64) -> u64 {
        let currents::Outputs { x, y, corners, least, .. } = self.currents_held(state);
        let inputs = ratio::Inputs { start: bit(false), x, y, corners, least };
        clock_alone(&self.ratio, &mut state.submodules.ratio, inputs, most, |r| r.done != 0)
    }

    fn position_alone(&self, state: &mut State<Self, Clocked>, most: u64) -> u64 {
        let within = &mut state.submodules;
        let nothing = ratio::Inputs::map(self.ratio.inputs(), zero);
        let ratio::Outputs { r_x, r_y, share, .. } = self.ratio.clock(&mut within.ratio, nothing);
        let table = TablePort::map(self.position.inputs().table, zero);
        let inputs = position::Inputs { start: bit(false), r_x, r_y, share, table };
        self.position.run(&mut within.position, &inputs, most)
    }

    #[inline(never)]
    fn capacitance_alone(
        &self,
        state: &mut State<Self, Clocked>,
        r: &Regs<Clocked>,
        gain: Signal<Clocked>,
        most: u64,
    ) -> u64 {
        let currents::Outputs { total, sense, .. } = self.currents_held(state);
        let within = &mut state.submodules;
        let last = self.sheets.data(&mut within.sheets);
        let found = within.position.load(&self.position).sheet;
        let sheet = self.early(r).select(self.where_placed(r, last), found);
        let inputs = capacitance::Inputs { start: bit(false), total, sense, sheet, gain };
        clock_alone(&self.capacitance, &mut within.capacitance, inputs, most, |r| r.done != 0)
    }

    /// The outputs of the currents while they are idle.
    fn currents_held(&self, state: &mut State<Self, Clocked>) -> currents::Out<Clocked> {
        let nothing = currents::Inputs::map(self.currents.inputs(), zero);
        self.currents.clock(&mut state.submodules.currents, nothing)
    }

    /// The outputs while at most one block is busy, and gives no results.
    #[inline(always)]
    pub(in crate::blocks) fn held(
        &self,
        state: &State<Self, Clocked>,
        i: &In<Clocked>,
    ) -> Out<Clocked> {
        self.quiet(state, state.load(self), i)
    }
}
