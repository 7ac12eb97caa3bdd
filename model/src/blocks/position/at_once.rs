// SPDX-License-Identifier: MIT OR Apache-2.0
//! The program's results without its clocks, for fidelity `fixed`: most of a slot's clocks are the
//! program's, and two in three of those wait for products.
//!
//! Its jumps are followed once for all slots (`trace.rs`). Instructions are as `instruction.rs` says, on
//! raw codes. `fixed` and `clock` are held to be equal to the bit.

use super::Position;
use super::instruction::{CHECK, LOW, OPEN, SHARE, SLOT_BITS, WRAP};
use super::program::Program;
use super::trace::{CELL, QUOTIENT, ROW, ROW_WORDS, TABLE_SCALARS, Term, Then, Trace};
use hapticore_contract::calibration::{Layout, Surface};
use hapticore_hdl::format::Format;

/// All words that a term can name: a run has a copy of its own, without an allocation.
type Words = [i64; 256];

/// A program, its constants and a calibration's words.
#[derive(Debug, Clone)]
pub struct AtOnce {
    trace: Trace,
    words: Words,
    table: Vec<i64>,
    word: Format,
    /// Digits of a quotient.
    digits: u32,
    /// Bits of half a ratio that a word does not have.
    rest: u32,
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
struct Run<'a> {
    of: &'a AtOnce,
    ratios: [i64; 3],
    words: Words,
    sum: i64,
    quotient: i64,
    placed: Placed,
}

impl AtOnce {
    /// The program of a position block over a table of these codes.
    pub(super) fn new(position: &Position, table: Vec<i64>) -> Self {
        let (word, ratio) = (position.word, position.ratio);
        let (constants, program) = (position.scratch.codes(), Program::new(word));
        assert!(constants.len() <= 1 << SLOT_BITS, "slots are numbered with {SLOT_BITS} bits");
        let mut words = [0; 256];
        words[..constants.len()].copy_from_slice(&constants);
        let scalars = &table[..2 * Layout::SCALARS];
        words[TABLE_SCALARS.into()..][..scalars.len()].copy_from_slice(scalars);
        AtOnce {
            trace: Trace::of(&program, position.steps),
            words,
            table,
            word,
            digits: program.digits().into(),
            rest: (ratio.frac + 1 - word.frac) as u32,
        }
    }

    /// What the program makes of r_x, r_y and the share.
    pub(super) fn run(&self, ratios: [i64; 3]) -> Placed {
        let mut run = Run {
            of: self,
            ratios,
            words: self.words,
            sum: self.half(),
            quotient: 0,
            placed: Placed::default(),
        };
        let mut terms = &self.trace.terms[..];
        for statement in &self.trace.statements {
            let (these, others) = terms.split_at(statement.terms);
            run.add(these);
            run.conclude(statement.then);
            terms = others;
        }
        run.placed
    }

    fn bits(&self) -> u32 {
        self.word.frac as u32
    }

    fn half(&self) -> i64 {
        1 << (self.bits() - 1)
    }
}

impl Run<'_> {
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
                self.sum = self.of.half();
            }
            Then::StoreWith { slot, option, surface } => self.store(slot, option, surface),
            Then::Row => self.row(),
            Then::Cell { slot } => {
                let fraction = self.of.bits() - 5;
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
        let table = &self.of.table;
        let base = (self.sum >> self.of.bits()) as usize & (table.len().next_power_of_two() - 1);
        for (number, word) in (ROW..).zip(0..ROW_WORDS) {
            self.set(number, table.get(base + word).copied().unwrap_or(0));
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
        self.quotient &= (1 << self.of.digits) - 1;
    }

    /// The sum as a word, and whether it was saturated.
    #[inline(always)]
    fn result(&self) -> (i64, bool) {
        let floor = self.sum >> self.of.bits();
        let (low, high) = (self.of.word.min_code() as i64, self.of.word.max_code() as i64);
        (floor.clamp(low, high), !(low..=high).contains(&floor))
    }

    fn store(&mut self, slot: u8, option: u8, surface: u8) {
        let (result, _) = self.result();
        if option & CHECK != 0 {
            let tolerance = 1 << (self.of.bits() - u32::from(Position::TOLERANCE_BITS));
            let beyond = !(-tolerance..tolerance).contains(&result);
            self.placed.invalid = beyond | (surface == 1 && self.placed.invalid);
        }
        if option & OPEN != 0 {
            self.placed.lost = result < 0;
        }
        let unused = 64 - u32::from(self.of.word.width);
        let wrapped = self.sum >> self.of.bits() << unused >> unused;
        self.set(slot, if option & WRAP != 0 { wrapped } else { result });
        self.sum = self.of.half();
    }

    fn input(&self, option: u8, surface: u8) -> i64 {
        let ratio = self.ratios[if option & SHARE != 0 { 2 } else { usize::from(surface & 1) }];
        let rest = self.of.rest;
        match option & LOW {
            0 => ratio >> rest,
            _ => (ratio & ((1 << rest) - 1)) << (self.of.bits() - rest),
        }
    }

    fn output(&mut self, surface: usize) {
        let (result, held) = self.result();
        let is_place = surface != Surface::Resistance as usize;
        self.placed.outputs[surface] = if is_place { result } else { result.max(0) };
        self.placed.saturated |= is_place && held;
        self.sum = self.of.half();
    }

    /// The quotient of its digits, of which a set bit is +1 and another −1, as a place.
    fn of_digits(&self) -> i64 {
        let digits = self.of.digits;
        let unused = 64 - digits;
        let coded = (self.quotient ^ 1 << (digits - 1)) << unused >> unused;
        coded << (self.of.bits() - digits - 2)
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
