// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where a measured quantity departs from its law at low voltages: a force from the square law, any
//! other from a constant.

use hapticore_scene::{Criterion, Quantity};

use super::estimate::{Estimate, estimated};
use crate::record::Row;

/// Up to here the law holds, V rms.
const LOW_V: f64 = 100.0;

/// How far from the expected voltage the measurement leaves its law, V; not a number where it does
/// not.
pub fn off(rows: &[&Row], criterion: &Criterion, estimate: Estimate) -> f64 {
    let volt = |row: &&Row| estimated(row, Quantity::HapticVRms, estimate);
    let measurement = |row: &&Row| estimated(row, criterion.of, estimate);
    let law = |row: &&Row| if criterion.of == Quantity::ForceN { volt(row).powi(2) } else { 1.0 };
    let low = || rows.iter().filter(|row| volt(row) <= LOW_V);
    let factor = low().map(measurement).sum::<f64>() / low().map(law).sum::<f64>();
    let more = 1.0 + 0.01 * criterion.departure_percent;
    let beyond = |row: &&&Row| volt(row) > LOW_V && measurement(row) > more * factor * law(row);
    let departure_v = rows.iter().filter(beyond).map(volt).reduce(f64::min);
    (departure_v.unwrap_or(f64::NAN) - criterion.expected.unwrap_or(f64::NAN)).abs()
}
