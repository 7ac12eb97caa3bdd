// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fig. 4: the capacitance rises with the load and with the haptic voltage.

use super::axis::Axis;
use super::figure::Figure;
use super::number;
use super::paint::Paint;
use super::plot::Plot;
use super::select::Setting;
use super::series::Series;
use super::sweep::{self, Load, load, loads, means, measured, reference, slots, voltage};
use hapticore_run::record::{Record, Row, Truth};

/// What a dot is.
pub const MEASURED: &str = "measured, mean ± standard deviation";

/// What a figure without that legend says of its bars.
pub const BARS: &str = "Dots are means over a setting's slots, bars ± one standard deviation.";

/// Voltages that are drawn over the load.
const VOLTAGES: usize = 8;

/// Capacitance over load, over voltage, and its error.
pub fn figures(record: &Record) -> Vec<Figure> {
    let loads = loads(record);
    vec![over_load(&loads), over_voltage(&loads), error(&loads)]
}

fn over_load(loads: &[Load]) -> Figure {
    let most = loads.iter().map(|l| l.settings.len()).max().unwrap_or(0);
    let stride = most.saturating_sub(1).div_ceil(VOLTAGES - 1).max(1);
    let ranks: Vec<usize> = (0..most).step_by(stride).collect();
    let mut series = Vec::new();
    for (n, rank) in ranks.iter().enumerate() {
        let at: Vec<Setting> =
            loads.iter().filter_map(|l| l.settings.get(*rank).cloned()).collect();
        let paint = Paint::ramp(n, ranks.len());
        let volts = super::select::mean(at.iter().map(voltage));
        let tag = format!("{} V", number::fixed(volts, 0));
        series.extend(trio(&at, paint, &tag, |_, t| t.load_g));
    }
    series.extend(keys(loads));
    let x = Axis::linear("load (g)", loads.iter().flat_map(|l| l.settings.iter().map(load)));
    let plot = Plot::new(
        "Capacitance over load at several haptic voltages",
        x,
        capacitance_axis(loads),
        series,
    );
    Figure::plot("Capacitance over load, by haptic voltage", "", &plot)
}

fn over_voltage(loads: &[Load]) -> Figure {
    let mut series = Vec::new();
    for (n, load) in loads.iter().enumerate() {
        let tag = format!("{} g", number::fixed(load.load_g, 0));
        series
            .extend(trio(&load.settings, Paint::series(n), &tag, |_, t| t.quantities.haptic_v_rms));
    }
    series.extend(keys(loads));
    let plot = Plot::new(
        "Capacitance over haptic voltage",
        voltage_axis(loads),
        capacitance_axis(loads),
        series,
    );
    Figure::plot("Capacitance over haptic voltage, by load", "", &plot)
}

/// Truth as a line, what is measured as dots with bars, the reference's means as rings.
pub fn trio(
    settings: &[Setting],
    paint: Paint,
    tag: &str,
    x: fn(&Row, &Truth) -> f64,
) -> [Series; 3] {
    [
        Series::line("", paint, means(settings, |r, t| (x(r, t), t.quantities.capacitance_pf)))
            .tagged(tag),
        Series::rings(
            "",
            paint,
            means(settings, |r, t| (x(r, t), reference(r, |q| q.capacitance_pf))),
        ),
        measured("", paint, settings, |r, t| (x(r, t), r.measured.capacitance_pf)),
    ]
}

/// What line, dot and ring stand for, whatever their colour.
pub fn keys(loads: &[Load]) -> Vec<Series> {
    let mut keys = vec![
        Series::dots(MEASURED, Paint::INK, vec![]),
        Series::line("true value", Paint::INK, vec![]),
    ];
    if rows(loads).any(|(row, _)| row.reference.is_some()) {
        keys.push(Series::rings("floating-point reference", Paint::INK, vec![]));
    }
    keys
}

fn rows<'a>(loads: &'a [Load]) -> impl Iterator<Item = &'a (&'a Row, Truth)> {
    loads.iter().flat_map(|l| l.settings.iter().flat_map(|s| s.rows.iter()))
}

/// The horizontal axis over all true haptic voltages.
pub fn voltage_axis(loads: &[Load]) -> Axis {
    Axis::linear("haptic voltage (V RMS)", rows(loads).map(|(_, t)| t.quantities.haptic_v_rms))
}

/// The vertical axis over all capacitances, true and measured.
pub fn capacitance_axis(loads: &[Load]) -> Axis {
    let of = |(r, t): &(&Row, Truth)| {
        [r.measured.capacitance_pf, reference(r, |q| q.capacitance_pf), t.quantities.capacitance_pf]
    };
    let values = rows(loads).flat_map(of);
    Axis::linear("C (pF)", values)
}

/// What the vertical axis has to reach: points and the ends of their bars.
pub fn ordinates(series: &[Series]) -> impl Iterator<Item = f64> {
    let of_points = series.iter().flat_map(|s| s.points.iter().map(|p| p.1));
    let of_bars = series
        .iter()
        .flat_map(|s| s.points.iter().zip(&s.bars).flat_map(|(p, bar)| [p.1 - bar, p.1 + bar]));
    of_points.chain(of_bars)
}

fn error(loads: &[Load]) -> Figure {
    let percent = |value: f64, t: &Truth| 100.0 * (value / t.quantities.capacitance_pf - 1.0);
    let (mut series, mut worst) = (Vec::new(), f64::NAN);
    for (n, load) in loads.iter().enumerate() {
        let point =
            |r: &Row, t: &Truth| (t.quantities.haptic_v_rms, percent(r.measured.capacitance_pf, t));
        let name = format!("{} g", number::fixed(load.load_g, 0));
        worst = slots(&load.settings, point).iter().map(|p| p.1.abs()).fold(worst, f64::max);
        series.push(measured(&name, Paint::series(n), &load.settings, point));
        let ideal = |r: &Row, t: &Truth| {
            (t.quantities.haptic_v_rms, percent(reference(r, |q| q.capacitance_pf), t))
        };
        series.push(Series::line("", Paint::series(n), sweep::means(&load.settings, ideal)));
    }
    series.push(Series::line("floating-point reference", Paint::INK, vec![]));
    let y = Axis::with_zero("ΔC (%)", ordinates(&series));
    let plot =
        Plot::new("Error of the capacitance over haptic voltage", voltage_axis(loads), y, series);
    Figure::plot(
        "Error of the capacitance",
        &format!("At most {} % of the true capacitance. {BARS}", number::short(worst)),
        &plot,
    )
}
