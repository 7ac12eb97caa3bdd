// SPDX-License-Identifier: MIT OR Apache-2.0
//! When a measured quantity jumps.

use hapticore_scene::Criterion;

use super::estimate::{Estimate, estimated};
use crate::record::Row;

/// A jump is at least so many times the mean change from slot to slot.
const STANDS_OUT: f64 = 5.0;

/// How far the jump of the core's measurement is from where the criterion expects it, s; not a
/// number where nothing jumps.
pub fn off(rows: &[&Row], criterion: &Criterion, start_s: f64) -> f64 {
    let expected_s = criterion.expected.unwrap_or(f64::NAN);
    steepest(rows, criterion).map_or(f64::NAN, |row| (row.time_s - start_s - expected_s).abs())
}

/// The row to which the measurement rises most from the same pad's row before, if that stands out.
fn steepest<'a>(rows: &[&'a Row], criterion: &Criterion) -> Option<&'a Row> {
    let measurement = |row: &Row| estimated(row, criterion.of, Estimate::Core);
    let last = |n: usize| rows[..n].iter().rev().find(|before| before.pad == rows[n].pad);
    let rises: Vec<_> = (0..rows.len())
        .filter_map(|n| Some((measurement(rows[n]) - measurement(last(n)?), rows[n])))
        .collect();
    let mean = rises.iter().map(|(rise, _)| rise.abs()).sum::<f64>() / rises.len() as f64;
    let (rise, row) = rises.into_iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    (rise >= STANDS_OUT * mean).then_some(row)
}
