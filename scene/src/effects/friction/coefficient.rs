// SPDX-License-Identifier: MIT OR Apache-2.0
//! The coefficient of friction: `device.mu`, which a device is calibrated with, and what becomes of
//! it as surfaces wear, warm and take up moisture.
//!
//!   μ(t) = μ·drift(t)
//!
//! The truth is of μ(t): force and friction. ± 20 % is ± 0.14 N at 0.7 N (docs/physics.md §4).

use crate::device::Device;
use crate::error::SceneError;
use crate::format::{Key, Limits, Table, keys};
use crate::stimulus::{Moment, Stimulus};

keys! { KEYS:
    /// Factor of `device.mu` over time: wear, warmth, moisture.
    DRIFT: Option<Stimulus> = Key::over_time("drift", Limits::within(0.0, 100.0)).usually("1");
}

/// μ over time.
#[derive(Clone, Debug)]
pub(super) struct Coefficient {
    pub nominal: f64,
    drift: Option<Stimulus>,
}

impl Coefficient {
    /// Reads `friction.drift`.
    pub fn read(table: &Table, device: &Device) -> Result<Coefficient, SceneError> {
        let drift = table.get(&DRIFT)?;
        match drift.as_ref().is_none_or(|drift| drift.points() == 1) {
            true => Ok(Coefficient { nominal: device.mu, drift }),
            false => Err(table.error(
                "drift",
                "expected a factor over time, not a sweep; a case can set another",
            )),
        }
    }

    /// At a time.
    #[inline]
    pub fn at(&self, time_s: f64) -> f64 {
        let at = |drift: &Stimulus| self.nominal * drift.at(0, Moment::at(time_s));
        self.drift.as_ref().map_or(self.nominal, at)
    }

    /// The same in the last moment before a time.
    pub fn before(&self, time_s: f64) -> f64 {
        let at = |drift: &Stimulus| self.nominal * drift.at(0, Moment::before(time_s));
        self.drift.as_ref().map_or(self.nominal, at)
    }

    /// When it next steps or turns.
    pub fn next_event_s(&self, after_s: f64) -> f64 {
        self.drift.as_ref().map_or(f64::INFINITY, |drift| drift.next_event_s(after_s))
    }
}
