// SPDX-License-Identifier: MIT OR Apache-2.0
//! The paper's Fig. 13: the direction of the push that is read over the push's eccentricity, a panel for each case and a line
//! for each haptic voltage. Below it, the straight line that fits each best.

use std::collections::BTreeMap;

use super::axis::Axis;
use super::figure::Figure;
use super::general;
use super::map::half_sheet_mm;
use super::number;
use super::page::escape;
use super::paint::{Paint, SERIES};
use super::plot::Plot;
use super::select;
use super::series::{Mark, Point, Series};
use super::tables;
use hapticore_run::record::{Record, Row, Truth};

/// Cases that are drawn, and lines of each: the colours that there are. All are in the table.
const PANELS: usize = 8;

/// The part whose slot completes a direction: the right one.
const COMPLETE: usize = 1;

/// A case at a haptic voltage: what was read, what is true, mm over mm.
struct Line {
    case: String,
    volt: String,
    read: Vec<Point>,
    truth: Vec<Point>,
}

/// The readings and the lines through them.
pub fn figures(record: &Record) -> Vec<Figure> {
    let lines = lines(record);
    if lines.is_empty() {
        return general::figures(record);
    }
    vec![readings(&lines), fits(&lines)]
}

fn lines(record: &Record) -> Vec<Line> {
    let (half_width_mm, _) = half_sheet_mm(record);
    let mut lines: BTreeMap<(usize, i64), Vec<(&Row, Truth)>> = BTreeMap::new();
    for row in &record.rows {
        if let Some(truth) = row.truth.filter(|truth| truth.part == COMPLETE) {
            let volt = (1e3 * truth.set.haptic_v_rms).round() as i64;
            lines.entry((row.case, volt)).or_default().push((row, truth));
        }
    }
    let line = |((case, volt), rows): ((usize, i64), Vec<(&Row, Truth)>)| {
        let volt = format!("{} V", number::short(1e-3 * volt as f64));
        let case = select::case_name(record, case);
        let of = |direction: &dyn Fn(&Row, &Truth) -> f64| {
            let point = |(row, truth): &(&Row, Truth)| {
                (truth.set.eccentricity_mm, half_width_mm * direction(row, truth))
            };
            rows.iter().map(point).collect()
        };
        Line {
            case,
            volt,
            read: of(&|row, _| row.measured.direction),
            truth: of(&|_, truth| truth.quantities.direction),
        }
    };
    lines.into_iter().map(line).collect()
}

fn readings(lines: &[Line]) -> Figure {
    let cases: Vec<_> = lines.chunk_by(|a, b| a.case == b.case).collect();
    let points = || lines.iter().flat_map(|line| line.read.iter().chain(&line.truth));
    let x = Axis::linear("eccentricity of the push (mm)", points().map(|it| it.0));
    let y = Axis::linear("direction of the push, eq. 10 (mm)", points().map(|it| it.1));
    let panel = |lines: &&[Line]| {
        let drawn = || lines.iter().take(SERIES).enumerate();
        let truth = |(n, line): (usize, &Line)| {
            Series::line("", Paint::series(n), line.truth.clone()).mark(Mark::Line(3))
        };
        let read = |(n, line): (usize, &Line)| {
            Series::dots(&line.volt, Paint::series(n), line.read.clone()).mark(Mark::Dots(6))
        };
        let key = Series::line("true value", Paint::INK, Vec::new());
        let series = drawn().map(truth).chain(drawn().map(read)).chain([key]).collect();
        let about = "Direction of the push over its eccentricity";
        (lines[0].case.clone(), Plot::new(about, x.clone(), y.clone(), series))
    };
    let plots: Vec<_> = cases.iter().take(PANELS).map(panel).collect();
    let drawn: usize = cases.iter().take(PANELS).map(|lines| lines.len().min(SERIES)).sum();
    let left_out = match lines.len() - drawn {
        0 => String::new(),
        others => format!(" {others} further lines are in the table alone."),
    };
    let note = "Dots: the core's readings. Lines: what the parts' true capacitances give. The offset \
                at 0 mm is that of electrodes of unequal size.";
    Figure::plots("Direction of the push", &(note.to_string() + &left_out), &plots)
}

/// Slope, offset and departure of each line.
fn fits(lines: &[Line]) -> Figure {
    let heads =
        ["case", "#haptic voltage", "#slope", "#offset", "#largest departure from the line"];
    let row = |line: &Line| {
        let [slope, offset_mm, off] = fit(&line.read);
        tables::row(&[
            ("", &escape(&line.case)),
            ("number", &line.volt),
            ("number", &number::short(slope)),
            ("number", &number::with_unit(&number::short(1e3 * offset_mm), "µm")),
            ("number", &number::with_unit(&number::short(off), "%")),
        ])
    };
    let table = tables::table("Readings", &heads, &lines.iter().map(row).collect::<String>());
    let note = "The straight line that fits a line's readings best: mm read per mm of eccentricity, \
                the reading at 0 mm, and by how much the readings leave it, in percent of what it \
                spans.";
    Figure::wide("Sensitivity and offset", note, String::new(), table)
}

/// Slope, middle and largest departure, in percent of what the line spans.
fn fit(points: &[Point]) -> [f64; 3] {
    let count = points.len() as f64;
    let [x, y] = [0, 1].map(|n| points.iter().map(|it| [it.0, it.1][n]).sum::<f64>() / count);
    let sum =
        |of: &dyn Fn(f64, f64) -> f64| -> f64 { points.iter().map(|p| of(p.0 - x, p.1 - y)).sum() };
    let slope = sum(&|x, y| x * y) / sum(&|x, _| x * x);
    let off = points.iter().map(|p| (p.1 - y - slope * (p.0 - x)).abs()).fold(0.0, f64::max);
    let span = |of: fn(f64, f64) -> f64| points.iter().map(|p| p.0).reduce(of).unwrap_or(0.0);
    [slope, y - slope * x, 100.0 * off / (slope * (span(f64::max) - span(f64::min))).abs()]
}
