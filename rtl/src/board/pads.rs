// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pad selection: one line a pad, never two closed, break before make.
//!
//! ```text
//! wanted   ──1───┐        ┌──2──────         the core's own open time is 10 µs; this one holds whatever the core says
//! select   ──1──────0─0─0─0──2──────         at least `dead` clocks with none between two
//! ```
//!
//! | signal | format       | overflow                 |
//! | select | one bit a pad | –                       |
//! | dead   | counter       | held at zero, by compare |
//!
//! Latency: one clock to open; one to close, where none was closed in the `dead` clocks before. Outputs are registers, so that
//! no line glitches. Source: DESIGN §3.

use super::bits::{previous, word};
use hapticore_model::block::{Block, Cell};
use hapticore_model::bundle;
use hapticore_model::format::{BIT, Format};
use hapticore_model::signal::{Signal, Value, int};

bundle! {
    /// The inputs.
    pub struct Inputs {
        /// The pad that is served.
        serve,
        /// Whether its switch is to be made.
        closed,
    }
}

bundle! {
    /// The output: a register.
    pub struct Outputs {
        /// A bit for each pad: its switch is made.
        select,
    }
}

bundle! {
    /// The registers.
    pub struct Registers {
        select, dead,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct Pads {
    pads: u64,
    dead: u64,
}

impl Pads {
    /// So many pads, with so many clocks at least between two.
    pub fn new(pads: u64, dead: u64) -> Self {
        assert!(dead > 0, "a break takes a clock");
        Pads { pads, dead }
    }
}

impl Block for Pads {
    const NAME: &'static str = "pads";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = ();

    fn inputs(&self) -> Inputs<Format> {
        Inputs { serve: Format::counter(self.pads - 1), closed: BIT }
    }

    fn outputs(&self) -> Outputs<Format> {
        Outputs { select: Format::unsigned(self.pads as u8, 0) }
    }

    fn registers(&self) -> Registers<Format> {
        Registers { select: self.outputs().select, dead: Format::counter(self.dead) }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let wanted = word((0..self.pads).map(|pad| i.closed & i.serve.is(pad)));
        let open = r.select.is(0);
        let may = r.select.equals(wanted) | (open & r.dead.is(0));
        let select = may.select(wanted, int(0));
        let rest = r.dead.is(0).select(int(0), previous(r.dead));
        let dead = open.select(rest, int(self.dead));
        cell.store(self, Registers { select, dead });
        Outputs { select: r.select }
    }
}
