// SPDX-License-Identifier: MIT OR Apache-2.0
//! Calibration: the numbers that make a core of a profile into the sensor of a device.
//!
//! It is made from points at which ratios and place are both known: a simulation of the device, or
//! a measurement. Numbers are in the core's own units: fractions of full scale, millimetres,
//! picofarads, newtons.

mod force;
mod layout;
mod least_squares;
mod position;

pub use force::{ForceTable, PastVoltage};
pub use layout::{Axis, Layout, Scalar, Surface};
pub use position::{Condition, Found, Point, PositionError, PositionTable, Real};

use crate::profile::{ForceLaw, Profile};
use hapticore_hdl::format::Format;

/// The calibration of a device.
///
/// ```
/// use hapticore_contract::calibration::{Calibration, ForceTable, Point, PositionTable};
/// use hapticore_contract::profile::Profile;
///
/// let profile = Profile::bundled("small")?;
/// // Ratios as they were read at 9 × 9 places of a sheet of 160 × 80 mm.
/// let place = |k: i32| (f64::from(k % 9 - 4) * 20.0, f64::from(k / 9 - 4) * 10.0);
/// let point = |(x, y)| Point { x, y, r_x: x / 100.0, r_y: y / 50.0, sheet: 0.05 };
/// let position = PositionTable::fit(&profile, &(0..81).map(place).map(point).collect::<Vec<_>>())?;
/// let force_table = ForceTable::default();
/// let (capacitance_gain, force_gain, contact_capacitance) = (800.0, 2e-6, 100.0);
/// let calibration =
///     Calibration { position, capacitance_gain, force_gain, contact_capacitance, force_table };
/// calibration.check(&profile)?;
///
/// let found = calibration.position.look_up(0.25f64, -0.4);
/// assert!((found.x - 25.0).abs() < 1e-5 && (found.y + 20.0).abs() < 1e-5 && (found.sheet - 0.05).abs() < 1e-9);
///
/// let too_large = Calibration { capacitance_gain: 1e9, ..calibration };
/// assert!(too_large.check(&profile).unwrap_err().to_string().starts_with("calibration capacitance gain: expected a number"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// Position and sheet resistance from ratios.
    pub position: PositionTable,
    /// Gain of the capacitance, pF at an admittance of 1.
    pub capacitance_gain: f64,
    /// Newtons per square picofarad at a haptic mean-square word of one.
    pub force_gain: f64,
    /// A pad of at most this capacitance, pF, is lifted; 0: only a pad without any.
    pub contact_capacitance: f64,
    /// What the force gain is multiplied by, for cores whose law is the table.
    pub force_table: ForceTable,
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
        let (name, format, value) =
            ("contact capacitance", f.capacitance, self.contact_capacitance);
        if format.code(value).is_none_or(|code| code == 0 && value != 0.0) {
            return Err(CalibrationError { name, format, value });
        }
        let mut words = self.words(profile).into_iter().skip(self.position.words.len());
        match words.find(|&word| f.table.code(word).is_none()) {
            Some(value) => Err(CalibrationError { name: "force table", format: f.table, value }),
            None => Ok(()),
        }
    }

    /// The words that a core of the profile receives through its table port, by address, as
    /// fractions: the position table, and behind it the force table where the law is one.
    pub fn words(&self, profile: &Profile) -> Vec<f64> {
        let force = (profile.force.law == ForceLaw::Table).then(|| self.force_table.words());
        self.position.words.iter().copied().chain(force.into_iter().flatten()).collect()
    }
}
