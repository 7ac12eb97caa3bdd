// SPDX-License-Identifier: MIT OR Apache-2.0
//! The program's results without its clocks, for fidelity `fixed`: most of a slot's clocks are the
//! program's, and two in three of those wait for products.
//!
//! Instructions are as `instruction.rs` says, on raw codes. `fixed` and `clock` are held to be
//! equal to the bit.

use super::instruction::{
    CHECK, COUNT, Index, Instruction, LOW, OPEN, Operation, SCALARS, SHARE, SLOT_BITS, SURFACE,
    WRAP,
};
use super::{Position, Program};
use hapticore_contract::calibration::{Layout, Surface};
use hapticore_hdl::format::Format;

/// The scratch memory, as many words as an instruction can name: a run has a copy of its own,
/// without an allocation.
type Scratch = [i64; 1 << SLOT_BITS];

/// A program, its constants and a calibration's words.
#[derive(Debug, Clone)]
pub struct AtOnce {
    program: Program,
    scratch: Scratch,
    table: Vec<i64>,
    word: Format,
    /// Bits of half a ratio that a word does not have.
    rest: u32,
    steps: u64,
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
    scratch: Scratch,
    sum: i64,
    left: i64,
    quotient: i64,
    base: usize,
    count: u8,
    surface: usize,
    step: u64,
    placed: Placed,
}

impl AtOnce {
    /// The program of a position block over a table of these codes.
    pub(super) fn new(position: &Position, table: Vec<i64>) -> Self {
        let (word, ratio) = (position.word, position.ratio);
        let constants = position.scratch.codes();
        let mut scratch = [0; 1 << SLOT_BITS];
        scratch[..constants.len()].copy_from_slice(&constants);
        AtOnce {
            program: Program::new(word),
            scratch,
            table,
            word,
            rest: (ratio.frac + 1 - word.frac) as u32,
            steps: position.steps,
        }
    }

    /// What the program makes of r_x, r_y and the share.
    pub(super) fn run(&self, ratios: [i64; 3]) -> Placed {
        let mut run = Run {
            of: self,
            ratios,
            scratch: self.scratch,
            sum: self.half(),
            left: 0,
            quotient: 0,
            base: 0,
            count: 0,
            surface: 0,
            step: 0,
            placed: Placed::default(),
        };
        let (mut at, instructions) = (0, &self.program.instructions[..]);
        while let Some(instruction) = instructions.get(at) {
            if instruction.operation == Operation::End {
                break;
            }
            at = if run.jumps(instruction) { instruction.target.into() } else { at + 1 };
            run.execute(instruction);
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
    fn found(&self) -> bool {
        self.step == self.of.steps
    }

    fn jumps(&self, instruction: &Instruction) -> bool {
        match instruction.operation {
            Operation::Repeat => self.count != 0,
            Operation::Surfaces => self.surface == 0,
            Operation::Pass => self.step != self.of.steps - 1,
            Operation::Found => self.found(),
            _ => false,
        }
    }

    /// The word that an instruction means.
    fn slot(&self, &Instruction { operation, slot, .. }: &Instruction) -> usize {
        let index = match slot.1 {
            Index::None if operation == Operation::LoadDigit => usize::from(self.sum < 0),
            Index::None => 0,
            Index::Surface => self.surface,
            Index::Counter => self.count.into(),
            Index::SurfacePair => (self.surface & 1) << 1,
        };
        usize::from(slot.0) | index
    }

    fn execute(&mut self, instruction: &Instruction) {
        let (slot, option) = (self.slot(instruction), instruction.option);
        let bits = self.of.bits();
        match instruction.operation {
            Operation::Load => self.left = self.scratch[slot],
            Operation::LoadCell => self.left = self.scratch[slot] >> (bits - 5) << (bits - 5),
            Operation::LoadQuotient => self.left = self.of_digits(),
            Operation::Multiply => self.sum += self.left * self.scratch[slot],
            Operation::MultiplyTable => {
                let word = self.of.table.get(self.base + usize::from(option)).copied().unwrap_or(0);
                self.sum += word * self.scratch[slot];
            }
            Operation::LoadDigit => {
                self.quotient = (self.quotient << 1 | i64::from(self.sum >= 0))
                    & ((1 << self.of.program.digits()) - 1);
                self.left = self.scratch[slot];
            }
            Operation::Store => self.store(slot, option),
            Operation::Base => {
                self.base =
                    (self.sum >> bits) as usize & (self.of.table.len().next_power_of_two() - 1)
            }
            Operation::Input => self.scratch[slot] = self.input(option),
            Operation::Output => self.output(),
            Operation::Set => self.set(instruction),
            Operation::Repeat => self.count = self.count.saturating_sub(1),
            Operation::Surfaces => {
                self.surface = match (self.surface, self.found()) {
                    (0, _) => Surface::RatioY as usize,
                    (_, true) => Surface::Resistance as usize,
                    (_, false) => Surface::RatioX as usize,
                }
            }
            Operation::Pass => self.step += 1,
            Operation::Found | Operation::End => (),
        }
    }

    /// The sum as a word, and whether it was saturated.
    fn result(&self) -> (i64, bool) {
        let floor = self.sum >> self.of.bits();
        let (low, high) = (self.of.word.min_code() as i64, self.of.word.max_code() as i64);
        (floor.clamp(low, high), !(low..=high).contains(&floor))
    }

    fn store(&mut self, slot: usize, option: u8) {
        let (result, _) = self.result();
        if option & CHECK != 0 {
            let tolerance = 1 << (self.of.bits() - u32::from(Position::TOLERANCE_BITS));
            let beyond = !(-tolerance..tolerance).contains(&result);
            self.placed.invalid = beyond | (self.surface == 1 && self.placed.invalid);
        }
        if option & OPEN != 0 {
            self.placed.lost = result < 0;
        }
        let unused = 64 - u32::from(self.of.word.width);
        let wrapped = self.sum >> self.of.bits() << unused >> unused;
        self.scratch[slot] = if option & WRAP != 0 { wrapped } else { result };
        self.sum = self.of.half();
    }

    fn input(&self, option: u8) -> i64 {
        let ratio = self.ratios[if option & SHARE != 0 { 2 } else { self.surface & 1 }];
        let rest = self.of.rest;
        match option & LOW {
            0 => ratio >> rest,
            _ => (ratio & ((1 << rest) - 1)) << (self.of.bits() - rest),
        }
    }

    fn output(&mut self) {
        let (result, held) = self.result();
        let is_place = self.surface != Surface::Resistance as usize;
        self.placed.outputs[self.surface] = if is_place { result } else { result.max(0) };
        self.placed.saturated |= is_place && held;
        self.sum = self.of.half();
    }

    fn set(&mut self, instruction: &Instruction) {
        let option = instruction.option;
        if option & SCALARS != 0 {
            self.base = (self.surface & 1) * Layout::SCALARS;
        }
        if option & COUNT != 0 {
            self.count = instruction.slot.0;
        }
        if option & SURFACE != 0 {
            self.surface = 0;
        }
    }

    /// The quotient of its digits, of which a set bit is +1 and another −1, as a place.
    fn of_digits(&self) -> i64 {
        let digits = u32::from(self.of.program.digits());
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
