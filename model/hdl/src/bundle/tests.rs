// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bundles and multiplexers: fields in their order, choices by the first bit that is set, states by name.

use crate::bundle::{Bundle, Choice, Field, Nothing, join};
use crate::format::{BIT, Format};
use crate::interpretations::range::{Range, whole};
use crate::signal::{Signal, bit, code, int};
use crate::states::{States, snake, snake_length, text};

crate::bundle! {
    /// A write port.
    pub struct Port { enable, word }
}

crate::bundle! {
    pub struct Group {
        /// Begins.
        start,
        port as Port,
        step in Step,
    }
}

crate::bundle! {
    /// No field.
    pub struct Empty {}
}

crate::states! {
    /// Steps of a division.
    pub enum Step { Idle, RoundUp, DoneA }
}

const fn field(name: &'static str, doc: &'static str) -> Field {
    Field { name, states: &[], doc }
}

#[test]
fn fields_are_listed_in_their_order() {
    let states = Field { states: &["idle", "round_up", "done_a"], ..field("step", "") };
    assert_eq!(
        Group::FIELDS,
        [field("start", " Begins."), field("enable", ""), field("word", ""), states]
    );
    let mut seen = Vec::new();
    let group = Group { start: 1, port: Port { enable: 2, word: 3 }, step: 4 };
    Group::each(Group::map(group, |n| n * 10), |field, n| seen.push((field.name, n)));
    assert_eq!(seen, [("start", 10), ("enable", 20), ("word", 30), ("step", 40)]);
    assert_eq!(Group::zip(group, group).port.word, (3, 3));
    assert_eq!(Group::of(7), Group { start: 7, port: Port { enable: 7, word: 7 }, step: 7 });
    assert_eq!(
        (Empty::FIELDS.len(), Empty::map(Nothing::<u8>::default(), |n| n)),
        (0, Nothing::default())
    );
}

#[test]
fn declarations_are_joined_in_their_order() {
    let [a, b, c, d] = ["a", "b", "c", "d"].map(|name| field(name, ""));
    assert_eq!(join::<4>(&[&[a, b], &[], &[c], &[d]]), [a, b, c, d]);
    assert_eq!(join::<0>(&[]), []);
}

#[test]
fn states_have_codes_and_names() {
    assert_eq!(Step::ALL, [Step::Idle, Step::RoundUp, Step::DoneA]);
    assert_eq!((Step::FORMAT, Step::DoneA.code()), (Format::unsigned(2, 0), 2));
    assert_eq!(Step::RoundUp.signal::<i64>().value, 1);
    let step: Signal<i64> = code(2, Step::FORMAT);
    assert_eq!([step.at(Step::DoneA).value, step.at(Step::RoundUp).value], [1, 0]);
}

#[test]
fn names_are_written_in_snake_case() {
    assert_eq!(["A", "Ab", "AbcDe", "ABC"].map(snake_length), [1, 2, 6, 5]);
    assert_eq!(&snake::<6>("AbcDe"), b"abc_de");
    assert_eq!(&snake::<5>("ABC"), b"a_b_c");
    assert_eq!(text(b"abc_de"), "abc_de");
}

/// Intervals of one code are known bits; whole ones are not.
fn range_bit(known: Option<bool>) -> Signal<Range> {
    known.map_or(Signal { value: whole(BIT), format: BIT }, bit)
}

/// What `when!` chooses of 1, 2 and 3, as an interval.
fn chosen(first: Option<bool>, second: Option<bool>) -> (i128, i128) {
    let (first, second) = (range_bit(first), range_bit(second));
    let choice = when!(first => int::<Range>(1), second => int(2), else int(3));
    (choice.value.low, choice.value.high)
}

#[test]
fn the_first_bit_that_is_set_chooses() {
    let (no, yes) = (Some(false), Some(true));
    assert_eq!([chosen(yes, yes), chosen(no, yes), chosen(no, no)], [(1, 1), (2, 2), (3, 3)]);
    assert_eq!([chosen(None, yes), chosen(None, no), chosen(no, None)], [(1, 2), (1, 3), (2, 3)]);
    assert_eq!([chosen(yes, None), chosen(None, None)], [(1, 1), (1, 3)]);
    for (first, second, expected) in
        [(true, true, 1), (true, false, 1), (false, true, 2), (false, false, 3)]
    {
        let choice =
            when!(bit::<i64>(first) => int::<i64>(1), bit::<i64>(second) => int(2), else int(3));
        assert_eq!(choice.value, expected);
    }
}

#[test]
fn a_bundle_is_chosen_field_by_field() {
    let of = |n: u64| Port { enable: int::<Range>(n), word: int(n + 1) };
    for (bit, expected) in [(Some(true), (1, 1)), (Some(false), (0, 0)), (None, (0, 1))] {
        let choice = Port::choose(range_bit(bit), of(1), of(0));
        assert_eq!((choice.enable.value.low, choice.enable.value.high), expected);
        assert_eq!(
            (choice.word.value.low, choice.word.value.high),
            (expected.0 + 1, expected.1 + 1)
        );
    }
}
