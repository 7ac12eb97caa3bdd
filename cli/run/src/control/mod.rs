// SPDX-License-Identifier: MIT OR Apache-2.0
//! The force loop of a scene: its controller in the core's units, and the core and controller that
//! close it.

pub mod bode;
pub mod closed;
pub mod plant;
pub mod stability;
mod tuning;

pub use tuning::{controlled, tuning};
