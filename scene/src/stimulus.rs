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

/// One quantity of a pad over sweep points or time.
#[derive(Clone, Debug)]
pub(crate) enum Stimulus {
    Constant(f64),
    Sweep(Vec<f64>),
    Timeline(Vec<[f64; 2]>),
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
            (None, Some(timeline), None) => ("timeline", Stimulus::Timeline(timeline)),
            (None, None, Some(sine)) => ("sine", sine),
            _ => {
                return Err(
                    form.error("", "expected exactly one of \"sweep\", \"timeline\", \"sine\"")
                );
            }
        };
        if let Stimulus::Timeline(points) = &stimulus
            && points.windows(2).any(|pair| pair[1][0] < pair[0][0])
        {
            return Err(form.error("timeline", "expected times that do not fall"));
        }
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
        let frequency_hz = sine.number("frequency_hz", Limits::POSITIVE)?;
        Ok(Some(Stimulus::Sine {
            mean: sine.number_or("mean", Limits::ANY, 0.0)?,
            amplitude: sine.require(
                "amplitude",
                "a number",
                sine.number("amplitude", Limits::ANY)?,
            )?,
            frequency_hz: sine.require("frequency_hz", "a number above 0", frequency_hz)?,
            phase_turns: sine.number_or("phase_turns", Limits::ANY, 0.0)?,
        }))
    }

    /// Values between which all others lie.
    pub fn extremes(&self) -> Vec<f64> {
        match self {
            Stimulus::Constant(value) => vec![*value],
            Stimulus::Sweep(values) => values.clone(),
            Stimulus::Timeline(points) => points.iter().map(|point| point[1]).collect(),
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

    /// The value at a sweep's point and a time.
    pub fn at(&self, point: usize, time_s: f64) -> f64 {
        match self {
            Stimulus::Constant(value) => *value,
            Stimulus::Sweep(values) => values[point % values.len()],
            Stimulus::Timeline(points) => interpolate(points, time_s),
            Stimulus::Sine { mean, amplitude, frequency_hz, phase_turns } => {
                mean + amplitude * (TAU * (frequency_hz * time_s + phase_turns)).sin()
            }
        }
    }
}

/// Linear between points, held before the first and after the last; at two points of equal time the
/// later one holds.
fn interpolate(points: &[[f64; 2]], time_s: f64) -> f64 {
    let after = points.partition_point(|point| point[0] <= time_s);
    match (after.checked_sub(1).map(|n| points[n]), points.get(after)) {
        (None, Some(first)) => first[1],
        (Some(last), None) => last[1],
        (Some([t0, v0]), Some([t1, v1])) => v0 + (v1 - v0) * (time_s - t0) / (t1 - t0),
        (None, None) => unreachable!("a timeline has points"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_timeline_is_linear_between_points_and_steps_where_times_are_equal() {
        let ramp = Stimulus::Timeline(vec![[0.0, 0.0], [1.0, 10.0], [1.0, 50.0], [2.0, 50.0]]);
        let at = |time| ramp.at(0, time);
        assert_eq!([at(-1.0), at(0.5), at(1.0), at(9.0)], [0.0, 5.0, 50.0, 50.0]);
    }
}
