// SPDX-License-Identifier: MIT OR Apache-2.0
//! Position tables without a fit: a core only needs words, and a fit takes longer than all else of a run of `core`.
//!
//! Ratios rise along the axes and bend towards the edges, and the resistance is largest at the ends, as those of a
//! sheet. A B-spline's coefficients are near its values, so that the functions stand for them.

use fastrand::Rng;
use hapticore_contract::calibration::{Axis, Layout, Point, PositionTable, Scalar, Surface};
use hapticore_contract::format::Format;
use hapticore_contract::profile::Profile;

use crate::stimulus::corner;

/// A fitted table, of the smallest profile.
pub(super) fn any() -> PositionTable {
    let profile = Profile::bundled("small").expect("a bundled profile");
    let point = |k: i32| {
        let (x, y) = (f64::from(k % 5 - 2) * 20.0, f64::from(k / 5 - 2) * 10.0);
        Point { x, y, r_x: x / 50.0, r_y: y / 25.0, sheet: 0.05 }
    };
    let points: Vec<_> = (0..25).map(point).collect();
    PositionTable::fit(&profile, &points).expect("places that span an area")
}

/// The words of a table of the profile's raster, whose surfaces bend and reach so far.
pub(super) fn words(profile: &Profile, bend: f64, reach: f64) -> Vec<f64> {
    let layout = Layout::new(profile);
    let mut words = vec![0.0; layout.words()];
    for (axis, start) in [(Axis::X, Scalar::StartRatioX), (Axis::Y, Scalar::StartRatioY)] {
        let half = layout.cells(Surface::RatioX, axis) as f64 / 2.0;
        let scalars = [
            (Scalar::Gain, reach / Layout::GAIN),
            (start, half / Layout::CELLS / 4.0),
            (Scalar::Pitch, 0.9),
        ];
        scalars.iter().for_each(|&(scalar, word)| words[layout.scalar(scalar, axis)] = word);
    }
    let r_x = |u: f64, v: f64| reach * (bend * u).sin() / bend.sin() * (1.0 - 0.15 * v * v);
    let r_y = |u: f64, v: f64| reach * v * (1.0 - 0.3 * u * u);
    fill(&mut words, &layout, Surface::RatioX, r_x);
    fill(&mut words, &layout, Surface::RatioY, r_y);
    fill(&mut words, &layout, Surface::Resistance, |u, _| 0.05 + 0.02 * u * u);
    words
}

/// The coefficients of a surface: its values at their centres, from -1 to 1 along either axis.
fn fill(words: &mut [f64], layout: &Layout, surface: Surface, value: impl Fn(f64, f64) -> f64) {
    let [columns, rows] = [Axis::X, Axis::Y].map(|axis| layout.coefficients(surface, axis));
    let centre = |k: usize, of: usize| 2.0 * k as f64 / (of - 1) as f64 - 1.0;
    let coefficients = &mut words[layout.surface(surface)..][..columns * rows];
    for (k, word) in coefficients.iter_mut().enumerate() {
        *word = value(centre(k % columns, columns), centre(k / columns, rows));
    }
}

/// Puts corners of the format in place of some words.
pub(super) fn disturb(words: &mut [f64], format: Format, rng: &mut Rng) {
    for _ in 0..rng.usize(1..=8) {
        let at = rng.usize(..words.len());
        words[at] = format.real(corner(rng, format));
    }
}
