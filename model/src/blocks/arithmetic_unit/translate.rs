// SPDX-License-Identifier: MIT OR Apache-2.0
//! From an expression to the lines of a program.
//!
//! Nodes are translated as they are needed, operands that are not words first. A node with several
//! users is stored once. A node whose code is that of its operand (another point, a narrowing that
//! cannot overflow) takes no line: such are told by the ranges of all nodes.

use super::instruction::Operation;
use super::writer::{Slot, Writer};
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::expression::{Expression, Op, Place, Term};
use hapticore_hdl::interpretations::range::{Range, whole};
use hapticore_hdl::signal::{HalfEven, Overflow, Rounding, Signal};
use std::collections::HashMap;

mod codes;

/// What the unit's surroundings know a block's inputs, memories and outputs by.
pub trait Ports {
    /// The number of an input, by its number among the block's.
    fn input(&self, input: usize) -> u8;
    /// The number of a memory that is looked up.
    fn memory(&self, memory: &'static str) -> u8;
    /// The number of an output.
    fn output(&self, output: &'static str) -> u8;
}

/// The translation of an expression.
pub struct Translation<'a> {
    pub(super) expression: &'a Expression,
    pub(super) writer: &'a mut Writer,
    ports: &'a dyn Ports,
    /// Clocks from an address to its word, of memories that ports give.
    of_memory: usize,
    ranges: Vec<Range>,
    /// Words that hold signed codes, though their memory does not.
    signed: HashMap<Place, Format>,
    /// Nodes that results depend on.
    live: Vec<bool>,
    users: Vec<u32>,
    slots: HashMap<Term, Slot>,
}

/// Translates an expression: results are given, then words that are kept are stored, for until then they are
/// read as they were. So many instructions are on their way behind the one that is carried out.
pub fn translate(expression: &Expression, ports: &dyn Ports, behind: usize, writer: &mut Writer) {
    let mut of = Translation {
        expression,
        writer,
        ports,
        of_memory: behind + 1,
        ranges: Vec::new(),
        signed: HashMap::new(),
        live: codes::live(expression),
        users: vec![0; expression.nodes.len()],
        slots: HashMap::new(),
    };
    of.look_at_words();
    of.find_ranges();
    let written: Vec<_> =
        expression.written.iter().map(|(place, term)| (*place, of.kept(*place, *term))).collect();
    let results = expression.results.iter().map(|(_, term)| of.base(*term));
    let roots: Vec<_> = written.iter().map(|(_, term)| *term).chain(results).collect();
    of.count_users(roots);
    let mut kept = Vec::new();
    for (place, term) in written {
        if !of.is_word(term, place) {
            kept.push((place, of.operand(term)));
        }
    }
    for (name, term) in &expression.results {
        of.sum(*term);
        let (number, sum) = (ports.output(name), of.writer.sum());
        of.writer.number(Operation::Give, number, sum);
    }
    for (place, slot) in kept {
        of.writer.load(slot);
        of.writer.store(Slot::Kept(place));
    }
    let sum = of.writer.sum();
    of.writer.alone(Operation::End, sum);
}

impl Translation<'_> {
    pub(super) fn op(&self, term: Term) -> Op {
        self.expression.node(term).op
    }

    pub(super) fn format(&self, term: Term) -> Format {
        self.expression.node(term).format
    }

    fn range(&self, term: Term) -> Range {
        self.ranges[term.0 as usize]
    }

    fn signal(&self, term: Term) -> Signal<Range> {
        Signal { value: self.range(term), format: self.format(term) }
    }

    fn is_word(&self, term: Term, place: Place) -> bool {
        self.op(term) == Op::Word(place)
    }

    fn operands(&self, op: Op) -> Vec<Term> {
        op.operands().into_iter().map(|term| self.base(term)).collect()
    }

    fn count_users(&mut self, mut roots: Vec<Term>) {
        while let Some(term) = roots.pop() {
            let users = &mut self.users[term.0 as usize];
            *users += 1;
            if *users == 1 {
                roots.extend(self.operands(self.op(term)));
            }
        }
    }

    /// The word that holds a node's code, where there is one.
    fn ready(&self, base: Term) -> Option<Slot> {
        match self.op(base) {
            Op::Constant(code) => Some(Slot::Constant(code)),
            Op::Word(place) => Some(Slot::Kept(place)),
            _ => self.slots.get(&base).copied(),
        }
    }

    /// A word that holds a node's code.
    pub(super) fn operand(&mut self, term: Term) -> Slot {
        let base = self.base(term);
        if let Some(slot) = self.ready_word(base) {
            return slot;
        }
        self.sum(base);
        self.slots.get(&base).copied().unwrap_or_else(|| self.writer.keep())
    }

