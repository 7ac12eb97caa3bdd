// SPDX-License-Identifier: MIT OR Apache-2.0
//! `sensor.gain_error_percent`: all current sensors' gain is off by the same, so that capacitances
//! are off by as much and forces by twice that; positions do not see it.

use super::super::effect::{ChannelEffect, Effect, Phasors, Run};
use super::super::pad::Pad;
use super::super::spec::{Setting, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::Table;

pub(in super::super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(percent) = super::key(root, &super::GAIN_ERROR_PERCENT)? else {
        return Ok(None);
    };
    let build = move |_: &Setting| Effect::Channels(Box::new(Scale(1.0 + percent / 100.0)));
    Ok(Spec::new("sensor.scale", format!("{percent} %"), build))
}

struct Scale(f64);

impl ChannelEffect for Scale {
    fn phasors(&mut self, _: &Pad, phasors: &mut Phasors) {
        phasors.terminals().iter_mut().for_each(|phasor| *phasor *= self.0);
    }

    fn samples(&mut self, _: &Pad, run: &Run, samples: &mut [f64]) {
        run.rows(samples, |row| {
            Run::terminals(row).iter_mut().for_each(|sample| *sample *= self.0)
        });
    }
}
