// SPDX-License-Identifier: MIT OR Apache-2.0
//! `sensor.bandwidth_khz`: the current sensors are low-passes of first order, 1/(1 + jf/f_b), which
//! makes the carrier smaller and later: by 5 % and 18° where f_b is three times the carrier. In
//! steady state, as the carrier itself; the haptic current is a hundred times slower and passes.

use num_complex::Complex64;

use super::super::effect::{ChannelEffect, Effect, Phasors, Run};
use super::super::pad::Pad;
use super::super::spec::{Setting, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::Table;
use crate::rotor::Rotor;

pub(in super::super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(khz) = super::key(root, &super::BANDWIDTH_KHZ)? else {
        return Ok(None);
    };
    let build = move |setting: &Setting| {
        let device = setting.device.clone();
        let passes = 1.0 / Complex64::new(1.0, device.carrier_hz / (1e3 * khz));
        let turns_per_sample = 1.0 / setting.timing.samples_per_period;
        Effect::Channels(Box::new(Bandwidth { device, passes, turns_per_sample }))
    };
    Ok(Spec::new("sensor.bandwidth", format!("{khz} kHz"), build))
}

struct Bandwidth {
    device: Device,
    /// What is left of the carrier.
    passes: Complex64,
    turns_per_sample: f64,
}

impl ChannelEffect for Bandwidth {
    fn phasors(&mut self, _: &Pad, phasors: &mut Phasors) {
        phasors.terminals().iter_mut().for_each(|phasor| *phasor *= self.passes);
    }

    fn samples(&mut self, pad: &Pad, run: &Run, samples: &mut [f64]) {
        let change =
            (self.passes - 1.0) * (self.device.carrier_v / self.device.current_full_scale_a);
        let change = pad.transfer(&self.device).map(|siemens| siemens * change).padded();
        let mut carrier =
            Rotor::new(self.turns_per_sample * run.range.start as f64, self.turns_per_sample);
        run.rows(samples, |row| {
            let now = carrier.turn();
            let terminals = Run::terminals(row).iter_mut();
            terminals.zip(&change).for_each(|(sample, change)| *sample += (change * now).re);
        });
    }
}
