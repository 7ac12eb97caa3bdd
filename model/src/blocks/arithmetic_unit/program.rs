// SPDX-License-Identifier: MIT OR Apache-2.0
//! Programs of the arithmetic unit: lines without what is superfluous, words with addresses.

use super::instruction::{Instruction, OPERAND_BITS, Operation, ROW_SLOT_BITS, SLOT_BITS};
use super::translate::{Ports, translate};
use super::writer::{Line, Operand, Slot, Writer};
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::expression::{Expression, Place};
use hapticore_hdl::interpretations::range::Range;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// The bit of an operand that says that its word is of a row.
const OF_ROW: u8 = 1 << (OPERAND_BITS - 1);

/// Programs with one memory for all.
#[derive(Debug, Clone)]
pub struct Programs {
    /// The instructions of all, one program after the other.
    pub instructions: Vec<Instruction>,
    /// Where each begins.
    pub entries: Vec<usize>,
    /// Clocks from each one's start to its end, without those that wait for products.
    pub clocks: Vec<u64>,
    /// How many products each has.
    pub products: Vec<u64>,
    /// Instructions on their way behind the one that is carried out.
    pub behind: usize,
    /// The words of no row at reset: constants; variables come behind them.
    pub words: Vec<i64>,
    /// Of the sum.
    pub sum: Format,
    /// Of a word.
    pub word: Format,
    /// Of the factors of a product.
    pub factors: [Format; 2],
}

/// Why expressions are not made a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TooLarge {
    /// What there is too much of.
    pub what: &'static str,
    /// How much there may be.
    pub most: usize,
    /// How much there is.
    pub got: usize,
}

impl Programs {
    /// The programs of expressions, for a unit in which so many instructions are on their way behind the one
    /// that is carried out.
    ///
    /// # Errors
    /// Words or slots beyond those that instructions can name.
    pub fn of(expressions: &[(Expression, &dyn Ports)], behind: usize) -> Result<Self, TooLarge> {
        let mut writer = Writer::default();
        let mut programs = Vec::new();
        for (expression, ports) in expressions {
            writer.lines.clear();
            translate(expression, *ports, behind, &mut writer);
            programs.push(without_superfluous(std::mem::take(&mut writer.lines), behind));
        }
        let slots = Slots::of(&programs)?;
        let mut instructions = Vec::new();
        let mut entries = Vec::new();
        for lines in &programs {
            entries.push(instructions.len());
            slots.assemble(lines, behind, &mut instructions);
        }
        let clocks = programs.iter().map(|lines| clocks(lines, behind as u64)).collect();
        let products = programs.iter().map(|lines| products(lines)).collect();
        let factor = |most: i128| Format::counter(most.max(1) as u64);
        Ok(Programs {
            instructions,
            entries,
            clocks,
            products,
            behind,
            words: slots.words,
            sum: signed(writer.sums),
            word: signed(writer.stored.map(|range| {
                slots
                    .constants
                    .keys()
                    .fold(range, |all, code| all.join(Range::point((*code).into())))
            })),
            factors: writer.factors.map(factor),
        })
    }
}

impl Programs {
    /// The numbers that instructions of an operation have, in the order of `key`; they are numbered by their
    /// places in it from now on.
    pub fn renumber<K: Ord>(&mut self, operation: Operation, key: impl Fn(u8) -> K) -> Vec<u8> {
        let of = |instruction: &&Instruction| instruction.operation == operation;
        let numbers: BTreeSet<_> = self.instructions.iter().filter(of).map(|i| i.operand).collect();
        let mut numbers: Vec<_> = numbers.into_iter().collect();
        numbers.sort_by_key(|number| key(*number));
        for instruction in self.instructions.iter_mut().filter(|i| i.operation == operation) {
            let place = numbers.iter().position(|number| *number == instruction.operand);
            instruction.operand = place.expect("each number has a place") as u8;
        }
        numbers
    }
}

/// The signed integers that hold a range.
fn signed(range: Option<Range>) -> Format {
    let Range { low, high } = range.unwrap_or(Range::point(0));
    let bits = |code: i128| 128 - (if code < 0 { !code } else { code }).leading_zeros();
    Format::signed(bits(low).max(bits(high)) as u8 + 1, 0)
}

