// SPDX-License-Identifier: MIT OR Apache-2.0
//! The expression interpretation: what a block makes of its inputs from `start` to `done`, as one
//! expression, whatever its clocks.
//!
//! Control does not depend on data, so that counters and states are constants as the block runs, and
//! their selections are settled. What is left are the operations on data. A word of a memory is an
//! operand, read before it is written; a division or a square root is one operation
//! ([`Value::quotient`], [`Value::root`]). From an expression a program for an arithmetic unit is
//! made, which folds all operations onto one adder (Parhi, VLSI Digital Signal Processing Systems, §6).
//!
//! ```
//! use hapticore_hdl::block::{Block, Interpretation, State};
//! use hapticore_hdl::format::{BIT, Format};
//! use hapticore_hdl::interpretations::expression::{Expression, Op};
//! use hapticore_hdl::signal::Wrap;
//!
//! hapticore_hdl::block! {
//!     /// Twice the sum, in two clocks.
//!     pub struct Twice("twice") {}
//!     submodules {}
//!     inputs(block) {
//!         start: BIT,
//!         a: Format::signed(8, 0),
//!         b: Format::signed(8, 0),
//!     }
//!     outputs(block) {
//!         done: BIT,
//!         sum: Format::signed(10, 0),
//!     }
//!     registers(block) {
//!         begun: BIT,
//!         done: BIT,
//!         sum: Format::signed(10, 0),
//!     }
//! }
//!
//! impl Block for Twice {
//!     fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
//!         let r = state.load(self);
//!         let first = (i.a + i.b).resize(r.sum.format, Wrap);
//!         let sum = i.start.select(first, r.begun.select((r.sum + r.sum).resize(r.sum.format, Wrap), r.sum));
//!         state.store(self, Registers { begun: i.start, done: r.begun, sum });
//!         Outputs { done: r.done, sum: r.sum }
//!     }
//! }
//!
//! let [held, begins] = [0, 1].map(|start| Inputs { start: Some(start), a: None, b: None });
//! let expression = Expression::of(&Twice {}, begins, held, |outputs| outputs.done);
//! let (name, sum) = expression.results[0];
//! assert_eq!(name, "sum", "what is a constant, as `done`, is no result");
//! assert!(matches!(expression.node(sum).op, Op::Fit(..)), "a sum that wraps");
//! assert_eq!(expression.results.len(), 1);
//! ```

mod value;

use crate::block::{Block, Inputs, Outputs};
use crate::bundle::Bundle;
use crate::format::Format;
use crate::memory::Memory;
use crate::signal::{Clocked, Overflow, Rounding, Signal, Value};
use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};

/// The value of the expression interpretation: a node of the expression.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Term(pub u32);

/// A word of a memory: of the row that an input names, or of the only one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Place {
    /// The memory's name.
    pub memory: &'static str,
    /// The input that is the upper part of its address.
    pub row: Option<Term>,
    /// The lower part of its address.
    pub offset: u64,
}

/// What a node is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Op {
    /// A code.
    Constant(i64),
    /// An input of the block, by its number among the bundle's fields.
    Input(usize),
    /// A word of a memory as it is before the block begins.
    Word(Place),
    /// The word of a memory whose address is computed.
    Lookup(&'static str, Term),
    /// Exact sum.
    Add(Term, Term),
    /// Exact difference.
    Sub(Term, Term),
    /// Exact product.
    Mul(Term, Term),
    /// Magnitude.
    Abs(Term),
    /// A change of format.
    Fit(Term, Rounding, Overflow),
    /// The same bits with the point moved.
    Scale(Term),
    /// Bits from this one up.
    Bits(Term, u8),
    /// Two words side by side.
    Concat(Term, Term),
    /// Whether the first is less.
    Less(Term, Term),
    /// Whether they are equal.
    Equal(Term, Term),
    /// Both bits.
    And(Term, Term),
    /// Either bit.
    Or(Term, Term),
    /// The other bit.
    Not(Term),
    /// The second where the first is set, else the third.
    Select(Term, Term, Term),
    /// The quotient of two unsigned numbers, to the nearest, ties to even; saturates.
    Quotient(Term, Term),
    /// The square root of an unsigned number, to the nearest.
    Root(Term),
}

