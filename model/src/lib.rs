// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sensing core, written once and read many ways.

pub mod block;
pub mod blocks;
pub mod bundle;
pub mod calibration;
mod declaration;
pub mod fidelity;
pub mod format;
pub mod frame;
pub mod interpretations;
pub mod memory;
pub mod probe;
pub mod profile;
pub mod proof;
pub mod reference;
pub mod signal;
pub mod states;
