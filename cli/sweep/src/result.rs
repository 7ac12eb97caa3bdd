// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a point leaves: a line of results, the same bytes wherever it is run, and how long it took.

use hapticore_tradeoff::cost::Cost;
use hapticore_tradeoff::errors::{Error, Errors};
use hapticore_tradeoff::loops::LoopErrors;
use serde::{Deserialize, Serialize};

use crate::axis::Settings;
use crate::canonical;

/// A line of results.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// The point's name: the hash of everything that it is made of.
    pub key: String,
    /// Seed of the scene.
    pub seed: u64,
    /// What of the profile is set.
    pub profile: Settings,
    /// What of the scene is set.
    pub scene: Settings,
    /// What came of it, where it could be run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub results: Option<Results>,
    /// Why it cannot be run, else.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

/// What a point costs, and what it is off.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Results {
    /// Time and area of the core.
    pub cost: Cost,
    /// Slots that it was tried on, all with a position that the ideal estimator finds.
    pub slots: usize,
    /// Of them, those that the core flags invalid, clipped or saturated.
    pub flagged: usize,
    /// Against the ideal estimator, on the same samples before any ADC.
    pub measured: Three,
    /// Against what the scene knows.
    pub truth: Three,
    /// What is predicted, where it was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub predicted: Option<Prediction>,
    /// Of a case whose slots depend on the core: what else is measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub looped: Option<Looped>,
    /// What the device's levels are off finer ones, where anything of the scene is set.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub levels: Vec<Level>,
}

/// A fidelity level of the simulated device and the largest difference from a finer one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Level {
    /// The effect.
    pub effect: String,
    /// Its level.
    pub level: String,
    /// A finer one.
    pub finer: String,
    /// Of what a user reads, percent (docs/physics.md §8).
    pub percent: f64,
}

/// Predicted errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Prediction {
    /// Against the ideal estimator.
    pub errors: Three,
    /// The least amplitude of a channel in steps of the ADC.
    pub least_codes: f64,
}

/// What is measured of a force loop, and of pads that are served part by part.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Looped {
    /// Against the loop that the ideal core closes.
    pub measured: LoopErrors,
    /// Of the true force against its target, of the direction against the true one.
    pub truth: LoopErrors,
}

/// An error of each quantity.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Three {
    /// Haptic force, mN.
    pub force: Error,
    /// Capacitance, %.
    pub capacitance: Error,
    /// Position, µm.
    pub position: Error,
}

/// How long a point took, s.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Times {
    /// The point's name.
    pub key: String,
    /// All of it.
    pub seconds: f64,
    /// Of the plant, per simulated second of the slots that are tried.
    pub plant: f64,
    /// Of the core, likewise.
    pub core: f64,
}

impl From<Errors> for Three {
    fn from([force, capacitance, position]: Errors) -> Self {
        Three { force, capacitance, position }
    }
}

impl Three {
    /// In the order of [`Quantity::ALL`](hapticore_tradeoff::errors::Quantity::ALL).
    pub fn all(&self) -> Errors {
        [self.force, self.capacitance, self.position]
    }
}

impl Results {
    /// The largest difference of a level from a finer one, percent.
    pub fn plant_percent(&self) -> Option<f64> {
        self.levels.iter().map(|level| level.percent).reduce(f64::max)
    }

    /// Whether every number is one.
    pub fn is_finite(&self) -> bool {
        let predicted = self.predicted.as_ref().map(|of| of.errors.all());
        let errors = [self.measured.all(), self.truth.all()].into_iter().chain(predicted);
        let of_loop = self.looped.iter().flat_map(|of| [of.measured.all(), of.truth.all()]);
        let finite = |of: Error| [of.rms, of.mean, of.largest].iter().all(|of| of.is_finite());
        errors.flatten().chain(of_loop.flatten().flatten()).all(finite)
            && self.levels.iter().all(|level| level.percent.is_finite())
            && self.predicted.as_ref().is_none_or(|of| of.least_codes.is_finite())
    }
}

impl Line {
    /// The line as it is stored: canonical JSON, without its end. Its first key is a check sum of all others.
    pub fn text(&self) -> String {
        with_check(&canonical::text(self))
    }

    /// Reads a stored line.
    ///
    /// # Errors
    /// A torn line, a check sum that is not the line's, an unknown key, neither results nor error.
    pub fn read(text: &str) -> Result<Line, String> {
        let line: Line =
            serde_json::from_str(&checked(text)?).map_err(|error| error.to_string())?;
        match (&line.results, &line.error) {
            (Some(_), None) | (None, Some(_)) => Ok(line),
            _ => Err("expected either results or error".into()),
        }
    }
}

/// What a line begins with, before its check sum; `check` is the first of the canonical order.
const CHECK: &str = "{\"check\":\"";

/// Hexadecimal digits of a check sum: a line that is wrong passes once in 2^64.
const DIGITS: usize = 16;

fn with_check(object: &str) -> String {
    format!("{CHECK}{}\",{}", check_of(object), &object[1..])
}

fn check_of(object: &str) -> String {
    blake3::hash(object.as_bytes()).to_hex()[..DIGITS].to_owned()
}

/// The line without its check sum.
fn checked(text: &str) -> Result<String, String> {
    let parts = text.strip_prefix(CHECK).and_then(|rest| rest.split_once("\","));
    let (check, rest) = parts.filter(|(check, _)| check.len() == DIGITS).ok_or(
        "expected a line that begins with its check sum; without one it is damaged, or of an earlier version",
    )?;
    let object = format!("{{{rest}");
    match check_of(&object) {
        own if own == check => Ok(object),
        own => Err(format!(
            "expected the check sum {own} of what stands here, got {check}: the line is damaged"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line() -> Line {
        Line {
            key: "k".into(),
            seed: 1234,
            profile: Settings::default(),
            scene: Settings::default(),
            results: None,
            error: Some("none".into()),
        }
    }

    #[test]
    fn a_line_reads_as_it_was_stored() {
        let text = line().text();
        assert_eq!(Line::read(&text), Ok(line()), "{text}");
        let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(canonical::text(&value), text, "canonical with its check sum");
    }

    /// Any byte of a line is damaged, in any bit.
    #[test]
    fn no_damaged_byte_passes() {
        let text = line().text();
        for (at, bit) in (0..text.len()).flat_map(|at| (0..8).map(move |bit| (at, bit))) {
            let mut bytes = text.clone().into_bytes();
            bytes[at] ^= 1 << bit;
            let Ok(damaged) = String::from_utf8(bytes) else { continue };
            assert!(Line::read(&damaged).is_err(), "{at}, {bit}: {damaged}");
        }
        let old = canonical::text(&line());
        assert!(Line::read(&old).is_err_and(|error| error.contains("begins with its check sum")));
    }
}
