// SPDX-License-Identifier: MIT OR Apache-2.0
//! The force loop of a scene: its controller in the core's units, and the core and controller that
//! close it.

pub mod bode;
pub mod closed;
mod gains;
pub mod plant;
pub mod prediction;
pub mod stability;
mod tuning;

pub use gains::Gains;
pub use tuning::{controlled, tuning};
