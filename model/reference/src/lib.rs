// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core's results from the equations alone: what every core is compared with.
//!
//! | module | a result is | compare with |
//! | --- | --- | --- |
//! | [`Reference`] | the equation in floating point: `f64`, or any [`Real`] | any core: the difference is what word lengths cost |
//! | [`wall`] | direction of push and walls, frame by frame, in `f64` | the wall's block: the difference is what word lengths cost |
//! | [`rounded`] | the exact value, rounded where and how the blocks' docs say | the clocked core: equal to the bit |
//!
//! Absent: the core. This crate depends on the contract alone (profiles, frames, calibrations,
//! number formats). It can share no line with a block or with the signals of the hardware language:
//! its rounding, roots, division, tables and sums are its own.
//!
//! What `f64` rounds is itself measured: [`Reference::with_precision`] takes a type with more bits,
//! and `cargo run --release -p hapticore-tests --example reference_error` prints the difference on
//! every quantity of every bundled scene beside a derived bound.
//!
//! Units are those of the contract: fractions of full scale, mm, pF, N. A slot of one pad, from
//! phasors:
//!
//! ```
//! use hapticore_contract::calibration::{Calibration, ForceTable, Point, PositionTable};
//! use hapticore_contract::profile::Profile;
//! use hapticore_reference::Reference;
//!
//! let profile = Profile::bundled("standard")?;
//! let place = |k: i32| (f64::from(k % 9 - 4) * 20.0, f64::from(k / 9 - 4) * 10.0);
//! let point = |(x, y)| Point { x, y, r_x: x / 100.0, r_y: y / 50.0, sheet: 0.0 };
//! let position = PositionTable::fit(&profile, &(0..81).map(place).map(point).collect::<Vec<_>>())?;
//! let force_table = ForceTable::default();
//! let (capacitance_gain, force_gain, contact_capacitance) = (800.0, 2e-6, 100.0);
//! let calibration =
//!     Calibration { position, capacitance_gain, force_gain, contact_capacitance, force_table };
//! let mut reference = Reference::new(&profile, &calibration);
//!
//! // The same current at all six terminals, a tenth of full scale; the sensing voltage at half of it.
//! let mut phasors = [(0.0, 0.1); 7];
//! phasors[6] = (0.5, 0.0);
//! let measurement = reference.phasors(0, &phasors, 0.125);
//!
//! assert_eq!((measurement.r_x, measurement.r_y), (0.0, 0.0), "a pad in the middle");
//! assert!((measurement.capacitance_pf - 800.0 * 0.6 / 0.5).abs() < 1e-9, "gain · total current / voltage");
//! let force = 2e-6 * measurement.capacitance_pf.powi(2) * measurement.mean_square;
//! assert!((measurement.force_n - force).abs() < 1e-12, "eq. 8");
//! assert!(!measurement.flags.invalid);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod control;
mod ideal;
pub mod rounded;
pub mod wall;

pub use ideal::{Real, Reference};
