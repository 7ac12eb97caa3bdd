// SPDX-License-Identifier: MIT OR Apache-2.0
//! The arithmetic of expressions: operations on constants are carried out, others become nodes.

use super::{GRAPH, Op, Place, Term, Words, clocked, node_of, settled, term};
use crate::block::Interpretation;
use crate::format::{BIT, Format};
use crate::memory::{Memory, Storage, Write};
use crate::signal::{Clocked, Overflow, Proved, Rounding, Signal, Value};

/// The operation on codes where both are constants, else the node.
fn of_two(
    a: Signal<Term>,
    b: Signal<Term>,
    to: Format,
    on_codes: impl Fn(Signal<Clocked>, Signal<Clocked>) -> Clocked,
    op: impl Fn(Term, Term) -> Op,
) -> Term {
    match clocked(a).zip(clocked(b)) {
        Some((a, b)) => Term::raw(on_codes(a, b), to),
        None => term(op(a.value, b.value), to),
    }
}

fn of_one(
    a: Signal<Term>,
    to: Format,
    on_code: impl Fn(Signal<Clocked>) -> Clocked,
    op: impl Fn(Term) -> Op,
) -> Term {
    match clocked(a) {
        Some(a) => Term::raw(on_code(a), to),
        None => term(op(a.value), to),
    }
}

fn is_word(a: Term) -> bool {
    matches!(node_of(a).op, Op::Word(_))
}

fn is_taken_from_word(a: Term) -> bool {
    matches!(node_of(a).op, Op::Bits(of, 0) if is_word(of))
}

fn bit(set: bool) -> Term {
    Term::raw(set.into(), BIT)
}

impl Value for Term {
    const ELABORATES: bool = true;
    const FOLDS: bool = true;

    fn literal(real: f64, format: Format) -> Self {
        Term::raw(format.code_saturating(real), format)
    }

    fn raw(code: i64, format: Format) -> Self {
        term(Op::Constant(code), format)
    }

    fn add(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        of_two(a, b, to, |a, b| i64::add(a, b, to), Op::Add)
    }

    fn sub(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        of_two(a, b, to, |a, b| i64::sub(a, b, to), Op::Sub)
    }

    fn mul(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        of_two(a, b, to, |a, b| i64::mul(a, b, to), Op::Mul)
    }

    fn abs(a: Signal<Self>, to: Format) -> Self {
        of_one(a, to, |a| <Clocked as Value>::abs(a, to), Op::Abs)
    }

    fn quantize(a: Signal<Self>, to: Format, rounding: Rounding, overflow: Overflow) -> Self {
        if a.format == to {
            return a.value;
        }
        if rounding == Rounding::Exact && overflow == Overflow::Wrap {
            match node_of(a.value).op {
                Op::Select(bit, x, y) if is_taken_from_word(x) || is_taken_from_word(y) => {
                    let of = |a: Term| {
                        let a = Signal { value: a, format: node_of(a).format };
                        Signal { value: Self::quantize(a, to, rounding, overflow), format: to }
                    };
                    return Self::select(bit, of(x), of(y), to);
                }
                // All bits of a code, read in its format again.
                Op::Bits(x, 0) if node_of(x).format.integer() == to => {
                    return Self::scale(x, node_of(x).format.frac);
                }
                _ => {}
            }
        }
        let on_code = |a| i64::quantize(a, to, rounding, overflow);
        of_one(a, to, on_code, |a| Op::Fit(a, rounding, overflow))
    }

    fn scale(a: Self, by: i8) -> Self {
        let node = node_of(a);
        let to = node.format.scaled(by);
        match node.op {
            Op::Constant(code) => Term::raw(code, to),
            _ if by == 0 => a,
            _ => term(Op::Scale(a), to),
        }
    }

    fn bits(a: Signal<Self>, low: u8, to: Format) -> Self {
        let of = |a: Term| Self::bits(Signal { value: a, format: node_of(a).format }, low, to);
        match node_of(a.value).op {
            Op::Scale(x) => of(x),
            // Of a word that is as it was, or begins anew, the bits are taken before.
            Op::Select(bit, x, y) if is_word(x) || is_word(y) => {
                let [x, y] = [x, y].map(|of_it| Signal { value: of(of_it), format: to });
                Self::select(bit, x, y, to)
            }
            Op::Fit(x, Rounding::Exact, Proved) if node_of(x).format.frac == a.format.frac => of(x),
            Op::Bits(x, 0) if low + to.width <= a.format.width => of(x),
            _ => of_one(a, to, |a| i64::bits(a, low, to), |a| Op::Bits(a, low)),
        }
    }

