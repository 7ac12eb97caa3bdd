// SPDX-License-Identifier: MIT OR Apache-2.0
//! What becomes of operations: constants, nodes that are there already, or new ones.

use super::*;
use crate::block::{Block, Interpretation, State};
use crate::format::BIT;
use crate::memory::Storage;
use crate::signal::Wrap;
use crate::signal::{Exact, HalfEven, Proved};

const CODE: Format = Format::signed(8, 4);

fn input(number: usize, format: Format) -> Signal<Term> {
    Signal { value: term(Op::Input(number), format), format }
}

fn constant(code: i64, format: Format) -> Signal<Term> {
    Signal { value: Term::raw(code, format), format }
}

fn word(offset: u64, format: Format) -> Signal<Term> {
    let place = Place { memory: "words", row: None, offset };
    Signal { value: term(Op::Word(place), format), format }
}

fn signal(value: Term) -> Signal<Term> {
    Signal { value, format: node_of(value).format }
}

fn op(term: Term) -> Op {
    node_of(term).op
}

#[test]
fn logic_with_a_constant_or_with_itself_is_no_node() {
    let [a, b] = [0, 1].map(|number| input(number, BIT).value);
    let [zero, one] = [0, 1].map(|code| Term::raw(code, BIT));
    for (x, y, both, either) in
        [(zero, a, zero, a), (a, zero, zero, a), (one, a, a, one), (a, one, a, one), (a, a, a, a)]
    {
        assert_eq!((Term::and(x, y), Term::or(x, y)), (both, either), "{:?}, {:?}", op(x), op(y));
    }
    assert_eq!((op(Term::and(a, b)), op(Term::or(a, b))), (Op::And(a, b), Op::Or(a, b)));
    assert_eq!((Term::not(zero), Term::not(one)), (one, zero));
    assert_eq!((op(Term::not(a)), Term::not(Term::not(a))), (Op::Not(a), a));
    assert_eq!((Term::known_bit(one), Term::known_bit(zero)), (Some(true), Some(false)));
    assert_eq!(Term::known_bit(a), None);
}

#[test]
fn a_selection_is_settled_where_the_bit_is_or_both_are_the_same() {
    let [a, b] = [0, 1].map(|number| input(number, CODE));
    let bit = input(2, BIT).value;
    assert_eq!(Term::select(Term::raw(1, BIT), a, b, CODE), a.value);
    assert_eq!(Term::select(Term::raw(0, BIT), a, b, CODE), b.value);
    assert_eq!(Term::select(bit, a, a, CODE), a.value);
    assert_eq!(op(Term::select(bit, a, b, CODE)), Op::Select(bit, a.value, b.value));
}

#[test]
fn operations_on_constants_are_carried_out() {
    let [a, b] = [5, -3].map(|code| constant(code, CODE));
    let sum = Format::signed(9, 4);
    assert_eq!(op(Term::add(a, b, sum)), Op::Constant(2));
    assert_eq!(op(Term::sub(a, b, sum)), Op::Constant(8));
    assert_eq!(op(Term::abs(b, Format::unsigned(8, 4))), Op::Constant(3));
    let x = input(0, CODE);
    assert_eq!(op(Term::add(x, b, sum)), Op::Add(x.value, b.value));
    assert_eq!(op(Term::abs(x, CODE)), Op::Abs(x.value));
    let scaled = Term::scale(a.value, 2);
    assert_eq!((op(scaled), node_of(scaled).format), (Op::Constant(5), CODE.scaled(2)));
    assert_eq!(
        (op(Term::scale(x.value, 2)), Term::scale(x.value, 0)),
        (Op::Scale(x.value), x.value)
    );
}

#[test]
fn all_bits_of_a_code_read_in_its_format_again_are_the_code() {
    let x = input(0, CODE);
    let narrow = Format::signed(7, 0);
    let bits = signal(Term::bits(x, 0, Format::unsigned(8, 0)));
    let again = |to, rounding, overflow| op(Term::quantize(bits, to, rounding, overflow));
    assert_eq!(again(CODE.integer(), Exact, Wrap), Op::Scale(x.value));
    assert_eq!(again(narrow, Exact, Wrap), Op::Fit(bits.value, Exact, Wrap));
    assert_eq!(again(CODE.integer(), HalfEven, Wrap), Op::Fit(bits.value, HalfEven, Wrap));
    assert_eq!(again(CODE.integer(), Exact, Proved), Op::Fit(bits.value, Exact, Proved));
    assert_eq!(Term::quantize(x, CODE, HalfEven, Wrap), x.value, "the same format");
}

#[test]
fn a_choice_of_bits_of_words_is_one_of_the_codes() {
    let (raw, to) = (Format::unsigned(8, 0), Format::signed(8, 0));
    let bit = input(0, BIT).value;
    let stored = signal(Term::bits(word(0, Format::unsigned(12, 0)), 0, raw));
    let other = input(1, raw);
    for (x, y, turns) in
        [(stored, other, true), (other, stored, true), (other, input(2, raw), false)]
    {
        let chosen = signal(Term::select(bit, x, y, raw));
        let read = op(Term::quantize(chosen, to, Exact, Wrap));
        let expected = match turns {
            true => {
                let [x, y] = [x, y].map(|of| Term::quantize(of, to, Exact, Wrap));
                Op::Select(bit, x, y)
            }
            false => Op::Fit(chosen.value, Exact, Wrap),
        };
        assert_eq!(read, expected);
    }
}

