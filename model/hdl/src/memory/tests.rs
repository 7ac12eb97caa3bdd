// SPDX-License-Identifier: MIT OR Apache-2.0
//! Memories: when a word is there, what a collision gives, what intervals know of words.

use super::*;
use crate::interpretations::range::{Range, take_violations, whole};
use crate::signal::{bit, code};

/// A memory of codes while it is used.
struct Used {
    memory: Memory,
    words: <i64 as Storage>::Words,
}

impl Used {
    fn new(memory: Memory) -> Self {
        let words = i64::words(&memory);
        Used { memory, words }
    }

    /// One clock that reads a word, and may write one: what was read.
    fn access(&mut self, read: i64, write: Option<(bool, i64, Signal<i64>)>) -> i64 {
        let address = |word| code(word, self.memory.address());
        match write {
            None => self.memory.read(&mut self.words, address(read)),
            Some((enable, at, data)) => {
                let write = Write { enable: bit(enable), address: address(at), data };
                self.memory.access(&mut self.words, address(read), write);
            }
        }
        let data = self.memory.data::<i64>(&mut self.words);
        assert_eq!(data.format, self.memory.format);
        data.value
    }
}

const WORD: Format = Format::signed(6, 2);

#[test]
fn a_memory_begins_with_zeros_or_its_table() {
    let zeros = Memory::new("zeros", 3, WORD);
    assert_eq!((zeros.codes(), zeros.reals()), (vec![0; 3], vec![0.0; 3]));
    assert_eq!((zeros.collision, zeros.block, zeros.name), (Collision::OldWord, false, "zeros"));
    let table = Memory::table("table", WORD, vec![0.4, -99.0, 1.0]);
    assert_eq!((table.codes(), table.reals()), (vec![2, -32, 4], vec![0.4, -99.0, 1.0]));
    assert_eq!((table.collision, table.words), (Collision::DontCare, 3));
    let changed = zeros.dont_care_on_collision().in_block();
    assert_eq!((changed.collision, changed.block, changed.words), (Collision::DontCare, true, 3));
    assert_eq!(Used::new(table).words_at_reset(), 0, "the read register is zero at reset");
}

impl Used {
    fn words_at_reset(mut self) -> i64 {
        self.memory.data::<i64>(&mut self.words).value
    }
}

#[test]
fn an_address_has_as_many_bits_as_the_last_word() {
    let of = |words| Memory::new("memory", words, WORD).address();
    assert_eq!([1, 2, 3, 4, 5, 256, 257].map(|words| of(words).width), [1, 1, 2, 2, 3, 8, 9]);
}

#[test]
fn a_word_that_is_written_reads_as_it_was() {
    let mut used = Used::new(Memory::new("memory", 4, WORD));
    let word = |value| code(value, WORD);
    assert_eq!(used.access(1, Some((true, 1, word(5)))), 0);
    assert_eq!(used.access(1, Some((false, 1, word(6)))), 5, "what is not enabled is not written");
    assert_eq!(used.access(1, Some((true, 2, word(7)))), 5);
    assert_eq!([0, 1, 2, 3].map(|word| used.access(word, None)), [0, 5, 7, 0]);
}

/// In builds with debug assertions it is not the word, so that using it is noticed.
#[test]
#[cfg(debug_assertions)]
fn a_collision_that_nobody_cares_about_reads_another_word() {
    for (format, other) in [(WORD, -6), (Format::unsigned(6, 2), 58)] {
        let mut used = Used::new(Memory::new("memory", 4, format).dont_care_on_collision());
        used.access(0, Some((true, 1, code(5, format))));
        assert_eq!(used.access(1, Some((true, 2, code(1, format)))), 5, "another word is written");
        assert_eq!(used.access(1, Some((false, 1, code(1, format)))), 5, "nothing is written");
        assert_eq!(used.access(1, Some((true, 1, code(9, format)))), other);
        assert_eq!(used.access(1, None), 9);
    }
}

#[test]
fn a_word_takes_the_point_of_the_memory() {
    let mut used = Used::new(Memory::new("memory", 4, WORD));
    used.access(0, Some((true, 3, code(-3, Format::signed(4, 0)))));
    assert_eq!(used.access(3, None), -12);
}

