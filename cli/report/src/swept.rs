// SPDX-License-Identifier: MIT OR Apache-2.0
//! Any sweep: every quantity over what is swept. Where only the place is swept, its error over the
//! place.

use std::collections::BTreeMap;

use super::axis::Axis;
use super::fig3_maps;
use super::figure::Figure;
use super::general::{self, Quantity};
use super::number;
use super::paint::Paint;
use super::plot::Plot;
use super::select::{self, settings};
use super::series::{Mark, Point, Series};
use hapticore_run::record::{Record, Row, Truth};

/// Lines of a plot; more would not be told apart.
const LINES: usize = 12;

/// What quantities are drawn over, the first that is swept, and how it is called.
const OVER: [(&str, &str); 4] = [
    ("haptic_v_rms", "haptic voltage (V RMS)"),
    ("load_g", "load (g)"),
    ("capacitance_pf", "set capacitance (pF)"),
    ("eccentricity_mm", "eccentricity (mm)"),
];

/// All figures of a sweep.
pub fn figures(record: &Record) -> Vec<Figure> {
    let quantities = general::quantities(record);
    match OVER.into_iter().find(|(key, _)| record.swept.contains(key)) {
        Some(over) => quantities.into_iter().map(|q| over_setting(record, q, over)).collect(),
        None => {
            let errors = quantities.into_iter().map(|q| error_over_x(record, q));
            [fig3_maps::position(&settings(record))].into_iter().chain(errors).collect()
        }
    }
}

/// Rows of one line: equal case, pad and settings, except the setting on its horizontal axis.
type Lines<'a> = BTreeMap<(usize, usize, Vec<i64>), Vec<(&'a Row, Truth)>>;

fn lines<'a>(record: &'a Record, over: &str) -> Lines<'a> {
    let others: Vec<_> = record.swept.iter().filter(|key| **key != over).collect();
    let mut lines = Lines::new();
    for row in &record.rows {
        if let Some(truth) = row.truth {
            let key = others.iter().map(|key| (truth.set.get(key) * 1e6).round() as i64).collect();
            lines.entry((row.case, row.pad, key)).or_default().push((row, truth));
        }
    }
    lines
}

fn over_setting(
    record: &Record,
    (title, axis, get): Quantity,
    (key, name): (&str, &str),
) -> Figure {
    let lines = lines(record, key);
    let (mut series, mut truths) = (Vec::new(), Vec::new());
    for (n, rows) in lines.values().take(LINES).enumerate() {
        let at = |value: &dyn Fn(&Row, &Truth) -> f64| {
            rows.iter().map(|(r, t)| (t.set.get(key), value(r, t))).collect()
        };
        let paint = Paint::series(n);
        series.push(
            Series::dots(&line_name(record, rows[0], key), paint, at(&|r, _| get(&r.measured)))
                .mark(Mark::Dots(6)),
        );
        truths.push(
            Series::line("", paint, sorted(at(&|_, t| get(&t.quantities)))).mark(Mark::Line(3)),
        );
    }
    series.extend(truths);
    let points = || series.iter().flat_map(|s| s.points.iter());
    let (x, y) =
        (Axis::linear(name, points().map(|p| p.0)), Axis::linear(axis, points().map(|p| p.1)));
    series.push(Series::line("true value", Paint::INK, Vec::new()));
    let left_out = lines.len().saturating_sub(LINES);
    let more = if left_out > 0 {
        format!(" {left_out} further settings are not shown.")
    } else {
        String::new()
    };
    let note = general::difference_note(record, get, axis) + &more;
    Figure::plot(title, note.trim(), &Plot::new(&format!("{title} over {name}"), x, y, series))
}

/// What sets a line apart: the pad, and what else is swept.
fn line_name(record: &Record, (row, truth): (&Row, Truth), over: &str) -> String {
    let several = select::pads(record).len() > 1;
    let pad = several.then(|| select::pad_name(record, row.pad));
    let case = Some(select::case_name(record, row.case)).filter(|name| !name.is_empty());
    let others = record.swept.iter().filter(|key| **key != over);
    let values = others.map(|key| {
        let (name, unit) = key.split_once('_').unwrap_or((key, ""));
        format!("{name} {} {}", number::chosen(truth.set.get(key)), unit.replace('_', " "))
    });
    let words: Vec<_> = case.into_iter().chain(pad).chain(values).collect();
    if words.is_empty() { "measured".into() } else { words.join(", ") }
}

fn sorted(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}

fn error_over_x(record: &Record, (title, axis, get): Quantity) -> Figure {
    let error = |r: &Row| r.truth.map_or(f64::NAN, |t| get(&r.measured) - get(&t.quantities));
    let x = |r: &Row| r.truth.map_or(f64::NAN, |t| t.set.x_mm);
    let pads = select::pads(record);
    let series: Vec<_> = pads
        .iter()
        .map(|pad| {
            let rows = record.rows.iter().filter(|r| r.pad == *pad);
            let name = if pads.len() > 1 { select::pad_name(record, *pad) } else { String::new() };
            Series::dots(&name, Paint::series(*pad), rows.map(|r| (x(r), error(r))).collect())
        })
        .collect();
    let points = || series.iter().flat_map(|s| s.points.iter());
    let horizontal = Axis::linear("x (mm)", points().map(|p| p.0));
    let vertical = Axis::with_zero(&format!("Δ{axis}"), points().map(|p| p.1));
    let rms = number::short(select::rms(points().map(|p| p.1)));
    let title = format!("{title}: measured minus true value");
    let code = general::code_note(record, get, general::unit_of(axis), points().map(|p| p.1));
    let rms = number::with_unit(&rms, general::unit_of(axis));
    let note = format!("RMS error over all positions: {rms}. {code}");
    Figure::plot(
        &title,
        note.trim(),
        &Plot::new(&format!("{title}, over x"), horizontal, vertical, series),
    )
}
