// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[carrier]`: the currents that the sensing voltage drives through the pad into the terminals.
//!
//!   I_i = w_i·jωC/(1 + jωC·R_p)·V      (eqs. 1 and 4; w_i is the share of terminal i)
//!
//! The sensing voltage is V·cos ωt with t = 0 at each slot's first sample. The haptic voltage is
//! √2·V_h·sin ω_h·t with t since the start of the case, or V_h with the polarity of its `wave`.
//!
//! | level | what the `float` and `fixed` cores receive | error |
//! | --- | --- | --- |
//! | `phasor` | the amplitudes themselves, one set per slot | exact in steady state |
//! | `samples` | ADC samples, as the `clock` core always is | sampling effects only |
//!
//! The carrier is how the device measures: it is there even without its table, at the defaults.

use crate::few::Few;
use num_complex::Complex64;

use super::effect::{ChannelEffect, Effect, Phasors, Run};
use super::pad::Pad;
use super::spec::{Level, Rung, Setting, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::{Table, keys};
use crate::rotor::Rotor;
use crate::stimulus::Moment;
use crate::terminals::MOST_CHANNELS;
use crate::wave::HapticWave;

/// The effect's name.
pub(crate) const CARRIER: &str = "carrier";

/// The level at which a core demodulates samples itself.
pub(crate) const SAMPLES: &str = "samples";

keys! { KEYS:
    /// What the `float` and `fixed` cores receive: amplitudes, one set per slot, or ADC samples.
    RUNG: Option<&'static str> = Rung::choice("rung", || vec!["phasor", SAMPLES]).usually("phasor");
}

pub(super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let level = |word, cost_ns| {
        Level::new(word, cost_ns, |setting| Effect::Channels(Box::new(Carrier::new(setting))))
    };
    Spec::with_levels(
        CARRIER,
        root.table("carrier")?,
        &RUNG,
        vec![level("phasor", 100.0), level(SAMPLES, 4e3)],
        "phasor",
    )
}

struct Carrier {
    device: Device,
    turns_per_sample: f64,
}

impl Carrier {
    fn new(setting: &Setting) -> Self {
        Carrier {
            device: setting.device.clone(),
            turns_per_sample: 1.0 / setting.timing.samples_per_period,
        }
    }

    /// Samples of a haptic voltage that is no sine.
    fn set_haptic(&self, pad: &Pad, run: &Run, samples: &mut [f64]) {
        let volt = pad.haptic_v_rms / self.device.haptic_full_scale_v;
        let mut sample = run.slot_start + run.range.start as u64;
        run.rows(samples, |row| {
            let moment = Moment::at(sample as f64 / self.device.sample_rate_hz);
            row[row.len() - 1] = volt * self.device.haptic_wave.polarity(moment);
            sample += 1;
        });
    }

    /// Of the terminals' currents, then of the sensing voltage.
    fn amplitudes(&self, pad: &Pad) -> Few<Complex64, { MOST_CHANNELS - 1 }> {
        let sense = Complex64::new(self.device.carrier_v / self.device.sense_full_scale_v, 0.0);
        let terminals = pad.terminal_amplitudes(&self.device);
        Few::of(terminals.len() + 1, |amplitudes| {
            amplitudes[..terminals.len()].copy_from_slice(&terminals);
            amplitudes[terminals.len()] = sense;
        })
    }
}

/// Phase of the haptic voltage at a run's first sample and its step per sample, turns.
pub(super) fn haptic_rotor(device: &Device, run: &Run) -> Rotor {
    let step = device.haptic_hz / device.sample_rate_hz;
    Rotor::new(step * (run.slot_start + run.range.start as u64) as f64, step)
}

impl ChannelEffect for Carrier {
    fn phasors(&mut self, pad: &Pad, phasors: &mut Phasors) {
        phasors.carrier = self.amplitudes(pad);
        phasors.haptic_mean_square = (pad.haptic_v_rms / self.device.haptic_full_scale_v).powi(2);
    }

    fn samples(&mut self, pad: &Pad, run: &Run, samples: &mut [f64]) {
        let amplitudes = self.amplitudes(pad).padded();
        let (inphase, quadrature) = (amplitudes.map(|a| a.re), amplitudes.map(|a| a.im));
        let haptic = pad.haptic_v_rms * std::f64::consts::SQRT_2 / self.device.haptic_full_scale_v;
        let mut carrier =
            Rotor::new(self.turns_per_sample * run.range.start as f64, self.turns_per_sample);
        let mut slow = haptic_rotor(&self.device, run);
        run.rows(samples, |row| {
            let now = carrier.turn();
            for (sample, (re, im)) in row.iter_mut().zip(inphase.iter().zip(&quadrature)) {
                *sample = re * now.re - im * now.im;
            }
            row[row.len() - 1] = haptic * slow.turn().im;
        });
        if self.device.haptic_wave != HapticWave::Sine {
            self.set_haptic(pad, run, samples);
        }
    }
}
