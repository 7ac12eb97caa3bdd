// SPDX-License-Identifier: MIT OR Apache-2.0
//! `sensor.quantisation_bits`: samples become codes of this many bits, full scale ±1, half to even,
//! clipped at full scale. Amplitudes stay exact: quantisation is a matter of samples.

use super::super::effect::{ChannelEffect, Effect, Phasors, Run};
use super::super::pad::Pad;
use super::super::spec::{Setting, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::Table;

/// Adding and taking away 1.5·2^52 rounds an f64 of up to 2^51 to an integer, half to even, in two
/// additions.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

pub(in super::super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(codes) = codes(root)? else { return Ok(None) };
    let bits = codes.log2() + 1.0;
    let build = move |_: &Setting| Effect::Channels(Box::new(Quantisation { codes }));
    Ok(Spec::new("sensor.quantisation", format!("{bits} bit"), build))
}

/// Codes per full scale, where there are codes.
pub(super) fn codes(root: &Table) -> Result<Option<f64>, SceneError> {
    let bits =
        root.table("sensor")?.map_or(Ok(None), |table| table.get(&super::QUANTISATION_BITS))?;
    Ok(bits.map(|bits| (1u64 << (bits - 1)) as f64))
}

struct Quantisation {
    /// Codes per full scale.
    codes: f64,
}

impl ChannelEffect for Quantisation {
    fn phasors(&mut self, _: &Pad, _: &mut Phasors) {}

    fn clips(&self) -> bool {
        true
    }

    fn samples(&mut self, _: &Pad, _: &Run, samples: &mut [f64]) {
        let (codes, step) = (self.codes, 1.0 / self.codes);
        for sample in samples {
            let code = (*sample * codes + ROUNDER) - ROUNDER;
            *sample = code.clamp(-codes, codes - 1.0) * step;
        }
    }
}
