// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which lines small expressions become: none that is superfluous, words as they are read.

use super::super::writer::{Line, Operand};
use super::*;
use hapticore_hdl::format::BIT;
use hapticore_hdl::interpretations::expression::Node;
use hapticore_hdl::signal::{Exact, Proved, Saturate, Wrap};

/// Inputs, memories and outputs by these numbers.
struct Numbers;

impl Ports for Numbers {
    fn input(&self, input: usize) -> u8 {
        input as u8
    }

    fn memory(&self, _memory: &'static str) -> u8 {
        63
    }

    fn output(&self, _output: &'static str) -> u8 {
        0
    }
}

const PLACE: Place = Place { memory: "kept", row: None, offset: 0 };
const A: Term = Term(0);
const B: Term = Term(1);
const C: Term = Term(2);

/// An expression of nodes, each a term by its place.
fn expression(nodes: &[(Op, Format)], results: &[Term], written: Option<Term>) -> Expression {
    Expression {
        nodes: nodes.iter().map(|&(op, format)| Node { op, format }).collect(),
        results: results.iter().map(|term| ("result", *term)).collect(),
        written: written.into_iter().map(|term| (PLACE, term)).collect(),
    }
}

fn written(expression: &Expression) -> Writer {
    let mut writer = Writer::default();
    translate(expression, &Numbers, 1, &mut writer);
    writer
}

/// How many lines have an operation.
fn count(writer: &Writer, operation: Operation) -> usize {
    writer.lines.iter().filter(|line| line.operation == operation).count()
}

const fn u(width: u8, frac: i8) -> Format {
    Format::unsigned(width, frac)
}

const fn s(width: u8, frac: i8) -> Format {
    Format::signed(width, frac)
}

#[test]
fn a_word_that_stays_as_it_is_is_not_stored() {
    let stays = expression(&[(Op::Word(PLACE), u(4, 0))], &[A], Some(A));
    assert_eq!(count(&written(&stays), Operation::Store), 0);
    let changes = expression(&[(Op::Word(PLACE), u(4, 0)), (Op::Input(0), u(4, 0))], &[A], Some(B));
    assert!(count(&written(&changes), Operation::Store) > 0);
}

#[test]
fn the_points_of_constants_are_aligned_as_the_program_is_made() {
    let nodes = [(Op::Input(0), u(6, 3)), (Op::Constant(3), u(2, 0)), (Op::Add(A, B), u(7, 3))];
    let writer = written(&expression(&nodes, &[C], None));
    let aligned = Operand::Slot(Slot::Constant(3 << 3));
    assert!(writer.lines.iter().any(|line| line.operand == aligned), "{:?}", writer.lines);
    assert_eq!(count(&writer, Operation::Left), 0);
}

#[test]
fn a_narrowing_that_cannot_wrap_takes_no_lines_to_do_so() {
    let narrowed = |from, to| {
        let nodes = [(Op::Input(0), from), (Op::Fit(A, HalfEven, Wrap), to)];
        written(&expression(&nodes, &[B], None)).lines.len()
    };
    assert!(narrowed(u(6, 2), u(5, 0)) < narrowed(u(6, 2), u(4, 0)), "16 is rounded up to");
    assert!(narrowed(s(6, 2), s(5, 0)) < narrowed(s(6, 2), s(4, 0)), "8 is");
    assert_eq!(narrowed(s(6, 2), s(5, 0)), narrowed(u(6, 2), u(5, 0)), "no line for a sign");
}

/// A code that is the same in a wider word is one word, and is had once.
#[test]
fn a_change_of_format_that_fits_is_no_new_word() {
    for (to, overflow) in [(u(6, 0), Saturate), (u(3, 0), Proved)] {
        let nodes =
            [(Op::Input(0), u(4, 0)), (Op::Fit(A, Exact, overflow), to), (Op::Add(A, B), u(7, 0))];
        let writer = written(&expression(&nodes, &[C], None));
        assert_eq!(count(&writer, Operation::Store), 1, "{overflow:?}: {:?}", writer.lines);
    }
}

/// The inputs 0 and 1 and whether they differ, with nodes behind.
fn with_difference(more: &[(Op, Format)]) -> Vec<(Op, Format)> {
    let different = [
        (Op::Input(0), u(4, 0)),
        (Op::Input(1), u(4, 0)),
        (Op::Equal(A, B), BIT),
        (Op::Not(C), BIT),
    ];
    different.iter().chain(more).copied().collect()
}

