// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lines of a program, and what each leaves in the unit: the range of its sum tells how wide it is.

use super::instruction::Operation;
use hapticore_hdl::interpretations::expression::Place;
use hapticore_hdl::interpretations::range::Range;
use std::collections::HashMap;

/// A word of the unit's memory, before it has an address.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Slot {
    /// A constant.
    Constant(i64),
    /// A word of a row, which stays from run to run.
    Kept(Place),
    /// What a program writes before it reads it.
    Variable(u32),
}

/// What an operation works on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operand {
    /// A word.
    Slot(Slot),
    /// A number of places, or of a port.
    Number(u8),
    /// Nothing is done: here a loop begins.
    Mark,
}

/// A line of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Line {
    /// What it does.
    pub operation: Operation,
    /// With what.
    pub operand: Operand,
}

/// A program as it is written.
#[derive(Debug, Default)]
pub struct Writer {
    /// The lines so far.
    pub lines: Vec<Line>,
    /// The range of all sums so far.
    pub sums: Option<Range>,
    /// The range of all words that were stored.
    pub stored: Option<Range>,
    /// The largest operands of a product.
    pub factors: [i128; 2],
    /// The range of the sum after the last line.
    sum: Option<Range>,
    ranges: HashMap<Slot, Range>,
    variables: u32,
}

impl Writer {
    fn line(&mut self, operation: Operation, operand: Operand, sum: Range) {
        self.lines.push(Line { operation, operand });
        self.sums = Some(self.sums.map_or(sum, |before| before.join(sum)));
        self.sum = Some(sum);
    }

    fn with_slot(&mut self, operation: Operation, slot: Slot, sum: Range) {
        self.line(operation, Operand::Slot(slot), sum);
    }

    /// An operation on the sum alone, with its range then.
    pub fn alone(&mut self, operation: Operation, sum: Range) {
        self.line(operation, Operand::Number(0), sum);
    }

    /// An operation with a number.
    pub fn number(&mut self, operation: Operation, number: u8, sum: Range) {
        self.line(operation, Operand::Number(number), sum);
    }

    /// The range of the sum.
    ///
    /// # Panics
    /// Where there is none yet.
    pub fn sum(&self) -> Range {
        self.sum.expect("a sum is made before it is used")
    }

    /// A word that is stored in each turn of a loop, before it: what it holds in any.
    pub fn variable(&mut self, range: Range) -> Slot {
        let slot = self.keep();
        self.ranges.insert(slot, range);
        slot
    }

    /// What is known of the sum besides.
    pub fn know(&mut self, range: Range) {
        let Range { low, high } = self.sum();
        self.sum = Some(Range { low: low.max(range.low), high: high.min(range.high) });
    }

    /// The range of a word.
    pub fn range(&self, slot: Slot) -> Range {
        match slot {
            Slot::Constant(code) => Range::point(code.into()),
            _ => self.ranges[&slot],
        }
    }

    /// Says what a word holds that the program finds.
    pub fn found(&mut self, slot: Slot, range: Range) {
        self.ranges.insert(slot, range);
    }

    /// sum ← word
    pub fn load(&mut self, slot: Slot) {
        self.with_slot(Operation::Load, slot, self.range(slot));
    }

    /// sum ← word where the flag is set
    pub fn load_if(&mut self, slot: Slot) {
        let either = self.sum().join(self.range(slot));
        self.with_slot(Operation::LoadIf, slot, either);
    }

    /// sum ← sum + word
    pub fn add(&mut self, slot: Slot) {
        let (a, b) = (self.sum(), self.range(slot));
        self.with_slot(Operation::Add, slot, Range { low: a.low + b.low, high: a.high + b.high });
    }

    /// sum ← sum − word
    pub fn subtract(&mut self, slot: Slot) {
        let (a, b) = (self.sum(), self.range(slot));
        self.with_slot(
            Operation::Subtract,
            slot,
            Range { low: a.low - b.high, high: a.high - b.low },
        );
    }

    /// sum ← the lesser of sum and word
    pub fn at_most(&mut self, slot: Slot) {
        let (a, b) = (self.sum(), self.range(slot));
        self.difference(a, b);
        self.with_slot(
            Operation::AtMost,
            slot,
            Range { low: a.low.min(b.low), high: a.high.min(b.high) },
        );
    }

