// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hardware language.

pub mod format;