#[test]
fn a_choice_by_the_opposite_of_a_bit_changes_its_operands() {
    let nodes = with_difference(&[(Op::Select(Term(3), A, B), u(4, 0))]);
    let writer = written(&expression(&nodes, &[Term(4)], None));
    let slot = |number| Operand::Slot(Slot::Variable(number));
    let chosen: Vec<_> = writer.lines[writer.lines.len() - 4..].to_vec();
    let expected = [(Operation::Load, slot(0)), (Operation::LoadIf, slot(1))];
    let expected = expected.map(|(operation, operand)| Line { operation, operand });
    assert_eq!(chosen[..2], expected, "where they are equal, the second");
    assert_eq!(count(&writer, Operation::Negative), 0, "the opposite itself is not computed");
}

#[test]
fn the_opposite_of_a_bit_is_computed_once_where_it_is_used_twice() {
    let nodes = with_difference(&[
        (Op::Select(Term(3), A, B), u(4, 0)),
        (Op::Select(Term(3), B, A), u(4, 0)),
    ]);
    let writer = written(&expression(&nodes, &[Term(4), Term(5)], None));
    assert_eq!(count(&writer, Operation::Negative), 1, "{:?}", writer.lines);
}

#[test]
fn only_a_choice_of_both_that_are_compared_is_the_lesser_or_the_greater() {
    let compared = |set, clear| {
        let nodes = [
            (Op::Input(0), u(4, 0)),
            (Op::Input(1), u(4, 0)),
            (Op::Input(2), u(4, 0)),
            (Op::Less(A, B), BIT),
            (Op::Select(Term(3), set, clear), u(4, 0)),
        ];
        let writer = written(&expression(&nodes, &[Term(4)], None));
        [Operation::AtMost, Operation::AtLeast].map(|operation| count(&writer, operation))
    };
    assert_eq!([compared(A, B), compared(B, A)], [[1, 0], [0, 1]]);
    for others in [(A, C), (B, C), (C, A), (C, B)] {
        assert_eq!(compared(others.0, others.1), [0, 0], "{others:?}");
    }
}

/// A word that is given all bits of a signed code, with nodes that read it from number 3 on.
fn stored(readers: &[(Op, Format)]) -> Writer {
    let given = [(Op::Input(0), s(4, 0)), (Op::Bits(A, 0), u(4, 0)), (Op::Word(PLACE), u(5, 0))];
    let nodes: Vec<_> = given.iter().chain(readers).copied().collect();
    let last = Term(nodes.len() as u32 - 1);
    written(&expression(&nodes, &[last], Some(B)))
}

#[test]
fn a_signed_code_that_is_read_as_one_is_stored_as_it_is() {
    let read = |to| (Op::Fit(Term(3), Exact, Wrap), to);
    let twice = (Op::Add(Term(4), Term(4)), s(5, 0));
    let writer = stored(&[(Op::Bits(C, 0), u(4, 0)), read(s(4, 0)), twice]);
    assert_eq!(writer.range(Slot::Kept(PLACE)), whole(s(4, 0)));
    assert_eq!(writer.sums, Some(Range { low: -16, high: 14 }), "it is found so, too");
    for readers in [
        // Of another width, of other bits, in another format, or as an integer.
        [(Op::Bits(C, 0), u(3, 0)), read(s(4, 0))],
        [(Op::Bits(C, 1), u(4, 0)), read(s(4, 0))],
        [(Op::Bits(C, 0), u(4, 0)), read(s(3, 0))],
        [(Op::Bits(C, 0), u(4, 0)), (Op::Add(Term(3), Term(3)), u(5, 0))],
    ] {
        let kept = stored(&readers).range(Slot::Kept(PLACE));
        assert_eq!(kept, whole(u(4, 0)), "{readers:?}: its bits are stored");
    }
}

/// An unsigned code, of which all bits are read again, is the word as it is.
#[test]
fn a_word_of_an_unsigned_code_has_no_sign() {
    let nodes = [
        (Op::Input(0), u(4, 0)),
        (Op::Bits(A, 0), u(4, 0)),
        (Op::Word(PLACE), u(5, 0)),
        (Op::Bits(C, 0), u(4, 0)),
        (Op::Fit(Term(3), Exact, Wrap), u(4, 0)),
    ];
    let writer = written(&expression(&nodes, &[Term(4)], Some(B)));
    assert_eq!(writer.range(Slot::Kept(PLACE)), whole(u(4, 0)));
}
