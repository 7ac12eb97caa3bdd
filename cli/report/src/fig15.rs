// SPDX-License-Identifier: MIT OR Apache-2.0
//! The paper's Fig. 15: a hand that pushes a pad into a virtual wall and draws it out again. For each
//! case the pad's place, the forces of hand and wall, and the direction that the core reads; below
//! them, what the hand feels of the wall on its way out.

use super::axis::Axis;
use super::fig3_maps::titled;
use super::figure::{self, Figure};
use super::general;
use super::number;
use super::page::escape;
use super::paint::Paint;
use super::plot::Plot;
use super::select;
use super::series::{Mark, Point, Series};
use super::tables;
use hapticore_run::record::{Record, Row, Truth, WallPlace};

/// A force of the hand below which it neither pushes nor pulls, N.
const LEAST_N: f64 = 0.01;

/// Cases that are drawn; the others are in the table alone.
const PANELS: usize = 8;

/// Lines of a panel.
type Lines = fn(&Panel) -> Vec<Series>;

/// A pad's frame: the slot of its last part, and where pad and wall then are.
struct Frame<'a> {
    time_s: f64,
    x_mm: f64,
    surface_mm: f64,
    depth_mm: f64,
    /// The wall's inside is right of its surface.
    right: bool,
    row: &'a Row,
    truth: Truth,
}

struct Panel<'a> {
    name: String,
    frames: Vec<Frame<'a>>,
}

/// A panel for each case, then the table.
pub fn figures(record: &Record) -> Vec<Figure> {
    let panels: Vec<Panel> = record
        .rows
        .cases()
        .map(|rows| Panel { name: select::case_name(record, rows[0].case), frames: frames(rows) })
        .filter(|panel| !panel.frames.is_empty())
        .collect();
    if panels.is_empty() {
        return general::figures(record);
    }
    vec![drawn(&panels[..panels.len().min(PANELS)]), felt(&panels)]
}

/// The frames of the first pad. Its place is that between its outer parts, which lie on either side
/// of it.
fn frames(rows: &[Row]) -> Vec<Frame<'_>> {
    let parts = rows.iter().filter_map(|row| row.truth).map(|truth| truth.part + 1).max();
    let mut outer_mm = [f64::NAN; 2];
    let mut part_off_mm = None;
    let mut frames = Vec::new();
    for (row, truth) in rows.iter().filter_map(|row| Some((row, row.truth?))) {
        if row.pad != truth.part {
            continue;
        }
        if let Some(x_mm) = outer_mm.get_mut(truth.part) {
            *x_mm = truth.quantities.x_mm;
        }
        let is_last = Some(truth.part + 1) == parts;
        if let Some(WallPlace { surface_mm, depth_mm }) =
            row.driven.and_then(|driven| driven.wall).filter(|_| is_last)
        {
            let x_mm = 0.5 * (outer_mm[0] + outer_mm[1]);
            let off_surface_mm = truth.quantities.x_mm - surface_mm;
            // Of the part's place, whose distance from the pad's is that at the beginning: its slots come later.
            let off_mm = *part_off_mm.get_or_insert(truth.quantities.x_mm - x_mm);
            let surface_mm = surface_mm - off_mm;
            let right = (off_surface_mm > 0.0) == (depth_mm > 0.0);
            let time_s = row.time_s - rows[0].time_s;
            frames.push(Frame { time_s, x_mm, surface_mm, depth_mm, right, row, truth });
        }
    }
    frames
}

