// SPDX-License-Identifier: MIT OR Apache-2.0
//! The potential of a uniform resistive sheet, in SI units and `f64`: how it splits the current of
//! a pad among its terminals, and what pads on it do to each other. The simulation of devices and
//! the host of a real one both use it.
//!
//! | module | holds |
//! | --- | --- |
//! | [`uniform`] | the sheet: its size, its film, its terminals |
//! | [`analytic`] | the exact split of a current, and the potential between two places |
//! | [`coupling`] | the currents of several pads together |
//! | [`model`] | what a host takes crosstalk out by |
//! | [`ratios`] | the ratios of the terminals' currents that a position is found from |
//! | [`neumann`] | Neumann function of the rectangle |
//! | [`linear`], [`few`] | small dense systems; a few values in place |

pub mod analytic;
pub mod coupling;
pub mod few;
pub mod linear;
pub mod model;
pub mod neumann;
pub mod ratios;
pub mod uniform;

pub use analytic::{Analytic, Source};
pub use few::Few;
pub use model::{NominalSheet, PadEstimate, SheetModel};
pub use ratios::Ratios;
pub use uniform::UniformSheet;

/// The fewest terminals of a sheet: two ratios need three currents.
pub const LEAST_TERMINALS: usize = 3;

/// The most terminals of a sheet.
pub const MOST_TERMINALS: usize = 16;
