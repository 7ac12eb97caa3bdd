// SPDX-License-Identifier: MIT OR Apache-2.0
//! The plant in SI units and `f64`: sheet, gap, friction, carrier and sensor chain, each an opt-in effect, and the scenes
//! that say what is done with it.
//!
//! | module | what it is |
//! | --- | --- |
//! | [`Scene`] | a scene file, read and checked: cases, pads, criteria |
//! | [`Plant`] | one case at work: truth, phasors and ADC samples, slot by slot |
//! | [`Device`] | what the builder of the device knows of it |
//! | [`gallery`] | the bundled scenes |
//!
//! The plant knows no bit widths of the core and writes no file.

mod budget;
mod case;
mod course;
mod criterion;
mod device;
mod effects;
mod error;
mod few;
mod format;
pub mod gallery;
mod nominal;
mod pad;
mod path;
mod plant;
mod quantity;
mod random;
mod ratios;
mod rotor;
mod scene;
mod terminals;
mod timing;
mod truth;
mod variant;

pub use budget::RungError;
pub use case::Case;
pub use criterion::{Criterion, Measure, Per, Where};
pub use device::Device;
pub use effects::EffectCost;
pub use error::{Place, SceneError};
pub use nominal::NominalSheet;
pub use num_complex::Complex64 as Complex;
pub use plant::Plant;
pub use quantity::Quantity;
pub use ratios::signs_by_place;
pub use scene::{Figure, Record, Scene};
pub use terminals::{LEAST_TERMINALS, MOST_TERMINALS};
pub use timing::Timing;
pub use truth::{ForcePoint, MapPoint, PadReading, Setpoint, Truth};
