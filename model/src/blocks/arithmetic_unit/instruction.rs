// SPDX-License-Identifier: MIT OR Apache-2.0
//! Instructions of the arithmetic unit, and their codes.
//!
//! ```text
//! bit   15 … 13   12, 11   10 … 8   7     6 … 0
//!       action    when     source   row   slot           with a word
//!       action    when     source   number               Left, Right: places; Repeat: times; Again: back; Ask, Give: a port
//! ```
//!
//! The sum takes its source always, never, where the flag is set, or by the sign of the difference of sum
//! and word. Fields are as the unit's multiplexer has them, so that little is decoded.

/// What an instruction does. `word` is the one that its operand names, `flag` decides what is conditional.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operation {
    /// Nothing.
    Rest,
    /// sum ← word
    Load,
    /// sum ← word where the flag is set
    LoadIf,
    /// sum ← sum + word
    Add,
    /// sum ← sum + word where the flag is set
    AddIf,
    /// sum ← sum − word
    Subtract,
    /// sum ← the lesser of sum and word
    AtMost,
    /// sum ← the greater of sum and word
    AtLeast,
    /// Where sum ≥ word: sum ← sum − word, and its lowest bit, which was clear, is set
    Divide,
    /// word ← sum
    Store,
    /// sum ← sum · word, both without a sign
    Multiply,
    /// sum ← sum · 2^number
    Left,
    /// sum ← sum / 2^number, rounded down
    Right,
    /// flag ← whether what the last `Right` rounded down is to be rounded up, ties to even
    Round,
    /// sum ← 1 where it is negative, else 0
    Negative,
    /// sum ← 1 where it is zero, else 0
    Zero,
    /// flag ← lowest bit of word
    Test,
    /// flag ← lowest bit of sum
    TestSum,
    /// flag ← whether sum is negative
    TestNegative,
    /// Shows the number of what is asked for; it is given in the clock after
    Ask,
    /// sum ← what was asked for
    Take,
    /// Shows sum and its number
    Give,
    /// The next `Again` goes back so many times
    Repeat,
    /// Goes back by so many instructions while there are times left
    Again,
    /// The last
    End,
}

/// Where a sum comes from. Sources that take a clock for each place come second and third.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// The word.
    Word,
    /// Whether the sum is negative, or zero.
    Told,
    /// The sum with a place more.
    Left,
    /// The sum with a place less.
    Right,
    /// The sum and the word.
    Sum,
    /// The difference of sum and word.
    Difference,
    /// The product.
    Product,
    /// What was asked for.
    Given,
}

/// When a sum takes its source.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum When {
    /// Never.
    Never,
    /// Always.
    Always,
    /// Where the flag is set.
    Flag,
    /// Where the sum is less than the word, or is not: by the action.
    Less,
}

/// What else happens. Where the sum is compared or told, an odd action means the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Action {
    /// Nothing: not less; negative.
    None,
    /// The word is written. Less; zero.
    Store,
    /// flag ← lowest bit of word
    Test,
    /// flag ← lowest bit of sum
    TestSum,
    /// flag ← whether sum is negative
    TestNegative,
    /// flag ← whether to round up
    Round,
    /// Shows the sum; where the source is told, it is the last.
    Give,
    /// Times are set; where the source is told, they are counted.
    Repeat,
}

/// Bits of an operand.
pub const OPERAND_BITS: u8 = 8;
/// Bits of a source.
pub const SOURCE_BITS: u8 = 3;
/// Bits of a condition.
pub const WHEN_BITS: u8 = 2;
/// Bits of an action.
pub const ACTION_BITS: u8 = 3;
/// Bits of an instruction.
pub const BITS: u8 = ACTION_BITS + WHEN_BITS + SOURCE_BITS + OPERAND_BITS;
/// Bits of a slot of a row.
pub const ROW_SLOT_BITS: u8 = 5;
/// Bits of a slot of no row.
pub const SLOT_BITS: u8 = 7;
/// Bits of how often an instruction goes back.
pub const TIMES_BITS: u8 = 5;

/// An operation with its operand as it is coded: a slot, with the row's bit in front, or a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Instruction {
    /// What it does.
    pub operation: Operation,
    /// With what.
    pub operand: u8,
}

impl Instruction {
    /// The instruction as a word of the program memory.
    pub fn code(self) -> u16 {
        let (source, when, action) = self.operation.fields();
        let fields = ((action as u16) << WHEN_BITS | when as u16) << SOURCE_BITS | source as u16;
        fields << OPERAND_BITS | u16::from(self.operand)
    }
}

impl Operation {
    /// Whether its operand is a word that it reads.
    pub fn reads(self) -> bool {
        use Operation::*;
        matches!(
            self,
            Load | LoadIf | Add | AddIf | Subtract | AtMost | AtLeast | Divide | Multiply | Test
        )
    }

    /// Its fields.
    pub fn fields(self) -> (Source, When, Action) {
        use {Action as A, Source as S, When as W};
        match self {
            Operation::Rest | Operation::Ask => (S::Word, W::Never, A::None),
            Operation::Load => (S::Word, W::Always, A::None),
            Operation::LoadIf => (S::Word, W::Flag, A::None),
            Operation::Add => (S::Sum, W::Always, A::None),
            Operation::AddIf => (S::Sum, W::Flag, A::None),
            Operation::Subtract => (S::Difference, W::Always, A::None),
            Operation::AtMost => (S::Word, W::Less, A::None),
            Operation::AtLeast => (S::Word, W::Less, A::Store),
            Operation::Divide => (S::Difference, W::Less, A::None),
            Operation::Store => (S::Word, W::Never, A::Store),
            Operation::Multiply => (S::Product, W::Always, A::None),
            Operation::Left => (S::Left, W::Always, A::None),
            Operation::Right => (S::Right, W::Always, A::None),
            Operation::Round => (S::Word, W::Never, A::Round),
            Operation::Negative => (S::Told, W::Always, A::None),
            Operation::Zero => (S::Told, W::Always, A::Store),
            Operation::Test => (S::Word, W::Never, A::Test),
            Operation::TestSum => (S::Word, W::Never, A::TestSum),
            Operation::TestNegative => (S::Word, W::Never, A::TestNegative),
            Operation::Take => (S::Given, W::Always, A::None),
            Operation::Give => (S::Word, W::Never, A::Give),
            Operation::End => (S::Told, W::Never, A::Give),
            Operation::Repeat => (S::Word, W::Never, A::Repeat),
            Operation::Again => (S::Told, W::Never, A::Repeat),
        }
    }
}
