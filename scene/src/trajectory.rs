// SPDX-License-Identifier: MIT OR Apache-2.0
//! The position of a pad over the points of a sweep or over time. Millimetres from the sheet's
//! centre, x right, y up. With `over_edge = true` beside it the pad may reach over the edge, where
//! its slots are flagged.
//!
//! | written as `position_mm =` | the pad |
//! | --- | --- |
//! | `[100, -50]` | stays |
//! | `{ sweep = [[0, 0], [100, 0]] }` | is placed point by point |
//! | `{ raster = { nx = 24, ny = 14, margin_mm = 15 } }` | is placed on a grid, row by row from the bottom left, its centre `margin_mm` off the edges |
//! | `{ line = { from_mm = [0, 0], to_mm = [100, 0], period_s = 2 } }` | goes there and back at even speed |
//! | `{ circle = { centre_mm = [0, 0], radius_mm = 100, period_s = 2, phase_turns = 0 } }` | circles, anticlockwise |
//! | `{ timeline = { x_mm = [[0, -20], [1, 5]], y_mm = [[0, 0]] } }` | goes from point to point: time in s and mm, linear between, held outside; an axis left out stays at 0 |
//! | `{ lissajous = { centre_mm, amplitude_mm = [ax, ay], frequency_hz = [fx, fy], phase_turns = [px, py] } }` | swings |

use std::f64::consts::TAU;

use crate::device::Device;
use crate::error::SceneError;
use crate::format::{Key, Limits, Table, Value, keys};
use crate::stimulus::{Moment, Timeline, next_multiple};

type Point = [f64; 2];

/// Where in its turn a motion may begin.
const TURNS: Limits = Limits::within(-1e6, 1e6);

/// Rounding of a trajectory that reaches just to the edge is not a pad over the edge.
pub(crate) const SLACK_MM: f64 = 1e-9;

keys! { KEYS:
    /// Where the pad's centre is, from the sheet's centre, x right and y up: two numbers, or one of the forms below.
    POSITION_MM: [f64; 2] = Key::position("position_mm").required("[x, y]");
    /// The pad may reach over the sheet's edge, where its slots are flagged.
    OVER_EDGE: bool = Key::flag("over_edge");
}

keys! { FORM_KEYS:
    /// Places at which the pad is put, point by point.
    SWEEP: Option<Vec<Point>> = Key::pairs("sweep");
}

keys! { RASTER_KEYS:
    /// Columns of the grid.
    NX: u64 = Key::whole("nx", 1, 1000).required("an integer");
    /// Rows of the grid.
    NY: u64 = Key::whole("ny", 1, 1000).required("an integer");
    /// How far the outermost places are off the edges.
    MARGIN_MM: Option<f64> = Key::number("margin_mm", Limits::within(1e-9, 1e4)).usually("the pad's radius");
}

keys! { LINE_KEYS:
    /// Where the line begins.
    FROM_MM: Point = Key::pair("from_mm", Limits::ANY).required("[x, y]");
    /// Where the line turns back.
    TO_MM: Point = Key::pair("to_mm", Limits::ANY).required("[x, y]");
}

keys! { PERIOD_KEYS:
    /// Time for the way there and back, or once round.
    PERIOD_S: f64 = Key::number("period_s", Limits::within(1e-6, 1e9)).required("a number from 1e-6 to 1e9");
}

keys! { CIRCLE_KEYS:
    /// Radius of the circle.
    RADIUS_MM: f64 = Key::number("radius_mm", Limits::within(1e-9, 1e4)).required("a number above 0");
    /// Where on the circle the pad begins: 0 is right of its centre.
    PHASE_TURN: f64 = Key::number("phase_turns", TURNS).or(0.0);
}

keys! { LISSAJOUS_KEYS:
    /// Amplitudes along x and y.
    AMPLITUDE_MM: Point = Key::pair("amplitude_mm", Limits::ANY).required("two numbers");
    /// Frequencies along x and y.
    FREQUENCY_HZ: Point = Key::pair("frequency_hz", Limits::within(0.0, 1e6)).required("two numbers");
    /// Where in their turns the motions along x and y begin.
    PHASE_TURNS: Point = Key::pair("phase_turns", TURNS).or(&[0.0; 2]);
}

keys! { CENTRE_KEYS:
    /// The centre of the motion.
    CENTRE_MM: Point = Key::pair("centre_mm", Limits::ANY).or(&[0.0; 2]);
}

