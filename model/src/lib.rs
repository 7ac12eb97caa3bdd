// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sensing core, written once and read many ways.

pub mod format;
pub mod probe;
