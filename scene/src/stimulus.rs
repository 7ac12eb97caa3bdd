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
use crate::format::{Key, KeyInfo, Kind, Limits, Otherwise, Read, Table, Value, keys};

/// The most points of one sweep.
const MOST_POINTS: u64 = 1_000_000;

keys! { FORM_KEYS:
    /// Values of a sweep, one after the other.
    SWEEP: Option<Vec<f64>> = Key::numbers("sweep", Limits::ANY);
    /// Pairs of time in s and value, linear between them and held outside.
    TIMELINE: Option<Vec<[f64; 2]>> = Key::pairs("timeline");
}

keys! { RANGE_KEYS:
    /// The first value of a sweep.
    FROM: f64 = Key::number("from", Limits::ANY).required("a number");
    /// The last value of a sweep.
    TO: f64 = Key::number("to", Limits::ANY).required("a number");
    /// The number of values of a sweep, which are evenly spaced.
    POINTS: u64 = Key::whole("points", 2, MOST_POINTS).required("an integer");
}

keys! { SINE_KEYS:
    /// The mean of a sine.
    MEAN: f64 = Key::number("mean", Limits::ANY).or(0.0);
    /// The amplitude of a sine.
    AMPLITUDE: f64 = Key::number("amplitude", Limits::ANY).required("a number");
    /// The frequency of a sine.
    FREQUENCY_HZ: f64 = Key::number("frequency_hz", Limits::within(1e-6, 1e6)).required("a number above 0");
    /// Where in its turn a sine begins.
    PHASE_TURNS: f64 = Key::number("phase_turns", Limits::within(-1e6, 1e6)).or(0.0);
}

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

impl Read for Stimulus {
    /// Every value that it can take must lie in the key's limits.
    fn read(table: &Table, key: &KeyInfo) -> Result<Option<Stimulus>, SceneError> {
        match table.node(key.name).map(|node| &node.value) {
            None => Ok(None),
            Some(Value::Table(form)) => Stimulus::read_form(form, key.limits()).map(Some),
            Some(_) => Ok(table.number(key.name, key.limits())?.map(Stimulus::Constant)),
        }
    }

    fn absent(otherwise: Otherwise) -> Option<Stimulus> {
        f64::absent(otherwise).map(Stimulus::Constant)
    }
}

impl Key<Option<Stimulus>> {
    pub const fn stimulus(name: &'static str, limits: Limits) -> Self {
        Key::new(name, Kind::Stimulus(limits))
    }

    /// One that is not swept: see [`over_time`](crate::pad::over_time).
    pub const fn over_time(name: &'static str, limits: Limits) -> Self {
        Key::new(name, Kind::OverTime(limits))
    }

    pub const fn or(self, usual: f64) -> Key<Stimulus> {
        self.otherwise(Otherwise::Number(usual))
    }
}

impl Stimulus {
    fn read_form(form: &Table, limits: Limits) -> Result<Stimulus, SceneError> {
        let all =
            (Stimulus::read_sweep(form, limits)?, form.get(&TIMELINE)?, Stimulus::read_sine(form)?);
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
        let Some(Value::Table(range)) = form.node("sweep").map(|node| &node.value) else {
            return form.get(&SWEEP.within(limits));
        };
        let (from, to) = (range.get(&FROM.within(limits))?, range.get(&TO.within(limits))?);
        let points = range.get(&POINTS)?;
        let step = (to - from) / (points - 1) as f64;
        Ok(Some((0..points).map(|n| from + step * n as f64).collect()))
    }

    fn read_sine(form: &Table) -> Result<Option<Stimulus>, SceneError> {
        let Some(sine) = form.table("sine")? else { return Ok(None) };
        Ok(Some(Stimulus::Sine {
            mean: sine.get(&MEAN)?,
            amplitude: sine.get(&AMPLITUDE)?,
            frequency_hz: sine.get(&FREQUENCY_HZ)?,
            phase_turns: sine.get(&PHASE_TURNS)?,
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
