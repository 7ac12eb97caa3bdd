// SPDX-License-Identifier: MIT OR Apache-2.0
//! Any run: every quantity of every pad over time, measured, reference and truth.

use super::axis::Axis;
use super::figure::Figure;
use super::number;
use super::paint::Paint;
use super::plot::Plot;
use super::select;
use super::series::{Mark, Point, Series};
use hapticore_host::{QUANTITIES, Quantities};
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

/// Slots of a pad of which each has a dot of its own; more become a line of means and the band that
/// they fill.
const FEW: usize = 300;

/// Means on the lines of a pad.
const BINS: usize = 200;

/// Every quantity that is measured, over time.
pub fn figures(record: &Record) -> Vec<Figure> {
    quantities(record).into_iter().map(|q| over_time(record, q)).collect()
}

/// The quantities that are not zero throughout; the direction where it is measured.
pub fn quantities(record: &Record) -> Vec<Quantity> {
    let some = |value: f64| value.is_finite() && value != 0.0;
    let measured = |get: Get| record.rows.iter().any(|r| some(get(&r.measured)));
    let true_one =
        |get: Get| record.rows.iter().any(|r| r.truth.is_some_and(|t| some(get(&t.quantities))));
    let direction = quantity_of_column("direction").0;
    let present =
        |(title, _, get): &Quantity| measured(*get) || (*title != direction && true_one(*get));
    let drawn = QUANTITIES.iter().filter(|quantity| !quantity.axis.is_empty());
    drawn.map(|quantity| quantity_of_column(quantity.name)).filter(present).collect()
}

/// One quantity of all pads over time.
pub fn over_time(record: &Record, (title, axis, get): Quantity) -> Figure {
    let mut series = pads_series(record, get);
    let y = Axis::linear(axis, series.iter().flat_map(|s| s.points.iter().map(|p| p.1)));
    series.extend(keys(record));
    let mut plot = Plot::new(&format!("{title} over time"), time_axis(record), y, series);
    plot.breaks = breaks(record);
    let bands = plot.series.iter().any(|s| s.mark == Mark::Band);
    let notes = [difference_note(record, get, axis), band_note(bands), breaks_note(record)];
    let notes: Vec<_> = notes.into_iter().filter(|note| !note.is_empty()).collect();
    Figure::plot(title, &notes.join(" "), &plot)
}

/// What a band is.
pub fn band_note(bands: bool) -> String {
    if bands {
        format!(
            "Each line shows means over 1/{BINS} of the pad's slots, each band the range from the smallest to the largest value."
        )
    } else {
        String::new()
    }
}

/// What was measured, a colour per pad; reference and truth as thin lines over it.
fn pads_series(record: &Record, get: Get) -> Vec<Series> {
    let pads = select::pads(record);
    let measured = |pad: &usize| {
        let points = points(record, *pad, |r| get(&r.measured));
        noisy(&select::pad_name(record, *pad), Paint::series(*pad), points)
    };
    let reference = |pad: &usize| {
        let points = points(record, *pad, |r| r.reference.map_or(f64::NAN, |q| get(&q.quantities)));
        (points.len() <= FEW).then(|| Series::line("", Paint::MUTED.dotted(), points))
    };
    let truth = |pad: &usize| {
        let points = points(record, *pad, |r| r.truth.map_or(f64::NAN, |t| get(&t.quantities)));
        Series::line("", Paint::INK, points).mark(Mark::Line(3))
    };
    pads.iter()
        .flat_map(measured)
        .chain(pads.iter().filter_map(reference))
        .chain(pads.iter().map(truth))
        .collect()
}

/// What was measured: dots, or where they are many their means and the band that they fill.
pub fn noisy(name: &str, paint: Paint, points: Vec<Point>) -> Vec<Series> {
    if points.len() <= FEW {
        return vec![Series::dots(name, paint, points).mark(Mark::Dots(6))];
    }
    let (mut line, mut bands) = (Vec::new(), Vec::new());
    for run in points
        .split(|point| !(point.0.is_finite() && point.1.is_finite()))
        .filter(|run| !run.is_empty())
    {
        let bins = run.chunks(points.len().div_ceil(BINS));
        let bins = bins.filter_map(|bin| {
            Some((
                select::mean(bin.iter().map(|p| p.0)),
                bin,
                select::extent(bin.iter().map(|p| p.1))?,
            ))
        });
        let (mut high, mut low) = (Vec::new(), Vec::new());
        for (x, bin, extent) in bins {
            line.push((x, select::mean(bin.iter().map(|p| p.1))));
            low.push((x, extent.0));
            high.push((x, extent.1));
        }
        line.push((f64::NAN, f64::NAN));
        bands.push(Series::band(paint, high.into_iter().chain(low.into_iter().rev()).collect()));
    }
    bands.push(Series::line(name, paint, line));
    bands
}

/// How far core and reference are apart; their lines hardly show it.
pub fn difference_note(record: &Record, get: Get, axis: &str) -> String {
    let unit = axis.split_once('(').map_or("", |(_, unit)| unit.trim_end_matches(')'));
    let difference = |r: &Row| r.reference.map(|q| (get(&r.measured) - get(&q.quantities)).abs());
    match select::extent(record.rows.iter().filter_map(difference)) {
        Some((_, most)) => {
            let most = number::with_unit(&number::short(most), unit);
            format!("Largest difference between core and floating-point reference: {most}.")
        }
        None => String::new(),
    }
}

/// What stands for truth and reference in the legend, where there are any.
pub fn keys(record: &Record) -> Vec<Series> {
    let truth = record.rows.iter().any(|r| r.truth.is_some());
    let few = select::pads(record)
        .iter()
        .any(|pad| record.rows.iter().filter(|r| r.pad == *pad).count() < FEW);
    let reference = few && record.rows.iter().any(|r| r.reference.is_some());
    let keys = [
        (truth, Series::line("true value", Paint::INK, Vec::new())),
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
