// SPDX-License-Identifier: MIT OR Apache-2.0
//! The range a number may lie in, and how a message says so.

use std::fmt;

/// A range of numbers; `above` leaves its lower end out.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// The least number.
    pub low: f64,
    /// The greatest number.
    pub high: f64,
    /// The lower end itself is left out.
    pub open: bool,
}

impl Limits {
    /// Any finite number.
    pub const ANY: Limits = Limits { low: f64::NEG_INFINITY, high: f64::INFINITY, open: false };

    /// `low ..= high`
    pub const fn within(low: f64, high: f64) -> Self {
        Limits { low, high, open: false }
    }

    /// Above `low`, at most `high`
    pub const fn above(low: f64, high: f64) -> Self {
        Limits { low, high, open: true }
    }

    /// The range in few words: `0 to 15`, `above 0 to 1e4`.
    pub fn short(&self) -> String {
        match (self.low.is_finite(), self.open) {
            (false, _) => "any number".to_string(),
            (true, true) => format!("above {} to {}", short(self.low), short(self.high)),
            (true, false) => format!("{} to {}", short(self.low), short(self.high)),
        }
    }

    /// Whether a finite `value` lies in the range.
    pub fn holds(&self, value: f64) -> bool {
        value.is_finite()
            && value <= self.high
            && if self.open { value > self.low } else { value >= self.low }
    }
}

/// A number without long rows of zeros.
pub(super) fn short(number: f64) -> String {
    let is_plain = number == 0.0 || (1e-3..1e5).contains(&number.abs());
    if is_plain { number.to_string() } else { format!("{number:e}") }
}

impl fmt::Display for Limits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let from = if self.open { "above" } else { "of at least" };
        match (self.low.is_finite(), self.high.is_finite()) {
            (false, false) => write!(f, "a finite number"),
            (true, false) => write!(f, "a number {from} {}", self.low),
            (false, true) => write!(f, "a number of at most {}", self.high),
            (true, true) if self.open => {
                write!(f, "a number above {} and at most {}", self.low, self.high)
            }
            (true, true) => write!(f, "a number from {} to {}", self.low, self.high),
        }
    }
}
