// SPDX-License-Identifier: MIT OR Apache-2.0
//! The program as it is run: its jumps followed and its slots known, for control does not depend on
//! data.
//!
//! What instructions do between two that use the sum is a list of terms, times · left · right; terms that are the same
//! are one. Both factors are words of one memory: the scratch memory, and behind it what the table and the two loads
//! that change a word give.

use super::instruction::{Index, Instruction, Operation, SCALARS, SLOT_BITS};
use super::program::{Executed, Program};
use hapticore_contract::calibration::Layout;

/// The words of the table from the base on.
pub(super) const ROW: u8 = 1 << SLOT_BITS;
/// Words from a base that are multiplied.
pub(super) const ROW_WORDS: usize = 3;
/// Both surfaces' scalars.
pub(super) const TABLE_SCALARS: u8 = ROW + 8;
/// A word without its fraction of a cell.
pub(super) const CELL: u8 = TABLE_SCALARS + 2 * Layout::SCALARS as u8;
/// The digits of a quotient, as a word.
pub(super) const QUOTIENT: u8 = CELL + 1;

/// A product that is added to the sum `times` times.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Term {
    pub left: u8,
    pub right: u8,
    pub times: u8,
}

/// What follows a list of terms.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Then {
    /// slot ← sum, rounded and saturated; sum ← 0
    Store { slot: u8 },
    /// The same with options of [`Operation::Store`].
    StoreWith { slot: u8, option: u8, surface: u8 },
    /// The row ← the table's words from the sum on.
    Row,
    /// The cell's word ← slot, without its fraction of a cell.
    Cell { slot: u8 },
    /// A digit for each of `count` powers, from the first downwards: sum += pair's word by the sum's sign · power.
    Digits { pair: u8, first: u8, count: u8 },
    /// The quotient's word ← its digits.
    Quotient,
    /// slot ← half of a ratio, by the option and the surface.
    Input { slot: u8, option: u8, surface: u8 },
    /// x, y or R, by the surface ← sum; sum ← 0
    Output { surface: u8 },
}

/// The next `terms` terms, and what follows them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Statement {
    pub terms: usize,
    pub then: Then,
}

/// A jump that a program makes while no operation is in progress: all products are in the sum, and that has been
/// stored. No program goes on after one with a row, a cell or a quotient that it has read before.
#[derive(Debug, Clone, Copy)]
pub(super) struct Jump {
    /// Clocks up to it, without that which it adds.
    pub clocks: u64,
    /// Clocks up to that in which operands and products from before it are all replaced.
    pub replaced: u64,
    /// Where the base lies among the scalars; none where the sum has set it.
    pub scalars: Option<u8>,
    /// How many terms, and statements, come before it.
    pub terms: usize,
    pub statements: usize,
}

/// A program as it is run.
#[derive(Debug, Clone, Default)]
pub(super) struct Trace {
    pub terms: Vec<Term>,
    pub statements: Vec<Statement>,
    pub jumps: Vec<Jump>,
}

/// Follows a program.
#[derive(Default)]
struct Tracer {
    trace: Trace,
    /// Terms that belong to a statement.
    ended: usize,
    /// The multiplier's left operand, while it is what a word holds.
    left: Option<u8>,
    /// The words by one of which a digit's power is multiplied, until it is.
    digit: Option<u8>,
    /// Where the base lies among the scalars; none where the sum has set it.
    scalars: Option<u8>,
}

impl Trace {
    /// The program with `steps` steps, where a product takes `product` clocks from its operands'.
    pub fn of(program: &Program, steps: u64, product: u64) -> Self {
        let (mut tracer, mut clocks) = (Tracer::default(), 0);
        let [mut loads, mut products] = [Vec::new(), Vec::new()];
        program.execute(steps, |executed| {
            clocks += executed.clocks(product);
            tracer.add(&executed);
            match executed.instruction.operation {
                Operation::Load | Operation::LoadCell => loads.push(clocks),
                Operation::Multiply | Operation::MultiplyTable => products.push(clocks),
                _ => (),
            }
            if executed.jumps && tracer.nothing_is_under_way() {
                tracer.trace.jumps.push(Jump {
                    clocks: clocks - 1,
                    replaced: 0,
                    scalars: tracer.scalars,
                    terms: tracer.trace.terms.len(),
                    statements: tracer.trace.statements.len(),
                });
            }
        });
        let mut trace = tracer.trace;
        let mut jumps = std::mem::take(&mut trace.jumps);
        jumps.retain_mut(|jump| {
            let next = |of: &[u64]| of.iter().copied().find(|&clocks| clocks > jump.clocks);
            let replaced = next(&loads).zip(next(&products));
            // A product that has begun is in the sum by then.
            jump.replaced = replaced.map_or(0, |(load, begun)| load.max(begun) + product + 1);
            replaced.is_some()
        });
        trace.jumps = jumps;
        trace
    }
}

