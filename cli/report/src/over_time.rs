// SPDX-License-Identifier: MIT OR Apache-2.0
//! Plots over device time: the quantities of rows, their points, and a panel for each case.

use super::axis::Axis;
use super::figure::Figure;
use super::plot::Plot;
use super::select;
use super::series::{Mark, Point};
use hapticore_host::Quantities;
use hapticore_run::record::{Record, Row};

/// How a quantity is got from a row's.
pub type Get = fn(&Quantities) -> f64;

/// A quantity over time: title, axis, how it is got.
pub type Quantity = (&'static str, &'static str, Get);

/// The quantity of a column, over time.
///
/// # Panics
/// If there is no such column.
pub fn quantity_of_column(name: &str) -> Quantity {
    let found = hapticore_host::quantity(name).expect("a column");
    (found.label, found.axis, found.get)
}

/// Means on the lines of a pad.
pub const BINS: usize = 200;

/// Cases that have a panel each; of more, all are in one plot.
pub const PANELS: usize = 8;

/// A plot over time, of several cases a panel for each, with axes of its own.
pub fn of_cases(
    record: &Record,
    title: &str,
    note: &str,
    plot: impl Fn(&Record) -> Plot,
) -> Figure {
    let count = record.rows.cases().count();
    let panels =
        if (2..=PANELS).contains(&count) { select::by_case(record, PANELS) } else { Vec::new() };
    let shared = |(name, record): &(String, Record)| {
        (name.clone(), Plot { share: panels.len(), ..plot(record) })
    };
    let plots: Vec<_> = panels.iter().map(shared).collect();
    let whole = plots.is_empty().then(|| Plot { breaks: breaks(record), ..plot(record) });
    let all = || plots.iter().map(|(_, plot)| plot).chain(&whole);
    let bands = all().any(|plot| plot.series.iter().any(|s| s.mark == Mark::Band));
    let separate = if plots.is_empty() {
        breaks_note(record)
    } else {
        "Each case has axes of its own.".into()
    };
    let notes = [note.trim().to_string(), band_note(bands), separate];
    let notes: Vec<_> = notes.into_iter().filter(|note| !note.is_empty()).collect();
    match &whole {
        Some(plot) => Figure::plot(title, &notes.join(" "), plot),
        None => Figure::plots(title, &notes.join(" "), &plots),
    }
}

/// What a band is.
fn band_note(bands: bool) -> String {
    if bands {
        format!(
            "Each line shows means over 1/{BINS} of the pad's slots, each band the range from the smallest to the largest value."
        )
    } else {
        String::new()
    }
}

/// A pad's values over time, interrupted between cases.
pub fn points(record: &Record, pad: usize, value: impl Fn(&Row) -> f64) -> Vec<Point> {
    let rows: Vec<_> = record.rows.iter().filter(|r| r.pad == pad).collect();
    let mut points = Vec::with_capacity(rows.len());
    for case in rows.chunk_by(|a, b| a.case == b.case) {
        points.extend(case.iter().map(|r| (r.time_s, value(r))));
        points.push((f64::NAN, f64::NAN));
    }
    points
}

/// Device time over all cases.
pub fn time_axis(record: &Record) -> Axis {
    Axis::linear("time (s)", record.rows.iter().map(|r| r.time_s))
}

/// When a case follows another.
fn breaks(record: &Record) -> Vec<f64> {
    let cases = || record.rows.cases();
    let ends_s = cases().filter_map(|rows| rows.last()).map(|row| row.time_s);
    let starts_s = cases().skip(1).map(|rows| rows[0].time_s);
    ends_s.zip(starts_s).map(|(end_s, start_s)| (end_s + start_s) / 2.0).collect()
}

fn breaks_note(record: &Record) -> String {
    if breaks(record).is_empty() {
        return String::new();
    }
    format!("Dotted lines separate the cases: {}.", record.cases.join(", "))
}
