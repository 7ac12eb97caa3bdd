// SPDX-License-Identifier: MIT OR Apache-2.0
//! Forecast of a profile before a core of it has run: its cost, and its expected errors over all
//! scenes.

use super::bench::Bench;
use super::cost::{Cost, cost};
use super::errors::{Errors, Expectation, Sources, pooled, predicted};
use anyhow::{Context, Result};
use hapticore_contract::profile::Profile;
use hapticore_model::fidelity::noise::Predictor;

/// How many slots of a scene a prediction is made of.
const SLOTS: usize = 24;

/// Forecast of a profile before a core of it has run.
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
    /// Whether one slot makes most of a predicted error or a frame is flagged: the error then may be any.
    pub is_of_one: [bool; 3],
}

/// The forecast of a profile on scenes.
///
/// # Errors
/// A core that cannot be, a calibration that its words cannot represent.
pub fn forecast(profile: &Profile, benches: &[Bench]) -> Result<Forecast> {
    let (mut of_scenes, mut of_sources) = (Vec::new(), Sources::default());
    let (mut least_codes, mut is_of_one) = (f64::INFINITY, [false; 3]);
    for bench in benches {
        let what = || format!("profile {}", profile.name);
        let served = bench.serve(profile).with_context(what)?;
        let on =
            |slots| predicted(&served, bench.calibration(), bench.some(slots)).with_context(what);
        let mut expected = on(SLOTS)?;
        if expected.least_codes < Predictor::FEW_CODES {
            // Few slots do not say what the rounding of few codes is on others.
            expected = on(bench.slots().len())?;
        }
        let Expectation { errors, sources, .. } = expected;
        least_codes = least_codes.min(expected.least_codes);
        is_of_one = [0, 1, 2].map(|n| is_of_one[n] | expected.is_of_one[n]);
        of_scenes.push(errors);
        for (of, sources) in of_sources.iter_mut().zip(sources) {
            for (name, rms) in sources {
                *of.entry(name).or_default() += rms * rms / benches.len() as f64;
            }
        }
    }
    of_sources.iter_mut().flat_map(|of| of.values_mut()).for_each(|square| *square = square.sqrt());
    let predicted = mean(&of_scenes);
    Ok(Forecast { cost: cost(profile)?, predicted, sources: of_sources, least_codes, is_of_one })
}

/// Errors over scenes of the same weight.
pub fn mean(of_scenes: &[Errors]) -> Errors {
    [0, 1, 2].map(|quantity| {
        pooled(&of_scenes.iter().map(|errors| errors[quantity]).collect::<Vec<_>>())
    })
}