fn products(lines: &[Line]) -> u64 {
    let products = turns(lines).filter(|(line, _)| line.operation == Operation::Multiply);
    products.map(|(_, turns)| turns).sum()
}

/// Clocks from the start of a program to its end, without those that wait for products.
fn clocks(lines: &[Line], behind: u64) -> u64 {
    let lines_own = turns(lines).map(|(line, turns)| turns * clocks_of(line)).sum::<u64>();
    1 + behind + lines_own + (behind + 1) * jumps(lines)
}

fn clocks_of(line: &Line) -> u64 {
    match (line.operation, line.operand) {
        (_, Operand::Mark) => 0,
        (Operation::Left | Operation::Right, Operand::Number(places)) => places.into(),
        _ => 1,
    }
}

/// How often a loop goes back: instructions on their way are not carried out then.
fn jumps(lines: &[Line]) -> u64 {
    let repeats = lines.iter().filter(|line| line.operation == Operation::Repeat);
    repeats.map(number).sum()
}

fn number(line: &Line) -> u64 {
    match line.operand {
        Operand::Number(number) => number.into(),
        _ => unreachable!("{line:?} has a number"),
    }
}

/// Each line, and how often it is carried out.
fn turns(lines: &[Line]) -> impl Iterator<Item = (&Line, u64)> {
    let (mut next, mut now) = (1, 1);
    lines.iter().map(move |line| {
        match (line.operation, line.operand) {
            (Operation::Repeat, _) => next = 1 + number(line),
            (_, Operand::Mark) => now = next,
            _ => {}
        }
        let turns = now;
        if line.operation == Operation::Again {
            now = 1;
        }
        (line, turns)
    })
}

/// The word that a line reads.
fn read(line: &Line) -> Option<Slot> {
    match line.operand {
        Operand::Slot(slot) if line.operation.reads() => Some(slot),
        _ => None,
    }
}

fn stored(line: &Line) -> Option<Slot> {
    match line.operand {
        Operand::Slot(slot) if line.operation == Operation::Store => Some(slot),
        _ => None,
    }
}

/// Without loads of what the sum is, and stores of what nobody reads; a word is not read by a line that is
/// on its way as it is stored.
fn without_superfluous(mut lines: Vec<Line>, behind: usize) -> Vec<Line> {
    loop {
        let before = lines.len();
        lines = without_loads(lines);
        let used: BTreeSet<_> = lines.iter().filter_map(read).collect();
        lines.retain(|line| match stored(line) {
            Some(slot @ Slot::Variable(_)) => used.contains(&slot),
            _ => true,
        });
        if lines.len() == before {
            return apart(lines, behind);
        }
    }
}

fn without_loads(lines: Vec<Line>) -> Vec<Line> {
    let mut of_sum: Vec<Slot> = Vec::new();
    let mut kept = Vec::new();
    for line in lines {
        use Operation::*;
        match (line.operation, line.operand) {
            (_, Operand::Mark) => of_sum.clear(),
            (Load, Operand::Slot(slot)) if of_sum.contains(&slot) => continue,
            (Load, Operand::Slot(slot)) => of_sum = vec![slot],
            (Store, Operand::Slot(slot)) => of_sum.push(slot),
            (Rest | Round | Test | TestSum | TestNegative | Ask | Give | Repeat | Again, _) => {}
            _ => of_sum.clear(),
        }
        kept.push(line);
    }
    kept
}

fn apart(lines: Vec<Line>, behind: usize) -> Vec<Line> {
    let rest = Line { operation: Operation::Rest, operand: Operand::Number(0) };
    let mut all: Vec<Line> = Vec::new();
    for line in lines {
        let is_stored = |before: &Line| stored(before).is_some() && stored(before) == read(&line);
        let after = all.iter().rev().filter(|before| before.operand != Operand::Mark);
        if let Some(between) = after.take(behind).position(is_stored) {
            all.extend(std::iter::repeat_n(rest, behind - between));
        }
        all.push(line);
    }
    all
}

