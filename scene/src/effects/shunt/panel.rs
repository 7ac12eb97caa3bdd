// SPDX-License-Identifier: MIT OR Apache-2.0
//! `shunt.panel_noise_mv`: the panel's own voltage drives currents through the shunt into the sheet
//! and out of all terminals.
//!
//!   I = G·1·V_p,   G = (R_s·N_c + R_t)⁻¹                (N_c: the Neumann function with the shunt, between terminals)
//!
//! A sheet that no terminal holds follows the panel, so that the terminals see V_p through the
//! sheet. Their currents are of one source and sum to nearly jωcA·V_p, 24 µA of 10 mV through 9
//! nF/m². A pad's own share is left out: its 318 pF are a twelfth of the shunt's, behind a source
//! that holds it. V_p is Re{a·e^(jωt)} with an envelope a whose autocorrelation falls to e⁻¹ after
//! 1/(2πb), b the half width. A demodulator reads of it what the slot's Hann window passes: at 1
//! kHz and a window of 1 ms four tenths of its square. Source: docs/physics.md §7.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::{Screened, screened};
use crate::device::Device;
use crate::effects::effect::{ChannelEffect, Effect, Phasors, Run};
use crate::effects::pad::Pad;
use crate::effects::sensor::noise::Source;
use crate::effects::sheet::{Following, OfSheet};
use crate::effects::spec::{Setting, Spec};
use crate::error::SceneError;
use crate::format::{Key, Limits, Table, keys};
use crate::random::{Origin, Purpose, Stream, normal};
use crate::rotor::Rotor;
use crate::terminals::PerTerminal;

/// The effect's name.
pub(crate) const PANEL_NOISE: &str = "shunt.panel_noise";

keys! { KEYS:
    /// Voltage of the panel near the carrier, RMS.
    PANEL_NOISE_MV: Option<f64> = Key::number("panel_noise_mv", Limits::within(0.0, 1e5));
    /// Half width of the panel's line near the carrier, at most a tenth of its frequency.
    PANEL_NOISE_KHZ: Option<f64> = Key::number("panel_noise_khz", Limits::within(1e-6, 1e4)).usually("1");
}

pub(in super::super) fn read(root: &Table, device: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("shunt")? else { return Ok(None) };
    let milli = table.get(&PANEL_NOISE_MV)?;
    let half_khz = table.get(&PANEL_NOISE_KHZ)?;
    let Some(milli) = milli else {
        return match half_khz {
            None => Ok(None),
            Some(_) => Err(table.error("panel_noise_khz", "expected panel_noise_mv too")),
        };
    };
    let half_hz = 1e3 * half_khz.unwrap_or(1.0);
    if half_hz > 0.1 * device.carrier_hz {
        let most = 1e-4 * device.carrier_hz;
        let expected = format!("expected at most {most}, a tenth of the carrier's frequency");
        return Err(table.error("panel_noise_khz", format!("{expected}, got {}", 1e-3 * half_hz)));
    }
    let Some((sheet, siemens_per_m2)) = screened(root, device)? else { return Ok(None) };
    let driven =
        OfSheet::new(sheet, move |sheet| Screened::new(sheet, siemens_per_m2).driven_by_panel());
    let build = move |setting: &Setting| {
        let driven = Following::new(&driven);
        Effect::Channels(Box::new(PanelNoise::new(driven, 1e-3 * milli, half_hz, setting)))
    };
    Ok(Spec::new(PANEL_NOISE, format!("{milli} mV"), build))
}

struct PanelNoise {
    /// Current into each terminal per volt of the panel, S.
    driven: Following<PerTerminal<Complex64>>,
    /// RMS of the panel's voltage over the full scale of a current, V/A.
    level: f64,
    /// What is left of the envelope a sample later.
    kept: f64,
    /// What a demodulator's window passes of the envelope's mean square.
    passed: f64,
    turns_per_sample: f64,
    source: Source,
}

impl PanelNoise {
    fn new(
        driven: Following<PerTerminal<Complex64>>,
        volt: f64,
        half_hz: f64,
        setting: &Setting,
    ) -> Self {
        let kept = (-TAU * half_hz / setting.device.sample_rate_hz).exp();
        PanelNoise {
            driven,
            level: volt / setting.device.current_full_scale_a,
            kept,
            passed: passed(kept, setting.timing.window_samples),
            turns_per_sample: 1.0 / setting.timing.samples_per_period,
            source: Source::new(setting),
        }
    }
}

/// Σ_nm w_n·w_m·ρ^|n−m| of a Hann window, whose weights sum to one.
fn passed(kept: f64, samples: usize) -> f64 {
    let mut hann = Rotor::new(0.0, 1.0 / samples as f64);
    let (mut sum, mut before) = (0.0, 0.0);
    for _ in 0..samples {
        let weight = (1.0 - hann.turn().re) / samples as f64;
        sum += weight * (weight + 2.0 * before);
        before = kept * (before + weight);
    }
    sum
}

/// A complex number whose parts have this standard deviation.
fn normals(sigma: f64, random: &mut Stream) -> Complex64 {
    Complex64::new(sigma * normal(random), sigma * normal(random))
}

impl ChannelEffect for PanelNoise {
    fn phasors(&mut self, pad: &Pad, phasors: &mut Phasors) {
        let mut random = self.source.stream(phasors.slot, Purpose::PhasorNoise(Origin::Panel));
        let envelope = normals(self.level * self.passed.sqrt(), &mut random);
        let driven = self.driven.at(pad.film);
        for (phasor, siemens) in phasors.terminals().iter_mut().zip(driven.iter()) {
            *phasor += siemens * envelope;
        }
    }

    fn samples(&mut self, pad: &Pad, run: &Run, samples: &mut [f64]) {
        let from = run.range.start as u64;
        let purpose = Purpose::SampleNoise { origin: Origin::Panel, from };
        let mut random = self.source.stream(run.slot as u64, purpose);
        let fresh = self.level * (1.0 - self.kept.powi(2)).sqrt();
        let mut envelope = normals(self.level, &mut random);
        let mut carrier = Rotor::new(self.turns_per_sample * from as f64, self.turns_per_sample);
        let driven = self.driven.at(pad.film);
        run.rows(samples, |row| {
            let now = envelope * carrier.turn();
            let terminals = Run::terminals(row).iter_mut();
            terminals
                .zip(driven.iter())
                .for_each(|(sample, siemens)| *sample += (siemens * now).re);
            envelope = envelope * self.kept + normals(fresh, &mut random);
        });
    }
}
