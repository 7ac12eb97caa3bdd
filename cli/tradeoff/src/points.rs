// SPDX-License-Identifier: MIT OR Apache-2.0
//! Slots of scenes, which every profile is tried on: samples as the sensors give them, before any
//! ADC.

use anyhow::{Result, ensure};
use hapticore_contract::profile::Profile;
use hapticore_hdl::format::Format;
use hapticore_reference::Reference;
use hapticore_run::case::Case;
use hapticore_run::interrupt;
use hapticore_scene::Scene;

/// An ADC that rounds nothing away: what the ideal estimator is given.
pub const FINE: Format = Format::signed(30, 29);

/// A slot of a scene.
#[derive(Debug, Clone)]
pub struct Slot {
    /// Pad, from 0.
    pub pad: usize,
    /// The window's samples, of full scale; a sample after the other, each of all channels.
    pub samples: Vec<f64>,
    /// What the ideal estimator makes of it.
    pub ideal: Values,
}

/// The results that errors are asked of.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Values {
    /// Haptic force, N.
    pub force_n: f64,
    /// Capacitance, pF.
    pub capacitance_pf: f64,
    /// Position, mm.
    pub position_mm: [f64; 2],
}

/// Slots of a scene's case, spread over its time; those without a valid position are left out.
///
/// # Errors
/// A case that cannot be run, or is controlled; no slot with a valid position.
pub fn slots(scene: &Scene, profile: &Profile, count: usize) -> Result<Vec<Slot>> {
    ensure!(
        scene.cases[0].control.is_none(),
        "{}: expected a scene without [control]: its slots depend on the core",
        scene.name
    );
    let case = Case::new(scene, 0, profile, &[])?;
    let mut plant = case.plant()?;
    let (slot, channels) = (&case.profile.slot, case.profile.channels());
    let window = slot.blanking() as usize..slot.samples() as usize;
    let mut fine = (*case.profile).clone();
    fine.formats.adc = FINE;
    let mut reference = Reference::new(&fine, case.calibration()?);
    let step = (case.slots / count).max(1);
    let mut slots = Vec::new();
    for number in (0..case.slots).step_by(step) {
        interrupt::check()?;
        let pad = plant.truth(number).pad;
        let mut samples = Vec::with_capacity(window.len() * channels);
        plant.samples(number, window.clone(), &mut samples);
        let measured = reference.slot(pad, &codes(&samples, FINE));
        let flags = measured.flags;
        if flags.invalid || flags.clipped || flags.saturated {
            continue;
        }
        slots.push(Slot { pad, samples, ideal: Values::of(&measured) });
    }
    ensure!(!slots.is_empty(), "{}: expected a pad on the sheet in some slot", scene.name);
    Ok(slots)
}

impl Values {
    /// Those of a measurement.
    pub fn of(measured: &hapticore_contract::frame::Measurement) -> Self {
        Values {
            force_n: measured.force_n,
            capacitance_pf: measured.capacitance_pf,
            position_mm: [measured.x_mm, measured.y_mm],
        }
    }
}

/// Samples as codes of an ADC.
pub fn codes(samples: &[f64], adc: Format) -> Vec<i32> {
    let (scale, [low, high]) = (1.0 / adc.lsb(), [adc.min_code() as f64, adc.max_code() as f64]);
    let code = |sample: &f64| (sample * scale).round_ties_even().clamp(low, high) as i32;
    samples.iter().map(code).collect()
}
