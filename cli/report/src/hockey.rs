// SPDX-License-Identifier: MIT OR Apache-2.0
//! Several pads together: their trajectories over the sheet, forces and errors over time.

use super::axis::Axis;
use super::figure::Figure;
use super::general;
use super::map;
use super::number;
use super::paint::Paint;
use super::plot::Plot;
use super::select;
use super::series::{Mark, Point, Series};
use hapticore_run::record::{Record, Row};

/// Bins of time for what is too dense to draw.
const BINS: u32 = 50;

/// Trajectories, force, both errors, capacitance, voltage.
pub fn figures(record: &Record) -> Vec<Figure> {
    let [force, capacitance, voltage] = ["force_n", "capacitance_pf", "haptic_v_rms"]
        .map(|name| general::over_time(record, general::quantity_of_column(name)));
    vec![
        trajectories(record),
        force,
        position_error(record),
        force_error(record),
        capacitance,
        voltage,
    ]
}

fn trajectories(record: &Record) -> Figure {
    let pads = select::pads(record);
    let true_place =
        |r: &Row| r.truth.map_or((f64::NAN, f64::NAN), |t| (t.quantities.x_mm, t.quantities.y_mm));
    let place = |r: &Row| (r.measured.x_mm, r.measured.y_mm);
    let measured = |pad: &usize| {
        let name = select::pad_name(record, *pad);
        Series::dots(&name, Paint::series(*pad), trajectory(record, *pad, place))
            .mark(Mark::Dots(8))
    };
    let truth = |pad: &usize| {
        Series::line("", Paint::MUTED, trajectory(record, *pad, true_place)).mark(Mark::Line(3))
    };
    let half = map::half_sheet_mm(record);
    let mut series = vec![frame(half)];
    series.extend(pads.iter().map(truth));
    series.extend(pads.iter().map(measured));
    series.push(Series::line("true value", Paint::MUTED, vec![]));
    let points = || series.iter().flat_map(|s| s.points.iter());
    let (x, y) = (
        side("x (mm)", half.0, points().map(|p| p.0)),
        side("y (mm)", half.1, points().map(|p| p.1)),
    );
    let ratio = y.1 / x.1;
    let mut plot = Plot::new("Trajectories of the pads over the sheet", x.0, y.0, series);
    plot.height = (120.0 + 1130.0 * ratio).clamp(400.0, 1400.0) as u32;
    Figure::plot("Trajectories over the sheet", "The frame is the sheet's edge.", &plot)
}

/// The sheet's edge.
fn frame((x, y): (f64, f64)) -> Series {
    Series::line("", Paint::MUTED, vec![(-x, y), (x, y), (x, -y), (-x, -y), (-x, y)])
        .mark(Mark::Line(2))
}

/// An axis over the sheet, and further where a trajectory goes beyond its edge; half of what it
/// shows.
fn side(title: &str, half: f64, values: impl Iterator<Item = f64>) -> (Axis, f64) {
    let reach = values.map(f64::abs).filter(|v| v.is_finite()).fold(half, f64::max);
    (Axis::exact(title, -reach, reach), reach)
}

fn trajectory(record: &Record, pad: usize, place: impl Fn(&Row) -> Point) -> Vec<Point> {
    let rows: Vec<_> = record.rows.iter().filter(|r| r.pad == pad).collect();
    let cases = rows.chunk_by(|a, b| a.case == b.case);
    cases.flat_map(|case| case.iter().map(|r| place(r)).chain([(f64::NAN, f64::NAN)])).collect()
}

fn position_error(record: &Record) -> Figure {
    let error = |r: &Row| r.truth.map_or(f64::NAN, |t| select::position_error(&r.measured, &t));
    let rms = number::short(select::rms(record.rows.iter().map(error)));
    let plot = |record: &Record| {
        let mut series = Vec::new();
        for pad in select::pads(record) {
            let points = general::points(record, pad, error);
            let (name, paint) = (select::pad_name(record, pad), Paint::series(pad));
            series.push(Series::line(&name, paint, binned(&points, select::rms)));
            let largest = |bin: Vec<f64>| select::extent(bin).map_or(f64::NAN, |e| e.1);
            series.push(Series::dots("", paint, binned(&points, largest)));
        }
        series.push(Series::dots("largest error", Paint::INK, vec![]));
        let y = Axis::with_zero("|Δ position| (mm)", record.rows.iter().map(error));
        let time = general::time_axis(record);
        let mut plot = Plot::new("Distance from the true position", time, y, series);
        plot.limits.extend(select::bound(record, "position_mm"));
        plot
    };
    let note = format!(
        "Lines: RMS error in each 1/{BINS} of the time; dots: largest error in it. {rms} mm RMS over all pads.{}",
        select::limits_note(record, "position_mm", "mm")
    );
    general::of_cases(record, "Position error", &note, plot)
}

/// A value for each bin of time, from those within it.
fn binned(points: &[Point], value: impl Fn(Vec<f64>) -> f64) -> Vec<Point> {
    let Some((start, end)) = select::extent(points.iter().map(|p| p.0)) else {
        return Vec::new();
    };
    let width = ((end - start) / f64::from(BINS)).max(f64::MIN_POSITIVE);
    let bin = |time: f64| ((time - start) / width).floor().min(f64::from(BINS) - 1.0);
    let finite: Vec<_> = points.iter().filter(|p| p.0.is_finite()).copied().collect();
    let chunks = finite.chunk_by(|a, b| bin(a.0) == bin(b.0));
    chunks
        .map(|c| (select::mean(c.iter().map(|p| p.0)), value(c.iter().map(|p| p.1).collect())))
        .collect()
}

/// Measured less true force over time, and the limits of a criterion that bounds it in every slot.
pub fn force_error(record: &Record) -> Figure {
    let error = |r: &Row| r.truth.map_or(f64::NAN, |t| r.measured.force_n - t.quantities.force_n);
    let plot = |record: &Record| {
        let line = |pad: usize| {
            let name = select::pad_name(record, pad);
            general::noisy(&name, Paint::series(pad), general::points(record, pad, error))
        };
        let series: Vec<_> = select::pads(record).into_iter().flat_map(line).collect();
        let y = Axis::with_zero("ΔF (N)", record.rows.iter().map(error));
        let time = general::time_axis(record);
        let mut plot = Plot::new("Measured minus true force", time, y, series);
        plot.limits = select::bound(record, "force_n").map_or(vec![], |limit| vec![-limit, limit]);
        plot
    };
    let rms = number::short(select::rms(record.rows.iter().map(error)));
    let note = format!("{rms} N RMS over all pads.{}", select::limits_note(record, "force_n", "N"));
    general::of_cases(record, "Force error", &note, plot)
}
