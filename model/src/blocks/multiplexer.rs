// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pad multiplexer: serves the pads one by one, and says what each ADC sample is for.
//!
//! ```text
//! slot, in samples:  | open: no pad driven | settle: blanked            | integrate               |
//!                      switch breaks          switch made, all settles     the demodulator listens
//! ```
//!
//! | signal | format                    | overflow                             |
//! | count  | counter of a slot         | wraps to zero at the end, by compare |
//! | pad    | counter of the pads       | wraps to zero at the end, by compare |
//!
//! `clear` abandons the current slot: no pad is driven, and the next strobe is the first of the
//! first pad's slot.
//!
//! Latency: one clock from a strobe to its `sample`; the flags then hold until the next strobe.

use super::rests::Rests;
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::{Clocked, Proved, Signal, bit, int, zero};
use hapticore_hdl::{block, when};

block! {
    /// The pad multiplexer.
    pub struct Multiplexer("multiplexer") {
        /// Samples of a slot before a switch closes, before the window begins, and until it ends.
        open: u64,
        begin: u64,
        end: u64,
        pads: u64,
    }
    submodules {}
    inputs(multiplexer) {
        /// A set of ADC codes is valid.
        strobe: BIT,
        /// Abandons the current slot; overrides `strobe`.
        clear: BIT,
    }
    outputs(multiplexer) {
        /// Asserted for one cycle for each sample; the flags below are about this sample.
        sample: BIT,
        /// The first of a slot: the carrier's phase restarts.
        restart: BIT,
        /// The sample lies in the integration window.
        integrate: BIT,
        /// First sample of the window.
        first: BIT,
        /// Last sample of the window.
        last: BIT,
        /// The selected pad.
        pad: multiplexer.pad(),
        /// The pad's switch is closed.
        closed: BIT,
    }
    registers(multiplexer) {
        count: Format::counter(multiplexer.end - 1),
        next: multiplexer.pad(),
        sample: BIT,
        restart: BIT,
        integrate: BIT,
        first: BIT,
        last: BIT,
        pad: multiplexer.pad(),
        closed: BIT,
    }
}

impl Multiplexer {
    /// The multiplexer of a profile.
    pub fn new(profile: &Profile) -> Self {
        let slot = &profile.slot;
        let (begin, end) = (slot.open + slot.settle, slot.samples());
        Multiplexer { open: slot.open, begin, end, pads: profile.pads }
    }

    /// The format of a pad's number.
    #[inline(always)]
    fn pad(&self) -> Format {
        Format::counter(self.pads - 1)
    }

    /// Samples to come before a slot's last.
    #[inline(always)]
    pub(super) fn samples_before_last(&self, state: &State<Self, Clocked>) -> u64 {
        (self.end - 1).saturating_sub(state.registers.count as u64)
    }

    /// What a strobe makes of the registers.
    #[inline(always)]
    fn advance<V: Interpretation>(&self, r: Regs<V>) -> Regs<V> {
        let end = r.count.is(self.end - 1);
        let step = |at_end: Signal<V>, from: Signal<V>| {
            at_end.select(int(0), from + int(1)).resize(from.format, Proved)
        };
        let count = step(end, r.count);
        let following = step(r.next.is(self.pads - 1), r.next);
        Registers {
            count,
            next: end.select(following, r.next),
            sample: bit(true),
            restart: r.count.is(0),
            integrate: r.count.at_least(int(self.begin)),
            first: r.count.is(self.begin),
            last: end,
            pad: r.next,
            closed: r.count.at_least(int(self.open)),
        }
    }
}

impl Rests for Multiplexer {
    #[inline(always)]
    fn under_way<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        r.sample
    }
}

impl Block for Multiplexer {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let Registers { sample, restart, integrate, first, last, pad, closed, .. } = r;
        let outputs = Outputs { sample, restart, integrate, first, last, pad, closed };
        if (i.strobe | self.under_way(&r) | i.clear).can_skip() {
            return outputs;
        }
        let next = when!(i.strobe => self.advance(r), else r);
        let next = Registers { sample: i.strobe, ..next };
        let next = when!(i.clear => Registers::map(self.registers(), zero), else next);
        state.store(self, next);
        outputs
    }
}

#[cfg(test)]
mod tests;
