// SPDX-License-Identifier: MIT OR Apache-2.0
//! `sensor.noise_ppm_rms`: white Gaussian noise on every channel, in millionths of full scale per sample.
//!
//! 18 ppm is an AD7606C-16 (92 dB below a full-scale sine). A run's noise follows from seed, case, slot and first sample
//! alone, so that leaving one run out changes no other. Amplitudes get what a Hann window over the slot's N samples
//! passes: σ·√(2·1.5/N) in each of both parts.

use rand_distr::{Distribution, StandardNormal};

use super::super::{ChannelEffect, Effect, Pad, Phasors, Run, Setting, Spec};
use crate::device::{CHANNELS, Device};
use crate::error::SceneError;
use crate::format::{Limits, Table};
use crate::random::{Purpose, Stream, stream};

/// Equivalent noise bandwidth of a Hann window, bins.
const HANN_NENBW: f64 = 1.5;

pub(in super::super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(ppm) = super::key(root, "noise_ppm_rms", Limits::within(0.0, 1e6))? else { return Ok(None) };
    let build = move |setting: &Setting| Effect::Channels(Box::new(Noise::new(ppm, setting)));
    Ok(Spec::new("sensor.noise", format!("{ppm} ppm"), build))
}

struct Noise {
    sigma: f64,
    window_samples: usize,
    seed: u64,
    case: u64,
}

impl Noise {
    fn new(ppm: f64, setting: &Setting) -> Self {
        let Setting { timing, seed, case, .. } = *setting;
        Noise { sigma: ppm * 1e-6, window_samples: timing.window_samples, seed, case: case as u64 }
    }

    fn stream(&self, slot: u64, purpose: Purpose) -> Stream {
        stream(self.seed, [self.case, slot], purpose)
    }
}

impl ChannelEffect for Noise {
    fn phasors(&mut self, _: &Pad, phasors: &mut Phasors) {
        let sigma = self.sigma * (2.0 * HANN_NENBW / self.window_samples as f64).sqrt();
        let mut random = self.stream(phasors.slot, Purpose::PhasorNoise);
        for phasor in &mut phasors.carrier {
            phasor.re += sigma * normal(&mut random);
            phasor.im += sigma * normal(&mut random);
        }
        phasors.haptic_mean_square += self.sigma.powi(2);
    }

    fn samples(&mut self, _: &Pad, run: &Run, rows: &mut [[f64; CHANNELS]]) {
        let mut random = self.stream(run.slot as u64, Purpose::SampleNoise { from: run.range.start as u64 });
        for sample in rows.as_flattened_mut() {
            *sample += self.sigma * normal(&mut random);
        }
    }
}

fn normal(random: &mut Stream) -> f64 {
    StandardNormal.sample(random)
}
