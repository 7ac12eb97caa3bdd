// SPDX-License-Identifier: MIT OR Apache-2.0
//! `sensor.series_inductance_mh`: what lies between the place where the sensing voltage is measured
//! and the pad: the winding that adds it, and a cable. In series with the pad's capacitance it
//! makes the current larger, the more so the larger the capacitance: 0.1 mH shifts the force by 3.5 %
//! between 318 and 760 pF (docs/physics.md §7). The haptic current is too slow to see it.

use num_complex::Complex64;

use super::super::effect::{Effect, PadEffect};
use super::super::pad::Pad;
use super::super::spec::{Setting, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::Table;

pub(in super::super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(mh) = super::key(root, &super::SERIES_INDUCTANCE_MH)? else {
        return Ok(None);
    };
    let build = move |setting: &Setting| {
        let ohm = Complex64::new(0.0, setting.device.carrier_rad_s * 1e-3 * mh);
        Effect::Pad(Box::new(Inductance { ohm }))
    };
    Ok(Spec::new("sensor.inductance", format!("{mh} mH"), build))
}

struct Inductance {
    /// At the carrier.
    ohm: Complex64,
}

impl PadEffect for Inductance {
    fn act(&mut self, pad: &mut Pad) {
        pad.sheet_ohm += self.ohm;
    }

    /// A calibration measures the voltage at the pad.
    fn settle(&mut self, _: &mut Pad) {}
}
