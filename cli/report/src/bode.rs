// SPDX-License-Identifier: MIT OR Apache-2.0
//! Force loops: how stable they are predicted to be, as a table, and where they were measured, gain
//! and phase of the open loop beside the prediction, with the closed loop's gain.

use super::axis::Axis;
use super::fig3_maps::titled;
use super::figure::{self, Figure};
use super::number;
use super::page::escape;
use super::paint::Paint;
use super::plot::Plot;
use super::series::Series;
use super::tables;
use hapticore_run::record::{Bode, BodePoint, Record, Stability};

/// A figure for each loop that was measured.
pub fn figures(record: &Record) -> Vec<Figure> {
    record.bode.iter().map(of_loop).collect()
}

fn of_loop(of: &Bode) -> Figure {
    let force = number::short(of.predicted.force_n);
    let title = format!("Force loop of \"{}\" about {force} N", of.case);
    let margin = |of: &Stability| {
        of.phase_margin_deg.map_or("none".into(), |margin| format!("{}°", number::short(margin)))
    };
    let note = format!(
        "Phase margin {} as measured, {} as predicted. The true force follows its target to −3 dB up to {}.",
        margin(&of.measured),
        margin(&of.predicted),
        of.bandwidth_hz
            .map_or("the highest frequency".into(), |hz| format!("{} Hz", number::short(hz)))
    );
    let hz = Axis::log("frequency (Hz)", of.points.iter().map(|point| point.hz));
    let line = |name: &str, paint: Paint, value: fn(&BodePoint) -> f64| {
        Series::line(name, paint, points(of, value))
    };
    let dots = |name: &str, value: fn(&BodePoint) -> f64| {
        Series::dots(name, Paint::series(0), points(of, value))
    };
    let gains = vec![
        line("predicted", Paint::INK, |point| point.predicted[0]),
        line("target to true force", Paint::series(1), |point| point.closed_db),
        dots("measured", |point| point.open[0]),
    ];
    let phases = vec![
        line("predicted", Paint::INK, |point| point.predicted[1]),
        dots("measured", |point| point.open[1]),
    ];
    let legend = figure::keys(&gains);
    let values = |series: &[Series]| -> Vec<f64> {
        series.iter().flat_map(|series| series.points.iter().map(|point| point.1)).collect()
    };
    let body = titled("Open loop", "", |about| {
        let plot = |of: &str, series: Vec<Series>| {
            let y = Axis::linear(of, values(&series));
            let mut plot = Plot::new(&format!("{of}, {about}"), hz.clone(), y, series);
            plot.height = 500;
            plot.svg()
        };
        plot("gain (dB)", gains.clone()) + &plot("phase (degrees)", phases.clone())
    });
    Figure::wide(&title, &note, legend, format!("<div class=\"panels\">\n{body}</div>\n"))
}

fn points(of: &Bode, value: fn(&BodePoint) -> f64) -> Vec<(f64, f64)> {
    of.points.iter().map(|point| (point.hz, value(point))).collect()
}

/// What is predicted of each case with a loop; nothing where there is none.
pub fn table(record: &Record) -> String {
    let rows: String = record.stability.iter().map(|(case, of)| row(case, of)).collect();
    if rows.is_empty() {
        return String::new();
    }
    let heads = [
        "case",
        "force",
        "frame",
        "delay",
        "open loop is 1 at",
        "phase margin",
        "gain margin",
        "overshoot of a step",
        "swing of a step",
    ];
    tables::table("Predicted stability of force loops", &heads, &rows)
}

fn row(case: &str, of: &Stability) -> String {
    let unit = |value: Option<f64>, unit: &str| {
        value.map_or("none".to_string(), |value| format!("{}{unit}", number::short(value)))
    };
    let milliseconds = |seconds: f64| unit(Some(1e3 * seconds), " ms");
    let cells = [
        escape(case),
        unit(Some(of.force_n), " N"),
        milliseconds(of.frame_s),
        milliseconds(of.delay_s),
        unit(of.crossover_hz, " Hz"),
        unit(of.phase_margin_deg, "°"),
        unit(of.gain_margin, ""),
        unit(of.step.map(|step| step.overshoot_percent), " %"),
        unit(of.step.map(|step| step.swing_percent), " %"),
    ];
    tables::row(&cells.each_ref().map(|cell| ("", cell.as_str())))
}
