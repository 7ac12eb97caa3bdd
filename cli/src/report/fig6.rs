// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fig. 6: friction departs from the square law, the capacitance rises suddenly, and eq. 8 follows
//! both.

use super::axis::Axis;
use super::fig4::{capacitance_axis, keys, trio, voltage_axis};
use super::figure::Figure;
use super::number;
use super::paint::Paint;
use super::plot::Plot;
use super::select::{self, extent};
use super::series::{Point, Series};
use super::sweep::{Load, loads, means, reference, slots};
use hapticore_run::record::{Record, Row, Truth};

/// The square law is fitted up to this voltage, where the paper's data still follow it.
const SQUARE_LAW_TO_V: f64 = 150.0;

/// Force over the voltage squared, capacitance over voltage, and the force error of eq. 8.
pub fn figures(record: &Record) -> Vec<Figure> {
    let loads = loads(record);
    vec![force(&loads), capacitance(&loads), residual(record, &loads)]
}

fn kilovolts_squared(truth: &Truth) -> f64 {
    truth.quantities.haptic_v_rms.powi(2) / 1e3
}

fn force(loads: &[Load]) -> Figure {
    let mut series = Vec::new();
    for (n, load) in loads.iter().enumerate() {
        series.extend(forces(load, Paint::series(n)));
    }
    series.extend(keys(loads));
    series.push(Series::line("square law", Paint::INK.dashed(), vec![]));
    let points = || series.iter().flat_map(|s| s.points.iter());
    let x = Axis::with_zero("haptic voltage squared (10³ V²)", points().map(|p| p.0));
    let y = Axis::with_zero("F (N)", points().map(|p| p.1));
    let plot = Plot::new("Haptic force over the square of the haptic voltage", x, y, series);
    let note = format!("The square law is fitted to the true force up to {SQUARE_LAW_TO_V} V RMS.");
    Figure::plot("Haptic force over the haptic voltage squared", &note, &plot)
}

/// Square law, truth, reference and slots at one load.
fn forces(load: &Load, paint: Paint) -> [Series; 4] {
    let truth = means(&load.settings, |_, t| (kilovolts_squared(t), t.quantities.force_n));
    let slope = slope(&truth);
    let law = truth.iter().map(|(x, _)| (*x, slope * x)).collect();
    let ideal = means(&load.settings, |r, t| (kilovolts_squared(t), reference(r, |q| q.force_n)));
    let measured = slots(&load.settings, |r, t| (kilovolts_squared(t), r.measured.force_n));
    [
        Series::line("", paint.dashed(), law),
        Series::line("", paint, truth).tagged(&name(load)),
        Series::rings("", paint, ideal),
        Series::dots("", paint, measured),
    ]
}

/// Least squares through the origin, over the points that the square law holds for.
fn slope(points: &[Point]) -> f64 {
    let low = points.iter().filter(|(x, y)| x * 1e3 <= SQUARE_LAW_TO_V.powi(2) && y.is_finite());
    let (xy, xx) = low.fold((0.0, 0.0), |(xy, xx), (x, y)| (xy + x * y, xx + x * x));
    xy / xx
}

fn name(load: &Load) -> String {
    format!("{} g", number::fixed(load.load_g, 0))
}

fn capacitance(loads: &[Load]) -> Figure {
    let mut series = Vec::new();
    for (n, load) in loads.iter().enumerate() {
        series.extend(trio(&load.settings, Paint::series(n), &name(load), |_, t| {
            t.quantities.haptic_v_rms
        }));
    }
    series.extend(keys(loads));
    let plot = Plot::new(
        "Sensor output over haptic voltage",
        voltage_axis(loads),
        capacitance_axis(loads),
        series,
    );
    Figure::plot("Sensor output over the haptic voltage", "", &plot)
}

fn residual(record: &Record, loads: &[Load]) -> Figure {
    let at = |t: &Truth, force: f64| (t.quantities.haptic_v_rms, force - t.quantities.force_n);
    let eq6 = |r: &Row| r.reference.map_or(f64::NAN, |r| r.force_eq6_n);
    let mut series = Vec::new();
    for (n, load) in loads.iter().enumerate() {
        let paint = Paint::series(n);
        series.push(Series::line("", paint.dashed(), means(&load.settings, |r, t| at(t, eq6(r)))));
        series.push(Series::rings(
            "",
            paint,
            means(&load.settings, |r, t| at(t, reference(r, |q| q.force_n))),
        ));
        series.push(Series::dots(
            &name(load),
            paint,
            slots(&load.settings, |r, t| at(t, r.measured.force_n)),
        ));
    }
    let values: Vec<_> = series.iter().flat_map(|s| s.points.iter().map(|p| p.1)).collect();
    if record.rows.iter().any(|r| r.reference.is_some()) {
        series.push(Series::rings("floating-point reference", Paint::INK, vec![]));
        series.push(Series::line("eq. 6 alone", Paint::INK.dashed(), vec![]));
    }
    let limits = select::limit(record, "N", "").map_or(vec![], |limit| vec![-limit, limit]);
    let worst = extent(values.iter().map(|v| v.abs())).map_or(f64::NAN, |(_, high)| high);
    let y = Axis::with_zero("ΔF (N)", values.into_iter().chain(limits.iter().copied()));
    let mut plot =
        Plot::new("Measured minus true force over haptic voltage", voltage_axis(loads), y, series);
    plot.limits = limits;
    Figure::plot(
        "Force error of eq. 8",
        &format!("Measured minus true force: at most {} N.", number::short(worst)),
        &plot,
    )
}
