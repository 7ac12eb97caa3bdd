// SPDX-License-Identifier: MIT OR Apache-2.0
//! Both laws of the force on a core's words, whichever the core has: for comparison.

use hapticore_contract::calibration::{Calibration, PastVoltage};
use hapticore_contract::frame::Measurement;
use hapticore_contract::profile::Profile;

/// The force of a frame by either law, N.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Laws {
    /// By eq. 8.
    pub eq8_n: f64,
    /// By the force table of the calibration.
    pub table_n: f64,
}

/// From capacitance and mean square of each pad's frames, one after the other, to both forces.
///
/// ```
/// use hapticore_host::{DeviceCalibration, Flags, ForceLaws, Frame, Profile};
///
/// let device = DeviceCalibration::read("recordings/hockey.calibration.toml".as_ref())?;
/// let profile = device.profile(&Profile::bundled("standard")?)?;
/// let mut laws = ForceLaws::new(&profile, &device.for_profile(&profile)?);
/// let frame = Frame { pad: 0, codes: [0, 0, 0, 0, 0, 400 << 13, 0, 1 << 20], flags: Flags::default() };
/// let forces = laws.forces(&frame.measurement(&profile));
/// assert!(forces.eq8_n > 0.0 && forces.table_n == forces.eq8_n, "no table: eq. 8");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct ForceLaws {
    calibration: Calibration,
    past: Vec<PastVoltage>,
}

impl ForceLaws {
    /// Of a core of the profile with a calibration, before its first frame.
    pub fn new(profile: &Profile, calibration: &Calibration) -> Self {
        let past = vec![PastVoltage::default(); profile.pads as usize];
        ForceLaws { calibration: calibration.clone(), past }
    }

    /// The forces of a pad's next frame.
    ///
    /// # Panics
    /// Where there is no such pad.
    pub fn forces(&mut self, measurement: &Measurement) -> Laws {
        let Measurement { pad, capacitance_pf, mean_square, .. } = *measurement;
        let table = &self.calibration.force_table;
        self.past[pad].follow(table, mean_square.sqrt());
        let eq8_n = self.calibration.force_gain * capacitance_pf.powi(2) * mean_square;
        Laws { eq8_n, table_n: eq8_n * table.factor(capacitance_pf, self.past[pad]) }
    }
}
