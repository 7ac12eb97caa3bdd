// SPDX-License-Identifier: MIT OR Apache-2.0
//! The paper's Fig. 9: force control. A panel for each case, the force above its drive; cases with
//! the same target stand side by side, and all panels have the same axes. Below them, how far each
//! is off its target, and how that compares with the open loop.

use super::axis::Axis;
use super::control::{OPEN, Panel, by_target, panels};
use super::fig3_maps::titled;
use super::figure::{self, Figure};
use super::general;
use super::number;
use super::page::escape;
use super::paint::Paint;
use super::plot::Plot;
use super::series::{Mark, Point, Series};
use super::tables;
use hapticore_run::record::{Driven, Record, Row, Truth};

/// Panels that are drawn; the others are in the table alone.
const PANELS: usize = 16;

/// What limits and faults look like, above the drive.
const MARK: Mark = Mark::Line(10);

/// The axes of all panels, and the characters of the longest label of the vertical ones.
struct Axes {
    time: Axis,
    force: Axis,
    drive: Axis,
    label_characters: usize,
}

/// A figure for each target, then the table.
pub fn figures(record: &Record) -> Vec<Figure> {
    let panels = panels(record);
    if panels.is_empty() {
        return general::figures(record);
    }
    let groups = by_target(panels);
    let axes = axes(&groups);
    let mut room = PANELS;
    let mut figures = Vec::new();
    for group in &groups {
        let drawn = &group[..group.len().min(room)];
        room -= drawn.len();
        figures.extend((!drawn.is_empty()).then(|| of_target(drawn, &axes)));
    }
    figures.push(errors(&groups));
    figures
}

fn axes(groups: &[Vec<Panel>]) -> Axes {
    let rows = || groups.iter().flatten().flat_map(|panel| &panel.rows);
    let time = Axis::linear("time (s)", rows().map(|(time, ..)| *time));
    let forces = |(_, row, truth): &(f64, &Row, Truth)| {
        [truth.set.target_n, truth.quantities.force_n, row.measured.force_n]
    };
    let force = Axis::with_zero("force (N)", rows().flat_map(forces));
    let drives = rows().filter_map(|(_, row, _)| Some(row.driven?.drive_v_rms));
    let drive = Axis::with_zero("drive (V RMS)", drives);
    let label_characters = force.longest_label().max(drive.longest_label());
    Axes { time, force, drive, label_characters }
}

/// The cases with a target beside each other.
fn of_target(group: &[Panel], axes: &Axes) -> Figure {
    let title = format!("Force control, target up to {} N", number::short(group[0].most_n()));
    let note = "The target is that of the slot. The drive is what the controller makes of the slot: \
                the pad is given it from the slot's end on.";
    let panels: String = group.iter().map(|panel| drawn(panel, axes)).collect();
    let body = format!("<div class=\"panels\">\n{panels}</div>\n");
    Figure::wide(&title, note, legend(group), body)
}

fn drawn(panel: &Panel, axes: &Axes) -> String {
    let off = format!(
        "off target {} N RMS, overshoot {} N{}",
        number::short(panel.rms_n()),
        number::short(panel.overshoot_n()),
        marks(panel)
    );
    let mut untitled = axes.time.clone();
    untitled.title.clear();
    let plot = |about: String, [x, y]: [&Axis; 2], height: u32, series: Vec<Series>| {
        let mut plot = Plot::new(&about, x.clone(), y.clone(), series);
        (plot.height, plot.label_characters) = (height, axes.label_characters);
        plot.svg()
    };
    titled(&panel.name, &off, |about| {
        let [of_force, of_drive] = ["Force", "Drive"].map(|of| format!("{of} over time, {about}"));
        plot(of_force, [&untitled, &axes.force], 600, forces(panel))
            + &plot(of_drive, [&axes.time, &axes.drive], 400, drives(panel))
    })
}

/// How many of a panel's slots are marked.
fn marks(panel: &Panel) -> String {
    let count = |name: &str, marked: fn(&Driven) -> bool| match panel.count(marked) {
        0 => String::new(),
        count => format!("; {name} in {count} of {} slots", panel.rows.len()),
    };
    count("limited", |driven| driven.limited) + &count("fault", |driven| driven.fault)
}

