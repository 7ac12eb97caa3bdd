// SPDX-License-Identifier: MIT OR Apache-2.0
//! Boards: the core's peripherals as blocks like its own, and what stands between them and the pins
//! of a real board.
//!
//! | module | does |
//! | --- | --- |
//! | [`whole`] | the board: core and peripherals, its ports the pins |
//! | [`adc_reader`] | eight channels of a simultaneous ADC, in |
//! | [`line_test`] | the test of the ADC's data lines, one at a time |
//! | [`sigma_delta`] | the carrier, out |
//! | [`pads`] | one pad at a time, out |
//! | [`drive_output`] | drive words of a force loop, out through converters |
//! | [`uart`], [`crc32`], [`framing`] | the serial line and its packets; the host's side of it is `hapticore-host` |
//! | [`stream`] | frames, out |
//! | [`registers`] | calibration, in |
//! | [`drive_registers`] | settings, targets and walls of a force loop, in |
//! | [`parameters`] | what a board adds to a profile |
//! | [`target`] | the boards that one can buy |
//! | `top`, `printing` | tops in rust-hdl, pins, constraints; with the feature `boards` alone, since rust-hdl comes with it |

pub mod adc_reader;
mod bits;
pub mod crc32;
pub mod drive_output;
pub mod drive_registers;
pub mod framing;
pub mod line_test;
pub mod pads;
pub mod parameters;
#[cfg(feature = "boards")]
mod printing;
pub mod registers;
pub mod sigma_delta;
pub mod stream;
pub mod target;
#[cfg(feature = "boards")]
pub mod top;
pub mod uart;
pub mod whole;

pub use parameters::{Parameters, ParametersError};
pub use target::{Target, TargetError};
pub use whole::Board;
