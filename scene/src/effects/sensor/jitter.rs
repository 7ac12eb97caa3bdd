// SPDX-License-Identifier: MIT OR Apache-2.0
//! `sensor.jitter_ns_rms`: the ADC samples all channels together, a random time off. Off by δ it reads
//! x + δ·dx/dt of the carrier. 1 ns costs 0.0037 % of force (docs/physics.md §5).
//!
//! Amplitudes A get what a Hann window over the slot's N samples leaves of it, jωA·δ̄ − jωA*·δ̿: δ̄
//! is the window's mean of δ and δ̿ that of δ·e^(−2jωt), of variance σ²·NENBW/N each.

use std::f64::consts::TAU;

use crate::few::Few;
use num_complex::Complex64;

use super::super::effect::{ChannelEffect, Effect, Phasors, Run};
use super::super::pad::Pad;
use super::super::spec::{Setting, Spec};
use super::noise::{HANN_NENBW, Source};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::Table;
use crate::random::{Purpose, normal};
use crate::rotor::Rotor;
use crate::terminals::MOST_CHANNELS;

pub(in super::super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(ns) = super::key(root, &super::JITTER_NS_RMS)? else {
        return Ok(None);
    };
    let build = move |setting: &Setting| Effect::Channels(Box::new(Jitter::new(ns, setting)));
    Ok(Spec::new("sensor.jitter", format!("{ns} ns"), build))
}

struct Jitter {
    /// Standard deviation of the carrier's phase, rad.
    sigma: f64,
    window_samples: usize,
    turns_per_sample: f64,
    device: Device,
    source: Source,
}

impl Jitter {
    fn new(ns: f64, setting: &Setting) -> Self {
        Jitter {
            sigma: TAU * setting.device.carrier_hz * ns * 1e-9,
            window_samples: setting.timing.window_samples,
            turns_per_sample: 1.0 / setting.timing.samples_per_period,
            device: setting.device.clone(),
            source: Source::new(setting),
        }
    }

    /// Amplitudes of the terminals and the sensing voltage.
    fn amplitudes(&self, pad: &Pad) -> Few<Complex64, { MOST_CHANNELS - 1 }> {
        let sense = Complex64::from(self.device.carrier_v / self.device.sense_full_scale_v);
        pad.terminal_amplitudes(&self.device).iter().copied().chain([sense]).collect()
    }
}

impl ChannelEffect for Jitter {
    fn phasors(&mut self, pad: &Pad, phasors: &mut Phasors) {
        let sigma = self.sigma * (HANN_NENBW / self.window_samples as f64).sqrt();
        let mut random = self.source.stream(phasors.slot, Purpose::PhasorJitter);
        let mean = Complex64::new(0.0, sigma * normal(&mut random));
        let [re, im] = [(); 2].map(|()| sigma * 0.5f64.sqrt() * normal(&mut random));
        let twice = Complex64::new(-im, re);
        for (phasor, amplitude) in phasors.carrier.iter_mut().zip(self.amplitudes(pad)) {
            *phasor += mean * amplitude - twice * amplitude.conj();
        }
    }

    fn samples(&mut self, pad: &Pad, run: &Run, samples: &mut [f64]) {
        let amplitudes = self.amplitudes(pad).padded();
        let mut random = self
            .source
            .stream(run.slot as u64, Purpose::SampleJitter { from: run.range.start as u64 });
        let mut carrier =
            Rotor::new(self.turns_per_sample * run.range.start as f64, self.turns_per_sample);
        run.rows(samples, |row| {
            let slope = carrier.turn() * (self.sigma * normal(&mut random));
            let driven = row.len() - 1; // the haptic voltage is slow
            row[..driven]
                .iter_mut()
                .zip(&amplitudes)
                .for_each(|(sample, amplitude)| *sample -= (amplitude * slope).im);
        });
    }
}
