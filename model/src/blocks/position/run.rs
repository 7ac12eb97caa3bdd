// SPDX-License-Identifier: MIT OR Apache-2.0
//! The program by itself, clock by clock, with code of its own for what most of its clocks do: in each copy the
//! compiler sees how little that is.

use super::{Decoded, In, Inputs, Operation, Position};
use hapticore_hdl::block::State;
use hapticore_hdl::signal::{Clocked, bit, int, is_clear, is_set};

impl Position {
    /// Clocks of the program that is running, `most` at most, up to that in which it gives its results: how many
    /// there were.
    #[inline(always)]
    pub(in crate::blocks) fn run(
        &self,
        state: &mut State<Self, Clocked>,
        i: &In<Clocked>,
        most: u64,
    ) -> u64 {
        let i = Inputs { start: bit(false), ..*i };
        let (mut own, mut clocks) = (state.take_out(), 0);
        while clocks < most && self.is_running(&own) {
            self.run_clock(&mut own, i);
            clocks += 1;
        }
        state.put_back(own);
        clocks
    }

    #[inline(always)]
    fn run_clock(&self, state: &mut State<Self, Clocked>, i: In<Clocked>) {
        let r = state.load(self);
        let now = self.decode(&r);
        if is_clear(now.done) {
            return self.cycle(state, r, i, &Decoded { done: bit(false), ..now });
        }
        macro_rules! copies {
            ($($operation:ident)*) => {
                $(if is_set(now.is(Operation::$operation)) {
                    let operation = int(Operation::$operation as u64);
                    let now = Decoded { operation, done: bit(true), ..now };
                    return self.cycle(state, r, i, &now);
                })*
            };
        }
        copies!(Multiply MultiplyTable Load Store LoadDigit);
        self.cycle(state, r, i, &now);
    }
}
