// SPDX-License-Identifier: MIT OR Apache-2.0
//! `sensor.haptic_leakage_of_others`: in a pad's slot the other pads still carry their haptic
//! voltages, whose currents flow into the same terminals. Four pads in a corner drive them beyond
//! the ADC's range, where the selected pad alone does not (docs/physics.md §7).
//!
//! All haptic voltages are taken as in phase, as from one source.

use std::f64::consts::{SQRT_2, TAU};

use num_complex::Complex64;

use super::super::effect::{Effect, PadsEffect};
use super::super::pad::Pad;
use super::super::spec::{Setting, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::Table;
use crate::terminals::PerTerminal;

pub(in super::super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("sensor")? else { return Ok(None) };
    if !table.get(&super::HAPTIC_LEAKAGE_OF_OTHERS)? {
        return Ok(None);
    }
    if !table.get(&super::HAPTIC_LEAKAGE)? {
        let message =
            "expected haptic_leakage = true too, since the pad's own current is the first";
        return Err(table.error("haptic_leakage_of_others", message));
    }
    let build =
        |setting: &Setting| Effect::Pads(Box::new(Others { device: setting.device.clone() }));
    Ok(Spec::new("sensor.others", "steady state", build))
}

struct Others {
    device: Device,
}

impl PadsEffect for Others {
    fn act(&mut self, pad: &mut Pad, others: &[Pad]) {
        let rad_s = TAU * self.device.haptic_hz;
        let current = |other: &Pad, terminal: usize| {
            other.split[terminal] * other.admittance(rad_s) * (SQRT_2 * other.haptic_v_rms)
        };
        let into = |terminal: usize| others.iter().map(|other| current(other, terminal)).sum();
        let currents: PerTerminal<Complex64> = (0..pad.split.len()).map(into).collect();
        pad.leakage_of_others_a = Some(currents);
    }
}
