// SPDX-License-Identifier: MIT OR Apache-2.0
//! The paper's Fig. 7: friction and what eq. 8 makes of it over time, the pad's capacitance, and
//! its voltage, which falls.

use super::axis::Axis;
use super::figure::Figure;
use super::general::{self, Quantity};
use super::hockey::force_error;
use super::laws;
use super::paint::Paint;
use super::plot::Plot;
use super::select;
use super::series::{Point, Series};
use hapticore_run::record::Record;

/// Below this the haptic voltage is off, V rms.
const OFF_V: f64 = 1.0;

/// Voltage on an axis of its own range, since it falls by some percent.
const VOLTAGE: Quantity = ("Haptic voltage while switched on", "V RMS (V)", |q| {
    if q.haptic_v_rms > OFF_V { q.haptic_v_rms } else { f64::NAN }
});

/// Force, its error, capacitance, voltage; the cases over each other where there are several.
pub fn figures(record: &Record) -> Vec<Figure> {
    let [force, capacitance, voltage] = [
        general::quantity_of_column("force_n"),
        general::quantity_of_column("capacitance_pf"),
        VOLTAGE,
    ]
    .map(|q| general::over_time(record, q));
    let compared = (record.cases.len() > 1).then(|| cases(record));
    let figures = [force, force_error(record), capacitance, voltage];
    compared.into_iter().chain(figures).chain(laws::over_time(record)).collect()
}

/// True haptic force of every case over its own time: how much earlier one jumps than another.
fn cases(record: &Record) -> Figure {
    let force = |rows: &[hapticore_run::record::Row]| -> Vec<Point> {
        let start_s = rows[0].time_s;
        let points = rows.iter().map(|r| {
            (r.time_s - start_s, r.truth.map_or(f64::NAN, |truth| truth.quantities.force_n))
        });
        points.collect()
    };
    let mut series: Vec<Series> = record
        .rows
        .cases()
        .enumerate()
        .map(|(n, rows)| {
            let name = select::case_name(record, rows[0].case);
            Series::line(&name, Paint::series(n), force(rows))
        })
        .collect();
    // The last case lies behind: a drive's ripple would hide the mean square, which comes first.
    series.reverse();
    let values = |of: fn(&Point) -> f64| series.iter().flat_map(move |s| s.points.iter().map(of));
    let time = Axis::linear("time since switching on (s)", values(|p| p.0));
    let newtons = Axis::linear("true haptic force (N)", values(|p| p.1));
    let plot = Plot::new("True haptic force of each case", time, newtons, series.clone());
    let note = "Jumps are where a patch of the pad pulls in. Cases that differ in the drive alone \
                show what its mean square, in place of the sine, costs.";
    Figure::plot("True haptic force, cases compared", note, &plot)
}
