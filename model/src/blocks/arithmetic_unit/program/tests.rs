// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lines as programs: what is superfluous goes, words have places, too many are refused.

use super::*;
use std::cmp::Reverse;

fn load(slot: Slot) -> Line {
    Line { operation: Operation::Load, operand: Operand::Slot(slot) }
}

fn store(number: u32) -> Line {
    Line { operation: Operation::Store, operand: Operand::Slot(Slot::Variable(number)) }
}

const MARK: Line = Line { operation: Operation::Rest, operand: Operand::Mark };
const AGAIN: Line = Line { operation: Operation::Again, operand: Operand::Number(0) };

#[test]
fn what_the_sum_is_already_is_not_loaded_but_in_a_loop() {
    let word = load(Slot::Constant(5));
    assert_eq!(without_loads(vec![word, word]), [word]);
    let other = load(Slot::Constant(6));
    let changes = vec![word, other, word];
    assert_eq!(without_loads(changes.clone()), changes);
    // In its next turn the sum is what the loop has made of it.
    let turns = vec![word, MARK, word, other, AGAIN];
    assert_eq!(without_loads(turns.clone()), turns);
}

#[test]
fn a_loop_is_from_its_mark_to_where_it_goes_back() {
    let word = load(Slot::Constant(5));
    assert_eq!(loops(&[word, MARK, word, AGAIN, word, MARK, AGAIN]), [(1, 3), (5, 6)]);
}

/// A word that a loop reads early it may read in the next turn: nothing else has its place until the loop ends.
#[test]
fn words_of_a_loop_keep_their_places_until_its_end() {
    let (early, late) = (Slot::Variable(0), Slot::Variable(1));
    let lines = vec![store(0), MARK, load(early), store(1), load(late), AGAIN];
    let slots = Slots::of(&[lines]).expect("two words");
    assert_ne!(slots.variables[&0], slots.variables[&1]);
    let lines = vec![store(0), load(early), store(1), load(late)];
    let slots = Slots::of(&[lines]).expect("two words");
    assert_eq!(slots.variables[&0], slots.variables[&1], "one after the other");
}

#[test]
fn more_words_than_instructions_can_name_are_refused() {
    const MOST: usize = 1 << SLOT_BITS;
    let constants = |count| (0..count).map(|code| load(Slot::Constant(code))).collect::<Vec<_>>();
    let refused = |lines: Vec<Line>| Slots::of(&[lines]).err();
    assert_eq!(refused(constants(MOST as i64)), None);
    let what = "constants";
    let expected = TooLarge { what, most: MOST, got: MOST + 1 };
    assert_eq!(refused(constants(MOST as i64 + 1)), Some(expected));
    let mut lines = constants(MOST as i64);
    lines.extend([store(0), load(Slot::Variable(0))]);
    let what = "constants and variables";
    assert_eq!(refused(lines), Some(TooLarge { what, most: MOST, got: MOST + 1 }));
}

#[test]
fn numbers_are_their_places_in_the_order_of_a_key() {
    let instruction = |operation, operand| Instruction { operation, operand };
    let asked = [7, 3, 9, 3].map(|number| instruction(Operation::Ask, number));
    let mut programs = Programs {
        instructions: [&asked[..], &[instruction(Operation::Give, 9)]].concat(),
        entries: vec![0],
        clocks: vec![0],
        products: vec![0],
        behind: 1,
        words: vec![],
        sum: Format::signed(4, 0),
        word: Format::signed(4, 0),
        factors: [Format::unsigned(1, 0); 2],
    };
    assert_eq!(programs.renumber(Operation::Ask, Reverse), [9, 7, 3]);
    let operands: Vec<_> = programs.instructions.iter().map(|of| of.operand).collect();
    assert_eq!(operands, [1, 2, 0, 2, 9], "those of other operations stay");
}
