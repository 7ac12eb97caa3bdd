// SPDX-License-Identifier: MIT OR Apache-2.0
//! White Gaussian noise, by what it comes from:
//!
//! | key | on | size per sample |
//! | --- | --- | --- |
//! | `noise_ppm_rms` | every channel | millionths of full scale; 18 is an AD7606C-16, 92 dB below a full-scale sine |
//! | `noise_density_na_per_rthz` | the currents | density·√(half the sample rate, or π/2·`bandwidth_khz` where that is given) |
//! | `dither_lsb_rms` | every channel | codes of `quantisation_bits` |
//!
//! A run's noise follows from seed, case, slot and first sample alone, so that leaving one run out
//! changes no other. Amplitudes get what a Hann window over the slot's N samples passes:
//! σ·√(2·1.5/N) in each of both parts, so that a force has the relative noise 2n·√(6·NENBW/T)/|I|
//! of docs/physics.md §5.

use std::f64::consts::PI;

use rand_distr::{Distribution, StandardNormal};

use super::super::effect::{ChannelEffect, Effect, Phasors, Run};
use super::super::pad::Pad;
use super::super::spec::{Setting, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::{Limits, Table};
use crate::random::{Origin, Purpose, Stream, stream};
use crate::terminals::MOST_CHANNELS;

/// Equivalent noise bandwidth of a Hann window, bins.
pub(super) const HANN_NENBW: f64 = 1.5;

/// Reads `sensor.noise_ppm_rms`: ADC noise on every channel.
pub(in super::super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(ppm) = super::key(root, "noise_ppm_rms", Limits::within(0.0, 1e6))? else {
        return Ok(None);
    };
    let build =
        move |setting: &Setting| Noise::effect([ppm * 1e-6; MOST_CHANNELS], Origin::Adc, setting);
    Ok(Spec::new(NOISE, format!("{ppm} ppm"), build))
}

/// The name of the effect that an error of a level leaves out.
pub(crate) const NOISE: &str = "sensor.noise";

/// Reads `sensor.noise_density_na_per_rthz`: noise of the current sensors.
pub(in super::super) fn read_density(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let density = super::key(root, "noise_density_na_per_rthz", Limits::within(0.0, 1e6))?;
    let (Some(na), bandwidth_khz) = (density, super::key(root, "bandwidth_khz", Limits::POSITIVE)?)
    else {
        return Ok(None);
    };
    let build = move |setting: &Setting| {
        let half_rate_hz = setting.device.sample_rate_hz / 2.0;
        let enbw_hz = bandwidth_khz.map_or(half_rate_hz, |khz| PI / 2.0 * 1e3 * khz);
        let mut sigma = [0.0; MOST_CHANNELS];
        sigma[..setting.device.terminals()]
            .fill(1e-9 * na * enbw_hz.sqrt() / setting.device.current_full_scale_a);
        Noise::effect(sigma, Origin::Amplifier, setting)
    };
    Ok(Spec::new("sensor.noise_density", format!("{na} nA/√Hz"), build))
}

/// Reads `sensor.dither_lsb_rms`: noise before quantisation.
pub(in super::super) fn read_dither(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(lsb) = super::key(root, "dither_lsb_rms", Limits::within(0.0, 1e3))? else {
        return Ok(None);
    };
    let Some(codes) = super::quantisation::codes(root)? else {
        let table = root.table("sensor")?.unwrap_or(root);
        return Err(table.error(
            "dither_lsb_rms",
            "expected quantisation_bits too, since dither is counted in codes",
        ));
    };
    let build = move |setting: &Setting| {
        Noise::effect([lsb / codes; MOST_CHANNELS], Origin::Dither, setting)
    };
    Ok(Spec::new("sensor.dither", format!("{lsb} LSB"), build))
}

struct Noise {
    /// Standard deviation per sample of each channel.
    sigma: [f64; MOST_CHANNELS],
    /// The haptic channel.
    haptic: usize,
    origin: Origin,
    window_samples: usize,
    source: Source,
}

impl Noise {
    fn effect(sigma: [f64; MOST_CHANNELS], origin: Origin, setting: &Setting) -> Effect {
        let (window_samples, haptic) = (setting.timing.window_samples, setting.device.haptic());
        Effect::Channels(Box::new(Noise {
            sigma,
            haptic,
            origin,
            window_samples,
            source: Source::new(setting),
        }))
    }
}

impl ChannelEffect for Noise {
    fn phasors(&mut self, _: &Pad, phasors: &mut Phasors) {
        let passed = (2.0 * HANN_NENBW / self.window_samples as f64).sqrt();
        let mut random = self.source.stream(phasors.slot, Purpose::PhasorNoise(self.origin));
        for (phasor, sigma) in phasors.carrier.iter_mut().zip(self.sigma) {
            phasor.re += sigma * passed * normal(&mut random);
            phasor.im += sigma * passed * normal(&mut random);
        }
        phasors.haptic_mean_square += self.sigma[self.haptic].powi(2);
    }

    fn samples(&mut self, _: &Pad, run: &Run, samples: &mut [f64]) {
        let from = run.range.start as u64;
        let mut random =
            self.source.stream(run.slot as u64, Purpose::SampleNoise { origin: self.origin, from });
        run.rows(samples, |row| {
            row.iter_mut()
                .zip(&self.sigma)
                .for_each(|(sample, sigma)| *sample += sigma * normal(&mut random));
        });
    }
}

/// Where the random numbers of a case come from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source {
    seed: u64,
    case: u64,
}

impl Source {
    pub fn new(setting: &Setting) -> Self {
        Source { seed: setting.seed, case: setting.case as u64 }
    }

    /// Those of a slot.
    pub fn stream(&self, slot: u64, purpose: Purpose) -> Stream {
        stream(self.seed, [self.case, slot], purpose)
    }
}

pub(super) fn normal(random: &mut Stream) -> f64 {
    StandardNormal.sample(random)
}