impl Tracer {
    fn add(&mut self, executed: &Executed) {
        let &Executed { instruction, surface, .. } = executed;
        let &Instruction { operation, option, .. } = instruction;
        let slot = slot(executed);
        match operation {
            Operation::Load => self.left = Some(slot),
            Operation::LoadCell => {
                self.end(Then::Cell { slot });
                self.left = Some(CELL);
            }
            Operation::LoadQuotient => {
                self.end(Then::Quotient);
                self.left = Some(QUOTIENT);
            }
            Operation::LoadDigit => (self.left, self.digit) = (None, Some(slot)),
            Operation::Multiply => self.multiply(slot),
            Operation::MultiplyTable => {
                let word = self.scalars.map_or(ROW, |first| TABLE_SCALARS + first) + option;
                assert!(self.scalars.is_some() || usize::from(option) < ROW_WORDS, "{option}");
                self.term(word, slot);
            }
            Operation::Store if option == 0 => self.write(slot, Then::Store { slot }),
            Operation::Store => self.write(slot, Then::StoreWith { slot, option, surface }),
            Operation::Base => {
                self.end(Then::Row);
                self.scalars = None;
            }
            Operation::Input => self.write(slot, Then::Input { slot, option, surface }),
            Operation::Output => self.end(Then::Output { surface }),
            Operation::Set if option & SCALARS != 0 => {
                self.scalars = Some((surface & 1) * Layout::SCALARS as u8);
            }
            Operation::Set | Operation::Repeat | Operation::Surfaces => (),
            Operation::Pass | Operation::Found | Operation::End => (),
        }
    }

    /// Whether all products are in the sum, and that has been stored.
    fn nothing_is_under_way(&self) -> bool {
        let stores = |then: &Then| {
            matches!(then, Then::Store { .. } | Then::StoreWith { .. } | Then::Output { .. })
        };
        let adds = |of: &&Statement| of.terms > 0 || matches!(of.then, Then::Digits { .. });
        let mut statements = self.trace.statements.iter().rev();
        self.trace.terms.len() == self.ended
            && statements.find(|of| stores(&of.then) || adds(of)).is_some_and(|of| stores(&of.then))
    }

    fn multiply(&mut self, slot: u8) {
        match self.digit.take() {
            Some(pair) => self.digit(pair, slot),
            None => self.term(self.left.expect("a word that is still there"), slot),
        }
    }

    fn term(&mut self, left: u8, right: u8) {
        match self.trace.terms[self.ended..].last_mut() {
            Some(last) if (last.left, last.right) == (left, right) => last.times += 1,
            _ => self.trace.terms.push(Term { left, right, times: 1 }),
        }
    }

    fn digit(&mut self, pair: u8, power: u8) {
        let follows = self.trace.terms.len() == self.ended;
        if let Some(Statement { then: Then::Digits { pair: of, first, count }, .. }) =
            self.trace.statements.last_mut().filter(|_| follows)
            && (*of, *first - *count) == (pair, power)
        {
            *count += 1;
        } else {
            self.end(Then::Digits { pair, first: power, count: 1 });
        }
    }

    fn end(&mut self, then: Then) {
        let terms = self.trace.terms.len() - self.ended;
        self.ended = self.trace.terms.len();
        self.trace.statements.push(Statement { terms, then });
    }

    /// Ends with a statement that replaces a word.
    fn write(&mut self, slot: u8, then: Then) {
        self.end(then);
        self.left = self.left.filter(|&left| left != slot);
    }
}

/// The word that an instruction means; of a digit's pair the first.
fn slot(executed: &Executed) -> u8 {
    let slot = executed.instruction.slot;
    let index = match slot.1 {
        Index::None => 0,
        Index::Surface => executed.surface,
        Index::Counter => executed.count,
        Index::SurfacePair => (executed.surface & 1) << 1,
    };
    slot.0 | index
}
