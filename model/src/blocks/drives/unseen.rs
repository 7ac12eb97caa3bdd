// SPDX-License-Identifier: MIT OR Apache-2.0
//! Drives observed at their drive words only: clocks in which they are idle are skipped.

use super::{Drives, In, Out, TargetPort};
use crate::blocks::rests::Rests;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::signal::is_set;

impl Drives {
    /// Whether a drive word is in progress: else, without inputs, a clock changes nothing.
    #[inline(always)]
    fn is_busy<V: Interpretation>(&self, state: &State<Self, V>) -> bool {
        let (r, within) = (state.load(self), &state.submodules);
        let own = [r.asked, r.start, r.driven, r.cleared];
        let split_pad = self.split_pad.as_ref().zip(within.split_pad.as_ref());
        own.into_iter().any(is_set)
            || self.controller.is_busy(&within.controller)
            || split_pad.is_some_and(|(of, state)| of.is_busy(state))
    }

    /// Whether these inputs are nothing: neither an estimate nor a place, nothing that the host does, nothing that stops drives.
    #[inline(always)]
    fn is_nothing<V: Interpretation>(i: &In<V>) -> bool {
        let TargetPort { target_write, alive, clear_faults, .. } = i.target;
        let given = [i.estimate.prompt, i.placed, target_write, alive, clear_faults];
        let written = [i.tuning.curve_write, i.wall.wall_write, i.extremes_read];
        let clears = [i.clear, i.drives_clear, i.tick, !i.tuning.enable];
        !given.into_iter().chain(written).chain(clears).any(is_set)
    }

    /// A clock for a caller that uses each drive word as it comes and nothing else: its outputs, or nothing where it
    /// would change nothing.
    #[inline(always)]
    pub(crate) fn clock_unseen<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        i: In<V>,
    ) -> Option<Out<V>> {
        if Self::is_nothing(&i) && !self.is_busy(state) {
            return None;
        }
        Some(self.clock_apart(state, &i))
    }

    /// A clock, out of line: once is enough of what is large. Its inputs are not copied: the clock's wide loads would
    /// wait for the words of the copy, which takes a quarter of its time.
    #[inline(never)]
    pub(crate) fn clock_apart<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        i: &In<V>,
    ) -> Out<V> {
        self.clock(state, *i)
    }
}