    fn ready_word(&mut self, base: Term) -> Option<Slot> {
        let slot = self.ready(base)?;
        if let Slot::Kept(_) = slot {
            self.writer.found(slot, self.range(base));
        }
        Some(slot)
    }

    /// sum ← a node's code
    pub(super) fn sum(&mut self, term: Term) {
        let base = self.base(term);
        if let Some(slot) = self.ready_word(base) {
            return self.writer.load(slot);
        }
        self.write(base);
        self.writer.know(self.range(base));
        if self.users[base.0 as usize] > 1 {
            let slot = self.writer.keep();
            self.slots.insert(base, slot);
        }
    }

    /// sum ← a node's code, with so many places more.
    fn shifted(&mut self, term: Term, by: i32) {
        self.sum(term);
        self.writer.shift(by);
    }

    /// A word of a node's code with so many places more.
    fn shifted_operand(&mut self, term: Term, by: i32) -> Slot {
        match self.op(self.base(term)) {
            Op::Constant(code) => Slot::Constant(code << by),
            _ if by == 0 => self.operand(term),
            _ => {
                self.shifted(term, by);
                self.writer.keep()
            }
        }
    }

    /// Whether a node's code can be had without the sum.
    fn is_ready(&self, term: Term, by: i32) -> bool {
        let base = self.base(term);
        matches!(self.op(base), Op::Constant(_)) || (by == 0 && self.ready(base).is_some())
    }

    /// How many places the codes of two nodes lack to have their points where `frac` has it.
    fn places(&self, terms: [Term; 2], frac: i8) -> [i32; 2] {
        terms.map(|term| i32::from(frac) - i32::from(self.format(term).frac))
    }

    /// sum ← the first, aligned; the word of the second.
    fn pair(&mut self, [a, b]: [Term; 2], frac: i8) -> Slot {
        let [of_a, of_b] = self.places([a, b], frac);
        let slot = self.shifted_operand(b, of_b);
        self.shifted(a, of_a);
        slot
    }

    /// sum ← the difference of two nodes, their points aligned.
    fn difference(&mut self, a: Term, b: Term) {
        let frac = self.format(a).frac.max(self.format(b).frac);
        let slot = self.pair([a, b], frac);
        self.writer.subtract(slot);
    }

    /// The lines of a node.
    fn write(&mut self, base: Term) {
        let to = self.format(base);
        match self.op(base) {
            Op::Constant(_) | Op::Word(_) | Op::Scale(_) => unreachable!("a word, or a word's"),
            Op::Input(input) => self.ask(self.ports.input(input), 1, whole(to)),
            Op::Lookup(memory, address) => {
                self.sum(address);
                self.ask(self.ports.memory(memory), self.of_memory, whole(to));
            }
            Op::Add(a, b) => {
                let [of_a, of_b] = self.places([a, b], to.frac);
                let turned = self.is_ready(a, of_a) && !self.is_ready(b, of_b);
                let slot = self.pair(if turned { [b, a] } else { [a, b] }, to.frac);
                self.writer.add(slot);
            }
            Op::Sub(a, b) => {
                let slot = self.pair([a, b], to.frac);
                self.writer.subtract(slot);
            }
            Op::Mul(a, b) => self.product(a, b),
            Op::Abs(a) => {
                let slot = self.operand(a);
                self.magnitude(slot);
            }
            Op::Fit(a, rounding, overflow) => self.fit(a, to, rounding, overflow),
            Op::Bits(a, low) => self.bits(a, low, to.width),
            Op::Concat(high, low) => {
                let slot = self.operand(low);
                self.shifted(high, self.format(low).width.into());
                self.writer.add(slot);
            }
            Op::Less(a, b) => {
                self.difference(a, b);
                self.writer.negative();
            }
            Op::Equal(a, b) => {
                self.difference(a, b);
                self.writer.zero();
            }
            Op::And(a, b) => {
                let slot = self.pair([a, b], 0);
                self.writer.at_most(slot);
            }
            Op::Or(a, b) => {
                let slot = self.pair([a, b], 0);
                self.writer.at_least(slot);
            }
            Op::Not(a) => {
                self.sum(a);
                self.writer.subtract(Slot::Constant(1));
                self.writer.negative();
            }
            Op::Select(bit, a, b) => self.select(bit, a, b),
            Op::Quotient(a, b) => self.quotient(a, b, to),
            Op::Root(a) => self.root(a, to),
        }
    }

