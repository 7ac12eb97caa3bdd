// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sensing core, written once and read many ways.

pub mod block;
pub mod blocks;
pub mod bundle;
mod check;
mod declaration;
pub mod fidelity;
pub mod interpretations;
pub mod memory;
pub mod probe;
pub mod proof;
pub mod signal;
pub mod states;

pub use check::{check, least_clocks_per_sample, parse_profile};
pub use hapticore_contract::{calibration, frame, profile};
pub use hapticore_hdl::format;
