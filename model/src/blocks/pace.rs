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
//! P is `clocks_per_sample`: the demodulator serves all channels in them, and a sample that comes earlier breaks into the one
//! before. `overrun` stays from the strobe that was too early until `clear` or a reset. Latency: one clock.

use crate::block::{Block, Cell};
use crate::bundle;
use crate::format::{BIT, Format};
use crate::profile::Profile;
use crate::signal::{Signal, Value, int};

bundle! {
    /// The inputs.
    pub struct Inputs {
        /// A set of ADC codes is there.
        strobe,
        /// Forgets.
        clear,
    }
}

bundle! {
    /// The output: a register.
    pub struct Outputs {
        /// A strobe was too early.
        overrun,
    }
}

bundle! {
    /// The registers.
    pub struct Registers {
        left, overrun,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct Pace {
    clocks: u64,
}

impl Pace {
    /// The pace of a profile's samples.
    pub fn new(profile: &Profile) -> Self {
        Pace { clocks: profile.clocks_per_sample }
    }
}

impl Block for Pace {
    const NAME: &'static str = "pace";
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
        Outputs { overrun: BIT }
    }

    #[inline(always)]
    fn registers(&self) -> Registers<Format> {
        Registers { left: Format::counter(self.clocks - 1), overrun: BIT }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let none = r.left.is(0);
        let outputs = Outputs { overrun: r.overrun };
        if (i.strobe | i.clear | !none).idle() {
            return outputs;
        }
        let fewer = (r.left - int(1)).bits(0, r.left.format.width);
        let left = none.select(int(0), fewer);
        let left = (i.strobe & !i.clear).select(int(self.clocks - 1), left);
        let overrun = (r.overrun | (i.strobe & !none)) & !i.clear;
        cell.store(self, Registers { left, overrun });
        outputs
    }
}
