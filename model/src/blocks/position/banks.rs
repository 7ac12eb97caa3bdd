// SPDX-License-Identifier: MIT OR Apache-2.0
//! Banks: the words of the position table as two memories with registers behind them, for parts with quick clocks.
//!
//! ```text
//! address ─┬─ low ──[of_low]──┐
//!          ├─ high ─[of_high]─┴─(choose)─ word
//!          └─[asked_high]─[is_high]───┘
//! ```
//!
//! A table of thousands of words is several block RAMs, one of whose words is chosen. Either bank is half of them, and
//! the last choice comes after the registers.
//!
//! | signal | overflow |
//! | word   | cannot: it is one that was written |
//!
//! Latency: two clocks from the address to the word, which stays until the next is taken.

use super::TablePort;
use hapticore_hdl::block;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{Clocked, Proved, Signal, bit, int};

block! {
    /// A table in two banks.
    pub struct Banks("position_table") {
        word: Format,
    }
    submodules {
        low: Memory,
        high: Memory,
    }
    inputs(block) {
        /// Address of the word that is read.
        read_address: block.address(),
        /// The word that was asked for in the clock before goes to its register.
        takes: BIT,
        table as TablePort: TablePort { write: BIT, address: block.address(), word: block.word },
    }
    outputs(block) {
        word: block.word,
    }
    registers(block) {
        /// What was asked for is in the upper bank.
        asked_high: BIT,
        is_high: BIT,
        of_low: block.word,
        of_high: block.word,
    }
}

impl Banks {
    /// The banks of a table.
    pub fn new(table: &Memory) -> Self {
        let words = table.words.next_power_of_two().max(4) / 2;
        let bank = |name| Memory { name, words, ..table.clone() };
        Banks { word: table.format, low: bank("low"), high: bank("high") }
    }

    /// The format of an address: a bit for the bank, and one in it.
    fn address(&self) -> Format {
        Format::unsigned(1 + self.low.address().width, 0)
    }

    /// Sets a word, without a clock.
    pub(super) fn set_word<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        address: usize,
        word: Signal<V>,
    ) {
        let (bank, words, address) = self.bank(state, address);
        bank.access(words, address, Write { enable: bit(true), address, data: word });
    }

    /// A word, without a clock.
    pub(super) fn word<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        address: usize,
    ) -> Signal<V> {
        let (bank, words, address) = self.bank(state, address);
        bank.read(words, address);
        bank.data(words)
    }

    /// The bank of a word, and the word's address in it.
    fn bank<'a, V: Interpretation>(
        &'a self,
        state: &'a mut State<Self, V>,
        address: usize,
    ) -> (&'a Memory, &'a mut V::Words, Signal<V>) {
        let within = &mut state.submodules;
        let (bank, words) = match address < self.low.words {
            true => (&self.low, &mut within.low),
            false => (&self.high, &mut within.high),
        };
        (bank, words, int((address % bank.words) as u64).resize(bank.address(), Proved))
    }
}

impl Submodules<Clocked> {
    /// The words of the lower and of the upper bank.
    pub(super) fn words(&self) -> [&[i64]; 2] {
        [self.low.words(), self.high.words()]
    }
}

impl Block for Banks {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let outputs = Outputs { word: r.is_high.select(r.of_high, r.of_low) };
        let within = &mut state.submodules;
        let (low, high) = (self.low.data(&mut within.low), self.high.data(&mut within.high));
        let (bits, write) = (self.low.address().width, i.table);
        let [read, written] =
            [i.read_address, write.address].map(|of| (of.bits(bits, 1), of.bits(0, bits)));
        let of_bank = |enable| Write { enable, address: written.1, data: write.word };
        self.low.access(&mut within.low, read.1, of_bank(write.write & !written.0));
        self.high.access(&mut within.high, read.1, of_bank(write.write & written.0));
        let next = Registers {
            asked_high: read.0,
            is_high: i.takes.select(r.asked_high, r.is_high),
            of_low: i.takes.select(low, r.of_low),
            of_high: i.takes.select(high, r.of_high),
        };
        state.store(self, next);
        outputs
    }
}
