// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fig. 6: friction departs from the square law, the capacitance rises suddenly, and eq. 8 follows
//! both. The paper's panels first: friction over the voltage, capacitance over the voltage, and the
//! increment of friction over C·V.

use super::axis::Axis;
use super::fig4::{BARS, capacitance_axis, keys, ordinates, trio, voltage_axis};
use super::figure::Figure;
use super::laws;
use super::number;
use super::paint::Paint;
use super::plot::Plot;
use super::select::{self, extent};
use super::series::{Point, Series};
use super::sweep::{Load, loads, means, measured, reference, slots};
use hapticore_run::record::{Quantities, Record, Row, Truth};

/// The square law is fitted up to this voltage, where the paper's data still follow it.
const SQUARE_LAW_TO_V: f64 = 150.0;

/// Friction and capacitance over voltage, the increment over C·V, the force over the voltage
/// squared, and the force error of eq. 8.
pub fn figures(record: &Record) -> Vec<Figure> {
    let loads = loads(record);
    let has_friction = record.rows.iter().any(|row| row.truth.is_some_and(|t| t.friction_n > 0.0));
    let panel_a = has_friction.then(|| friction(&loads));
    let others = [capacitance(&loads), increment(&loads), force(&loads), residual(record, &loads)];
    panel_a.into_iter().chain(others).chain(laws::over_voltage(record)).collect()
}

/// Panel a: what the load's friction is without a voltage, and what the voltage adds.
fn friction(loads: &[Load]) -> Figure {
    let volt = |t: &Truth| t.quantities.haptic_v_rms;
    let mut series = Vec::new();
    for (n, load) in loads.iter().enumerate() {
        let paint = Paint::series(n);
        let of_load = |t: &Truth| t.friction_n - t.quantities.force_n;
        let truth = means(&load.settings, |_, t| (volt(t), t.friction_n));
        let offset = means(&load.settings, |_, t| (volt(t), of_load(t)));
        let at = |r: &Row, t: &Truth| (volt(t), of_load(t) + r.measured.force_n);
        series.push(Series::line("", paint.dashed(), offset));
        series.push(Series::line("", paint, truth).tagged(&name(load)));
        series.push(measured("", paint, &load.settings, at));
    }
    series.push(Series::dots(
        "the load's friction and the measured force, mean ± standard deviation",
        Paint::INK,
        vec![],
    ));
    series.push(Series::line("true friction", Paint::INK, vec![]));
    series.push(Series::line("the load's friction alone", Paint::INK.dashed(), vec![]));
    let y = Axis::with_zero("friction (N)", ordinates(&series));
    let plot = Plot::new("Friction over haptic voltage", voltage_axis(loads), y, series);
    Figure::plot("Friction over the haptic voltage", "", &plot)
}

/// Panel c: the increment of friction over C·V, whose square eq. 8 scales by one k.
fn increment(loads: &[Load]) -> Figure {
    let nanocoulomb = |q: &Quantities| 1e-3 * q.capacitance_pf * q.haptic_v_rms;
    let mut series = Vec::new();
    for (n, load) in loads.iter().enumerate() {
        let at = |r: &Row, t: &Truth| (nanocoulomb(&r.measured), t.quantities.force_n);
        series.push(measured(&name(load), Paint::series(n), &load.settings, at));
    }
    let all = || {
        loads.iter().flat_map(|load| {
            slots(&load.settings, |r, _| (nanocoulomb(&r.measured).powi(2), r.measured.force_n))
        })
    };
    let most = extent(all().map(|p| p.0.sqrt())).map_or(0.0, |(_, most)| most);
    let k = slope_through_origin(all());
    let curve = (0..=100).map(|n| most * f64::from(n) / 100.0).map(|x| (x, k * x * x));
    series.push(Series::line("eq. 8: k·(C·V)²", Paint::INK, curve.collect()));
    let x = Axis::with_zero(
        "C·V, measured (nC)",
        series.iter().flat_map(|s| s.points.iter().map(|p| p.0)),
    );
    let y = Axis::with_zero("increment of friction (N)", ordinates(&series));
    let plot = Plot::new("Increment of friction over C·V", x, y, series);
    let note = format!("k = {} N/nC², one for all loads.", number::short(k));
    Figure::plot("Increment of friction over C·V", &note, &plot)
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
    let y = Axis::with_zero("F (N)", ordinates(&series));
    let plot = Plot::new("Haptic force over the square of the haptic voltage", x, y, series);
    let note = format!("The square law is fitted to the true force up to {SQUARE_LAW_TO_V} V RMS.");
    Figure::plot("Haptic force over the haptic voltage squared", &note, &plot)
}

/// Square law, truth, reference and measured means at one load.
fn forces(load: &Load, paint: Paint) -> [Series; 4] {
    let truth = means(&load.settings, |_, t| (kilovolts_squared(t), t.quantities.force_n));
    let slope = slope(&truth);
    let law = truth.iter().map(|(x, _)| (*x, slope * x)).collect();
    let ideal = means(&load.settings, |r, t| (kilovolts_squared(t), reference(r, |q| q.force_n)));
    [
        Series::line("", paint.dashed(), law),
        Series::line("", paint, truth).tagged(&name(load)),
        Series::rings("", paint, ideal),
        measured("", paint, &load.settings, |r, t| (kilovolts_squared(t), r.measured.force_n)),
    ]
}

/// The slope over the points that the square law holds for.
fn slope(points: &[Point]) -> f64 {
    let holds = |point: &&Point| point.0 * 1e3 <= SQUARE_LAW_TO_V.powi(2);
    slope_through_origin(points.iter().filter(holds).copied())
}

/// Least squares through the origin.
fn slope_through_origin(points: impl Iterator<Item = Point>) -> f64 {
    let finite = points.filter(|(x, y)| x.is_finite() && y.is_finite());
    let (xy, xx) = finite.fold((0.0, 0.0), |(xy, xx), (x, y)| (xy + x * y, xx + x * x));
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
    let (mut series, mut worst) = (Vec::new(), f64::NAN);
    for (n, load) in loads.iter().enumerate() {
        let paint = Paint::series(n);
        series.push(Series::line("", paint.dashed(), means(&load.settings, |r, t| at(t, eq6(r)))));
        series.push(Series::rings(
            "",
            paint,
            means(&load.settings, |r, t| at(t, reference(r, |q| q.force_n))),
        ));
        let off = |r: &Row, t: &Truth| at(t, r.measured.force_n);
        worst = slots(&load.settings, off).iter().map(|p| p.1.abs()).fold(worst, f64::max);
        series.push(measured(&name(load), paint, &load.settings, off));
    }
    let values: Vec<_> = ordinates(&series).collect();
    if record.rows.iter().any(|r| r.reference.is_some()) {
        series.push(Series::rings("floating-point reference", Paint::INK, vec![]));
        series.push(Series::line("eq. 6 alone", Paint::INK.dashed(), vec![]));
    }
    let limits = select::bound(record, "force_n").map_or(vec![], |limit| vec![-limit, limit]);
    let y = Axis::with_zero("ΔF (N)", values.into_iter().chain(limits.iter().copied()));
    let mut plot =
        Plot::new("Measured minus true force over haptic voltage", voltage_axis(loads), y, series);
    plot.limits = limits;
    Figure::plot(
        "Force error of eq. 8",
        &format!("Measured minus true force: at most {} N. {BARS}", number::short(worst)),
        &plot,
    )
}