    /// sum ← what a port gives, so many clocks after it is asked for.
    fn ask(&mut self, number: u8, clocks: usize, range: Range) {
        // The sum stays as it is until then: its range is among those of all sums already.
        let sum = Range::point(0);
        (0..clocks).for_each(|_| self.writer.number(Operation::Ask, number, sum));
        self.writer.alone(Operation::Take, range);
    }

    /// sum ← |word|
    fn magnitude(&mut self, slot: Slot) {
        self.writer.load(Slot::Constant(0));
        self.writer.subtract(slot);
        self.writer.at_least(slot);
        let Range { low, high } = self.writer.range(slot);
        self.writer.know(Range { low: 0, high: high.max(-low) });
    }

    /// Of signed factors the magnitudes are multiplied.
    fn product(&mut self, a: Term, b: Term) {
        let [of_a, of_b] = [a, b].map(|term| self.range(term).low < 0);
        assert!(!of_b, "the second factor of a product has no sign");
        let [left, right] = [a, b].map(|term| self.operand(term));
        if !of_a {
            self.writer.load(left);
            return self.writer.multiply(right);
        }
        self.magnitude(left);
        self.writer.multiply(right);
        let positive = self.writer.keep();
        self.writer.load(Slot::Constant(0));
        self.writer.subtract(positive);
        let negative = self.writer.keep();
        self.writer.load(left);
        self.writer.test_negative();
        self.writer.load(positive);
        self.writer.load_if(negative);
    }

    fn fit(&mut self, a: Term, to: Format, rounding: Rounding, overflow: Overflow) {
        let by = i32::from(to.frac) - i32::from(self.format(a).frac);
        self.shifted(a, by);
        if by < 0 && rounding == HalfEven {
            self.writer.round();
        }
        let before = self.before_overflow(a, to, rounding);
        self.writer.know(before);
        let (least, most) = (to.min_code(), to.max_code());
        match overflow {
            Overflow::Saturate => {
                if before.high > most {
                    self.writer.at_most(Slot::Constant(most as i64));
                }
                if before.low < least {
                    self.writer.at_least(Slot::Constant(least as i64));
                }
            }
            Overflow::Wrap if !whole(to).holds(before) => self.wrap(to),
            _ => {}
        }
    }

    fn wrap(&mut self, to: Format) {
        if to.signed {
            let half = Slot::Constant(to.max_code() as i64 + 1);
            self.writer.add(half);
            self.writer.low_bits(to.width.into());
            self.writer.subtract(half);
        } else {
            self.writer.low_bits(to.width.into());
        }
    }

    fn bits(&mut self, a: Term, low: u8, width: u8) {
        let format = self.format(a);
        self.sum(a);
        if format.signed && low + 1 == format.width {
            return self.writer.negative();
        }
        self.writer.shift(-i32::from(low));
        self.writer.low_bits(width.into());
    }

    /// Sets the flag by a bit; whether it is set where the bit is.
    fn flag(&mut self, bit: Term) -> bool {
        let base = self.base(bit);
        if let Some(slot) = self.ready_word(base) {
            self.writer.test(slot);
            return true;
        }
        match self.op(base) {
            Op::Not(a) if self.users[base.0 as usize] == 1 => !self.flag(a),
            Op::Less(a, b) if self.users[base.0 as usize] == 1 => {
                self.difference(a, b);
                self.writer.test_negative();
                true
            }
            _ => {
                self.sum(base);
                let sum = self.writer.sum();
                self.writer.alone(Operation::TestSum, sum);
                true
            }
        }
    }

    fn select(&mut self, bit: Term, a: Term, b: Term) {
        if let Some((lesser, x, y)) = self.lesser_or_greater(bit, a, b) {
            let slot = self.pair([x, y], self.format(x).frac);
            return if lesser { self.writer.at_most(slot) } else { self.writer.at_least(slot) };
        }
        let of_a = self.operand(a);
        if let Some(slot) = self.ready_word(self.base(bit)) {
            self.sum(b);
            self.writer.test(slot);
            return self.writer.load_if(of_a);
        }
        let of_b = self.operand(b);
        let (set, clear) = if self.flag(bit) { (of_a, of_b) } else { (of_b, of_a) };
        self.writer.load(clear);
        self.writer.load_if(set);
    }

    /// Whether a selection is the lesser of two, or the greater; and of which.
    fn lesser_or_greater(&self, bit: Term, a: Term, b: Term) -> Option<(bool, Term, Term)> {
        let Op::Less(x, y) = self.op(self.base(bit)) else { return None };
        let same = |p: Term, q: Term| {
            self.base(p) == self.base(q) && self.format(p).frac == self.format(q).frac
        };
        if same(a, x) && same(b, y) {
            Some((true, a, b))
        } else if same(a, y) && same(b, x) {
            Some((false, a, b))
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests;
