// SPDX-License-Identifier: MIT OR Apache-2.0
//! The independent reference: the core's results from the equations alone.
//!
//! | reference | a result is | compare with |
//! | --- | --- | --- |
//! | [`Reference`] | the equation in `f64` | any core: the difference is what word lengths cost |
//! | [`rounded`] | the exact value, rounded where and how the blocks' docs say | the clocked model: equal to the bit |
//!
//! Absent: signals, clocks, registers, and any code of the blocks. Profiles and calibrations are read as numbers; a format's
//! fields say where a word's point and rails lie, and rounding is written anew.

mod ideal;
pub mod rounded;

pub use ideal::{Real, Reference};
