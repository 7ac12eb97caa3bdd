// SPDX-License-Identifier: MIT OR Apache-2.0
//! Predictions without most clocks beside those of every clock.

use super::*;
use crate::support::device;
use hapticore_contract::profile::ForceLaw;
use std::collections::BTreeMap;

/// Profiles whose estimators differ: bundled ones, block-floating words, a force table.
fn profiles() -> Vec<Profile> {
    let mut profiles = Profile::of_distinct_words();
    let of = |change: fn(&mut Profile)| {
        let mut profile = Profile::bundled("standard").expect("bundled");
        change(&mut profile);
        crate::check(&profile).expect("a core");
        profile
    };
    profiles.push(of(|profile| profile.force.law = ForceLaw::Table));
    profiles.push(of(|profile| {
        let formats = &mut profile.formats;
        formats.block_shift = 8;
        formats.total = Format { width: formats.iq.width + 2, ..formats.iq };
    }));
    profiles
}

/// Predictions of three slots with other currents.
fn predictions(core: Core, profile: &Profile) -> Vec<Prediction> {
    let mut predictor = Predictor::of_core(core, profile, &device::calibration(profile));
    let slot = |current: f64| {
        let mut amplitudes: Vec<(f64, f64)> = (1..profile.channels())
            .map(|n| (0.1 * current * (1.0 + 0.1 * n as f64), 0.02 * current))
            .collect();
        *amplitudes.last_mut().expect("the sensing voltage") = (0.02, -0.7);
        predictor.slot(0, Signals::Tones { amplitudes: &amplitudes, mean_square: 0.1 })
    };
    [0.9, 0.3, 0.05].map(slot).into()
}

/// What a block rounds at its output is one source where its reader holds the signal, and several where it reads it in
/// several clocks: variances then differ by less than this part.
const ONE_OR_SEVERAL: f64 = 0.01;

fn check_moments(of: Moments, expected: Moments, scale: f64, what: &str) {
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-6 * scale;
    let part =
        (of.variance - expected.variance).abs() / expected.variance.max(1e-12 * scale * scale);
    let is_near =
        near(of.mean, expected.mean) && near(of.bound, expected.bound) && part < ONE_OR_SEVERAL;
    assert!(is_near, "{what}: {of:?}, in every clock {expected:?}");
}

fn check_expected(of: &Expected, expected: &Expected, what: &str) {
    assert!((of.real - expected.real).abs() <= 1e-9 * expected.real.abs(), "{what}");
    // Derivatives of products, not of their halves: the same but for what differences of golden models are off.
    let scale = expected.errors.total.bound;
    check_moments(of.errors.total, expected.errors.total, scale, what);
    let sources = |of: &Expected| of.errors.by_source.iter().cloned().collect::<BTreeMap<_, _>>();
    let (of, expected) = (sources(of), sources(expected));
    assert!(of.keys().eq(expected.keys()), "{what}: {of:?}, in every clock {expected:?}");
    for ((name, of), expected) in of.into_iter().zip(expected.into_values()) {
        check_moments(of, expected, scale, &format!("{what} by {name}"));
    }
}

/// Also by source: what rounds is named as it is where blocks are clocked one beside the other.
#[test]
fn predictions_are_those_of_every_clock() {
    for profile in profiles() {
        let core = Core::new(&profile);
        let expected = predictions(core.clone(), &profile);
        let mut short = core;
        short.place_by_statements();
        let found = predictions(short, &profile);
        for (n, (of, expected)) in found.iter().zip(&expected).enumerate() {
            let what = |name: &str| format!("{}, slot {n}, {name}", profile.name);
            check_expected(&of.x, &expected.x, &what("x"));
            check_expected(&of.y, &expected.y, &what("y"));
            check_expected(&of.capacitance, &expected.capacitance, &what("capacitance"));
            check_expected(&of.force, &expected.force, &what("force"));
            check_expected(&of.mean_square, &expected.mean_square, &what("mean square"));
        }
    }
}
