// SPDX-License-Identifier: MIT OR Apache-2.0
//! Parallel converter: word, address and a write strobe.
//!
//! ```text
//! word, address  ══╳══════════╳══
//! write_n        ‾‾‾‾‾\__/‾‾‾‾‾‾‾     one clock of set-up, one of strobe, one of hold
//! ```
//!
//! | signal | format    | overflow                         |
//! | word   | magnitude | saturates: full scale is no code |
//!
//! Latency: one clock from a level to its word, two to its strobe. The line is busy for 3 clocks.
//! Source: the usual microprocessor interface of converters; hold it against the data sheet of yours.

use super::LevelPort;
use super::magnitude;
use hapticore_hdl::block;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::int;

block! {
    /// The parallel line.
    pub struct Parallel("dac_parallel") {
        bits: u8,
        channel: Format,
        level: Format,
    }
    submodules {}
    inputs(block) {
        given as LevelPort: LevelPort { valid: BIT, channel: block.channel, level: block.level },
    }
    outputs(block) {
        /// A level may be given in this cycle.
        ready: BIT,
        word: Format::unsigned(block.bits, 0),
        address: block.channel,
        write_n: BIT,
    }
    registers(block) {
        word: Format::unsigned(block.bits, 0),
        address: block.channel,
        /// Clocks until the line is free.
        left: Format::counter(3),
    }
}

impl Parallel {
    /// A line with words of `bits` bits.
    ///
    /// # Panics
    /// Where a word has no or more than 24 bits.
    pub fn new(bits: u8, channel: Format, level: Format) -> Self {
        assert!((1..=24).contains(&bits), "bits: expected 1 to 24, got {bits}");
        Parallel { bits, channel, level }
    }
}

impl Block for Parallel {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let free = r.left.is(0);
        let word = magnitude(i.given.level, self.bits);
        let waited = free.select(int(0), (r.left - int(1)).bits(0, r.left.format.width));
        let registers = Registers {
            word: i.given.valid.select(word, r.word),
            address: i.given.valid.select(i.given.channel, r.address),
            left: i.given.valid.select(int(3), waited),
        };
        state.store(self, registers);
        Outputs { ready: free, word: r.word, address: r.address, write_n: !r.left.is(2) }
    }
}