/// Each narrower than the one below it, so that lines at the same place all show.
fn forces(panel: &Panel) -> Vec<Series> {
    let of = |value: fn(&Row, &Truth) -> f64| {
        panel.rows.iter().map(|(time, row, truth)| (*time, value(row, truth))).collect::<Vec<_>>()
    };
    vec![
        Series::line("target", Paint::series(1), held(&of(|_, truth| truth.set.target_n)))
            .mark(Mark::Line(8)),
        Series::line("core's estimate", Paint::series(0), of(|row, _| row.measured.force_n))
            .mark(Mark::Line(5)),
        Series::line("true force", Paint::INK, of(|_, truth| truth.quantities.force_n))
            .mark(Mark::Line(2)),
    ]
}

/// The drive, held from slot to slot; below it, wider, where it is limited or zero by a fault.
fn drives(panel: &Panel) -> Vec<Series> {
    let of = |drawn: fn(&Driven) -> bool| {
        let drive = |row: &Row| row.driven.filter(drawn).map_or(f64::NAN, |it| it.drive_v_rms);
        held(&panel.rows.iter().map(|(time, row, _)| (*time, drive(row))).collect::<Vec<_>>())
    };
    let fault = Series::line("drives off by a fault", Paint::LIMIT, of(|driven| driven.fault));
    vec![
        Series::line("drive limited", Paint::series(3), of(|driven| driven.limited)).mark(MARK),
        fault.mark(MARK),
        Series::line("drive", Paint::series(2), of(|_| true)),
    ]
}

/// What any of the panels shows.
fn legend(group: &[Panel]) -> String {
    let mut keys: Vec<Series> = Vec::new();
    for series in group.iter().flat_map(|panel| [forces(panel), drives(panel)]).flatten() {
        let shown = series.points.iter().any(|(_, y)| y.is_finite());
        if shown && keys.iter().all(|key| key.name != series.name) {
            keys.push(series);
        }
    }
    figure::keys(&keys)
}

/// Steps: each value stands until the time of the next.
fn held(points: &[Point]) -> Vec<Point> {
    let ends = points.iter().skip(1).chain(points.last()).map(|(time, _)| *time);
    points.iter().zip(ends).flat_map(|(&(time, y), end)| [(time, y), (end, y)]).collect()
}

/// What each case is off its target, and how many times that of the open loop.
fn errors(groups: &[Vec<Panel>]) -> Figure {
    let heads = [
        "case",
        "law",
        "#target up to",
        "#off target, RMS",
        "#× open loop",
        "#largest overshoot",
        "#× open loop",
        "#limited slots",
        "#slots with a fault",
    ];
    let rows = groups.iter().flat_map(|group| group.iter().map(|panel| error(panel, group)));
    let table = tables::table("Off target", &heads, &rows.collect::<String>());
    let note = "Off target is the true force less its target, over all slots of the case; the largest \
                overshoot is the most that it is above. Beside each, the same over that of the open \
                loop with the same target.";
    Figure::wide("Off target, closed loop and open loop", note, String::new(), table)
}

fn error(panel: &Panel, group: &[Panel]) -> String {
    let open = group.iter().find(|other| other.law == Some(OPEN) && other.pad == panel.pad);
    let ratio =
        |of: fn(&Panel) -> f64| number::short(open.map_or(f64::NAN, |open| of(panel) / of(open)));
    let newtons = |value: f64| number::with_unit(&number::short(value), "N");
    tables::row(&[
        ("", &escape(&panel.name)),
        ("", &escape(panel.law.unwrap_or(number::NONE))),
        ("number", &newtons(panel.most_n())),
        ("number", &newtons(panel.rms_n())),
        ("number", &ratio(|panel| panel.rms_n())),
        ("number", &newtons(panel.overshoot_n())),
        ("number", &ratio(|panel| panel.overshoot_n())),
        ("number", &panel.count(|driven| driven.limited).to_string()),
        ("number", &panel.count(|driven| driven.fault).to_string()),
    ])
}
