// SPDX-License-Identifier: MIT OR Apache-2.0
//! `sensor.crosstalk_percent`: each current channel gets so much of its neighbours' currents, in
//! the order of the terminals. −60 dB between channels is 0.1 %.

use std::ops::{Add, Mul};

use super::super::effect::{ChannelEffect, Effect, Phasors, Run};
use super::super::pad::Pad;
use super::super::spec::{Setting, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::Table;

pub(in super::super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(percent) = super::key(root, &super::CROSSTALK_PERCENT)? else {
        return Ok(None);
    };
    let build = move |_: &Setting| Effect::Channels(Box::new(Crosstalk(percent / 100.0)));
    Ok(Spec::new("sensor.crosstalk", format!("{percent} %"), build))
}

struct Crosstalk(f64);

impl Crosstalk {
    fn mix<T: Copy + Add<Output = T> + Mul<f64, Output = T>>(&self, terminals: &mut [T]) {
        let mut before = None;
        for n in 0..terminals.len() {
            let own = terminals[n];
            let neighbours = [before, terminals.get(n + 1).copied()];
            terminals[n] =
                neighbours.into_iter().flatten().fold(own, |sum, other| sum + other * self.0);
            before = Some(own);
        }
    }
}

impl ChannelEffect for Crosstalk {
    fn phasors(&mut self, _: &Pad, phasors: &mut Phasors) {
        self.mix(phasors.terminals());
    }

    fn samples(&mut self, _: &Pad, run: &Run, samples: &mut [f64]) {
        run.rows(samples, |row| self.mix(Run::terminals(row)));
    }
}
