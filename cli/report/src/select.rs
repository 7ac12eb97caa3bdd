// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rows by case, setting and pad, and what is measured over them.

use std::collections::BTreeMap;

use super::map::half_sheet_mm;
use super::number;
use hapticore_run::record::{Quantities, Record, Row, Truth};

/// Slots with all settings equal but the position.
#[derive(Clone, Debug)]
pub struct Setting<'a> {
    /// The case, and what sets this one apart within it.
    pub name: String,
    /// Half of the sheet.
    pub half_sheet_mm: (f64, f64),
    /// Its slots, all with a truth.
    pub rows: Vec<(&'a Row, Truth)>,
}

/// The settings of a run, in its order.
pub fn settings(record: &Record) -> Vec<Setting<'_>> {
    let mut groups: BTreeMap<(usize, usize), Vec<(&Row, Truth)>> = BTreeMap::new();
    for row in &record.rows {
        if let Some(truth) = row.truth {
            groups.entry((row.case, truth.group)).or_default().push((row, truth));
        }
    }
    let several = |case: usize| groups.keys().filter(|key| key.0 == case).count() > 1;
    let half_sheet_mm = half_sheet_mm(record);
    let named = groups.iter().map(|((case, _), rows)| {
        let setting = if several(*case) { setting_name(rows) } else { String::new() };
        let parts = [case_name(record, *case), setting];
        let parts: Vec<_> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        Setting { name: parts.join(", "), half_sheet_mm, rows: rows.clone() }
    });
    named.collect()
}

fn setting_name(rows: &[(&Row, Truth)]) -> String {
    let load = mean(rows.iter().map(|(_, t)| t.load_g));
    let volts = mean(rows.iter().map(|(_, t)| t.quantities.haptic_v_rms));
    format!("{} g, {} V", number::fixed(load, 0), number::fixed(volts, 0))
}

/// The case's name; empty where there is but one.
pub fn case_name(record: &Record, case: usize) -> String {
    match record.cases.get(case) {
        Some(name) if record.cases.len() > 1 => name.clone(),
        _ => String::new(),
    }
}

/// The pad's name, or its number.
pub fn pad_name(record: &Record, pad: usize) -> String {
    record.pads.get(pad).filter(|n| !n.is_empty()).cloned().unwrap_or_else(|| format!("pad {pad}"))
}

/// The pads that have rows.
pub fn pads(record: &Record) -> Vec<usize> {
    let mut pads: Vec<_> = record.rows.iter().map(|r| r.pad).collect();
    pads.sort_unstable();
    pads.dedup();
    pads
}

/// The cases that have rows, each as a record of its own whose time begins with it: up to `most` of them where they are
/// several.
pub fn by_case(record: &Record, most: usize) -> Vec<(String, Record)> {
    let alone = |rows: &[Row]| {
        let start_s = rows[0].time_s;
        let rows = rows.iter().map(|row| Row { time_s: row.time_s - start_s, ..row.clone() });
        let (cases, pads, criteria) =
            (record.cases.clone(), record.pads.clone(), record.criteria.clone());
        Record {
            rows: rows.collect(),
            cases,
            pads,
            criteria,
            sheet_mm: record.sheet_mm,
            ..Record::default()
        }
    };
    let cases = record.rows.cases().take(most);
    cases.map(|rows| (case_name(record, rows[0].case), alone(rows))).collect()
}

/// The limit of a criterion that bounds the error of this quantity in every slot of the rows.
pub fn bound(record: &Record, of: &str) -> Option<f64> {
    let names: Vec<_> = record.rows.cases().map(|rows| record.cases.get(rows[0].case)).collect();
    let covers = |cases: &[String]| {
        cases.is_empty() || names.iter().all(|name| name.is_some_and(|name| cases.contains(name)))
    };
    let criteria = record.criteria.iter().filter(|criterion| criterion.applicable);
    let bounds =
        criteria.filter_map(|criterion| Some((criterion.bounds.as_ref()?, criterion.limit)));
    let holding = bounds.filter(|(bounds, _)| bounds.of == of && covers(&bounds.cases));
    holding.map(|(_, limit)| limit).reduce(f64::min)
}

/// What is said where limits are not drawn: those of means and of chosen slots.
pub fn limits_note(record: &Record, of: &str, unit: &str) -> &'static str {
    let has_others = record.criteria.iter().any(|criterion| criterion.unit == unit);
    match bound(record, of) {
        None if has_others => {
            " Limits that criteria set to means, RMS errors or chosen slots are not drawn."
        }
        _ => "",
    }
}

/// Distance of the measured from the true position, mm.
pub fn position_error(measured: &Quantities, truth: &Truth) -> f64 {
    (measured.x_mm - truth.quantities.x_mm).hypot(measured.y_mm - truth.quantities.y_mm)
}

/// The mean of the finite values.
pub fn mean(values: impl IntoIterator<Item = f64>) -> f64 {
    let finite = values.into_iter().filter(|v| v.is_finite());
    let (sum, count) = finite.fold((0.0, 0.0), |(sum, count), v| (sum + v, count + 1.0));
    sum / count
}

/// The root mean square of the finite values.
pub fn rms(values: impl IntoIterator<Item = f64>) -> f64 {
    mean(values.into_iter().map(|v| v * v)).sqrt()
}

/// Least and largest finite value.
pub fn extent(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    let finite = values.into_iter().filter(|v| v.is_finite());
    finite.fold(None, |extent, v| {
        extent.map_or(Some((v, v)), |(low, high): (f64, f64)| Some((low.min(v), high.max(v))))
    })
}

/// Largest less least, in percent of the mean.
pub fn spread_percent(values: &[f64]) -> f64 {
    let extent = extent(values.iter().copied());
    extent.map_or(f64::NAN, |(low, high)| 100.0 * (high - low) / mean(values.iter().copied()).abs())
}

/// Each value's deviation from the mean, in percent of it.
pub fn deviation_percent(values: &[f64]) -> Vec<f64> {
    let mean = mean(values.iter().copied());
    values.iter().map(|v| 100.0 * (v - mean) / mean.abs()).collect()
}
