// SPDX-License-Identifier: MIT OR Apache-2.0
//! Any column of numbers of all pads over time.

use hapticore_host::quantity;
use hapticore_run::columns::{Column, Columns, Value};
use hapticore_run::record::{Record, Row};

use super::axis::Axis;
use super::figure::Figure;
use super::general::{self, noisy, points, time_axis};
use super::paint::Paint;
use super::plot::Plot;
use super::select;

/// A column over time, a colour per pad. A quantity is drawn as in a report: what is measured, with truth and reference
/// where they are known. None of a column of names.
pub fn over_time(record: &Record, columns: &Columns, column: &Column) -> Option<Figure> {
    if quantity(&column.name).is_some_and(|of| !of.axis.is_empty()) {
        return Some(general::over_time(record, general::quantity_of_column(&column.name)));
    }
    if matches!(columns.kind(column), Value::Text(_)) {
        return None;
    }
    let value = |row: &Row| match columns.value(column, row) {
        Value::Number(number) => number,
        Value::Index(index) => index as f64,
        Value::Flag(is) => f64::from(u8::from(is)),
        Value::Text(_) => f64::NAN,
    };
    let plot = |record: &Record| {
        let of_pad = |pad: usize| {
            let points = points(record, pad, value);
            noisy(&select::pad_name(record, pad), Paint::series(pad), points)
        };
        let series: Vec<_> = select::pads(record).into_iter().flat_map(of_pad).collect();
        let values = series.iter().flat_map(|s| s.points.iter().map(|p| p.1));
        let y = Axis::linear(&column.name, values);
        Plot::new(&format!("{} over time", column.name), time_axis(record), y, series)
    };
    Some(general::of_cases(record, &column.name, "", plot))
}
