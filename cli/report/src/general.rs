// SPDX-License-Identifier: MIT OR Apache-2.0
//! Any run: every quantity of every pad over time, measured, reference and truth.

use super::axis::Axis;
use super::driven;
use super::figure::Figure;
use super::number;
use super::paint::Paint;
use super::plot::Plot;
use super::select;
use super::series::{Mark, Point, Series};
use hapticore_host::QUANTITIES;
use hapticore_run::record::{Record, Row};

use super::over_time::BINS;
pub use super::over_time::{Get, Quantity, of_cases, points, quantity_of_column, time_axis};

/// Slots of a pad of which each has a dot of its own; more become a line of means and the band that
/// they fill.
const FEW: usize = 300;

/// The least range of an axis, of its values: 150 V with a noise of 1.5 mV is a straight line.
const LEAST_RANGE: f64 = 2e-3;

/// A plot over fewer codes than this shows them as steps.
const CODES: f64 = 40.0;

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
    let plot = |record: &Record| {
        let mut series = pads_series(record, get);
        let values = series.iter().flat_map(|s| s.points.iter().map(|p| p.1));
        let y = Axis::linear(axis, values).at_least(LEAST_RANGE);
        series.extend(driven::surfaces(record, title));
        series.extend(keys(record));
        Plot::new(&format!("{title} over time"), time_axis(record), y, series)
    };
    let unit = unit_of(axis);
    let values = record.rows.iter().map(|row| get(&row.measured));
    let notes = [
        error_note(record, get, unit),
        difference_note(record, get, axis),
        code_note(record, get, unit, values),
    ];
    let notes: Vec<_> = notes.into_iter().filter(|note| !note.is_empty()).collect();
    of_cases(record, title, &notes.join(" "), plot)
}

/// The unit of an axis.
pub fn unit_of(axis: &str) -> &str {
    axis.split_once('(').map_or("", |(_, unit)| unit.trim_end_matches(')'))
}

/// What was measured, a colour per pad, over the truth and, where slots are few, the reference as a dotted line.
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
        // A line of means is narrower than the truth, which frames it; dots are wider.
        let width = if points.len() <= FEW { 3 } else { 9 };
        Series::line("", Paint::MUTED, points).mark(Mark::Line(width))
    };
    pads.iter()
        .map(truth)
        .chain(pads.iter().filter_map(reference))
        .chain(pads.iter().flat_map(measured))
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

/// How far what is measured is off the truth.
fn error_note(record: &Record, get: Get, unit: &str) -> String {
    let error = |r: &Row| r.truth.map(|t| (get(&r.measured) - get(&t.quantities)).abs());
    let errors: Vec<_> = record.rows.iter().filter_map(error).filter(|e| e.is_finite()).collect();
    let Some((_, most)) = select::extent(errors.iter().copied()) else { return String::new() };
    let [most, rms] =
        [most, select::rms(errors)].map(|value| number::with_unit(&number::short(value), unit));
    format!("Measured and true value differ by {most} at most, {rms} RMS.")
}

/// How far core and reference are apart; their lines hardly show it.
pub fn difference_note(record: &Record, get: Get, axis: &str) -> String {
    let difference = |r: &Row| r.reference.map(|q| (get(&r.measured) - get(&q.quantities)).abs());
    match select::extent(record.rows.iter().filter_map(difference)) {
        Some((_, most)) => {
            let most = number::with_unit(&number::short(most), unit_of(axis));
            format!("Largest difference between core and floating-point reference: {most}.")
        }
        None => String::new(),
    }
}

/// What one code of the core is, where `values` span so few that dots show them as steps.
pub fn code_note(
    record: &Record,
    get: Get,
    unit: &str,
    values: impl Iterator<Item = f64>,
) -> String {
    let (code, span) = (get(&record.codes), select::extent(values));
    let few = |(low, high): (f64, f64)| high - low < CODES * code;
    if record.fidelity == "float" || !span.is_some_and(few) {
        return String::new();
    }
    let code = number::with_unit(&number::short(code), unit);
    format!("Dots lie in steps: one code of the core is {code}.")
}

/// What stands for truth and reference in the legend, where there are any.
pub fn keys(record: &Record) -> Vec<Series> {
    let truth = record.rows.iter().any(|r| r.truth.is_some());
    let few = select::pads(record)
        .iter()
        .any(|pad| record.rows.iter().filter(|r| r.pad == *pad).count() < FEW);
    let reference = few && record.rows.iter().any(|r| r.reference.is_some());
    let keys = [
        (truth, Series::line("true value", Paint::MUTED, Vec::new())),
        (reference, Series::line("floating-point reference", Paint::MUTED.dotted(), Vec::new())),
    ];
    keys.into_iter().filter_map(|(there, key)| there.then_some(key)).collect()
}