#[test]
fn beyond_the_words_there_is_zero() {
    let mut used = Used::new(Memory::table("table", WORD, vec![1.0, 1.0, 1.0]));
    assert_eq!([2, 3].map(|word| used.access(word, None)), [4, 0]);
}

/// A memory of intervals: what was read, with violations by the range of their address.
fn access(
    words: &mut (Vec<Range>, Range),
    read: Range,
    write: Option<(Range, Range, Signal<Range>)>,
) -> (Range, Vec<Range>) {
    let memory = Memory::new("memory", 3, WORD);
    let signal = |value, format| Signal { value, format };
    let address = |word| signal(word, memory.address());
    match write {
        None => memory.read(words, address(read)),
        Some((enable, at, data)) => {
            let enable = signal(enable, crate::format::BIT);
            memory.access(words, address(read), Write { enable, address: address(at), data });
        }
    }
    let violations = take_violations().into_iter().map(|violation| {
        assert_eq!((violation.memory, violation.format), (Some("memory"), memory.address()));
        violation.range
    });
    (memory.data::<Range>(words).value, violations.collect())
}

fn range(low: i128, high: i128) -> Range {
    Range { low, high }
}

#[test]
fn intervals_of_words_are_those_of_all_that_may_be_written() {
    let (off, on, perhaps) = (range(0, 0), range(1, 1), range(0, 1));
    let data = |low, high| Signal { value: range(low, high), format: Format::signed(5, 1) };
    let mut words = Range::words(&Memory::new("memory", 3, WORD));
    let mut check = |read, write, value, after: [Range; 3]| {
        assert_eq!(access(&mut words, read, write), (value, vec![]));
        assert_eq!(words.0, after);
    };
    let zero = range(0, 0);
    check(range(0, 2), Some((off, on, data(1, 2))), zero, [zero; 3]);
    check(on, Some((on, on, data(1, 2))), zero, [zero, range(2, 4), zero]);
    check(on, Some((perhaps, on, data(-1, 0))), range(2, 4), [zero, range(-2, 4), zero]);
    check(on, Some((on, range(0, 1), data(3, 3))), range(-2, 4), [range(0, 6), range(-2, 6), zero]);
    check(on, Some((on, on, data(1, 1))), range(-2, 6), [range(0, 6), range(2, 2), zero]);
    check(range(1, 2), None, range(0, 2), [range(0, 6), range(2, 2), zero]);
    check(range(0, 1), None, range(0, 6), [range(0, 6), range(2, 2), zero]);
}

#[test]
fn an_address_beyond_the_words_is_a_violation() {
    let mut words = Range::words(&Memory::table("memory", WORD, vec![1.0, 2.0, 3.0]));
    assert_eq!(access(&mut words, range(1, 3), None), (range(8, 12), vec![range(1, 3)]));
    assert_eq!(access(&mut words, range(-1, 1), None), (range(4, 8), vec![range(-1, 1)]));
    let data = Signal { value: range(0, 0), format: WORD };
    let write = Some((range(0, 1), range(2, 3), data));
    assert_eq!(access(&mut words, range(0, 0), write), (range(4, 4), vec![range(2, 3)]));
    assert_eq!(words.0, [range(4, 4), range(8, 8), range(0, 12)]);
}

#[test]
#[should_panic(expected = "memory holds s6.2, which cannot represent every s7.2")]
fn a_memory_is_given_words_of_its_format() {
    let mut words = Range::words(&Memory::new("memory", 3, WORD));
    let data = Signal { value: range(0, 0), format: Format::signed(7, 2) };
    access(&mut words, range(0, 0), Some((range(1, 1), range(0, 0), data)));
}

#[test]
fn what_intervals_say_of_a_whole_address() {
    let mut words = Range::words(&Memory::table("memory", WORD, vec![1.0, -2.0]));
    let memory = Memory::table("memory", WORD, vec![1.0, -2.0]);
    memory.read(&mut words, Signal { value: whole(memory.address()), format: memory.address() });
    assert_eq!((memory.data::<Range>(&mut words).value, take_violations()), (range(-8, 4), vec![]));
}
