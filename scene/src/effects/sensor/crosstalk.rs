// SPDX-License-Identifier: MIT OR Apache-2.0
//! `sensor.crosstalk_percent`: each current channel gets so much of its neighbours' currents, in the order of the terminals.
//! −60 dB between channels is 0.1 %.

use std::ops::{Add, Mul};

use super::super::{ChannelEffect, Effect, Pad, Phasors, Run, Setting, Spec};
use crate::device::{CHANNELS, Device, TERMINALS};
use crate::error::SceneError;
use crate::format::{Limits, Table};

pub(in super::super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(percent) = super::key(root, "crosstalk_percent", Limits::within(0.0, 50.0))? else { return Ok(None) };
    let build = move |_: &Setting| Effect::Channels(Box::new(Crosstalk(percent / 100.0)));
    Ok(Spec::new("sensor.crosstalk", format!("{percent} %"), build))
}

struct Crosstalk(f64);

impl Crosstalk {
    fn mix<T: Copy + Add<Output = T> + Mul<f64, Output = T>>(&self, channels: &mut [T]) {
        let own: [T; TERMINALS] = std::array::from_fn(|n| channels[n]);
        for n in 0..TERMINALS {
            let neighbours = [n.checked_sub(1), (n + 1 < TERMINALS).then_some(n + 1)];
            channels[n] = neighbours.into_iter().flatten().fold(own[n], |sum, other| sum + own[other] * self.0);
        }
    }
}

impl ChannelEffect for Crosstalk {
    fn phasors(&mut self, _: &Pad, phasors: &mut Phasors) {
        self.mix(&mut phasors.carrier);
    }

    fn samples(&mut self, _: &Pad, _: &Run, rows: &mut [[f64; CHANNELS]]) {
        rows.iter_mut().for_each(|row| self.mix(row));
    }
}
