// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is told of a profile before a core of it has run: its cost, and the errors that are expected of
//! it, over all scenes.

use super::bench::Bench;
use super::cost::{Cost, cost};
use super::errors::{Errors, Sources, pooled, predicted};
use anyhow::{Context, Result};
use hapticore_contract::profile::Profile;

/// How many slots of a scene a prediction is made of.
const SLOTS: usize = 24;

/// What is told of a profile before a core of it has run.
#[derive(Debug, Clone)]
pub struct Forecast {
    /// What it costs.
    pub cost: Cost,
    /// Expected errors of force, capacitance and position.
    pub predicted: Errors,
    /// What these are made of.
    pub sources: Sources,
    /// The least amplitude of a channel in steps of the ADC.
    pub least_codes: f64,
}

/// What is told of a profile on scenes.
///
/// # Errors
/// A core that cannot be, a calibration that its words cannot represent.
pub fn forecast(profile: &Profile, benches: &[Bench]) -> Result<Forecast> {
    let (mut of_scenes, mut of_sources) = (Vec::new(), Sources::default());
    let mut least_codes = f64::INFINITY;
    for bench in benches {
        let what = || format!("profile {}", profile.name);
        let served = bench.serve(profile).with_context(what)?;
        let (expected, sources, codes) =
            predicted(&served, bench.calibration(), bench.some(SLOTS)).with_context(what)?;
        least_codes = least_codes.min(codes);
        of_scenes.push(expected);
        for (of, sources) in of_sources.iter_mut().zip(sources) {
            for (name, rms) in sources {
                *of.entry(name).or_default() += rms * rms / benches.len() as f64;
            }
        }
    }
    of_sources.iter_mut().flat_map(|of| of.values_mut()).for_each(|square| *square = square.sqrt());
    let predicted = mean(&of_scenes);
    Ok(Forecast { cost: cost(profile)?, predicted, sources: of_sources, least_codes })
}

/// Errors over scenes of the same weight.
pub fn mean(of_scenes: &[Errors]) -> Errors {
    [0, 1, 2].map(|quantity| {
        pooled(&of_scenes.iter().map(|errors| errors[quantity]).collect::<Vec<_>>())
    })
}
