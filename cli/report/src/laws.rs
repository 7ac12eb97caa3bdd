// SPDX-License-Identifier: MIT OR Apache-2.0
//! The force by eq. 8 and by the force table, side by side: what either leaves of the true force.

use super::axis::Axis;
use super::figure::Figure;
use super::general;
use super::number;
use super::paint::Paint;
use super::plot::Plot;
use super::series::{Point, Series};
use hapticore_run::record::{ForceLawErrors, Record, Row, Truth};

/// Over the haptic voltage; none where no row has both laws and a truth.
pub fn over_voltage(record: &Record) -> Option<Figure> {
    let volts = |_: &Row, truth: &Truth| truth.quantities.haptic_v_rms;
    let axis = Axis::with_zero("haptic voltage (V RMS)", points(record, volts, 0).map(|p| p.0));
    figure(record, volts, axis)
}

/// Over time, likewise.
pub fn over_time(record: &Record) -> Option<Figure> {
    figure(record, |row, _| row.time_s, general::time_axis(record))
}

/// The errors of a law: of eq. 8, or of the table.
fn points<'a>(
    record: &'a Record,
    x: impl Fn(&Row, &Truth) -> f64 + 'a,
    law: usize,
) -> impl Iterator<Item = Point> + 'a {
    record.rows.iter().filter_map(move |row| {
        let (laws, truth) = (row.laws?, row.truth?);
        let force_n = [laws.eq8_n, laws.table_n][law];
        Some((x(row, &truth), force_n - truth.quantities.force_n))
    })
}

fn figure(record: &Record, x: impl Fn(&Row, &Truth) -> f64, axis: Axis) -> Option<Figure> {
    let ForceLawErrors { eq8_n, table_n } = ForceLawErrors::of(&record.rows)?;
    let dots = |(law, name): (usize, &str)| {
        Series::dots(name, Paint::series(law), points(record, &x, law).collect())
    };
    let series: Vec<_> = ["eq. 8", "force table"].into_iter().enumerate().map(dots).collect();
    let values = series.iter().flat_map(|series| series.points.iter().map(|point| point.1));
    let y = Axis::with_zero("ΔF (N)", values);
    let plot = Plot::new("Force error of eq. 8 and of the force table", axis, y, series.clone());
    let errors = |[most, rms]: [f64; 2]| {
        format!("at most {} N, {} N RMS", number::short(most), number::short(rms))
    };
    let note = format!(
        "From the core's capacitance and voltage, less the true force. Eq. 8: {}. Force table: {}.",
        errors(eq8_n),
        errors(table_n)
    );
    Some(Figure::plot("Force error by law", &note, &plot))
}
