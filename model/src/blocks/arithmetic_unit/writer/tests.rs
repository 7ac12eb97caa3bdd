// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ranges that lines leave: of the sum now, of all sums, of all words and factors.

use super::*;

const fn range(low: i128, high: i128) -> Range {
    Range { low, high }
}

/// A writer whose sum is in a range, with a word that is in another.
fn with(sum: Range, word: Range) -> (Writer, Slot) {
    let mut writer = Writer::default();
    writer.alone(Operation::Take, word);
    let slot = writer.keep();
    writer.alone(Operation::Take, sum);
    (writer, slot)
}

#[test]
fn sums_and_differences_have_the_ranges_of_both() {
    let of = |change: fn(&mut Writer, Slot)| {
        let (mut writer, slot) = with(range(-5, 7), range(-20, 300));
        change(&mut writer, slot);
        writer.sum()
    };
    assert_eq!(of(Writer::add), range(-25, 307));
    assert_eq!(of(Writer::subtract), range(-305, 27));
    assert_eq!(of(Writer::at_most), range(-20, 7));
    assert_eq!(of(Writer::at_least), range(-5, 300));
    assert_eq!(of(Writer::load), range(-20, 300));
    assert_eq!(of(Writer::load_if), range(-20, 300));
}

/// The lesser and the greater are chosen by a difference, which the adder must hold.
#[test]
fn comparisons_are_differences_that_the_sum_holds() {
    for compare in [Writer::at_most, Writer::at_least] {
        let (mut writer, slot) = with(range(-5, 7), range(-20, 300));
        compare(&mut writer, slot);
        assert_eq!(writer.sums, Some(range(-305, 300)));
        let (mut writer, slot) = with(range(-5, 7), range(-400, 20));
        compare(&mut writer, slot);
        assert_eq!(writer.sums, Some(range(-400, 407)));
    }
}

#[test]
fn words_are_numbered_and_their_ranges_known() {
    let (mut writer, first) = with(range(-5, 7), range(-20, 300));
    let second = writer.keep();
    assert_eq!((first, second), (Slot::Variable(0), Slot::Variable(1)));
    assert_eq!((writer.range(first), writer.range(second)), (range(-20, 300), range(-5, 7)));
    assert_eq!(writer.stored, Some(range(-20, 300)));
    assert_eq!(writer.range(Slot::Constant(-9)), range(-9, -9));
}

#[test]
fn factors_of_products_are_the_largest_of_each_side() {
    let (mut writer, slot) = with(range(2, 7), range(3, 300));
    writer.multiply(slot);
    assert_eq!((writer.sum(), writer.factors), (range(6, 2100), [7, 300]));
    writer.multiply(Slot::Constant(5));
    assert_eq!((writer.sum(), writer.factors), (range(30, 10_500), [2100, 300]));
}

#[test]
fn shifts_move_both_ends_and_rounding_adds_one() {
    let (mut writer, _) = with(range(-5, 7), range(0, 0));
    writer.shift(3);
    assert_eq!(writer.sum(), range(-40, 56));
    writer.shift(-4);
    assert_eq!(writer.sum(), range(-3, 3));
    writer.round();
    assert_eq!(writer.sum(), range(-3, 4));
    let lines = writer.lines.len();
    writer.shift(0);
    assert_eq!(writer.lines.len(), lines, "no places are no line");
    let counts: Vec<_> = writer.lines.iter().map(|line| (line.operation, line.operand)).collect();
    assert!(counts.contains(&(Operation::Left, Operand::Number(3))), "{counts:?}");
    assert!(counts.contains(&(Operation::Right, Operand::Number(4))), "{counts:?}");
}

#[test]
fn digits_leave_less_than_the_divisor() {
    let (mut writer, divisor) = with(range(0, 100), range(1, 300));
    writer.digits(9, divisor);
    assert_eq!(writer.sums, Some(range(-300, 599)), "twice the remainder, and less the divisor");
    let (mut writer, divisor) = with(range(0, 1000), range(1, 300));
    writer.digits(9, divisor);
    assert_eq!(writer.sum(), range(0, 299));
    assert_eq!(writer.sums, Some(range(-300, 1000)), "the remainder less the divisor");
    let turns = |line: &Line| line.operation == Operation::Repeat;
    let repeat = writer.lines.iter().find(|line| turns(line)).expect("a loop");
    assert_eq!(repeat.operand, Operand::Number(8), "nine turns go back eight times");
}

#[test]
fn low_bits_take_lines_only_where_there_are_others() {
    let (mut writer, _) = with(range(0, 15), range(0, 0));
    let lines = writer.lines.len();
    writer.low_bits(4);
    assert_eq!((writer.lines.len(), writer.sum()), (lines, range(0, 15)));
    writer.low_bits(3);
    assert!(writer.lines.len() > lines);
    assert_eq!(writer.sum(), range(0, 7));
    let (mut signed, _) = with(range(-1, 7), range(0, 0));
    signed.low_bits(3);
    assert_eq!(signed.sum(), range(0, 7));
    assert!(signed.lines.len() > lines);
}

#[test]
fn what_a_port_gives_is_a_line_with_its_number() {
    let mut writer = Writer::default();
    writer.number(Operation::Ask, 5, range(0, 3));
    assert_eq!(writer.lines, [Line { operation: Operation::Ask, operand: Operand::Number(5) }]);
    assert_eq!(writer.sum(), range(0, 3));
}
