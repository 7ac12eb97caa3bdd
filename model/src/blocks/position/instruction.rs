// SPDX-License-Identifier: MIT OR Apache-2.0
//! Instructions of the position's arithmetic unit, and their codes.
//!
//! ```text
//! bit   15 … 12     11, 10   9 … 3   2 … 0
//!       operation   index    slot    option           Load, Multiply, Store, Input
//!       operation   –        value   option           Set
//!       operation   –        target (bits 7 … 0)      Surfaces, Repeat, Pass, Found
//! ```

/// What an instruction does. `left` is the multiplier's left operand, `slot` a word of the scratch
/// memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operation {
    /// left ← slot.
    Load,
    /// left ← slot, without its fraction of a cell.
    LoadCell,
    /// left ← the digits of a quotient.
    LoadQuotient,
    /// sum ← sum + left · slot.
    Multiply,
    /// sum ← sum + table[base + option] · slot.
    MultiplyTable,
    /// A quotient digit is set where sum ≥ 0; left ← slot, or the one after it where sum < 0.
    LoadDigit,
    /// slot ← sum, rounded and saturated, or with [`WRAP`] not saturated; [`CHECK`] compares it
    /// with the tolerance, [`OPEN`] with zero; sum ← 0.
    Store,
    /// base ← sum, as an integer.
    Base,
    /// slot ← half of the surface's ratio, or with [`SHARE`] of the least current's share; with
    /// [`LOW`] what rounding left.
    Input,
    /// x, y or R, by the surface ← sum; sum ← 0.
    Output,
    /// With [`COUNT`] the counter takes the value, with [`SURFACE`] the surface is that of r_x,
    /// with [`SCALARS`] base ← the surface's scalars.
    Set,
    /// Where the counter is not zero: one less, and on at the target.
    Repeat,
    /// For the surface of r_x: that of r_y follows, and on at the target; after that of r_y again
    /// that of r_x, or R when found.
    Surfaces,
    /// One step more; on at the target while there are steps left.
    Pass,
    /// On at the target when all steps are done.
    Found,
    /// The last instruction.
    End,
}

impl Operation {
    /// Those that wait until all products are in the sum.
    pub const WAITING: [Operation; 5] = [
        Operation::Base,
        Operation::LoadDigit,
        Operation::LoadQuotient,
        Operation::Output,
        Operation::Store,
    ];

    /// The name of the signal that says it is this one.
    pub const fn name(self) -> &'static str {
        use Operation::*;
        match self {
            Load => "is_load",
            LoadCell => "is_load_cell",
            LoadQuotient => "is_load_quotient",
            Multiply => "is_multiply",
            MultiplyTable => "is_multiply_table",
            LoadDigit => "is_load_digit",
            Store => "is_store",
            Base => "is_base",
            Input => "is_input",
            Output => "is_output",
            Set => "is_set",
            Repeat => "is_repeat",
            Surfaces => "is_surfaces",
            Pass => "is_pass",
            Found => "is_found",
            End => "is_end",
        }
    }
}

/// Which word of a group of slots an instruction means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Index {
    /// The slot itself.
    None,
    /// By the surface or axis.
    Surface,
    /// By the counter.
    Counter,
    /// By the surface or axis, pairs.
    SurfacePair,
}

/// Options of [`Operation::Store`].
pub const WRAP: u8 = 1;
/// Option of [`Operation::Store`]: compare the residual with the tolerance.
pub const CHECK: u8 = 2;
/// Option of [`Operation::Store`]: compare the sum with zero; tells an open terminal.
pub const OPEN: u8 = 4;
/// Options of [`Operation::Input`].
pub const LOW: u8 = 1;
/// Option of [`Operation::Input`]: the smallest share of the currents.
pub const SHARE: u8 = 2;
/// Options of [`Operation::Set`].
pub const COUNT: u8 = 1;
/// Option of [`Operation::Set`]: select the surface of r_x.
pub const SURFACE: u8 = 2;
/// Option of [`Operation::Set`]: base ← the surface's scalars.
pub const SCALARS: u8 = 4;

/// Widths of the fields.
pub const OPERATION_BITS: u8 = 4;
/// Bits of an instruction's slot field.
pub const SLOT_BITS: u8 = 7;
/// Bits of an instruction's option field.
pub const OPTION_BITS: u8 = 3;
/// Bits of a target.
pub const TARGET_BITS: u8 = 8;
/// Bits of an instruction.
pub const BITS: u8 = OPERATION_BITS + 2 + SLOT_BITS + OPTION_BITS;

/// A group of words of the scratch memory, or one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Slot(pub u8, pub Index);

impl Slot {
    /// The word of the surface, or of the axis.
    pub const fn of_surface(self) -> Slot {
        Slot(self.0, Index::Surface)
    }

    /// The word of the counter.
    pub const fn of_counter(self) -> Slot {
        Slot(self.0, Index::Counter)
    }

    /// The first or second word of the surface's pair.
    pub const fn of_pair(self, second: u8) -> Slot {
        Slot(self.0 + second, Index::SurfacePair)
    }

    /// A word of the group.
    pub const fn word(self, index: u8) -> Slot {
        Slot(self.0 + index, Index::None)
    }
}

/// An instruction of the position program: operation, slot and option.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Instruction {
    /// What it does.
    pub operation: Operation,
    /// With which word.
    pub slot: Slot,
    /// Variant of the operation.
    pub option: u8,
    /// Where it goes on, for those that jump.
    pub target: u8,
}

impl Instruction {
    /// The instruction as a word of the program memory.
    pub fn code(&self) -> u16 {
        let operation = (self.operation as u16) << (BITS - OPERATION_BITS);
        let index = (self.slot.1 as u16) << (SLOT_BITS + OPTION_BITS);
        operation
            | index
            | u16::from(self.slot.0) << OPTION_BITS
            | u16::from(self.option)
            | u16::from(self.target)
    }

    /// Whether it waits until all products are in the sum.
    pub fn waits(&self) -> bool {
        Operation::WAITING.contains(&self.operation)
    }
}
