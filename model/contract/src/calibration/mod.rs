// SPDX-License-Identifier: MIT OR Apache-2.0
//! Calibration: the numbers that make a core of a profile into the sensor of a device.
//!
//! It is made from points at which ratios and place are both known: a simulation of the device, or a measurement. Numbers
//! are in the core's own units: fractions of full scale, millimetres, picofarads, newtons.

mod layout;
mod least_squares;
mod position;

pub use layout::{Axis, Layout, Scalar, Surface};
pub use position::{Condition, Found, Point, PositionError, PositionTable, Real};

use crate::profile::Profile;
use hapticore_hdl::format::Format;

/// The calibration of a device.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// Position and sheet resistance from ratios.
    pub position: PositionTable,
    /// Picofarads at an admittance of one.
    pub capacitance_gain: f64,
    /// Newtons per square picofarad at a haptic mean-square word of one.
    pub force_gain: f64,
}

/// A number that a core of the profile cannot be given.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("calibration {name}: expected a number that {format} holds, got {value}")]
pub struct CalibrationError {
    name: &'static str,
    format: Format,
    value: f64,
}

impl Calibration {
    /// Whether a core of the profile can be given all of it.
    ///
    /// # Errors
    /// The first number that its format does not hold, or holds as zero.
    pub fn check(&self, profile: &Profile) -> Result<(), CalibrationError> {
        let f = &profile.formats;
        for (name, format, value) in [
            ("capacitance gain", f.capacitance_gain, self.capacitance_gain),
            ("force gain", f.force_gain, self.force_gain),
        ] {
            if format.code(value).is_none_or(|code| code == 0) {
                return Err(CalibrationError { name, format, value });
            }
        }
        Ok(())
    }
}
