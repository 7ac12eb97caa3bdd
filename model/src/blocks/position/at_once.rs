// SPDX-License-Identifier: MIT OR Apache-2.0
//! The program's results without its clocks: most of a slot's clocks are the program's, and two in three of those wait
//! for products. Fidelity `fixed` computes all of it in one step, `clock` the part between two jumps (`leaps.rs`).
//!
//! Its jumps are followed once for all slots (`trace.rs`). Instructions are as `instruction.rs` says, on
//! raw codes. `fixed` and `clock` are held to be equal to the bit.

use super::Position;
use super::instruction::{CHECK, LOW, OPEN, SHARE, SLOT_BITS, WRAP};
use super::program::Program;
use super::trace::{CELL, QUOTIENT, ROW, ROW_WORDS, Statement, TABLE_SCALARS, Term, Then, Trace};
use hapticore_contract::calibration::{Layout, Surface};
use hapticore_hdl::format::Format;

/// All words that a term can name: a run has a copy of its own, without an allocation.
pub(super) type Words = [i64; 256];

/// A program whose jumps have been followed.
#[derive(Debug, Clone)]
pub(super) struct Followed {
    pub trace: Trace,
    word: Format,
    /// Digits of a quotient.
    digits: u32,
    /// Bits of half a ratio that a word does not have.
    rest: u32,
}

/// A program, its constants and a calibration's words.
#[derive(Debug, Clone)]
pub struct AtOnce {
    program: Followed,
    words: Words,
    table: Vec<i64>,
}

/// What the program gives out, as codes.
#[derive(Debug, Clone, Copy, Default)]
pub struct Placed {
    /// The position along either axis, and the sheet's resistance.
    pub outputs: [i64; 3],
    /// As the block's output.
    pub invalid: bool,
    /// As the block's output.
    pub lost: bool,
    /// As the block's output.
    pub saturated: bool,
}

/// The registers of a run.
pub(super) struct Run<'a> {
    program: &'a Followed,
    /// The table's words; those that the first part does not have are in the second.
    table: [&'a [i64]; 2],
    ratios: [i64; 3],
    words: Words,
    sum: i64,
    /// Where the table's words were last read from.
    pub base: i64,
    pub quotient: i64,
    pub placed: Placed,
}

impl Followed {
    /// The program of a position block.
    pub fn new(position: &Position) -> Self {
        let (word, ratio) = (position.word, position.ratio);
        let program = Program::new(word);
        Followed {
            trace: Trace::of(&program, position.steps, position.wait),
            word,
            digits: program.digits().into(),
            rest: (ratio.frac + 1 - word.frac) as u32,
        }
    }

    /// The words of a run over this table, from those of the scratch memory.
    pub fn words(table: [&[i64]; 2], scratch: &[i64]) -> Words {
        let mut words = [0; 256];
        words[..scratch.len()].copy_from_slice(scratch);
        let [first, second] = table;
        let scalars = words[TABLE_SCALARS.into()..].iter_mut().take(2 * Layout::SCALARS);
        scalars.zip(first.iter().chain(second)).for_each(|(word, &of_table)| *word = of_table);
        words
    }

    /// A run with nothing in the sum.
    pub fn run<'a>(&'a self, table: [&'a [i64]; 2], words: Words, ratios: [i64; 3]) -> Run<'a> {
        let placed = Placed::default();
        Run { program: self, table, ratios, words, sum: self.half(), base: 0, quotient: 0, placed }
    }

    fn bits(&self) -> u32 {
        self.word.frac as u32
    }

    fn half(&self) -> i64 {
        1 << (self.bits() - 1)
    }
}

impl AtOnce {
    /// The program of a position block over a table of these codes.
    pub(super) fn new(position: &Position, table: Vec<i64>) -> Self {
        let constants = position.scratch.codes();
        assert!(constants.len() <= 1 << SLOT_BITS, "slots are numbered with {SLOT_BITS} bits");
        let program = Followed::new(position);
        let words = Followed::words([&table, &[]], &constants);
        AtOnce { program, words, table }
    }

    /// What the program makes of r_x, r_y and the share.
    pub(super) fn run(&self, ratios: [i64; 3]) -> Placed {
        let trace = &self.program.trace;
        let mut run = self.program.run([&self.table, &[]], self.words, ratios);
        run.execute(&trace.statements, &trace.terms);
        run.placed
    }
}

impl Run<'_> {
    /// Executes statements with their terms.
    #[inline]
    pub fn execute(&mut self, statements: &[Statement], terms: &[Term]) {
        let mut terms = terms;
        for statement in statements {
            let (these, others) = terms.split_at(statement.terms);
            self.add(these);
            self.conclude(statement.then);
            terms = others;
        }
    }

    /// The words of the scratch memory.
    pub fn scratch(&self) -> &[i64] {
        &self.words[..1 << SLOT_BITS]
    }

    #[inline(always)]
    fn word(&self, number: u8) -> i64 {
        self.words[usize::from(number)]
    }

    #[inline(always)]
    fn set(&mut self, number: u8, word: i64) {
        self.words[usize::from(number)] = word;
    }

    #[inline(always)]
    fn add(&mut self, terms: &[Term]) {
        for term in terms {
            self.sum += self.word(term.left) * self.word(term.right) * i64::from(term.times);
        }
    }

