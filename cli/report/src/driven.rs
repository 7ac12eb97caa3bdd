// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pads that a controller drives, in any scene: their targets beside their true forces, where walls are, and how deep pads
//! lie in them.

use super::axis::Axis;
use super::figure::Figure;
use super::over_time::{self, PANELS, Quantity};
use super::paint::Paint;
use super::plot::Plot;
use super::select;
use super::series::{Mark, Series};
use hapticore_run::record::{Driven, Record, Row, Rows, Truth, WallPlace};

/// Cases that are drawn of a run with more than [`PANELS`]; the table of tracking has all.
const FIRST: usize = 2;

/// Targets and depths over time, as far as there are any.
pub fn figures(record: &Record) -> Vec<Figure> {
    let count = record.rows.cases().count();
    let (most, further) = match count {
        0..=PANELS => (count, String::new()),
        _ => (FIRST, format!(" {} further cases are not drawn.", count - FIRST)),
    };
    let rows = Rows::of_cases(record.rows.cases().take(most).map(<[Row]>::to_vec));
    let (cases, pads) = (record.cases.clone(), record.pads.clone());
    let drawn = Record { rows, cases, pads, ..Record::default() };
    [targets(&drawn, &further), depths(&drawn, &further)].into_iter().flatten().collect()
}

/// The part of a split pad that brakes and is judged by the wall along x: its last.
fn last_part(record: &Record) -> usize {
    let parts = record.rows.iter().filter_map(|row| row.truth.map(|truth| truth.part));
    parts.max().unwrap_or(0)
}

fn driven(row: &Row) -> Option<(Driven, Truth)> {
    row.driven.zip(row.truth)
}

/// The force of each pad that is to have any, and its target.
fn targets(record: &Record, further: &str) -> Option<Figure> {
    let last = last_part(record);
    let brakes = |row: &Row| driven(row).filter(|(_, truth)| truth.part == last);
    let has_target = |pad: usize| {
        record
            .rows
            .iter()
            .filter(|row| row.pad == pad)
            .any(|row| brakes(row).is_some_and(|(driven, _)| driven.target_n > 0.0))
    };
    let pads: Vec<_> = select::pads(record).into_iter().filter(|pad| has_target(*pad)).collect();
    let plot = |record: &Record| {
        let of = |pad: usize, value: fn(&(Driven, Truth)) -> f64| {
            over_time::points(record, pad, |row| brakes(row).as_ref().map_or(f64::NAN, value))
        };
        let force = |pad: &usize| {
            let points = of(*pad, |(_, truth)| truth.quantities.force_n);
            Series::line(&select::pad_name(record, *pad), Paint::series(*pad), points)
                .mark(Mark::Line(6))
        };
        let target = |pad: &usize| {
            let points = of(*pad, |(driven, _)| driven.target_n);
            Series::line("", Paint::INK.dashed(), points).mark(Mark::Line(2))
        };
        let mut series: Vec<_> = pads.iter().map(force).chain(pads.iter().map(target)).collect();
        let y = Axis::with_zero("F (N)", series.iter().flat_map(|s| s.points.iter().map(|p| p.1)));
        series.push(Series::line("target", Paint::INK.dashed(), Vec::new()));
        Plot::new("True force and target over time", over_time::time_axis(record), y, series)
    };
    let note = "The force is the true one of the part that brakes; the target is that of its drive."
        .to_string() + further;
    (!pads.is_empty())
        .then(|| over_time::of_cases(record, "True force and its target", &note, plot))
}

/// How deep each pad that meets a wall lies in it.
fn depths(record: &Record, further: &str) -> Option<Figure> {
    let last = last_part(record);
    let wall = |row: &Row| row.driven.and_then(|driven| driven.wall);
    let depth = |row: &Row| wall(row).map_or(f64::NAN, |wall: WallPlace| wall.depth_mm.max(0.0));
    let meets = |pad: usize| record.rows.iter().any(|row| row.pad == pad && depth(row) > 0.0);
    let pads: Vec<_> = select::pads(record).into_iter().filter(|pad| meets(*pad)).collect();
    let plot = |record: &Record| {
        let line = |pad: &usize| {
            let points = over_time::points(record, *pad, depth);
            let of_last = |row: &Row| row.truth.is_some_and(|truth| truth.part == last);
            let along_x = record.rows.iter().any(|row| row.pad == *pad && of_last(row));
            let along = if along_x { "along x" } else { "along y" };
            let name = format!("{}, {along}", select::pad_name(record, *pad));
            Series::line(&name, Paint::series(*pad), points)
        };
        let series: Vec<_> = pads.iter().map(line).collect();
        let y =
            Axis::with_zero("depth (mm)", series.iter().flat_map(|s| s.points.iter().map(|p| p.1)));
        Plot::new("Depth in the wall over time", over_time::time_axis(record), y, series)
    };
    let note = "How deep a pad's last part lies within the wall; 0 outside. The wall along y is known by the part before the last.".to_string()
        + further;
    (!pads.is_empty()).then(|| over_time::of_cases(record, "Depth in the wall", &note, plot))
}

/// Where walls begin, as parts of pads meet them, in a plot of the place along x or along y. One wall for all pads, but for an
/// arena, where each has its own.
pub fn surfaces(record: &Record, title: &str) -> Vec<Series> {
    let of = |column: &str| -> Quantity { over_time::quantity_of_column(column) };
    let (along_x, along_y) = (title == of("x_mm").0, title == of("y_mm").0);
    let last = last_part(record);
    let surface = |row: &Row| {
        let (driven, _) = driven(row).filter(|(_, truth)| (truth.part == last) == along_x)?;
        driven.wall.map(|wall| wall.surface_mm)
    };
    if !(along_x || along_y) {
        return Vec::new();
    }
    let walled =
        |pad: &usize| record.rows.iter().any(|row| row.pad == *pad && surface(row).is_some());
    let walled = select::pads(record).into_iter().filter(walled);
    let most = if record.rows.iter().any(|row| row.game.is_some()) { usize::MAX } else { 1 };
    let line = |(n, pad): (usize, usize)| {
        let name = if n == 0 { "wall's surface" } else { "" };
        let points = over_time::points(record, pad, |row| surface(row).unwrap_or(f64::NAN));
        Series::line(name, Paint::LIMIT, points).mark(Mark::Line(3))
    };
    walled.take(most).enumerate().map(line).collect()
}
