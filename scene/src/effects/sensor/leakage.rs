// SPDX-License-Identifier: MIT OR Apache-2.0
//! `sensor.haptic_leakage`: the haptic voltage drives a current of its own into the terminals, eq.
//! 1's second term, −17 dB (200 Hz, 350 V) to −3 dB (1 kHz) of the carrier's at 5 V. It shifts no
//! phasor, since a demodulator's window rejects it, but takes ADC range and dithers the codes
//! (docs/physics.md §5). Only a sine's is known here: a constant voltage has none, and a square's flows
//! in the first moments after a turn.

use std::f64::consts::{SQRT_2, TAU};

use num_complex::Complex64;

use super::super::carrier::haptic_rotor;
use super::super::effect::{ChannelEffect, Effect, Phasors, Run};
use super::super::pad::Pad;
use super::super::spec::{Setting, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::Table;
use crate::terminals::PerTerminal;
use crate::wave::HapticWave;

pub(in super::super) fn read(root: &Table, device: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("sensor")? else { return Ok(None) };
    let on = table.get(&super::HAPTIC_LEAKAGE)?;
    if on && device.haptic_wave != HapticWave::Sine {
        let got = device.haptic_wave.name();
        return Err(table.error("haptic_leakage", format!("expected carrier.haptic_wave = \"sine\" with it, whose current alone is known here, got {got:?}")));
    }
    let build =
        |setting: &Setting| Effect::Channels(Box::new(Leakage { device: setting.device.clone() }));
    Ok(if on { Spec::new("sensor.leakage", "steady state", build) } else { None })
}

struct Leakage {
    device: Device,
}

impl ChannelEffect for Leakage {
    fn phasors(&mut self, _: &Pad, _: &mut Phasors) {}

    fn samples(&mut self, pad: &Pad, run: &Run, samples: &mut [f64]) {
        let volt = pad.haptic_v_rms * SQRT_2;
        let total =
            pad.admittance(TAU * self.device.haptic_hz) * volt / self.device.current_full_scale_a;
        let mut rotor = haptic_rotor(&self.device, run);
        let shares = pad.split.map(|share| share.re).padded();
        run.rows(samples, |row| {
            let now = (total * rotor.turn()).im;
            for (sample, share) in Run::terminals(row).iter_mut().zip(&shares) {
                *sample += now * share;
            }
        });
        if let Some(currents) = &pad.leakage_of_others_a {
            self.add_others(currents, run, samples);
        }
    }
}

impl Leakage {
    /// What flows from the pads that the slot does not serve.
    fn add_others(&self, currents: &PerTerminal<Complex64>, run: &Run, samples: &mut [f64]) {
        let currents = currents.map(|ampere| ampere / self.device.current_full_scale_a).padded();
        let mut rotor = haptic_rotor(&self.device, run);
        run.rows(samples, |row| {
            let now = rotor.turn();
            let terminals = Run::terminals(row).iter_mut();
            terminals.zip(&currents).for_each(|(sample, current)| *sample += (current * now).im);
        });
    }
}
