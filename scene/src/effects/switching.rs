// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[switching]`: the pad that a slot serves gets the sensing voltage at the slot's first sample,
//! uncharged. So its current takes some τ = R_p·C to settle: τ is 0.05 to 0.4 µs, and 0.01 % is
//! left after 9.2 τ.
//!
//!   i(t) = Re{Y·V·[e^(jωt) + e^(−t/τ)/(jωτ)]},   Y = jωC/(1 + jωτ)
//!
//! | level | what | error of C in steady state |
//! | --- | --- | --- |
//! | `rc-1`, `rc-4`, `rc-8`, `rc-16`, `rc-64` | the circuit by the trapezoid rule, this many steps per sample | tan(ωh/2)/(ωh/2) − 1: 3.4, 0.21, 0.051, 0.013, 0.0008 % at 1 MS/s |
//! | `euler-64` | the same explicitly; refused where a step is longer than 2τ, since it would diverge | first order in the step |
//! | `settling` | the closed form | none, at any rate |
//!
//! What it changes is added to the carrier's steady state: the deviation d(t) from e^(jωt) is the
//! same at each terminal.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::effect::{ChannelEffect, Effect, Phasors, Run};
use super::pad::Pad;
use super::spec::{Level, Rung, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::{Table, keys};
use crate::rotor::Rotor;
use crate::timing::Timing;

/// The levels: steps per sample, and what a slot costs, ns.
const RC: [(&str, Method, usize, f64); 6] = [
    ("rc-1", Method::Trapezoid, 1, 1.4e4),
    ("euler-64", Method::Euler, 64, 1e6),
    ("rc-4", Method::Trapezoid, 4, 4.6e4),
    ("rc-8", Method::Trapezoid, 8, 1e5),
    ("rc-16", Method::Trapezoid, 16, 2.5e5),
    ("rc-64", Method::Trapezoid, 64, 1e6),
];

keys! { KEYS:
    /// How the transient is computed: the circuit by the trapezoid rule in so many steps per sample (`rc-…`), explicitly, or
    /// the closed form.
    RUNG: Option<&'static str> =
        Rung::choice("rung", || [&RC.map(|(word, ..)| word)[..], &["settling"][..]].concat()).usually("settling");
}

/// What a transient has decayed to when it is left out.
const NOTHING: f64 = 1e-30;

pub(super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("switching")? else { return Ok(None) };
    if root.table("sheet")?.is_none() {
        return Err(table.error(
            "",
            "expected a [sheet] too, since without its resistance nothing takes time to settle",
        ));
    }
    let level = |word, method, steps, cost_ns| {
        Level::new(word, cost_ns, move |setting| {
            Effect::Channels(Box::new(Switching {
                method,
                steps,
                device: setting.device.clone(),
                timing: setting.timing.clone(),
            }))
        })
    };
    let integrated = |(word, method, steps, cost_ns): (&'static str, Method, usize, f64)| {
        let level = level(word, method, steps, cost_ns).against("settling");
        if method == Method::Euler { level.limited() } else { level }
    };
    let mut levels: Vec<_> = RC.map(integrated).into();
    levels.push(level("settling", Method::Exact, 1, 50.0));
    Spec::with_levels("switching", Some(table), &RUNG, levels, "settling")
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Method {
    Euler,
    Trapezoid,
    Exact,
}

struct Switching {
    method: Method,
    /// Steps per ADC sample.
    steps: usize,
    device: Device,
    timing: Timing,
}

impl Switching {
    /// d at the samples of a slot up to `end`, or until nothing is left of it.
    fn deviation(&self, pad: &Pad, end: usize) -> Vec<Complex64> {
        let tau_s = pad.sheet_ohm.re * pad.capacitance_f;
        let j_omega_tau = Complex64::new(0.0, self.device.carrier_rad_s * tau_s);
        if self.method == Method::Exact {
            let decay = |n: usize| (-(n as f64) / (self.device.sample_rate_hz * tau_s)).exp();
            return (0..end)
                .map(decay)
                .take_while(|left| *left > NOTHING)
                .map(|left| left / j_omega_tau)
                .collect();
        }
        let step_s = 1.0 / (self.device.sample_rate_hz * self.steps as f64);
        let mut source = Rotor::new(0.0, self.device.carrier_rad_s * step_s / TAU);
        let (mut charged, mut before) = (Complex64::ZERO, source.turn());
        let mut deviation = Vec::with_capacity(end);
        for step in 0..end * self.steps {
            if step % self.steps == 0 {
                deviation.push((before - charged) * (1.0 + j_omega_tau) / j_omega_tau - before);
            }
            let now = source.turn();
            charged = match self.method {
                Method::Euler => charged + (before - charged) * (step_s / tau_s),
                _ => {
                    (charged * (2.0 * tau_s - step_s) + (before + now) * step_s)
                        / (2.0 * tau_s + step_s)
                }
            };
            before = now;
        }
        deviation
    }
}

impl ChannelEffect for Switching {
    fn phasors(&mut self, pad: &Pad, phasors: &mut Phasors) {
        let Timing { window_start, window_samples, samples_per_period, .. } = self.timing;
        let deviation = self.deviation(pad, window_start + window_samples);
        let mut carrier =
            Rotor::new(-(window_start as f64) / samples_per_period, -1.0 / samples_per_period);
        let mut hann = Rotor::new(0.0, 1.0 / window_samples as f64);
        // The current is (A·d + its conjugate)/2: a demodulator sums both under its window.
        let [mut with, mut against] = [Complex64::ZERO; 2];
        for d in deviation.get(window_start..).unwrap_or_default() {
            let weight = carrier.turn() * ((1.0 - hann.turn().re) / window_samples as f64);
            with += weight * d;
            against += weight * d.conj();
        }
        for (phasor, amplitude) in
            phasors.carrier.iter_mut().zip(pad.terminal_amplitudes(&self.device))
        {
            *phasor += amplitude * with + amplitude.conj() * against;
        }
    }

    fn samples(&mut self, pad: &Pad, run: &Run, samples: &mut [f64]) {
        let amplitudes = pad.terminal_amplitudes(&self.device).padded();
        let deviation = self.deviation(pad, run.range.end);
        let deviation = deviation.get(run.range.start..).unwrap_or_default();
        let until = deviation.len().min(run.range.len()) * run.channels;
        let mut deviation = deviation.iter();
        run.rows(&mut samples[..until], |row| {
            let Some(d) = deviation.next() else { return };
            let terminals = Run::terminals(row).iter_mut();
            terminals
                .zip(&amplitudes)
                .for_each(|(sample, amplitude)| *sample += (amplitude * d).re);
        });
    }

    fn refuses(&self, pad: &Pad) -> Option<String> {
        let tau_s = pad.sheet_ohm.re * pad.capacitance_f;
        let step_s = 1.0 / (self.device.sample_rate_hz * self.steps as f64);
        let diverges = self.method == Method::Euler && step_s > 2.0 * tau_s;
        diverges.then(|| {
            let [step_ns, limit_ns] = [step_s * 1e9, 2e9 * tau_s];
            format!("expected steps of at most 2·R_p·C = {limit_ns:.1} ns, beyond which Euler's rule diverges, got {step_ns:.1} ns")
        })
    }
}
