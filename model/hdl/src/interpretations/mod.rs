// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a block means: the interpretations of its values, memories and instances.

mod clocked;
pub mod netlist;
pub mod noise;
pub mod range;
pub mod real;
pub mod shadow;

pub use clocked::Codes;
