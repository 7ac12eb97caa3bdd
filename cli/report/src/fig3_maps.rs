// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fig. 3's maps: the force's deviation and the position's error over the sheet, a map for each
//! setting.

use super::figure::{Figure, box_swatch, key};
use super::map::map;
use super::number;
use super::page::escape;
use super::paint::{DIVERGING, Paint, SEQUENTIAL};
use super::select::{Setting, deviation_percent, position_error, rms, spread_percent};
use hapticore_run::record::Row;

/// Tiles that all maps of a figure share.
const TILES: usize = 7000;

/// Where the steps of the deviation begin, percent.
const DEVIATION_STEPS: [f64; 5] = [0.05, 0.1, 0.2, 0.5, 2.0];

/// Where the steps of the position error begin, mm.
const ERROR_STEPS: [f64; 5] = [0.2, 0.5, 1.0, 2.0, 5.0];

/// Deviations of the force from its mean over the sheet, by the core and by eq. 6 alone.
pub fn force(
    settings: &[Setting],
    left_out: usize,
    core: fn(&Row) -> f64,
    eq6: fn(&Row) -> f64,
) -> Figure {
    let estimates = [("core", core), ("eq. 6 alone", eq6)];
    let is_known = |get: fn(&Row) -> f64| {
        settings.iter().any(|s| s.rows.iter().any(|(row, _)| get(row).is_finite()))
    };
    let estimates: Vec<_> = estimates.into_iter().filter(|(_, get)| is_known(*get)).collect();
    let most = TILES / (settings.len() * estimates.len()).max(1);
    let mut maps = String::new();
    for setting in settings {
        for (name, get) in &estimates {
            maps += &deviation_map(setting, name, *get, most);
        }
    }
    let mut note = String::from(
        "Deviation of the force from its mean over the sheet. The number above each map is (largest − smallest) / mean. The frame is the sheet's edge.",
    );
    if left_out > 0 {
        note += &format!(" {left_out} further settings are not shown, here and below.");
    }
    Figure::wide("Force over the sheet", &note, deviation_legend(), grid(&maps))
}

fn deviation_map(setting: &Setting, estimate: &str, get: fn(&Row) -> f64, most: usize) -> String {
    let values: Vec<_> = setting.rows.iter().map(|(row, _)| get(row)).collect();
    let what = format!("{estimate}: {} %", number::short(spread_percent(&values)));
    let places = places(setting, &deviation_percent(&values));
    titled(&setting.name, &what, |about| {
        map(about, setting.half_sheet_mm, &places, most, |d| Paint::diverging(deviation_step(d)))
    })
}

fn deviation_step(percent: f64) -> i32 {
    let step = DEVIATION_STEPS.partition_point(|edge| *edge <= percent.abs()) as i32;
    if percent < 0.0 { -step } else { step }
}

fn deviation_legend() -> String {
    let entry =
        |step: i32| key(&deviation_name(step), &box_swatch(&Paint::diverging(step).fill_class()));
    (-DIVERGING..=DIVERGING).map(entry).collect()
}

fn deviation_name(step: i32) -> String {
    let edge = |n: i32| usize::try_from(n).ok().and_then(|n| DEVIATION_STEPS.get(n)).copied();
    let sign = if step < 0 { "−" } else { "" };
    match (edge(step.abs() - 1), edge(step.abs())) {
        (None, Some(to)) => format!("±{to} %"),
        (Some(from), Some(to)) if step < 0 => format!("−{to} … −{from}"),
        (Some(from), Some(to)) => format!("{from} … {to}"),
        (from, None) => format!("beyond {sign}{}", from.unwrap_or_default()),
    }
}

/// Distances of the measured from the true position.
pub fn position(settings: &[Setting]) -> Figure {
    let most = TILES / settings.len().max(1);
    let maps: String = settings.iter().map(|s| error_map(s, most)).collect();
    let note = "Distance from the true position. The number above each map is its RMS over the sheet; in brackets, that of the floating-point reference.";
    Figure::wide("Position error over the sheet", note, error_legend(), grid(&maps))
}

/// A setting's position errors, mm.
pub fn position_errors(setting: &Setting) -> Vec<f64> {
    setting.rows.iter().map(|(row, truth)| position_error(&row.measured, truth)).collect()
}

fn error_map(setting: &Setting, most: usize) -> String {
    let errors = position_errors(setting);
    let ideal = rms(setting
        .rows
        .iter()
        .filter_map(|(r, t)| Some(position_error(&r.reference?.quantities, t))));
    let ideal =
        if ideal.is_finite() { format!(" ({})", number::short(ideal)) } else { String::new() };
    let what = format!("{} mm{ideal}", number::short(rms(errors.iter().copied())));
    titled(&setting.name, &what, |about| {
        map(about, setting.half_sheet_mm, &places(setting, &errors), most, error_paint)
    })
}

/// The colour of a position error, mm.
pub fn error_paint(error_mm: f64) -> Paint {
    Paint::sequential(ERROR_STEPS.partition_point(|edge| *edge <= error_mm))
}

/// What the colours of position errors are.
pub fn error_legend() -> String {
    let edge = |n: usize| ERROR_STEPS.get(n).copied();
    let name = |n: usize| match (n.checked_sub(1).and_then(edge), edge(n)) {
        (None, to) => format!("below {} mm", to.unwrap_or_default()),
        (Some(from), Some(to)) => format!("{from} … {to}"),
        (Some(from), None) => format!("beyond {from}"),
    };
    (0..SEQUENTIAL)
        .map(|n| key(&name(n), &box_swatch(&Paint::sequential(n).fill_class())))
        .collect()
}

fn places(setting: &Setting, values: &[f64]) -> Vec<(f64, f64, f64)> {
    let truths = setting.rows.iter().map(|(_, truth)| truth.quantities);
    truths.zip(values).map(|(q, value)| (q.x_mm, q.y_mm, *value)).collect()
}

/// A map under the name of its setting and a line on what it shows; `svg` draws it, told what it is
/// about.
pub fn titled(name: &str, what: &str, svg: impl Fn(&str) -> String) -> String {
    let lines =
        [name, what].into_iter().filter(|line| !line.is_empty()).map(escape).collect::<Vec<_>>();
    let about = format!("{name} {what}");
    format!("<div>\n<p>{}</p>\n{}</div>\n", lines.join("<br />"), svg(about.trim()))
}

/// Maps beside each other.
pub fn grid(maps: &str) -> String {
    format!("<div class=\"maps\">\n{maps}</div>\n")
}