keys! { TIMELINE_KEYS:
    /// Pairs of time in s and place along x, linear between them and held outside.
    X_MM: Option<Vec<Point>> = Key::pairs("x_mm").usually("0 throughout");
    /// The same along y.
    Y_MM: Option<Vec<Point>> = Key::pairs("y_mm").usually("0 throughout");
}

/// How far from the sheet's centre a pad's centre may be, mm.
pub(crate) fn reach_mm(pad: &Table, device: &Device) -> Result<[f64; 2], SceneError> {
    Ok(match pad.get(&OVER_EDGE)? {
        true => [device.width_mm, device.height_mm].map(|size| size / 2.0),
        false => device.reach_mm(),
    })
}

/// Whether a place is within a reach.
pub(crate) fn is_within(place: Point, reach: Point) -> bool {
    [0, 1].into_iter().all(|axis| place[axis].abs() <= reach[axis] + SLACK_MM)
}

/// A pad's position over sweep points or time.
#[derive(Clone, Debug)]
pub(crate) enum Trajectory {
    Points(Vec<Point>),
    Line {
        from: Point,
        to: Point,
        period_s: f64,
    },
    Swing {
        centre: Point,
        amplitude: Point,
        frequency_hz: Point,
        phase_turns: Point,
    },
    /// Along x and along y, mm.
    Timeline(Box<[Timeline; 2]>),
}

impl Trajectory {
    /// Reads `position_mm`; the pad must stay wholly on the sheet, but with `over_edge = true` its
    /// centre alone.
    pub fn read(pad: &Table, device: &Device) -> Result<Trajectory, SceneError> {
        const KEY: &str = POSITION_MM.about.name;
        let trajectory = match pad.node(KEY).map(|node| &node.value) {
            Some(Value::Table(form)) => Trajectory::read_form(form, device)?,
            _ => Trajectory::Points(vec![pad.get(&POSITION_MM)?]),
        };
        let reach = reach_mm(pad, device)?;
        match trajectory.extremes().into_iter().find(|place| !is_within(*place, reach)) {
            None => Ok(trajectory),
            Some([x, y]) => Err(pad.error(
                KEY,
                format!(
                    "expected the pad's centre within ±{} × ±{} mm, so that the pad lies wholly on the sheet, got [{x}, {y}]",
                    reach[0], reach[1]
                ),
            )),
        }
    }

    fn read_form(form: &Table, device: &Device) -> Result<Trajectory, SceneError> {
        let points = form.get(&SWEEP)?.map(Trajectory::Points);
        let raster = form.table("raster")?.map(|raster| read_raster(raster, device)).transpose()?;
        let line = form.table("line")?.map(read_line).transpose()?;
        let circle = form.table("circle")?.map(read_circle).transpose()?;
        let lissajous = form.table("lissajous")?.map(read_lissajous).transpose()?;
        let timeline = form.table("timeline")?.map(read_timeline).transpose()?;
        let mut given = [points, raster, line, circle, timeline, lissajous].into_iter().flatten();
        match (given.next(), given.next()) {
            (Some(trajectory), None) => Ok(trajectory),
            _ => {
                Err(form
                    .error("", "expected exactly one of \"sweep\", \"raster\", \"line\", \"circle\", \"timeline\", \"lissajous\""))
            }
        }
    }

    /// Corners of a box that holds the trajectory.
    fn extremes(&self) -> Vec<Point> {
        match self {
            Trajectory::Points(points) => points.clone(),
            Trajectory::Line { from, to, .. } => vec![*from, *to],
            Trajectory::Swing { centre: [x, y], amplitude: [ax, ay], .. } => {
                vec![[x - ax.abs(), y - ay.abs()], [x + ax.abs(), y + ay.abs()]]
            }
            Trajectory::Timeline(axes) => {
                let [x, y] = [0, 1].map(|axis| axes[axis].extremes());
                (0..2).map(|n| [x[n], y[n]]).collect()
            }
        }
    }

    /// How many places a sweep has; one where it does not sweep.
    pub fn points(&self) -> usize {
        if let Trajectory::Points(points) = self { points.len() } else { 1 }
    }

    /// Whether the position depends on time.
    pub fn moves(&self) -> bool {
        !matches!(self, Trajectory::Points(_))
    }

