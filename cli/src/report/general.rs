// SPDX-License-Identifier: MIT OR Apache-2.0
//! Any run: every quantity of every pad over time, measured, reference and truth.

use super::axis::Axis;
use super::figure::Figure;
use super::number;
use super::paint::Paint;
use super::plot::Plot;
use super::select;
use super::series::{Mark, Point, Series};
use crate::record::{Quantities, Record, Row};

/// How a quantity is got from a row's.
pub type Get = fn(&Quantities) -> f64;

/// A quantity over time: title, axis, how it is got.
pub type Quantity = (&'static str, &'static str, Get);

/// Position along x.
pub const X: Quantity = ("Position along x", "x (mm)", |q| q.x_mm);
/// Position along y.
pub const Y: Quantity = ("Position along y", "y (mm)", |q| q.y_mm);
/// Capacitance.
pub const CAPACITANCE: Quantity = ("Capacitance", "C (pF)", |q| q.capacitance_pf);
/// Force.
pub const FORCE: Quantity = ("Haptic force", "F (N)", |q| q.force_n);
/// Voltage.
pub const VOLTAGE: Quantity = ("Haptic voltage", "V rms (V)", |q| q.haptic_v_rms);
/// Direction.
pub const DIRECTION: Quantity = ("Direction of the push", "direction", |q| q.direction);

/// Every quantity that is not zero throughout.
pub fn figures(record: &Record) -> Vec<Figure> {
    let all = [X, Y, CAPACITANCE, FORCE, VOLTAGE, DIRECTION];
    all.into_iter().filter(|(_, _, get)| present(record, *get)).map(|q| over_time(record, q)).collect()
}

fn present(record: &Record, get: Get) -> bool {
    let some = |value: f64| value.is_finite() && value != 0.0;
    record.rows.iter().any(|r| some(get(&r.measured)) || r.truth.is_some_and(|t| some(get(&t.quantities))))
}

/// One quantity of all pads over time.
pub fn over_time(record: &Record, (title, axis, get): Quantity) -> Figure {
    let values = record.rows.iter().flat_map(|r| [Some(get(&r.measured)), r.truth.map(|t| get(&t.quantities))]);
    let y = Axis::linear(axis, values.flatten());
    let mut series = pads_series(record, get);
    series.extend(keys(record));
    let mut plot = Plot::new(&format!("{title} over time"), time_axis(record), y, series);
    plot.breaks = breaks(record);
    let notes = [difference_note(record, get, axis), breaks_note(record)];
    let notes: Vec<_> = notes.into_iter().filter(|note| !note.is_empty()).collect();
    Figure::plot(title, &notes.join(" "), &plot)
}

/// What was measured as dots, a colour per pad; reference and truth as thin lines over them.
fn pads_series(record: &Record, get: Get) -> Vec<Series> {
    let pads = select::pads(record);
    let measured = |pad: &usize| {
        let points = points(record, *pad, |r| get(&r.measured));
        Series::dots(&select::pad_name(record, *pad), Paint::series(*pad), points).mark(Mark::Dots(6))
    };
    let reference = |pad: &usize| {
        let points = points(record, *pad, |r| r.reference.map_or(f64::NAN, |q| get(&q.quantities)));
        Series::line("", Paint::MUTED.dotted(), points)
    };
    let truth = |pad: &usize| {
        let points = points(record, *pad, |r| r.truth.map_or(f64::NAN, |t| get(&t.quantities)));
        Series::line("", Paint::INK, points).mark(Mark::Line(3))
    };
    pads.iter().map(measured).chain(pads.iter().map(reference)).chain(pads.iter().map(truth)).collect()
}

/// How far core and reference are apart; their lines hardly show it.
fn difference_note(record: &Record, get: Get, axis: &str) -> String {
    let unit = axis.split_once('(').map_or("", |(_, unit)| unit.trim_end_matches(')'));
    let difference = |r: &Row| r.reference.map(|q| (get(&r.measured) - get(&q.quantities)).abs());
    match select::extent(record.rows.iter().filter_map(difference)) {
        Some((_, most)) => {
            let most = number::with_unit(&number::short(most), unit);
            format!("The core differs from the floating-point reference by at most {most}.")
        }
        None => String::new(),
    }
}

/// What stands for truth and reference in the legend, where there are any.
pub fn keys(record: &Record) -> Vec<Series> {
    let truth = record.rows.iter().any(|r| r.truth.is_some());
    let reference = record.rows.iter().any(|r| r.reference.is_some());
    let keys = [
        (truth, Series::line("truth", Paint::INK, Vec::new())),
        (reference, Series::line("floating-point reference", Paint::MUTED.dotted(), Vec::new())),
    ];
    keys.into_iter().filter_map(|(there, key)| there.then_some(key)).collect()
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
pub fn breaks(record: &Record) -> Vec<f64> {
    let pairs = record.rows.windows(2).filter(|pair| pair[0].case != pair[1].case);
    pairs.map(|pair| (pair[0].time_s + pair[1].time_s) / 2.0).collect()
}

fn breaks_note(record: &Record) -> String {
    if breaks(record).is_empty() {
        return String::new();
    }
    format!("The dotted lines part the cases: {}.", record.cases.join(", "))
}
