// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pace: whether samples come no closer than the profile says.
//!
//! ```text
//! strobe   ┐_______________┐_____┐____
//! left     0 P−1 P−2 … 1 0  P−1 …        a strobe while some are left is too early
//! ```
//!
//! | signal | format        | overflow                 |
//! | left   | counter P − 1 | held at zero, by compare |
//!
//! P is `clocks_per_sample`: the demodulator serves all channels in them, and a sample that comes
//! earlier breaks into the one before. `overrun` stays from the strobe that was too early until
//! `clear` or a reset. Latency: one clock.

use super::rests::Rests;
use hapticore_contract::profile::Profile;
use hapticore_hdl::block;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::{Signal, int};

block! {
    /// The check of the samples' distance.
    pub struct Pace("pace") {
        clocks: u64,
    }
    submodules {}
    inputs(pace) {
        /// A set of ADC codes is valid.
        strobe: BIT,
        /// Clears `overrun`.
        clear: BIT,
    }
    outputs(pace) {
        /// A strobe came too early; stays asserted until `clear` or reset.
        overrun: BIT,
    }
    registers(pace) {
        left: Format::counter(pace.clocks - 1),
        overrun: BIT,
    }
}

impl Pace {
    /// The pace of a profile's samples.
    pub fn new(profile: &Profile) -> Self {
        Pace { clocks: profile.clocks_per_sample }
    }

    /// The fewest clocks from one strobe to the next.
    pub fn clocks(&self) -> u64 {
        self.clocks
    }
}

impl Rests for Pace {
    #[inline(always)]
    fn under_way<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        !r.left.is(0)
    }
}

impl Block for Pace {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let none = r.left.is(0);
        let outputs = Outputs { overrun: r.overrun };
        if (i.strobe | i.clear | !none).can_skip() {
            return outputs;
        }
        let fewer = (r.left - int(1)).bits(0, r.left.format.width);
        let left = none.select(int(0), fewer);
        let left = (i.strobe & !i.clear).select(int(self.clocks - 1), left);
        let overrun = (r.overrun | (i.strobe & !none)) & !i.clear;
        state.store(self, Registers { left, overrun });
        outputs
    }
}

#[cfg(test)]
mod tests;
