// SPDX-License-Identifier: MIT OR Apache-2.0
//! `sensor.gain_mismatch_percent`: each current sensor's gain is off by its own constant factor,
//! drawn with the seed. 1 % costs 0.31 % rms of force over the map (docs/physics.md §5).

use super::super::effect::{ChannelEffect, Effect, Phasors, Run};
use super::super::pad::Pad;
use super::super::spec::{Setting, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::Table;
use crate::random::{Purpose, normals};
use crate::terminals::PerTerminal;

pub(in super::super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(percent) = super::key(root, &super::GAIN_MISMATCH_PERCENT)? else {
        return Ok(None);
    };
    Ok(Spec::new("sensor.gain", format!("{percent} %"), move |setting| {
        Effect::Channels(Box::new(Gain::new(percent, setting)))
    }))
}

/// Factors of the terminals.
struct Gain(PerTerminal<f64>);

impl Gain {
    fn new(percent: f64, setting: &Setting) -> Self {
        let normals = normals(setting.seed, Purpose::Gain).take(setting.device.terminals());
        Gain(normals.map(|normal| 1.0 + percent / 100.0 * normal).collect())
    }
}

impl ChannelEffect for Gain {
    fn phasors(&mut self, _: &Pad, phasors: &mut Phasors) {
        phasors.terminals().iter_mut().zip(self.0).for_each(|(phasor, gain)| *phasor *= gain);
    }

    fn samples(&mut self, _: &Pad, run: &Run, samples: &mut [f64]) {
        let gains = self.0.padded();
        run.rows(samples, |row| {
            Run::terminals(row).iter_mut().zip(&gains).for_each(|(sample, gain)| *sample *= gain);
        });
    }
}
