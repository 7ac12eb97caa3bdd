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
//! Latency: one clock to open; one to close, where none was closed in the `dead` clocks before.
//! Outputs are registers, so that no line glitches. Source: docs/decisions.md §15.

use super::bits::{previous, word};
use hapticore_hdl::block;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::int;

block! {
    /// The switches of the pads.
    pub struct Pads("pads") {
        pads: u64,
        /// Cycles with all switches open between two pads.
        dead: u64,
    }
    submodules {}
    inputs(block) {
        /// The selected pad.
        serve: Format::counter(block.pads - 1),
        /// Its switch is to be closed.
        closed: BIT,
    }
    outputs(block) {
        /// A bit for each pad: its switch is closed.
        select: Format::unsigned(block.pads as u8, 0),
    }
    registers(block) {
        select: Format::unsigned(block.pads as u8, 0),
        dead: Format::counter(block.dead),
    }
}

impl Pads {
    /// The switches of `pads` pads, with `dead` clocks at least between two.
    pub fn new(pads: u64, dead: u64) -> Self {
        assert!(dead > 0, "a break takes a clock");
        Pads { pads, dead }
    }
}

impl Block for Pads {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let wanted = word((0..self.pads).map(|pad| i.closed & i.serve.is(pad)));
        let open = r.select.is(0);
        let may = r.select.equals(wanted) | (open & r.dead.is(0));
        let select = may.select(wanted, int(0));
        let rest = r.dead.is(0).select(int(0), previous(r.dead));
        let dead = open.select(rest, int(self.dead));
        state.store(self, Registers { select, dead });
        Outputs { select: r.select }
    }
}
