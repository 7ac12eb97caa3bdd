// SPDX-License-Identifier: MIT OR Apache-2.0
//! `sensor.offset_percent`: each ADC channel's constant offset, drawn with the seed. A demodulator
//! over whole periods does not see it; the mean square of the haptic voltage does.

use super::super::effect::{ChannelEffect, Effect, Phasors, Run};
use super::super::pad::Pad;
use super::super::spec::{Setting, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::Table;
use crate::random::{Purpose, normals};
use crate::terminals::MOST_CHANNELS;

pub(in super::super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(percent) = super::key(root, &super::OFFSET_PERCENT)? else {
        return Ok(None);
    };
    let build = move |setting: &Setting| Effect::Channels(Box::new(Offset::new(percent, setting)));
    Ok(Spec::new("sensor.offset", format!("{percent} %"), build))
}

struct Offset {
    /// Offset of each channel, fraction of full scale.
    offsets: [f64; MOST_CHANNELS],
    /// The haptic channel.
    haptic: usize,
}

impl Offset {
    fn new(percent: f64, setting: &Setting) -> Self {
        let mut offsets = [0.0; MOST_CHANNELS];
        for (offset, normal) in offsets.iter_mut().zip(normals(setting.seed, Purpose::Offset)) {
            *offset = percent / 100.0 * normal;
        }
        Offset { offsets, haptic: setting.device.haptic() }
    }
}

impl ChannelEffect for Offset {
    fn phasors(&mut self, _: &Pad, phasors: &mut Phasors) {
        phasors.haptic_mean_square += self.offsets[self.haptic].powi(2);
    }

    fn samples(&mut self, _: &Pad, run: &Run, samples: &mut [f64]) {
        run.rows(samples, |row| {
            row.iter_mut().zip(&self.offsets).for_each(|(sample, offset)| *sample += offset);
        });
    }
}
