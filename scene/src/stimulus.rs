// SPDX-License-Identifier: MIT OR Apache-2.0
//! A quantity of a pad over the points of a sweep or over time: its load, its haptic voltage, its
//! capacitance.
//!
//! | written as | the value is |
//! | --- | --- |
//! | `50` | 50 throughout |
//! | `{ sweep = [20, 50, 100] }` | one after the other, point by point |
//! | `{ sweep = { from = 0, to = 300, points = 13 } }` | the same, evenly spaced |
//! | `{ timeline = [[0, 0], [1, 350], [4, 350]] }` | time in s and value, linear between, held outside |
//! | `{ sine = { mean = 100, amplitude = 50, frequency_hz = 2, phase_turns = 0 } }` | over time |

use std::f64::consts::TAU;

use crate::error::SceneError;
use crate::format::{Limits, Table, Value};

/// The most points of one sweep.
const MOST_POINTS: u64 = 1_000_000;

/// A moment at which something may step: just before, or with the step made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment {
    pub time_s: f64,
    before: bool,
}

impl Moment {
    /// What steps at this time has stepped.
    pub fn at(time_s: f64) -> Moment {
        Moment { time_s, before: false }
    }

    /// What steps at this time has not stepped yet.
    pub fn before(time_s: f64) -> Moment {
        Moment { time_s, before: true }
    }

    /// Whether what happens at `event_s` has happened.
    pub fn is_past(self, event_s: f64) -> bool {
        event_s < self.time_s || (event_s == self.time_s && !self.before)
    }
}

/// The first multiple of a period that is later.
pub(crate) fn next_multiple(period_s: f64, after_s: f64) -> f64 {
    let periods = (after_s / period_s).floor();
    let next_s = (periods + 1.0) * period_s;
    if next_s > after_s { next_s } else { (periods + 2.0) * period_s }
}

/// Points of time and value, and those times at which the value steps or its slope changes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Timeline {
    points: Vec<[f64; 2]>,
    events_s: Vec<f64>,
}

/// One quantity of a pad over sweep points or time.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Stimulus {
    Constant(f64),
    Sweep(Vec<f64>),
    Timeline(Timeline),
    Sine { mean: f64, amplitude: f64, frequency_hz: f64, phase_turns: f64 },
}

impl Stimulus {
    /// Reads `key`; every value it can take must lie in `limits`.
    pub fn read(
        table: &Table,
        key: &'static str,
        limits: Limits,
    ) -> Result<Option<Stimulus>, SceneError> {
        match table.get(key).map(|node| &node.value) {
            None => Ok(None),
            Some(Value::Table(form)) => Stimulus::read_form(form, limits).map(Some),
            Some(_) => Ok(table.number(key, limits)?.map(Stimulus::Constant)),
        }
    }

    fn read_form(form: &Table, limits: Limits) -> Result<Stimulus, SceneError> {
        let all = (
            Stimulus::read_sweep(form, limits)?,
            form.pairs("timeline")?,
            Stimulus::read_sine(form)?,
        );
        let (key, stimulus) = match all {
            (Some(sweep), None, None) => ("sweep", Stimulus::Sweep(sweep)),
            (None, Some(points), None) => {
                ("timeline", Stimulus::Timeline(Timeline::read(form, "timeline", points)?))
            }
            (None, None, Some(sine)) => ("sine", sine),
            _ => {
                return Err(
                    form.error("", "expected exactly one of \"sweep\", \"timeline\", \"sine\"")
                );
            }
        };
        match stimulus.extremes().into_iter().find(|value| !limits.holds(*value)) {
            Some(value) => Err(form.error(key, format!("expected {limits}, got {value}"))),
            None => Ok(stimulus),
        }
    }

    fn read_sweep(form: &Table, limits: Limits) -> Result<Option<Vec<f64>>, SceneError> {
        let Some(Value::Table(range)) = form.get("sweep").map(|node| &node.value) else {
            return form.numbers("sweep", limits);
        };
        let from = range.require("from", "a number", range.number("from", limits)?)?;
        let to = range.require("to", "a number", range.number("to", limits)?)?;
        let points =
            range.require("points", "an integer", range.whole("points", 2, MOST_POINTS)?)?;
        let step = (to - from) / (points - 1) as f64;
        Ok(Some((0..points).map(|n| from + step * n as f64).collect()))
    }

    fn read_sine(form: &Table) -> Result<Option<Stimulus>, SceneError> {
        let Some(sine) = form.table("sine")? else { return Ok(None) };
        let frequency_hz = sine.number("frequency_hz", Limits::within(1e-6, 1e6))?;
        Ok(Some(Stimulus::Sine {
            mean: sine.number_or("mean", Limits::ANY, 0.0)?,
            amplitude: sine.require(
                "amplitude",
                "a number",
                sine.number("amplitude", Limits::ANY)?,
            )?,
            frequency_hz: sine.require("frequency_hz", "a number above 0", frequency_hz)?,
            phase_turns: sine.number_or("phase_turns", Limits::within(-1e6, 1e6), 0.0)?,
        }))
    }