    #[inline(always)]
    fn conclude(&mut self, then: Then) {
        match then {
            Then::Store { slot } => {
                let (result, _) = self.result();
                self.set(slot, result);
                self.sum = self.program.half();
            }
            Then::StoreWith { slot, option, surface } => self.store(slot, option, surface),
            Then::Row => self.row(),
            Then::Cell { slot } => {
                let fraction = self.program.bits() - 5;
                self.set(CELL, self.word(slot) >> fraction << fraction);
            }
            Then::Digits { pair, first, count } => self.divide(pair, first, count),
            Then::Quotient => self.set(QUOTIENT, self.of_digits()),
            Then::Input { slot, option, surface } => self.set(slot, self.input(option, surface)),
            Then::Output { surface } => self.output(surface.into()),
        }
    }

    /// The table's words from the sum, as an integer, on.
    #[inline(always)]
    fn row(&mut self) {
        let [first, second] = self.table;
        let words = first.len() + second.len();
        let base = (self.sum >> self.program.bits()) as usize & (words.next_power_of_two() - 1);
        self.base = base as i64;
        for (number, address) in (ROW..).zip(base..base + ROW_WORDS) {
            let word = first.get(address).or_else(|| second.get(address - first.len()));
            self.set(number, word.copied().unwrap_or(0));
        }
    }

    /// A digit for each power, +1 where the sum is not negative: it then comes nearer to zero.
    #[inline(always)]
    fn divide(&mut self, pair: u8, first: u8, count: u8) {
        let [positive, negative] = [pair, pair | 1].map(|number| self.word(number));
        for digit in 0..count {
            let power = self.word(first - digit);
            let is_negative = self.sum < 0;
            self.quotient = self.quotient << 1 | i64::from(!is_negative);
            self.sum += if is_negative { negative } else { positive } * power;
        }
        self.quotient &= (1 << self.program.digits) - 1;
    }

    /// The sum as a word, and whether it was saturated.
    #[inline(always)]
    fn result(&self) -> (i64, bool) {
        let floor = self.sum >> self.program.bits();
        let (low, high) =
            (self.program.word.min_code() as i64, self.program.word.max_code() as i64);
        (floor.clamp(low, high), !(low..=high).contains(&floor))
    }

    fn store(&mut self, slot: u8, option: u8, surface: u8) {
        let (result, _) = self.result();
        if option & CHECK != 0 {
            let tolerance = 1 << (self.program.bits() - u32::from(Position::TOLERANCE_BITS));
            let beyond = !(-tolerance..tolerance).contains(&result);
            self.placed.invalid = beyond | (surface == 1 && self.placed.invalid);
        }
        if option & OPEN != 0 {
            self.placed.lost = result < 0;
        }
        let unused = 64 - u32::from(self.program.word.width);
        let wrapped = self.sum >> self.program.bits() << unused >> unused;
        self.set(slot, if option & WRAP != 0 { wrapped } else { result });
        self.sum = self.program.half();
    }

    fn input(&self, option: u8, surface: u8) -> i64 {
        let ratio = self.ratios[if option & SHARE != 0 { 2 } else { usize::from(surface & 1) }];
        let rest = self.program.rest;
        match option & LOW {
            0 => ratio >> rest,
            _ => (ratio & ((1 << rest) - 1)) << (self.program.bits() - rest),
        }
    }

    fn output(&mut self, surface: usize) {
        let (result, held) = self.result();
        let is_place = surface != Surface::Resistance as usize;
        self.placed.outputs[surface] = if is_place { result } else { result.max(0) };
        self.placed.saturated |= is_place && held;
        self.sum = self.program.half();
    }

    /// The quotient of its digits, of which a set bit is +1 and another −1, as a place.
    fn of_digits(&self) -> i64 {
        let digits = self.program.digits;
        let unused = 64 - digits;
        let coded = (self.quotient ^ 1 << (digits - 1)) << unused >> unused;
        coded << (self.program.bits() - digits - 2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hapticore_contract::profile::Profile;
    use hapticore_reference::rounded::{Exact, Position as Reference};

    /// Numbers without a pattern.
    fn random(state: &mut u64) -> i64 {
        *state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        *state as i64 >> (*state >> 58)
    }

    fn code(state: &mut u64, format: Format) -> i64 {
        random(state).rem_euclid((format.max_code() - format.min_code() + 1) as i64)
            + format.min_code() as i64
    }

    /// Any words: of these tables few have a place for any ratios, and much saturates.
    #[test]
    fn places_are_those_of_the_reference_whatever_the_table() {
        for (seed, profile) in (1..).zip(Profile::all()) {
            let (mut state, position) = (seed, Position::new(&profile));
            let f = &profile.formats;
            for _ in 0..20 {
                let table: Vec<_> =
                    (0..position.table().words).map(|_| code(&mut state, f.table)).collect();
                let words: Vec<_> = table.iter().map(|&word| Exact::of(word, f.table)).collect();
                let (at_once, reference) =
                    (AtOnce::new(&position, table), Reference::new(&profile, &words));
                for _ in 0..50 {
                    let [r_x, r_y, share] =
                        [f.ratio, f.ratio, position.share()].map(|format| code(&mut state, format));
                    let placed = at_once.run([r_x, r_y, share]);
                    let expected = reference.place([r_x, r_y].map(|code| Exact::of(code, f.ratio)));
                    let lost = reference.any_open(Exact::of(share, position.share()));
                    let [x, y] = [expected.x, expected.y].map(|mm| mm.code(f.position));
                    assert_eq!(
                        placed.outputs,
                        [x, y, expected.sheet.code(profile.sheet())],
                        "{}",
                        profile.name
                    );
                    assert_eq!(
                        [placed.invalid, placed.saturated, placed.lost],
                        [expected.invalid, expected.saturated, lost]
                    );
                }
            }
        }
    }
}
