// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rubber that leaves least of the capacitances.
//!
//! Where λ is known, pressures are linear in κg₀, κ and p₀. Their errors are weighted so that those of the
//! capacitance count, relative; λ is searched.

use hapticore_scene::Compression;
use nalgebra::{DMatrix, DVector};

use super::Reading;

/// λ that are tried, over the largest gap, and how many at a time.
const DECAYS: [f64; 2] = [1.0 / 200.0, 2.0];
const TRIES: usize = 120;

/// Iterations of a decomposition at most.
const ITERATIONS: usize = 1000;

/// Rounds in which weights follow the fit.
const ROUNDS: usize = 12;

/// The rubber that leaves least of the capacitances; none where none has a spring.
pub(super) fn fitted(readings: &[Reading], insulator_m: f64) -> Option<Compression> {
    let largest_m = readings.iter().map(|of| of.gap_m).fold(0.0, f64::max);
    let mut range = DECAYS.map(|share| share * largest_m);
    let mut best: Option<(f64, Compression)> = None;
    // Twice: between all, then between the neighbours of the best.
    for _ in 0..2 {
        let ratio = (range[1] / range[0]).powf(1.0 / TRIES as f64);
        let decays = (0..=TRIES).map(|n| range[0] * ratio.powi(n as i32));
        let tried = decays.filter_map(|decay_m| with_decay(readings, insulator_m, decay_m));
        let tried = tried.map(|found| (off_percent(&found, readings, insulator_m), found));
        let tried = tried.filter(|(off, _)| off.is_finite());
        best = best.into_iter().chain(tried).min_by(|a, b| a.0.total_cmp(&b.0));
        let decay_m = best?.1.contact_decay_m;
        range = [decay_m / ratio, decay_m * ratio];
    }
    best.map(|(_, found)| found)
}

/// The rubber whose contact decays over this length.
fn with_decay(readings: &[Reading], insulator_m: f64, decay_m: f64) -> Option<Compression> {
    let contact = |of: &Reading| (-of.gap_m / decay_m).exp();
    let mut weights: Vec<f64> = readings.iter().map(|of| 1.0 / of.pressure_pa).collect();
    let mut found = None;
    for _ in 0..ROUNDS {
        let left = DMatrix::from_fn(readings.len(), 3, |row, column| {
            let of = &readings[row];
            // Gaps over the decay length: columns of like size.
            weights[row] * [1.0, -of.gap_m / decay_m, contact(of)][column]
        });
        let right =
            DVector::from_fn(readings.len(), |row, _| weights[row] * readings[row].pressure_pa);
        let is_finite = left.iter().chain(&right).all(|number| number.is_finite());
        let svd = is_finite.then(|| left.try_svd(true, true, f64::EPSILON, ITERATIONS))??;
        let solved = svd.solve(&right, f64::EPSILON).ok()?;
        let spring_pa_per_m = solved[1] / decay_m;
        let is_rubber = spring_pa_per_m > 0.0 && solved[2] >= 0.0;
        if !is_rubber {
            return None;
        }
        let of = Compression {
            spring_pa_per_m,
            rest_m: solved[0] / spring_pa_per_m,
            contact_pa: solved[2],
            contact_decay_m: decay_m,
        };
        // Relative errors of the capacitance: of its height g + d.
        let weight =
            |at: &Reading| 1.0 / (of.stiffness_pa_per_m(at.gap_m) * (at.gap_m + insulator_m));
        weights = readings.iter().map(weight).collect();
        found = Some(of);
    }
    found
}

/// What a rubber leaves of the capacitances, RMS, %.
pub(super) fn off_percent(of: &Compression, readings: &[Reading], insulator_m: f64) -> f64 {
    let off = |reading: &Reading| {
        let height_m = of.gap_m(reading.pressure_pa) + insulator_m;
        ((reading.gap_m + insulator_m) / height_m - 1.0).powi(2)
    };
    100.0 * (readings.iter().map(off).sum::<f64>() / readings.len() as f64).sqrt()
}
