// SPDX-License-Identifier: MIT OR Apache-2.0
//! Gaussian noise, by what it comes from:
//!
//! | key | on | size per sample |
//! | --- | --- | --- |
//! | `noise_ppm_rms` | every channel | millionths of full scale; 18 is an AD7606C-16, 92 dB below a full-scale sine |
//! | `noise_density_na_per_rthz` | the currents | density·√(half the sample rate), or behind the sensors' pole, as below |
//! | `dither_lsb_rms` | every channel | codes of `quantisation_bits` |
//!
//! It is white but for that of sensors with a `bandwidth_khz` f_b: behind their pole noise of this
//! density has the variance density²·π/2·f_b, and each sample a share a = e^(−2πf_b/f_s) of the one
//! before. At 300 kHz and 1 MS/s a is 0.15, and the density at 100 kHz is 18 % more than that of the
//! noise before the pole, by what folds (docs/physics.md §7).
//!
//! A run's noise follows from seed, case, slot and first sample alone, so that leaving one run out
//! changes no other. Amplitudes get what a Hann window over the slot's N samples passes:
//! σ·√(2·1.5/N) in each of both parts, so that a force has the relative noise 2n·√(6·NENBW/T)/|I|
//! of docs/physics.md §5.

use std::f64::consts::{PI, TAU};

use num_complex::Complex64;

use super::super::effect::{ChannelEffect, Effect, Phasors, Run};
use super::super::pad::Pad;
use super::super::spec::{Setting, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::Table;
use crate::random::{Origin, Purpose, Stream, normal, stream};
use crate::terminals::MOST_CHANNELS;

/// Equivalent noise bandwidth of a Hann window, bins.
pub(super) const HANN_NENBW: f64 = 1.5;

/// Reads `sensor.noise_ppm_rms`: ADC noise on every channel.
pub(in super::super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(ppm) = super::key(root, &super::NOISE_PPM_RMS)? else {
        return Ok(None);
    };
    let build = move |setting: &Setting| {
        Noise::white([ppm * 1e-6; MOST_CHANNELS], Origin::Adc, setting).effect()
    };
    Ok(Spec::new("sensor.noise", format!("{ppm} ppm"), build))
}

/// Reads `sensor.noise_density_na_per_rthz`: noise of the current sensors.
pub(in super::super) fn read_density(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let density = super::key(root, &super::NOISE_DENSITY)?;
    let (Some(na), bandwidth_khz) = (density, super::key(root, &super::BANDWIDTH_KHZ)?) else {
        return Ok(None);
    };
    let build = move |setting: &Setting| {
        let rate_hz = setting.device.sample_rate_hz;
        let pole_hz = bandwidth_khz.map(|khz| 1e3 * khz);
        let enbw_hz = pole_hz.map_or(rate_hz / 2.0, |pole_hz| PI / 2.0 * pole_hz);
        let kept = pole_hz.map_or(0.0, |pole_hz| (-TAU * pole_hz / rate_hz).exp());
        let mut sigma = [0.0; MOST_CHANNELS];
        sigma[..setting.device.terminals()]
            .fill(1e-9 * na * enbw_hz.sqrt() / setting.device.current_full_scale_a);
        Noise { kept, ..Noise::white(sigma, Origin::Amplifier, setting) }.effect()
    };
    Ok(Spec::new("sensor.noise_density", format!("{na} nA/√Hz"), build))
}

/// Reads `sensor.dither_lsb_rms`: noise before quantisation.
pub(in super::super) fn read_dither(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(lsb) = super::key(root, &super::DITHER_LSB_RMS)? else {
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
        Noise::white([lsb / codes; MOST_CHANNELS], Origin::Dither, setting).effect()
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
    /// What part of a sample's noise is left in the next.
    kept: f64,
    /// Turns of the carrier from sample to sample.
    carrier_turns: f64,
}

impl Noise {
    fn white(sigma: [f64; MOST_CHANNELS], origin: Origin, setting: &Setting) -> Noise {
        Noise {
            sigma,
            haptic: setting.device.haptic(),
            origin,
            window_samples: setting.timing.window_samples,
            source: Source::new(setting),
            kept: 0.0,
            carrier_turns: 1.0 / setting.timing.samples_per_period,
        }
    }

    fn effect(self) -> Effect {
        Effect::Channels(Box::new(self))
    }

    /// The density at the carrier over that of white noise of the same variance.
    fn density_at_carrier(&self) -> f64 {
        let left = 1.0 - self.kept * Complex64::cis(-TAU * self.carrier_turns);
        (1.0 - self.kept.powi(2)) / left.norm_sqr()
    }

    /// White noise of each channel's size.
    fn add_white(&self, run: &Run, random: &mut Stream, samples: &mut [f64]) {
        run.rows(samples, |row| {
            let channels = row.iter_mut().zip(&self.sigma);
            channels.for_each(|(sample, sigma)| *sample += sigma * normal(random));
        });
    }

    /// Noise of each channel's size of which each sample keeps a share of the one before.
    fn add_coloured(&self, run: &Run, random: &mut Stream, samples: &mut [f64]) {
        let fresh = (1.0 - self.kept.powi(2)).sqrt();
        let mut states = self.sigma.map(|sigma| sigma * normal(random));
        run.rows(samples, |row| {
            let channels = row.iter_mut().zip(states.iter_mut().zip(&self.sigma));
            channels.for_each(|(sample, (state, sigma))| {
                *sample += *state;
                *state = self.kept * *state + fresh * sigma * normal(random);
            });
        });
    }
}

impl ChannelEffect for Noise {
    fn phasors(&mut self, _: &Pad, phasors: &mut Phasors) {
        let share = 2.0 * HANN_NENBW / self.window_samples as f64;
        let passed = (share * self.density_at_carrier()).sqrt();
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
        match self.kept {
            0.0 => self.add_white(run, &mut random, samples),
            _ => self.add_coloured(run, &mut random, samples),
        }
    }
}

/// Where the random numbers of a case come from.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Source {
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
