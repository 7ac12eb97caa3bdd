// SPDX-License-Identifier: MIT OR Apache-2.0
//! Programs give what the blocks give that they are made of: every operation in words of many formats,
//! quotients and square roots, words that are kept; the clocks they take; what is refused. Walls and
//! controllers are folded in the tests of drives.

use super::instruction::{BITS, Operation, Source};
use super::program::Programs;
use super::translate::Ports;
use super::{ArithmeticUnit, Inputs};
use crate::blocks::divider::{self, Divider};
use crate::blocks::sqrt::{self, SquareRoot};
use crate::support::random::Random;
use crate::support::{Bench, MILLION, operations};
use everything::Everything;
use hapticore_hdl::block::{Block, Interface};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::expression::Expression;

mod everything;

/// The number of a memory that is looked up; inputs have lower ones.
const LOOKED_UP: u8 = 63;
/// Of every input.
const GIVEN: Format = Format::signed(20, 0);
const PADS: u64 = 4;

struct Numbers(Vec<&'static str>);

impl Ports for Numbers {
    fn input(&self, input: usize) -> u8 {
        input as u8
    }

    fn memory(&self, _memory: &'static str) -> u8 {
        LOOKED_UP
    }

    fn output(&self, output: &'static str) -> u8 {
        self.0.iter().position(|name| *name == output).expect("an output") as u8
    }
}

/// A block, and a unit with its program.
struct Folded<B: Block> {
    block: Bench<B>,
    unit: Bench<ArithmeticUnit>,
    names: Vec<&'static str>,
}

impl<B: Block> Folded<B> {
    fn new(block: B, expression: Expression, behind: usize) -> Self {
        let names: Vec<_> = <B as Interface>::Outputs::FIELDS.iter().map(|of| of.name).collect();
        let programs =
            Programs::of(&[(expression, &Numbers(names.clone()))], behind).expect("it fits");
        let unit = ArithmeticUnit::new(programs, PADS, GIVEN, 16);
        assert_eq!(unit.registers_words(), behind == 2, "instructions on their way");
        Folded { block: Bench::new(block), unit: Bench::new(unit), names }
    }

    /// What the unit gives, by the outputs' numbers; words of the memory are those of the table.
    fn run(&mut self, row: i64, inputs: &[i64], table: &[i64]) -> Vec<Option<i64>> {
        let (mut given, mut looked_up) = (0, 0);
        let mut results = vec![None; self.names.len()];
        let latency = self.unit.block.latency(0);
        for clock in 0..=latency {
            let out =
                self.unit.clock(Inputs { start: i64::from(clock == 0), entry: 0, row, given });
            given = match out.number as u8 {
                LOOKED_UP => looked_up,
                number => inputs.get(usize::from(number)).copied().unwrap_or(0),
            };
            looked_up = table.get(out.sum.max(0) as usize).copied().unwrap_or(0);
            if out.gives == 1 {
                results[out.number as usize] = Some(out.sum);
            }
            assert_eq!(out.done == 1, clock == latency, "clock {clock} of {latency}");
        }
        results
    }

    /// Holds that block and unit give the same.
    fn check(&mut self, row: i64, inputs: <B::Inputs as Bundle>::Of<i64>, table: &[i64]) {
        let (expected, _) = self.block.operate(inputs);
        let got = self.run(row, &codes::<B::Inputs>(inputs), table);
        let mut number = 0;
        B::Outputs::each(expected, |field, code| {
            if let Some(got) = got[number] {
                assert_eq!(
                    got,
                    code,
                    "{}.{}: {:?}",
                    B::NAME,
                    field.name,
                    codes::<B::Inputs>(inputs)
                );
            }
            number += 1;
        });
    }
}

fn codes<S: Bundle>(bundle: S::Of<i64>) -> Vec<i64> {
    let mut codes = Vec::new();
    S::map(bundle, |code| codes.push(code));
    codes
}

fn of_formats<S: Bundle>(formats: S::Of<Format>, random: &mut Random) -> S::Of<i64> {
    S::map(formats, |format| random.word(format))
}

#[test]
fn every_operation_is_folded_in_any_format() {
    let mut random = Random::new(3);
    for n in 0..operations(MILLION / 20_000).max(12) as usize {
        let block = Everything::new(&mut random);
        let table = block.table();
        let any = everything::Inputs { start: Some(0), ..everything::Inputs::of(None) };
        let begins = everything::Inputs { start: Some(1), ..any };
        let expression = Expression::of(&block, begins, any, |outputs| outputs.done);
        assert_eq!(expression.results.len(), 20, "all but `done`");
        let mut folded = Folded::new(block, expression, 1 + n % 2);
        let formats = folded.block.block.inputs();
        for _ in 0..60 {
            let mut inputs = of_formats::<everything::Inputs>(formats, &mut random);
            inputs.start = 0;
            folded.check(inputs.pad, inputs, &table);
        }
    }
}

#[test]
fn quotients_and_roots_are_those_of_the_serial_blocks() {
    let mut random = Random::new(4);
    for number in 0..operations(MILLION / 20_000).max(20) as usize {
        // Up to quotients of three parts.
        let [n, d] = [(); 2].map(|()| Format::unsigned(2 + random.below(18) as u8, 3));
        let divides = Divider::new(n, d, Format::unsigned(1 + random.below(30) as u8, 9));
        let held = divider::Inputs { start: Some(0), ..divider::Inputs::of(None) };
        let begins = divider::Inputs { start: Some(1), ..held };
        let expression = Expression::of(&divides, begins, held, |outputs| outputs.done);
        let mut folded = Folded::new(divides, expression, 1 + number % 2);
        let corner = |random: &mut Random, format: Format| match random.below(6) {
            0 => 0,
            1 => format.max_code() as i64,
            2 => 1,
            _ => random.word(format) >> random.below(u64::from(format.width)),
        };
        for _ in 0..60 {
            let [numerator, denominator] = [n, d].map(|format| corner(&mut random, format));
            folded.check(0, divider::Inputs { start: 0, numerator, denominator }, &[]);
        }
        let of = Format::unsigned(1 + random.below(18) as u8, 8);
        let root = SquareRoot::new(of, 4 + random.below(5) as i8);
        let held = sqrt::Inputs { start: Some(0), radicand: None };
        let begins = sqrt::Inputs { start: Some(1), radicand: None };
        let expression = Expression::of(&root, begins, held, |outputs| outputs.done);
        let mut folded = Folded::new(root, expression, 1 + number % 2);
        for _ in 0..60 {
            let radicand = corner(&mut random, of);
            folded.check(0, sqrt::Inputs { start: 0, radicand }, &[]);
        }
    }
}

/// Words that are wider, or more lines, would give the same quotients.
#[test]
fn quotients_and_roots_cost_so_many_instructions_bits_and_clocks() {
    let unsigned = Format::unsigned;
    // By how many places the dividend is to be moved: more than there are digits, as many, fewer; in three parts.
    for (n, d, quotient, expected) in [
        (unsigned(12, 3), unsigned(4, 3), unsigned(8, 12), (65, [21, 13, 1, 1], 144)),
        (unsigned(12, 3), unsigned(4, 3), unsigned(12, 12), (61, [21, 17, 1, 1], 173)),
        (unsigned(12, 3), unsigned(4, 3), unsigned(16, 12), (62, [22, 21, 1, 1], 213)),
        (unsigned(19, 3), unsigned(4, 3), unsigned(8, 20), (65, [21, 20, 1, 1], 160)),
        (unsigned(19, 3), unsigned(19, 3), unsigned(30, 16), (120, [32, 31, 1, 1], 440)),
    ] {
        let divides = Divider::new(n, d, quotient);
        let held = divider::Inputs { start: Some(0), ..divider::Inputs::of(None) };
        let begins = divider::Inputs { start: Some(1), ..held };
        let expression = Expression::of(&divides, begins, held, |outputs| outputs.done);
        let costs = Folded::new(divides, expression, 1).unit.block.costs();
        assert_eq!((costs.0, costs.1, costs.2[0]), expected, "{n:?} / {d:?}: {quotient:?}");
    }
    let root = SquareRoot::new(unsigned(15, 8), 6);
    let held = sqrt::Inputs { start: Some(0), radicand: None };
    let begins = sqrt::Inputs { start: Some(1), radicand: None };
    let expression = Expression::of(&root, begins, held, |outputs| outputs.done);
    let costs = Folded::new(root, expression, 1).unit.block.costs();
    assert_eq!((costs.0, costs.1, costs.2[0]), (31, [21, 20, 10, 10], 182), "a root");
}

/// Sources that take a clock for each place are told by two of their bits, and all fields fit their word.
#[test]
fn fields_are_as_the_unit_reads_them() {
    assert_eq!((Source::Left as u64 >> 1, Source::Right as u64 >> 1), (1, 1));
    assert_eq!(BITS, 16);
    assert_eq!(Operation::Rest.fields().1 as u64, 0, "nothing is nothing in all fields");
}

impl ArithmeticUnit {
    /// What its programs cost: instructions, the bits of sum, words and factors, and the clocks of each program.
    pub(in super::super) fn costs(&self) -> (usize, [u8; 4], Vec<u64>) {
        let mut instructions = self.program.codes();
        instructions.extend(self.rest.iter().flat_map(|rest| rest.codes()));
        let last = instructions.iter().rposition(|code| *code != 0).expect("a program");
        let factors = self.multiplier.inputs();
        let widths = [self.sum, self.words.format, factors.left, factors.right];
        (last + 1, widths.map(|format| format.width), self.clocks.clone())
    }
}