impl Panel<'_> {
    fn line(&self, value: impl Fn(&Frame) -> f64) -> Vec<Point> {
        self.frames.iter().map(|frame| (frame.time_s, value(frame))).collect()
    }

    fn places(&self) -> Vec<Series> {
        let released = |frame: &Frame| if frame.released() { frame.x_mm } else { f64::NAN };
        vec![
            Series::line("wall's surface", Paint::LIMIT, self.line(|frame| frame.surface_mm))
                .mark(Mark::Line(2)),
            Series::line("released", Paint::series(3), self.line(released)).mark(Mark::Line(10)),
            Series::line("pad", Paint::INK, self.line(|frame| frame.x_mm)).mark(Mark::Line(3)),
        ]
    }

    fn forces(&self) -> Vec<Series> {
        let target = |frame: &Frame| frame.row.driven.map_or(f64::NAN, |driven| driven.target_n);
        vec![
            Series::line("wall's target", Paint::series(1), self.line(target)).mark(Mark::Line(7)),
            Series::line(
                "true haptic force",
                Paint::series(0),
                self.line(|it| it.truth.quantities.force_n),
            )
            .mark(Mark::Line(4)),
            Series::line("hand, outwards", Paint::series(4), self.line(|frame| frame.pull_n()))
                .mark(Mark::Line(3)),
        ]
    }

    fn directions(&self) -> Vec<Series> {
        vec![
            Series::line(
                "true direction",
                Paint::series(5),
                self.line(|it| 1e3 * it.truth.quantities.direction),
            )
            .mark(Mark::Line(8)),
            Series::line(
                "direction read",
                Paint::series(2),
                self.line(|it| 1e3 * it.row.measured.direction),
            )
            .mark(Mark::Line(2)),
        ]
    }

    /// Mean and largest part of the friction that the wall makes while the hand pulls outwards: the mean is that of the run's
    /// findings.
    fn sticking_n(&self) -> [f64; 2] {
        let pulls = |frame: &&Frame| frame.depth_mm > 0.0 && frame.pull_n() > LEAST_N;
        let felt: Vec<f64> =
            self.frames.iter().filter(pulls).map(|frame| frame.truth.haptic_friction_n).collect();
        let most = felt.iter().copied().fold(0.0, f64::max);
        [if felt.is_empty() { 0.0 } else { select::mean(felt) }, most]
    }

    fn largest_n(&self) -> f64 {
        self.frames.iter().map(|frame| frame.truth.quantities.force_n).fold(0.0, f64::max)
    }

    /// Changes between push and release within the wall.
    fn flips(&self) -> usize {
        let within = |pair: &&[Frame]| pair.iter().all(|frame| frame.depth_mm > 0.0);
        let changes = |pair: &&[Frame]| pair[0].released() != pair[1].released();
        self.frames.windows(2).filter(within).filter(changes).count()
    }
}

impl Frame<'_> {
    /// The hand's force out of the wall.
    fn pull_n(&self) -> f64 {
        if self.right { -self.truth.hand_x_n } else { self.truth.hand_x_n }
    }

    fn released(&self) -> bool {
        self.row.driven.and_then(|driven| driven.free) == Some(true)
    }
}

fn drawn(panels: &[Panel]) -> Figure {
    let all = |of: Lines| -> Vec<f64> {
        let points = |panel: &Panel| of(panel).into_iter().flat_map(|series| series.points);
        panels.iter().flat_map(points).map(|point| point.1).filter(|y| y.is_finite()).collect()
    };
    let times = panels.iter().flat_map(|panel| panel.frames.iter().map(|frame| frame.time_s));
    let time = Axis::linear("time (s)", times);
    let rows: [(&str, Lines, u32); 3] = [
        ("place (mm)", |panel| panel.places(), 400),
        ("force (N)", |panel| panel.forces(), 500),
        ("direction (10⁻³)", |panel| panel.directions(), 400),
    ];
    let axes = rows.map(|(name, of, _)| Axis::with_zero(name, all(of)));
    let label_characters = axes.iter().map(Axis::longest_label).max().unwrap_or(0);
    let mut untitled = time.clone();
    untitled.title.clear();
    let panel = |panel: &Panel| {
        titled(&panel.name, "", |about| {
            let plots = rows.iter().zip(&axes).enumerate().map(|(n, ((name, of, height), y))| {
                let x = if n + 1 == rows.len() { &time } else { &untitled };
                let mut plot = Plot::new(
                    &format!("{name} over time, {about}"),
                    x.clone(),
                    y.clone(),
                    of(panel),
                );
                (plot.height, plot.label_characters) = (*height, label_characters);
                plot.svg()
            });
            plots.collect::<String>()
        })
    };
    let body: String = panels.iter().map(panel).collect();
    let keys: Vec<Series> = rows.iter().flat_map(|(_, of, _)| of(&panels[0])).collect();
    let note = "The wall's inside is below its surface. It gives a force that grows with the depth, \
                until the core takes the push for one that leads out: released.";
    let body = format!("<div class=\"panels\">\n{body}</div>\n");
    Figure::wide("At the wall", note, figure::keys(&keys), body)
}

/// What the hand feels of the wall.
fn felt(panels: &[Panel]) -> Figure {
    let heads = [
        "case",
        "#largest haptic force",
        "#mean sticking force",
        "#largest sticking force",
        "#changes between push and release",
    ];
    let newtons = |value: f64| number::with_unit(&number::short(value), "N");
    let row = |panel: &Panel| {
        let [mean, most] = panel.sticking_n();
        tables::row(&[
            ("", &escape(&panel.name)),
            ("number", &newtons(panel.largest_n())),
            ("number", &newtons(mean)),
            ("number", &newtons(most)),
            ("number", &panel.flips().to_string()),
        ])
    };
    let rows: String = panels.iter().map(row).collect();
    let note = "The sticking force is the friction that the wall makes while the hand pulls the pad \
                outwards within it, over all of the case. Changes between push and release are those within the wall; one \
                belongs to each way out.";
    let table = tables::table("Felt", &heads, &rows);
    Figure::wide("What the hand feels on its way out", note, String::new(), table)
}