    fn concat(high: Signal<Self>, low: Signal<Self>, to: Format) -> Self {
        of_two(high, low, to, |high, low| i64::concat(high, low, to), Op::Concat)
    }

    fn less(a: Signal<Self>, b: Signal<Self>) -> Self {
        of_two(a, b, BIT, i64::less, Op::Less)
    }

    fn equal(a: Signal<Self>, b: Signal<Self>) -> Self {
        of_two(a, b, BIT, i64::equal, Op::Equal)
    }

    fn and(a: Self, b: Self) -> Self {
        match (settled(a), settled(b)) {
            (Some(0), _) | (_, Some(0)) => bit(false),
            (Some(_), _) => b,
            (_, Some(_)) => a,
            _ if a == b => a,
            _ => term(Op::And(a, b), BIT),
        }
    }

    fn or(a: Self, b: Self) -> Self {
        match (settled(a), settled(b)) {
            (Some(1), _) | (_, Some(1)) => bit(true),
            (Some(_), _) => b,
            (_, Some(_)) => a,
            _ if a == b => a,
            _ => term(Op::Or(a, b), BIT),
        }
    }

    fn not(a: Self) -> Self {
        match node_of(a).op {
            Op::Constant(code) => bit(code == 0),
            Op::Not(a) => a,
            _ => term(Op::Not(a), BIT),
        }
    }

    fn select(bit: Self, a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        let [a, b] = [a, b].map(|of| Self::quantize(of, to, Rounding::Exact, Proved));
        match settled(bit) {
            Some(set) => {
                if set == 1 {
                    a
                } else {
                    b
                }
            }
            None if a == b => a,
            None => term(Op::Select(bit, a, b), to),
        }
    }

    fn quotient(
        numerator: Signal<Self>,
        denominator: Signal<Self>,
        to: Format,
    ) -> Option<Signal<Self>> {
        let value = term(Op::Quotient(numerator.value, denominator.value), to);
        Some(Signal { value, format: to })
    }

    fn root(radicand: Signal<Self>, to: Format) -> Option<Signal<Self>> {
        Some(Signal { value: term(Op::Root(radicand.value), to), format: to })
    }

    fn code(_a: Signal<Self>) -> i64 {
        unreachable!("a term has no code")
    }

    fn known_bit(bit: Self) -> Option<bool> {
        settled(bit).map(|code| code != 0)
    }
}

/// The place that an address means; none where it is computed.
fn place(memory: &'static str, address: Signal<Term>) -> Option<Place> {
    let node = node_of(address.value);
    match node.op {
        Op::Constant(code) => Some(Place { memory, row: None, offset: code as u64 }),
        Op::Input(_) => Some(Place { memory, row: Some(address.value), offset: 0 }),
        Op::Concat(row, low) => match (node_of(row).op, settled(low)) {
            (Op::Input(_), Some(offset)) => {
                Some(Place { memory, row: Some(row), offset: offset as u64 })
            }
            _ => None,
        },
        _ => None,
    }
}

impl Storage for Term {
    type Words = Words;

    fn words(memory: &Memory) -> Words {
        Words { memory: memory.clone(), data: Term::raw(0, memory.format) }
    }

    fn data(_memory: &Memory, words: &mut Words) -> Self {
        words.data
    }

    /// # Panics
    /// Where what is written depends on data, or its address is computed.
    fn access(
        memory: &Memory,
        words: &mut Words,
        address: Signal<Self>,
        write: Option<Write<Self>>,
    ) {
        let format = words.memory.format;
        words.data = match place(memory.name, address) {
            None => term(Op::Lookup(memory.name, address.value), format),
            Some(place) => GRAPH
                .with_borrow(|graph| graph.expression.written.get(&place).copied())
                .unwrap_or_else(|| term(Op::Word(place), format)),
        };
        let Some(write) = write else { return };
        match settled(write.enable.value) {
            Some(0) => {}
            Some(_) => {
                let place = place(memory.name, write.address).expect("a place that is written");
                let data = write.data.resize(format, Proved).value;
                GRAPH.with_borrow_mut(|graph| graph.expression.written.insert(place, data));
            }
            None => panic!("whether {} is written depends on data", memory.name),
        }
    }
}

impl Interpretation for Term {}
