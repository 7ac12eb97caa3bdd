// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which entries of a raster meet in an equation.

/// The largest distance, in columns and in rows, of two entries that meet in an equation.
pub const REACH: usize = 2;

/// Columns, and rows, about an entry that it may meet.
pub const NEAR: usize = 2 * REACH + 1;

/// The coefficients of an entry with those about it: row by row, its own in the middle.
pub type Near = [[f64; NEAR]; NEAR];