impl Op {
    /// The nodes that it depends on.
    pub fn operands(self) -> Vec<Term> {
        match self {
            Op::Constant(_) | Op::Input(_) | Op::Word(_) => vec![],
            Op::Lookup(_, a)
            | Op::Abs(a)
            | Op::Fit(a, ..)
            | Op::Scale(a)
            | Op::Bits(a, _)
            | Op::Not(a)
            | Op::Root(a) => vec![a],
            Op::Add(a, b)
            | Op::Sub(a, b)
            | Op::Mul(a, b)
            | Op::Concat(a, b)
            | Op::Less(a, b)
            | Op::Equal(a, b)
            | Op::And(a, b)
            | Op::Or(a, b)
            | Op::Quotient(a, b) => vec![a, b],
            Op::Select(bit, a, b) => vec![bit, a, b],
        }
    }
}

/// A node with the format of its code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Node {
    /// What it is.
    pub op: Op,
    /// How its code is read.
    pub format: Format,
}

/// What a block makes of its inputs and memories.
#[derive(Debug, Clone, Default)]
pub struct Expression {
    /// Every node; each depends on nodes before it.
    pub nodes: Vec<Node>,
    /// Outputs of the block that are no constants.
    pub results: Vec<(&'static str, Term)>,
    /// Words of memories that are written, and with what.
    pub written: BTreeMap<Place, Term>,
}

#[derive(Default)]
struct Graph {
    expression: Expression,
    known: HashMap<Node, Term>,
}

thread_local! {
    static GRAPH: RefCell<Graph> = RefCell::default();
}

/// The node; the one that is there already where it is the same.
fn term(op: Op, format: Format) -> Term {
    GRAPH.with_borrow_mut(|graph| {
        let node = Node { op, format };
        *graph.known.entry(node).or_insert_with(|| {
            graph.expression.nodes.push(node);
            Term(graph.expression.nodes.len() as u32 - 1)
        })
    })
}

fn node_of(term: Term) -> Node {
    GRAPH.with_borrow(|graph| graph.expression.nodes[term.0 as usize])
}

/// The code of a node that is a constant.
fn settled(term: Term) -> Option<i64> {
    match node_of(term).op {
        Op::Constant(code) => Some(code),
        _ => None,
    }
}

/// The most clocks that a block is given until it is done.
const MOST_CLOCKS: usize = 10_000;

impl Expression {
    /// Runs a block from reset: with the inputs `begins` in the first clock, then `held`, until the output that
    /// `done` names is set. Inputs are constants, or symbols where there is none.
    ///
    /// # Panics
    /// Where the block is not done after 10,000 clocks, which control that depends on data may be the
    /// reason of.
    pub fn of<B: Block>(
        block: &B,
        begins: Inputs<B, Option<i64>>,
        held: Inputs<B, Option<i64>>,
        done: impl Fn(&Outputs<B, Signal<Term>>) -> Signal<Term>,
    ) -> Expression {
        GRAPH.take();
        let mut state = block.reset::<Term>();
        let [begins, held] = [begins, held].map(|codes| symbols(block, codes));
        let mut outputs = block.clock(&mut state, begins);
        for _ in 0..MOST_CLOCKS {
            outputs = block.clock(&mut state, held);
            if settled(done(&outputs).value) == Some(1) {
                break;
            }
        }
        assert!(settled(done(&outputs).value) == Some(1), "{} ends by itself", B::NAME);
        let mut expression = GRAPH.take().expression;
        B::Outputs::each(outputs, |field, signal| {
            if !matches!(expression.node(signal.value).op, Op::Constant(_)) {
                expression.results.push((field.name, signal.value));
            }
        });
        expression
    }

    /// A node.
    pub fn node(&self, term: Term) -> Node {
        self.nodes[term.0 as usize]
    }
}

fn symbols<B: Block>(block: &B, codes: Inputs<B, Option<i64>>) -> Inputs<B, Signal<Term>> {
    let mut number = 0;
    B::Inputs::map(B::Inputs::zip(codes, block.inputs()), |(code, format)| {
        number += 1;
        let value = match code {
            Some(code) => Term::raw(code, format),
            None if format.is_none() => Term::raw(0, format),
            None => term(Op::Input(number - 1), format),
        };
        Signal { value, format }
    })
}

/// A constant as the clocked interpretation has it.
fn clocked(a: Signal<Term>) -> Option<Signal<Clocked>> {
    settled(a.value).map(|value| Signal { value, format: a.format })
}

/// What a memory's words are as the block runs.
#[derive(Debug, Clone)]
pub struct Words {
    memory: Memory,
    data: Term,
}

#[cfg(test)]
mod tests;
