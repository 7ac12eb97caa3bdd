// SPDX-License-Identifier: MIT OR Apache-2.0
//! What share of the current each terminal has, by place: what the currents of a recording are
//! checked against.

use schemars::JsonSchema;
use serde::Deserialize;
use std::fmt::Write;

/// Shares of all current, at places.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shares {
    /// How far a place's shares are from those that the places about it tell: the median.
    pub error: f64,
    /// `[x_mm, y_mm, s_1, … s_N]`.
    pub places: Vec<Vec<f64>>,
}

impl Shares {
    pub(super) fn check(&self, terminals: usize) -> Result<(), String> {
        let expected = terminals + 2;
        let is_row = |row: &&Vec<f64>| row.len() != expected || !row.iter().all(|n| n.is_finite());
        match self.places.iter().find(is_row) {
            Some(row) => Err(format!(
                "shares.places: expected {expected} finite numbers in a row, got {row:?}"
            )),
            None if !(self.error.is_finite() && self.error >= 0.0) => {
                Err(format!("shares.error: expected a number not below 0, got {}", self.error))
            }
            None => Ok(()),
        }
    }

    pub(super) fn text(&self) -> String {
        let mut text = format!(
            "\n[shares]\nerror = {:?}\nplaces = [ # x_mm, y_mm, each terminal's share of the current\n",
            self.error
        );
        for row in &self.places {
            writeln!(text, "{row:?},").expect("a string takes all");
        }
        text + "]\n"
    }
}
