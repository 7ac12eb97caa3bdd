// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[carrier]`: the currents that the sensing voltage drives through the pad into the terminals.
//!
//!   I_i = w_i·jωC/(1 + jωC·R_p)·V      (eqs. 1 and 4; w_i is the share of terminal i)
//!
//! The sensing voltage is V·cos ωt with t = 0 at each slot's first sample; the haptic voltage is √2·V_h·sin ω_h·t with t
//! since the start of the case.
//!
//! | rung | what the `float` and `fixed` cores are given | error |
//! | --- | --- | --- |
//! | `phasor` | the amplitudes themselves, one set per slot | exact in steady state |
//! | `samples` | ADC samples, as the `clock` core always is | sampling effects only |
//!
//! The carrier is how the device measures: it is there even without its table, at the defaults.

use num_complex::Complex64;

use super::{ChannelEffect, Effect, Pad, Phasors, Run, Rung, Setting, Spec};
use crate::device::{CHANNELS, Device, HAPTIC, SENSE, TERMINALS};
use crate::error::SceneError;
use crate::format::Table;
use crate::rotor::Rotor;

/// The effect's name.
pub(crate) const CARRIER: &str = "carrier";

/// The rung at which a core demodulates samples itself.
pub(crate) const SAMPLES: &str = "samples";

pub(super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let rung = |word, cost_ns| Rung::new(word, cost_ns, |setting| Effect::Channels(Box::new(Carrier::new(setting))));
    Spec::ladder(CARRIER, root.table("carrier")?, vec![rung("phasor", 100.0), rung(SAMPLES, 4e3)], "phasor")
}

struct Carrier {
    device: Device,
    turns_per_sample: f64,
}

impl Carrier {
    fn new(setting: &Setting) -> Self {
        Carrier { device: setting.device.clone(), turns_per_sample: 1.0 / setting.timing.samples_per_period }
    }

    fn amplitudes(&self, pad: &Pad) -> [Complex64; CHANNELS] {
        let device = &self.device;
        let scale = device.carrier_v / device.current_full_scale_a;
        let mut amplitudes = [Complex64::ZERO; CHANNELS];
        for (amplitude, siemens) in amplitudes.iter_mut().zip(pad.transfer(device)) {
            *amplitude = siemens * scale;
        }
        amplitudes[SENSE] = Complex64::new(device.carrier_v / device.sense_full_scale_v, 0.0);
        amplitudes
    }
}

/// Phase of the haptic voltage at a run's first sample and its step per sample, turns.
pub(super) fn haptic_rotor(device: &Device, run: &Run) -> Rotor {
    let step = device.haptic_hz / device.sample_rate_hz;
    Rotor::new(step * (run.slot_start + run.range.start as u64) as f64, step)
}

impl ChannelEffect for Carrier {
    fn phasors(&mut self, pad: &Pad, phasors: &mut Phasors) {
        phasors.carrier.copy_from_slice(&self.amplitudes(pad)[..=TERMINALS]);
        phasors.haptic_mean_square = (pad.haptic_v_rms / self.device.haptic_full_scale_v).powi(2);
    }

    fn samples(&mut self, pad: &Pad, run: &Run, rows: &mut [[f64; CHANNELS]]) {
        let amplitudes = self.amplitudes(pad);
        let (inphase, quadrature) = (amplitudes.map(|a| a.re), amplitudes.map(|a| a.im));
        let haptic = pad.haptic_v_rms * std::f64::consts::SQRT_2 / self.device.haptic_full_scale_v;
        let mut carrier = Rotor::new(self.turns_per_sample * run.range.start as f64, self.turns_per_sample);
        let mut slow = haptic_rotor(&self.device, run);
        for row in rows {
            let now = carrier.turn();
            for channel in 0..CHANNELS {
                row[channel] = inphase[channel] * now.re - quadrature[channel] * now.im;
            }
            row[HAPTIC] = haptic * slow.turn().im;
        }
    }
}
