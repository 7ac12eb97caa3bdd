// SPDX-License-Identifier: MIT OR Apache-2.0
//! The program by itself: clock by clock to one of its jumps, and from there to the last one in one step.

use super::{In, Position};
use hapticore_hdl::block::{Block, State};
use hapticore_hdl::signal::Clocked;

impl Position {
    /// Clocks of the program that is running, `most` at most, up to that in which it gives its results: how many
    /// there were.
    pub(in crate::blocks) fn run(
        &self,
        state: &mut State<Self, Clocked>,
        i: &In<Clocked>,
        most: u64,
    ) -> u64 {
        let mut clocks = 0;
        while clocks < most && self.is_running(state) {
            let at_jump = state.registers.bubble != 0;
            let leapt = at_jump.then(|| self.leap(state, i, most - clocks)).flatten();
            clocks += leapt.unwrap_or_else(|| self.run_to_jump(state, i, most - clocks));
        }
        clocks
    }

    /// Clocks, `most` at most, up to the program's next jump or its results: how many there were.
    #[inline(never)]
    pub(super) fn run_to_jump(
        &self,
        state: &mut State<Self, Clocked>,
        i: &In<Clocked>,
        most: u64,
    ) -> u64 {
        let (mut own, mut clocks) = (state.take_out(), 0);
        loop {
            self.clock(&mut own, *i);
            clocks += 1;
            if clocks == most || !self.is_running(&own) || own.registers.bubble != 0 {
                break;
            }
        }
        state.put_back(own);
        clocks
    }
}