/// Which word has which address.
struct Slots {
    constants: BTreeMap<i64, u8>,
    kept: BTreeMap<Place, u8>,
    variables: HashMap<u32, u8>,
    words: Vec<i64>,
}

impl Slots {
    fn of(programs: &[Vec<Line>]) -> Result<Self, TooLarge> {
        let mut of = Slots {
            constants: BTreeMap::new(),
            kept: BTreeMap::new(),
            variables: HashMap::new(),
            words: Vec::new(),
        };
        let mut constants = BTreeSet::new();
        for line in programs.iter().flatten() {
            match line.operand {
                Operand::Slot(Slot::Constant(code)) => _ = constants.insert(code),
                Operand::Slot(Slot::Kept(place)) => _ = of.kept.insert(place, 0),
                _ => {}
            }
        }
        of.words = constants.iter().copied().collect();
        within("constants", 1 << SLOT_BITS, of.words.len())?;
        within("words of a row", 1 << ROW_SLOT_BITS, of.kept.len())?;
        of.constants = constants.into_iter().zip(0..).collect();
        for (slot, number) in of.kept.values_mut().zip(0..) {
            *slot = number;
        }
        for lines in programs {
            of.place_variables(lines)?;
        }
        Ok(of)
    }

    /// A variable has a word from where it is stored to where it is read last.
    fn place_variables(&mut self, lines: &[Line]) -> Result<(), TooLarge> {
        let mut last = HashMap::new();
        for (number, line) in lines.iter().enumerate() {
            if let Some(Slot::Variable(variable)) = read(line) {
                last.insert(variable, number);
            }
        }
        let loops = loops(lines);
        for last in last.values_mut() {
            // What a loop reads it may read in its next turn, too.
            if let Some((_, end)) = loops.iter().find(|(start, end)| (*start..*end).contains(last))
            {
                *last = *end;
            }
        }
        let first = self.constants.len();
        let mut free: BTreeSet<usize> = (first..1 << SLOT_BITS).collect();
        for (number, line) in lines.iter().enumerate() {
            for (variable, _) in last.iter().filter(|(_, last)| **last == number) {
                free.insert(self.variables[variable].into());
            }
            if let Some(Slot::Variable(variable)) = stored(line)
                && !self.variables.contains_key(&variable)
            {
                let Some(address) = free.pop_first() else {
                    let most = 1 << SLOT_BITS;
                    return Err(TooLarge { what: "constants and variables", most, got: most + 1 });
                };
                self.variables.insert(variable, address as u8);
            }
        }
        Ok(())
    }

    /// Lines as instructions; where a loop ends, it goes back to its mark.
    fn assemble(&self, lines: &[Line], behind: usize, instructions: &mut Vec<Instruction>) {
        let mut mark = 0;
        for &Line { operation, operand } in lines {
            let back = || (instructions.len() + behind + 1 - mark) as u8;
            let operand = match operand {
                Operand::Mark => {
                    mark = instructions.len();
                    continue;
                }
                Operand::Number(_) if operation == Operation::Again => back(),
                Operand::Number(number) => number,
                Operand::Slot(Slot::Constant(code)) => self.constants[&code],
                Operand::Slot(Slot::Variable(variable)) => self.variables[&variable],
                Operand::Slot(Slot::Kept(place)) => OF_ROW | self.kept[&place],
            };
            instructions.push(Instruction { operation, operand });
        }
    }
}

/// Where loops begin and end.
fn loops(lines: &[Line]) -> Vec<(usize, usize)> {
    let at = |found: fn(&Line) -> bool| {
        lines.iter().enumerate().filter(move |(_, line)| found(line)).map(|(number, _)| number)
    };
    let marks = at(|line| line.operand == Operand::Mark);
    marks.zip(at(|line| line.operation == Operation::Again)).collect()
}

fn within(what: &'static str, most: usize, got: usize) -> Result<(), TooLarge> {
    if got <= most { Ok(()) } else { Err(TooLarge { what, most, got }) }
}

#[cfg(test)]
mod tests;
