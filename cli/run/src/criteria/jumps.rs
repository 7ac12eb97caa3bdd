// SPDX-License-Identifier: MIT OR Apache-2.0
//! When a measured quantity jumps.

use std::collections::BTreeMap;

use hapticore_scene::Criterion;

use super::estimate::{Estimate, estimated};
use crate::record::Row;

/// A jump is at least this many times the mean change.
const STANDS_OUT: f64 = 5.0;

/// Slots of a pad before and after a jump that are averaged: the ripple of a gap that follows a sine
/// is not at the same phase in each.
const AVERAGED: usize = 7;

/// How far the jump of the core's measurement is from where the criterion expects it, s; not a
/// number where nothing jumps.
pub fn off(rows: &[&Row], criterion: &Criterion, start_s: f64) -> f64 {
    let expected_s = criterion.expected.unwrap_or(f64::NAN);
    steepest(rows, criterion).map_or(f64::NAN, |row| (row.time_s - start_s - expected_s).abs())
}

/// The row from which on the measurement's mean rises most above the mean before, if that stands
/// out.
fn steepest<'a>(rows: &[&'a Row], criterion: &Criterion) -> Option<&'a Row> {
    let mut pads: BTreeMap<usize, Vec<&Row>> = BTreeMap::new();
    rows.iter().for_each(|row| pads.entry(row.pad).or_default().push(row));
    let measurement = |row: &&Row| estimated(row, criterion.of, Estimate::Core);
    let mean = |rows: &[&Row]| rows.iter().map(measurement).sum::<f64>() / AVERAGED as f64;
    let rises: Vec<_> = pads
        .values()
        .flat_map(|rows| rows.windows(2 * AVERAGED))
        .map(|rows| (mean(&rows[AVERAGED..]) - mean(&rows[..AVERAGED]), rows[AVERAGED]))
        .collect();
    let usual = rises.iter().map(|(rise, _)| rise.abs()).sum::<f64>() / rises.len() as f64;
    let (rise, row) = rises.into_iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    (rise >= STANDS_OUT * usual).then_some(row)
}
