// SPDX-License-Identifier: MIT OR Apache-2.0
//! Blocks of the estimator that run through their clocks as they are started, for fidelity `fixed`: each of a slot's
//! clocks then evaluates one block instead of all.
//!
//! The clocks are the blocks' own, one after the other; their inputs are stable until they are done. Only
//! where every bit is known is it known that a block has been started.

use super::{Estimator, capacitance, currents, force, haptic_voltage, ratio};
use crate::blocks::rests::Rests;
use hapticore_hdl::block::{Interpretation, State};
use hapticore_hdl::signal::Signal;

/// What blocks were given in a clock.
pub(super) struct Given<V> {
    pub to_currents: currents::In<V>,
    pub to_haptic: haptic_voltage::In<V>,
    pub to_ratio: ratio::In<V>,
    pub to_capacitance: capacitance::In<V>,
    pub to_force: force::In<V>,
}

fn is_set<V: Interpretation>(bit: Signal<V>) -> bool {
    V::known_bit(bit.value) == Some(true)
}

impl Estimator {
    /// Has the blocks run on that were started in this clock.
    #[inline(never)]
    pub(super) fn run_on<V: Interpretation>(&self, state: &mut State<Self, V>, given: Given<V>) {
        let Given { to_currents, to_haptic, to_ratio, to_capacitance, to_force } = given;
        let within = &mut state.submodules;
        if is_set(to_currents.valid & self.currents.is_last(to_currents.index)) {
            V::within("currents", || self.currents.run_on(&mut within.currents, to_currents));
            let block = &self.haptic_voltage;
            V::within("haptic_voltage", || block.run_on(&mut within.haptic_voltage, to_haptic));
        }
        if is_set(to_ratio.start) {
            V::within("ratio", || self.ratio.run_on(&mut within.ratio, to_ratio));
        }
        // In the clock after its start: the sheet's resistance is not that of a prompt estimate before.
        if !is_set(to_capacitance.start) && self.capacitance.is_busy(&within.capacitance) {
            let block = &self.capacitance;
            V::within("capacitance", || block.run_on(&mut within.capacitance, to_capacitance));
        }
        if let Some((block, within)) =
            self.force_estimator.as_ref().zip(within.force_estimator.as_mut())
            && is_set(to_force.start)
        {
            V::within("force_estimator", || block.run_on(within, to_force));
        }
    }
}
