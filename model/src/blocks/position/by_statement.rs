// SPDX-License-Identifier: MIT OR Apache-2.0
//! The program's results from its statements, for interpretations that decide by codes and keep more than these.
//!
//! ```text
//! terms ─ sum += left · right ─ then ─ [the block's own functions] ─ a word, an output, the base
//! ```
//!
//! A program has some seven thousand clocks, each of which evaluates every operation that an instruction could be. Its
//! statements (`trace.rs`) are a few hundred. What rounds or decides in one is the block's function, so that
//! results, derivatives and sources of error are those of the clocks.

use super::instruction::{COUNT, Operation, SLOT_BITS};
use super::trace::{CELL, QUOTIENT, ROW, ROW_WORDS, TABLE_SCALARS, Term, Then, Trace};
use super::{Decoded, In, Position, Registers, Regs, instruction};
use hapticore_contract::calibration::Layout;
use hapticore_hdl::block::{Interpretation, State};
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::{Proved, Signal, bit, code, int, zero};

/// A run of the program.
struct Run<'a, V: Interpretation> {
    block: &'a Position,
    state: &'a mut State<Position, V>,
    inputs: &'a In<V>,
    registers: Regs<V>,
    /// Those that a term can name.
    words: [Signal<V>; 256],
}

impl Position {
    /// The registers in the clock after `start`, without the program's clocks.
    #[inline(never)]
    pub(super) fn by_statements<V: Interpretation>(
        &self,
        trace: &Trace,
        state: &mut State<Self, V>,
        inputs: &In<V>,
    ) -> Regs<V> {
        let words = self.words_of_terms(state);
        let registers = Registers {
            sum: self.cleared(),
            quotient: int(0).resize(self.registers().quotient, Proved),
            invalid: bit(false),
            saturated: bit(false),
            ..state.load(self)
        };
        let mut run = Run { block: self, state, inputs, registers, words };
        let mut terms = trace.terms.as_slice();
        for statement in &trace.statements {
            let (these, others) = terms.split_at(statement.terms);
            these.iter().for_each(|term| run.add(term));
            run.conclude(statement.then);
            terms = others;
        }
        Registers { done: bit(true), ..run.registers }
    }

    /// The sum when it is cleared, in its own format.
    fn cleared<V: Interpretation>(&self) -> Signal<V> {
        self.half().resize(self.registers().sum, Proved)
    }

    /// The words before a program: the scratch memory's, and the table's scalars.
    fn words_of_terms<V: Interpretation>(&self, state: &mut State<Self, V>) -> [Signal<V>; 256] {
        let mut words = [zero(self.word); 256];
        for (address, word) in words.iter_mut().enumerate().take(1 << SLOT_BITS) {
            let scratch = &mut state.submodules.scratch;
            self.scratch.read(scratch, address_of::<V>(address, self.scratch.address()));
            *word = self.scratch.data(scratch);
        }
        let scalars = words[TABLE_SCALARS.into()..].iter_mut().take(2 * Layout::SCALARS);
        scalars.enumerate().for_each(|(address, word)| *word = self.table_word(state, address));
        words
    }

    /// A word of the table, without a clock; zero beyond its last.
    fn table_word<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        address: usize,
    ) -> Signal<V> {
        if address >= self.words.words {
            return zero(self.word);
        }
        let within = &mut state.submodules;
        if let Some((banks, within)) = self.banks.as_ref().zip(within.banks.as_mut()) {
            return banks.word(within, address);
        }
        let (table, words) = self.table.as_ref().zip(within.table.as_mut()).expect("no banks");
        table.read(words, address_of::<V>(address, table.address()));
        table.data(words)
    }
}

/// An address as a signal.
fn address_of<V: Interpretation>(address: usize, format: Format) -> Signal<V> {
    int(address as u64).resize(format, Proved)
}

impl<V: Interpretation> Run<'_, V> {
    fn word(&self, number: u8) -> Signal<V> {
        self.words[usize::from(number)]
    }

    fn set(&mut self, number: u8, word: Signal<V>) {
        self.words[usize::from(number)] = word;
    }

    fn add(&mut self, term: &Term) {
        let product = self.word(term.left) * self.word(term.right);
        for _ in 0..term.times {
            self.registers.sum = self.block.sum_with(&self.registers, product);
        }
    }

    fn conclude(&mut self, then: Then) {
        match then {
            Then::Store { slot } => {
                let (result, _) = self.block.result(&self.registers);
                self.set(slot, result);
                self.registers.sum = self.block.cleared();
            }
            Then::StoreWith { slot, option, surface } => {
                let word = self.perform(Operation::Store, option, surface);
                self.set(slot, word);
                self.registers.sum = self.block.cleared();
            }
            Then::Row => self.row(),
            Then::Cell { slot } => self.set(CELL, self.block.whole(self.word(slot))),
            Then::Digits { pair, first, count } => {
                (0..count).for_each(|digit| self.digit(pair, first - digit));
            }
            Then::Quotient => self.set(QUOTIENT, self.block.of_digits(&self.registers)),
            Then::Input { slot, option, surface } => {
                let word = self.perform(Operation::Input, option, surface);
                self.set(slot, word);
            }
            Then::Output { surface } => {
                self.perform(Operation::Output, 0, surface);
                self.registers.sum = self.block.cleared();
            }
        }
    }

    /// An instruction, in the clock that does it: what it stores.
    fn perform(&mut self, operation: Operation, option: u8, surface: u8) -> Signal<V> {
        let now = decoded(operation, option);
        let (block, mut r) = (self.block, self.registers);
        r.surface = code(surface.into(), r.surface.format);
        let (result, held) = block.result(&r);
        let stored = block.stored(&r, self.inputs, &now, result);
        self.registers = block.give_out(r, &r, &now, result, held);
        stored
    }

    /// The table's words from the sum, as an integer, on.
    fn row(&mut self) {
        let now = decoded(Operation::Base, COUNT);
        self.registers.base = self.block.next_base(&self.registers, &now);
        let base = V::code(self.registers.base) as usize;
        for (number, address) in (ROW..).zip(base..base + ROW_WORDS) {
            let word = self.block.table_word(self.state, address);
            self.set(number, word);
        }
    }

    /// A digit of a quotient, after which the sum is nearer to zero.
    fn digit(&mut self, pair: u8, power: u8) {
        let r = &self.registers;
        let word = r.sum.msb().select(self.word(pair | 1), self.word(pair));
        let quotient = self.block.with_digit(r);
        self.registers = Registers { quotient, left: word, ..*r };
        let product = word * self.word(power);
        self.registers.sum = self.block.sum_with(&self.registers, product);
    }
}

/// An instruction that is done.
fn decoded<V: Interpretation>(operation: Operation, option: u8) -> Decoded<V> {
    let of = |number: u8, bits: u8| code(number.into(), Format::unsigned(bits, 0));
    Decoded {
        operation: of(operation as u8, instruction::OPERATION_BITS),
        option: of(option, instruction::OPTION_BITS),
        done: bit(true),
        slot: zero(Format::unsigned(SLOT_BITS, 0)),
    }
}