    /// Values between which all others lie.
    pub fn extremes(&self) -> Vec<f64> {
        match self {
            Stimulus::Constant(value) => vec![*value],
            Stimulus::Sweep(values) => values.clone(),
            Stimulus::Timeline(Timeline { points, .. }) => {
                points.iter().map(|point| point[1]).collect()
            }
            Stimulus::Sine { mean, amplitude, .. } => {
                vec![mean - amplitude.abs(), mean + amplitude.abs()]
            }
        }
    }

    /// How many points a sweep has; one where it does not sweep.
    pub fn points(&self) -> usize {
        if let Stimulus::Sweep(values) = self { values.len() } else { 1 }
    }

    /// Whether the value depends on time.
    pub fn moves(&self) -> bool {
        matches!(self, Stimulus::Timeline(_) | Stimulus::Sine { .. })
    }

    /// The value at a sweep's point and a moment.
    #[inline]
    pub fn at(&self, point: usize, moment: Moment) -> f64 {
        match self {
            Stimulus::Constant(value) => *value,
            Stimulus::Sweep(values) => values[point % values.len()],
            Stimulus::Timeline(timeline) => timeline.at(moment),
            Stimulus::Sine { mean, amplitude, frequency_hz, phase_turns } => {
                mean + amplitude * (TAU * (frequency_hz * moment.time_s + phase_turns)).sin()
            }
        }
    }

    /// When the value next steps, or turns from one slope to another; infinite where it never does.
    pub fn next_event_s(&self, after_s: f64) -> f64 {
        if let Stimulus::Timeline(timeline) = self {
            timeline.next_event_s(after_s)
        } else {
            f64::INFINITY
        }
    }
}

impl Timeline {
    /// The timeline of `key`, which has at least one point.
    pub fn read(
        form: &Table,
        key: &'static str,
        points: Vec<[f64; 2]>,
    ) -> Result<Timeline, SceneError> {
        if points.windows(2).any(|pair| pair[1][0] < pair[0][0]) {
            return Err(form.error(key, "expected times that do not fall"));
        }
        let limits = Limits::within(-1e9, 1e9);
        if let Some([time_s, _]) = points.iter().find(|[time_s, _]| !limits.holds(*time_s)) {
            return Err(form.error(key, format!("expected times in s, {limits}, got {time_s}")));
        }
        Ok(Timeline::new(points))
    }

    fn new(points: Vec<[f64; 2]>) -> Timeline {
        let slope = |pair: &[[f64; 2]]| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
        let inner = points.windows(2).map(slope);
        let slopes: Vec<f64> = std::iter::once(0.0).chain(inner).chain([0.0]).collect();
        // A step has no slope that equals another's.
        let is_event = |(_, around): &(&[f64; 2], &[f64])| around[0] != around[1];
        let events = points.iter().zip(slopes.windows(2)).filter(is_event);
        let events_s = events.map(|(point, _)| point[0]).collect();
        Timeline { points, events_s }
    }

    /// The lowest and the highest value.
    pub fn extremes(&self) -> [f64; 2] {
        let values = || self.points.iter().map(|point| point[1]);
        [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
    }

    /// When the value next steps, or turns from one slope to another; infinite where it never does.
    pub fn next_event_s(&self, after_s: f64) -> f64 {
        let next = self.events_s.partition_point(|event_s| *event_s <= after_s);
        self.events_s.get(next).copied().unwrap_or(f64::INFINITY)
    }

    /// Linear between points, held before the first and after the last; at two points of equal time
    /// the later one holds from then on.
    pub fn at(&self, moment: Moment) -> f64 {
        let after = self.points.partition_point(|point| moment.is_past(point[0]));
        match (after.checked_sub(1).map(|n| self.points[n]), self.points.get(after)) {
            (None, Some(first)) => first[1],
            (Some(last), None) => last[1],
            (Some([t0, v0]), Some([t1, v1])) => v0 + (v1 - v0) * (moment.time_s - t0) / (t1 - t0),
            (None, None) => unreachable!("a timeline has points"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_timeline_is_linear_between_points_and_steps_where_times_are_equal() {
        let ramp = Timeline::new(vec![[0.0, 0.0], [1.0, 10.0], [1.0, 50.0], [2.0, 50.0]]);
        let at = |time| ramp.at(Moment::at(time));
        assert_eq!([at(-1.0), at(0.5), at(1.0), at(9.0)], [0.0, 5.0, 50.0, 50.0]);
        assert_eq!(ramp.at(Moment::before(1.0)), 10.0);
    }

    #[test]
    fn events_are_steps_and_kinks_but_no_point_on_a_line() {
        let points =
            [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 2.0], [4.0, 2.0], [4.0, 7.0], [5.0, 7.0]];
        let timeline = Stimulus::Timeline(Timeline::new(points.to_vec()));
        let event = |after_s: &f64| Some(timeline.next_event_s(*after_s));
        let events: Vec<f64> = std::iter::successors(event(&-1.0), event)
            .take_while(|event| event.is_finite())
            .collect();
        assert_eq!(events, [0.0, 2.0, 4.0]);
    }
}