    /// When the pad next turns back on its line; infinite where it has none, or turns more often
    /// than every `least_s`.
    pub fn next_turn_s(&self, after_s: f64, least_s: f64) -> f64 {
        match self {
            Trajectory::Line { period_s, .. } if 0.5 * period_s >= least_s => {
                next_multiple(0.5 * period_s, after_s)
            }
            Trajectory::Timeline(axes) => {
                axes[0].next_event_s(after_s).min(axes[1].next_event_s(after_s))
            }
            _ => f64::INFINITY,
        }
    }

    /// The position at a sweep's point and a time.
    pub fn at(&self, point: usize, time_s: f64) -> Point {
        match self {
            Trajectory::Points(points) => points[point % points.len()],
            Trajectory::Line { from, to, period_s } => {
                let turns = time_s / period_s;
                let there = 1.0 - (2.0 * (turns - turns.floor()) - 1.0).abs();
                [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * there)
            }
            Trajectory::Swing { centre, amplitude, frequency_hz, phase_turns } => {
                [0, 1].map(|axis| {
                    centre[axis]
                        + amplitude[axis]
                            * (TAU * (frequency_hz[axis] * time_s + phase_turns[axis])).sin()
                })
            }
            Trajectory::Timeline(axes) => [0, 1].map(|axis| axes[axis].at(Moment::at(time_s))),
        }
    }
}

/// Evenly spaced places, the outermost `margin_mm` from the edges; a single column or row is in the
/// middle.
pub(crate) fn raster(nx: usize, ny: usize, margin_mm: f64, device: &Device) -> Vec<Point> {
    let along = |n: usize, of: usize, size: f64| match of {
        1 => 0.0,
        _ => (size / 2.0 - margin_mm) * (2.0 * n as f64 / (of - 1) as f64 - 1.0),
    };
    let place =
        |n: usize| [along(n % nx, nx, device.width_mm), along(n / nx, ny, device.height_mm)];
    (0..nx * ny).map(place).collect()
}

fn read_raster(table: &Table, device: &Device) -> Result<Trajectory, SceneError> {
    let margin_mm = table.get(&MARGIN_MM.or(device.pad_diameter_mm / 2.0))?;
    let [nx, ny] = [table.get(&NX)?, table.get(&NY)?].map(|count| count as usize);
    Ok(Trajectory::Points(raster(nx, ny, margin_mm, device)))
}

fn read_line(table: &Table) -> Result<Trajectory, SceneError> {
    let (from, to) = (table.get(&FROM_MM)?, table.get(&TO_MM)?);
    Ok(Trajectory::Line { from, to, period_s: table.get(&PERIOD_S)? })
}

fn read_timeline(table: &Table) -> Result<Trajectory, SceneError> {
    let axis = |key: &Key<Option<Vec<Point>>>| {
        let points = table.get(key)?.unwrap_or_else(|| vec![[0.0; 2]]);
        Timeline::read(table, key.about.name, points)
    };
    Ok(Trajectory::Timeline(Box::new([axis(&X_MM)?, axis(&Y_MM)?])))
}

fn read_circle(table: &Table) -> Result<Trajectory, SceneError> {
    let radius = table.get(&RADIUS_MM)?;
    let turns = table.get(&PHASE_TURN)?;
    Ok(Trajectory::Swing {
        centre: table.get(&CENTRE_MM)?,
        amplitude: [radius; 2],
        frequency_hz: [1.0 / table.get(&PERIOD_S)?; 2],
        phase_turns: [turns + 0.25, turns],
    })
}

fn read_lissajous(table: &Table) -> Result<Trajectory, SceneError> {
    Ok(Trajectory::Swing {
        centre: table.get(&CENTRE_MM)?,
        amplitude: table.get(&AMPLITUDE_MM)?,
        frequency_hz: table.get(&FREQUENCY_HZ)?,
        phase_turns: table.get(&PHASE_TURNS)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_turns_twice_a_period_unless_steps_are_longer() {
        let line = Trajectory::Line { from: [0.0; 2], to: [1.0; 2], period_s: 0.2 };
        let turn = |after_s: &f64| Some(line.next_turn_s(*after_s, 0.01));
        let turns: Vec<f64> = std::iter::successors(turn(&0.0), turn).take(1000).collect();
        assert!(turns.iter().enumerate().all(|(n, s)| (s - 0.1 * (n + 1) as f64).abs() < 1e-9));
        assert_eq!(line.next_turn_s(0.0, 0.11), f64::INFINITY);
        assert_eq!(Trajectory::Points(vec![[0.0; 2]; 2]).next_turn_s(0.0, 0.01), f64::INFINITY);
    }
}
