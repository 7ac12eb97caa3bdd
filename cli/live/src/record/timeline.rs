// SPDX-License-Identifier: MIT OR Apache-2.0
//! Timelines of a scene from what was done: values that are set, and lines on which a finger is led.

use hapticore_scene::{FingerPath, Line};
use toml::{Table, Value};

use super::script::Script;

/// A knot of a line was rounded.
pub(super) const ROUNDED: &str =
    "knots at which a line is cut short are rounded, so that places differ by 1e-12 mm";
/// A motion of the scene was sampled.
pub(super) const SAMPLED: &str =
    "what is no timeline in the scene is sampled every millisecond where it is led later";

fn note(notes: &mut Vec<String>, text: &str) {
    if !notes.iter().any(|known| known == text) {
        notes.push(text.into());
    }
}

/// Knots as a scene has them.
fn timeline(knots: &[[f64; 2]]) -> Value {
    let knot = |knot: &[f64; 2]| Value::Array(vec![knot[0].into(), knot[1].into()]);
    Value::Array(knots.iter().map(knot).collect())
}

fn of_key(key: &str, value: Value) -> Value {
    Value::Table(Table::from_iter([(key.to_string(), value)]))
}

/// Values, each from a time on.
#[derive(Debug, Clone, Default)]
pub(super) struct Steps(Vec<[f64; 2]>);

impl Steps {
    /// Of values in the order of time; the last of several at one time counts.
    pub fn of(values: impl Iterator<Item = [f64; 2]>) -> Steps {
        let mut steps: Vec<[f64; 2]> = Vec::new();
        for [time_s, value] in values {
            if steps.last().is_some_and(|last| last[0] == time_s) {
                steps.pop();
            }
            if steps.last().is_none_or(|last| last[1] != value) {
                steps.push([time_s, value]);
            }
        }
        Steps(steps)
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The script up to the first step, then the steps.
    pub fn written(&self, script: &Script, notes: &mut Vec<String>) -> Value {
        let first_s = self.0[0][0];
        let mut value = script.at(first_s);
        if script.slopes_at(first_s) {
            note(notes, if script.is_sampled { SAMPLED } else { ROUNDED });
        }
        let mut knots: Vec<[f64; 2]> = script.between(f64::NEG_INFINITY, first_s).collect();
        for [time_s, next] in &self.0 {
            knots.extend([[*time_s, value], [*time_s, *next]]);
            value = *next;
        }
        of_key("timeline", timeline(&knots))
    }
}

/// What a hand does with a finger.
#[derive(Debug, Clone, Copy)]
pub(super) struct Motion {
    pub from_s: f64,
    pub at_s: f64,
    /// Where it goes, mm; none where it goes back to the scene.
    pub to_mm: Option<[f64; 2]>,
}

/// The path of a finger; before its first line the scene has it.
#[derive(Debug, Clone)]
pub(super) struct Track {
    path: FingerPath,
    scripts: [Script; 2],
}

impl Track {
    /// Of motions in the order of time, with what the scene does by itself.
    pub fn of(motions: impl Iterator<Item = Motion>, scripts: [Script; 2]) -> Track {
        let mut track = Track { path: FingerPath::default(), scripts };
        motions.for_each(|motion| track.add(motion));
        track
    }

    fn scripted(&self, time_s: f64) -> [f64; 2] {
        [0, 1].map(|axis| self.scripts[axis].at(time_s))
    }

    fn at(&self, time_s: f64) -> [f64; 2] {
        self.path.at(time_s).unwrap_or_else(|| self.scripted(time_s))
    }

    fn add(&mut self, Motion { from_s, at_s, to_mm }: Motion) {
        let from_mm = self.at(from_s);
        let place_mm = to_mm.unwrap_or_else(|| self.scripted(at_s));
        self.path.go([from_s, at_s], from_mm, place_mm, to_mm.is_some());
    }

    /// Both axes as a `position_mm`.
    pub fn written(&self, notes: &mut Vec<String>) -> Value {
        let axes = ["x_mm", "y_mm"].into_iter().enumerate();
        let axes = axes.map(|(axis, key)| (key.to_string(), timeline(&self.knots(axis, notes))));
        of_key("timeline", Value::Table(Table::from_iter(axes)))
    }

    fn knots(&self, axis: usize, notes: &mut Vec<String>) -> Vec<[f64; 2]> {
        let script = &self.scripts[axis];
        let mut cut = |time_s: f64| {
            if script.is_sampled || script.slopes_at(time_s) {
                note(notes, if script.is_sampled { SAMPLED } else { ROUNDED });
            }
        };
        let lines: Vec<&Line> = self.path.lines().collect();
        let first_s = lines[0].from_s;
        cut(first_s);
        let mut knots: Vec<[f64; 2]> = script.between(f64::NEG_INFINITY, first_s).collect();
        let mut is_cut = false;
        for (n, line) in lines.iter().enumerate() {
            let next_s = lines.get(n + 1).map_or(f64::INFINITY, |next| next.from_s);
            knots.push([line.from_s, line.from_mm[axis]]);
            if next_s < line.at_s {
                is_cut |= line.from_mm[axis] != line.to_mm[axis];
                continue;
            }
            knots.push([line.at_s, line.to_mm[axis]]);
            if !line.stays {
                cut(line.at_s);
                if next_s.is_finite() {
                    cut(next_s);
                }
                knots.extend(script.between(line.at_s, next_s));
            }
        }
        if is_cut {
            note(notes, ROUNDED);
        }
        // A line that begins where the last one ends has that knot already.
        knots.dedup();
        knots
    }
}