#[test]
fn bits_are_taken_from_where_they_come() {
    let x = input(0, CODE);
    let low = |of: Signal<Term>, low, width| Term::bits(of, low, Format::unsigned(width, 0));
    assert_eq!(low(signal(Term::scale(x.value, 3)), 1, 3), low(x, 1, 3), "the point is moved");
    let wider = signal(Term::quantize(x, Format::signed(10, 4), Exact, Proved));
    assert_eq!(low(wider, 1, 3), low(x, 1, 3), "a wider word");
    let finer = signal(Term::quantize(x, Format::signed(10, 6), Exact, Proved));
    assert_eq!(op(low(finer, 1, 3)), Op::Bits(finer.value, 1), "others with another point");
    let five = signal(low(x, 0, 5));
    assert_eq!(low(five, 2, 3), low(x, 2, 3), "of its low bits the upper");
    assert_eq!(op(low(five, 2, 4)), Op::Bits(five.value, 2), "one beyond them, a zero");
    let upper = signal(low(x, 1, 5));
    assert_eq!(op(low(upper, 0, 2)), Op::Bits(upper.value, 0));
}

#[test]
fn bits_of_a_choice_are_chosen_where_one_is_a_word() {
    let bit = input(0, BIT).value;
    let (stored, [other, another]) = (word(0, CODE), [1, 2].map(|number| input(number, CODE)));
    let to = Format::unsigned(3, 0);
    for (x, y, turns) in [(stored, other, true), (other, stored, true), (other, another, false)] {
        let chosen = signal(Term::select(bit, x, y, CODE));
        let expected = match turns {
            true => Op::Select(bit, Term::bits(x, 0, to), Term::bits(y, 0, to)),
            false => Op::Bits(chosen.value, 0),
        };
        assert_eq!(op(Term::bits(chosen, 0, to)), expected);
    }
}

#[test]
fn quotient_and_root_are_one_node() {
    let [a, b] = [0, 1].map(|number| input(number, Format::unsigned(8, 4)));
    let to = Format::unsigned(9, 5);
    let quotient = Term::quotient(a, b, to).expect("folds");
    assert_eq!((op(quotient.value), quotient.format), (Op::Quotient(a.value, b.value), to));
    let root = Term::root(a, to).expect("folds");
    assert_eq!((op(root.value), root.format), (Op::Root(a.value), to));
}

#[test]
fn operands_are_those_that_a_node_depends_on() {
    let [a, b, c] = [0, 1, 2].map(Term);
    assert_eq!(Op::Constant(3).operands(), []);
    assert_eq!(Op::Root(a).operands(), [a]);
    assert_eq!(Op::Sub(a, b).operands(), [a, b]);
    assert_eq!(Op::Select(a, b, c).operands(), [a, b, c]);
}

#[test]
#[should_panic(expected = "a term has no code")]
fn a_term_has_no_code() {
    Term::code(input(0, CODE));
}

#[test]
fn an_address_of_a_row_and_a_constant_is_a_place() {
    let memory = Memory::new("words", 16, CODE);
    let mut words = Term::words(&memory);
    let mut read = |address: Signal<Term>| {
        Term::access(&memory, &mut words, address, None);
        op(Term::data(&memory, &mut words))
    };
    let row = input(0, Format::unsigned(2, 0));
    let of = |row, offset| Op::Word(Place { memory: "words", row, offset });
    assert_eq!(read(constant(5, Format::unsigned(4, 0))), of(None, 5));
    assert_eq!(read(row), of(Some(row.value), 0));
    let low = constant(3, Format::unsigned(2, 0));
    assert_eq!(read(row.concat(low)), of(Some(row.value), 3));
    let computed = row.concat(input(1, Format::unsigned(2, 0)));
    assert_eq!(read(computed), Op::Lookup("words", computed.value));
}

crate::block! {
    /// The sum of what is there.
    struct Present("present") {}
    submodules {}
    inputs(block) {
        a: CODE,
        absent: Format::NONE,
        b: CODE,
    }
    outputs(block) {
        done: BIT,
        sum: Format::signed(9, 4),
    }
    registers(block) {}
}

impl Block for Present {
    fn clock<V: Interpretation>(&self, _state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        Outputs { done: crate::signal::bit(true), sum: i.a + i.b }
    }
}

#[test]
fn what_is_absent_is_no_input() {
    let all = Inputs { a: None, absent: None, b: None };
    let expression = Expression::of(&Present {}, all, all, |outputs| outputs.done);
    let inputs: Vec<_> = expression.nodes.iter().map(|node| node.op).collect();
    assert!(inputs.contains(&Op::Input(0)) && inputs.contains(&Op::Input(2)), "{inputs:?}");
    assert!(!inputs.contains(&Op::Input(1)), "{inputs:?}");
    assert_eq!(expression.results.len(), 1);
}