    /// sum ← the greater of sum and word
    pub fn at_least(&mut self, slot: Slot) {
        let (a, b) = (self.sum(), self.range(slot));
        self.difference(a, b);
        self.with_slot(
            Operation::AtLeast,
            slot,
            Range { low: a.low.max(b.low), high: a.high.max(b.high) },
        );
    }

    /// A difference whose sign is looked at.
    fn difference(&mut self, a: Range, b: Range) {
        let sum = Range { low: a.low - b.high, high: a.high - b.low };
        self.sums = Some(self.sums.map_or(sum, |before| before.join(sum)));
    }

    /// word ← sum
    pub fn store(&mut self, slot: Slot) {
        let sum = self.sum();
        self.ranges.insert(slot, sum);
        self.stored = Some(self.stored.map_or(sum, |before| before.join(sum)));
        self.with_slot(Operation::Store, slot, sum);
    }

    /// A new word ← sum
    pub fn keep(&mut self) -> Slot {
        self.variables += 1;
        let slot = Slot::Variable(self.variables - 1);
        self.store(slot);
        slot
    }

    /// sum ← sum · word
    ///
    /// # Panics
    /// Where either may be negative.
    pub fn multiply(&mut self, slot: Slot) {
        let (a, b) = (self.sum(), self.range(slot));
        assert!(a.low >= 0 && b.low >= 0, "factors have no sign");
        self.factors = [self.factors[0].max(a.high), self.factors[1].max(b.high)];
        let product = Range { low: a.low * b.low, high: a.high * b.high };
        self.with_slot(Operation::Multiply, slot, product);
    }

    /// sum ← sum · 2^by, rounded down where `by` is negative.
    pub fn shift(&mut self, by: i32) {
        let Range { low, high } = self.sum();
        let number = u8::try_from(by.unsigned_abs()).expect("few places");
        match by {
            0 => {}
            1.. => self.number(Operation::Left, number, Range { low: low << by, high: high << by }),
            _ => {
                self.number(Operation::Right, number, Range { low: low >> -by, high: high >> -by })
            }
        }
    }

    /// What the last shift rounded down is rounded to the nearest, ties to even.
    pub fn round(&mut self) {
        let sum = self.sum();
        self.alone(Operation::Round, sum);
        let up = Range { low: sum.low, high: sum.high + 1 };
        self.with_slot(Operation::AddIf, Slot::Constant(1), up);
    }

    /// sum ← 1 where it is negative, else 0
    pub fn negative(&mut self) {
        self.alone(Operation::Negative, Range { low: 0, high: 1 });
    }

    /// sum ← 1 where it is zero, else 0
    pub fn zero(&mut self) {
        self.alone(Operation::Zero, Range { low: 0, high: 1 });
    }

    /// flag ← whether sum is negative
    pub fn test_negative(&mut self) {
        self.alone(Operation::TestNegative, self.sum());
    }

    /// flag ← lowest bit of word
    pub fn test(&mut self, slot: Slot) {
        // It may be the first line.
        let sum = self.sum.unwrap_or(Range::point(0));
        self.with_slot(Operation::Test, slot, sum);
    }

    /// A loop of so many turns. Before and after each the sum is within `turn`.
    pub fn turns(&mut self, count: u8, turn: Range, body: impl FnOnce(&mut Self)) {
        self.number(Operation::Repeat, count - 1, turn);
        self.line(Operation::Rest, Operand::Mark, turn);
        body(self);
        self.know(turn);
        let sum = self.sum();
        self.number(Operation::Again, 0, sum);
    }

    /// So many digits of a quotient, below what remains of the sum.
    pub fn digits(&mut self, count: u8, divisor: Slot) {
        // The remainder stays below the divisor, so that twice of it stays below twice.
        let divisors = self.range(divisor);
        let rest = Range { low: 0, high: divisors.high - 1 };
        self.know(rest);
        self.turns(count, rest, |writer| {
            writer.number(Operation::Left, 1, Range { low: 0, high: 2 * divisors.high - 1 });
            writer.difference(writer.sum(), divisors);
            writer.with_slot(Operation::Divide, divisor, rest);
        });
    }

    /// The low bits of the sum: without its sign.
    pub fn low_bits(&mut self, count: u32) {
        let sum = self.sum();
        let most = (1 << count) - 1;
        if sum.low >= 0 && sum.high <= most {
            return;
        }
        let whole = self.keep();
        self.shift(-(count as i32));
        self.shift(count as i32);
        let above = self.keep();
        self.load(whole);
        self.subtract(above);
        self.know(Range { low: 0, high: most });
    }
}

#[cfg(test)]
mod tests;
