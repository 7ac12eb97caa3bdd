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
//! `clear` abandons the slot under way: no pad is driven, and the next strobe is the first of the first pad's slot.
//!
//! Latency: one clock from a strobe to its `sample`; the flags then hold until the next strobe.

use crate::block::{Block, Cell};
use crate::format::{BIT, Format};
use crate::profile::Profile;
use crate::signal::{Exact, Never, Signal, Value, bit, int, zero};
use crate::{bundle, when};

bundle! {
    /// The inputs.
    pub struct Inputs {
        /// A set of ADC codes is there.
        strobe,
        /// Abandons the slot under way; wins over `strobe`.
        clear,
    }
}

bundle! {
    /// The outputs: all registers.
    pub struct Outputs {
        /// Set for one clock for each sample; the flags below are about this sample.
        sample,
        /// The first of a slot: the carrier begins anew.
        restart,
        /// Within the integration window.
        integrate,
        /// The first of the window.
        first,
        /// The last of the window.
        last,
        /// The pad that is served.
        pad,
        /// Whether the pad's switch is made.
        closed,
    }
}

bundle! {
    /// The registers.
    pub struct Registers {
        count, next, sample, restart, integrate, first, last, pad, closed,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct Multiplexer {
    open: u64,
    begin: u64,
    end: u64,
    pads: u64,
    registers: Registers<Format>,
}

impl Multiplexer {
    /// The multiplexer of a profile.
    pub fn new(profile: &Profile) -> Self {
        let slot = &profile.slot;
        let (begin, end) = (slot.open + slot.settle, slot.samples());
        let pad = Format::counter(profile.pads - 1);
        let registers = Registers {
            count: Format::counter(end - 1),
            next: pad,
            sample: BIT,
            restart: BIT,
            integrate: BIT,
            first: BIT,
            last: BIT,
            pad,
            closed: BIT,
        };
        Multiplexer { open: slot.open, begin, end, pads: profile.pads, registers }
    }

    /// What a strobe makes of the registers.
    #[inline(always)]
    fn advance<V: Value>(&self, r: Registers<Signal<V>>) -> Registers<Signal<V>> {
        let end = r.count.is(self.end - 1);
        let step =
            |at_end: Signal<V>, from: Signal<V>| at_end.select(int(0), from + int(1)).fit(from.format, Exact, Never);
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

impl Multiplexer {
    /// As at reset.
    #[inline(always)]
    fn cleared<V: Value>(&self) -> Registers<Signal<V>> {
        let Registers { count, next, pad, .. } = self.registers();
        let no = bit(false);
        Registers {
            count: zero(count),
            next: zero(next),
            pad: zero(pad),
            sample: no,
            restart: no,
            integrate: no,
            first: no,
            last: no,
            closed: no,
        }
    }
}

impl Block for Multiplexer {
    const NAME: &'static str = "multiplexer";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = ();

    #[inline]
    fn inputs(&self) -> Inputs<Format> {
        Inputs { strobe: BIT, clear: BIT }
    }

    #[inline]
    fn outputs(&self) -> Outputs<Format> {
        let Registers { sample, restart, integrate, first, last, pad, closed, .. } = self.registers;
        Outputs { sample, restart, integrate, first, last, pad, closed }
    }

    #[inline(always)]
    fn registers(&self) -> Registers<Format> {
        let Registers { count, next, pad, .. } = self.registers;
        let (count, next, pad) = (count.counting(), next.counting(), pad.counting());
        Registers { count, next, sample: BIT, restart: BIT, integrate: BIT, first: BIT, last: BIT, pad, closed: BIT }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let Registers { sample, restart, integrate, first, last, pad, closed, .. } = r;
        let outputs = Outputs { sample, restart, integrate, first, last, pad, closed };
        if (i.strobe | r.sample | i.clear).idle() {
            return outputs;
        }
        let next = when!(V, Registers, i.strobe, self.advance(r), r);
        let next = Registers { sample: i.strobe, ..next };
        let next = when!(V, Registers, i.clear, self.cleared(), next);
        cell.store(self, next);
        outputs
    }
}
