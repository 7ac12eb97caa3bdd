// SPDX-License-Identifier: MIT OR Apache-2.0
//! A hard case, what came of it, and how far that is from failing.

use std::fmt::{self, Display};

/// Cases of one kind.
#[derive(Clone, Copy)]
pub struct Group {
    /// Part of the name of its tests.
    pub name: &'static str,
    /// Heading of the page.
    pub title: &'static str,
    /// What its cases have in common.
    pub about: &'static str,
    /// In the order of the page.
    pub cases: &'static [Case],
}

/// A hard case.
#[derive(Clone, Copy)]
pub struct Case {
    /// Name of its test.
    pub name: &'static str,
    /// What is done to the core.
    pub stimulus: &'static str,
    /// What must happen.
    pub must: &'static str,
    /// Runs it.
    ///
    /// Panics where something other than the measured quantity is wrong, for example a flag.
    pub run: fn() -> Outcome,
}

/// What came of a case.
#[derive(Debug, Clone, Default)]
pub struct Outcome {
    /// What the margins are of, or what was counted: never that all went well, which margins say.
    pub about: String,
    /// What is measured against its limit, the tightest first.
    pub margins: Vec<Margin>,
    /// The same done to others: floating point, idsp, …; empty where nothing compares.
    pub rivals: String,
}

/// A measured quantity and its limit.
#[derive(Debug, Clone, PartialEq)]
pub enum Margin {
    /// Equal to the bit, as often as this; one that is not ends the case.
    Equal(u64),
    /// As it must be, as often as this; one that is not ends the case.
    Holds(u64),
    /// At most the limit.
    AtMost(Quantity),
    /// At least the limit.
    AtLeast(Quantity),
}

/// A number, what it is, and its limit.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// What is measured.
    pub name: String,
    /// As it was measured.
    pub measured: f64,
    /// In the same unit.
    pub limit: f64,
    /// For example "%" or "mm".
    pub unit: &'static str,
}

impl Outcome {
    /// What is measured, without margins yet.
    pub fn of(about: impl Into<String>) -> Self {
        Outcome { about: about.into(), ..Outcome::default() }
    }

    /// The same with a comparison that found no difference in `results` results.
    pub fn equal(mut self, results: u64) -> Self {
        self.margins.push(Margin::Equal(results));
        self
    }

    /// The same with a property that held in `results` results.
    pub fn holds(mut self, results: u64) -> Self {
        self.margins.push(Margin::Holds(results));
        self
    }

    /// The same with a quantity that may be at most its limit.
    pub fn at_most(
        mut self,
        name: impl Into<String>,
        measured: f64,
        limit: f64,
        unit: &'static str,
    ) -> Self {
        self.margins.push(Margin::AtMost(Quantity { name: name.into(), measured, limit, unit }));
        self
    }

    /// The same with a quantity that must be at least its limit.
    pub fn at_least(
        mut self,
        name: impl Into<String>,
        measured: f64,
        limit: f64,
        unit: &'static str,
    ) -> Self {
        self.margins.push(Margin::AtLeast(Quantity { name: name.into(), measured, limit, unit }));
        self
    }

    /// The same with what others make of it.
    pub fn rivals(mut self, rivals: impl Into<String>) -> Self {
        self.rivals = rivals.into();
        self
    }

    /// The first quantity that misses its limit.
    pub fn missed(&self) -> Option<&Margin> {
        self.margins.iter().find(|margin| !margin.holds())
    }
}

impl Margin {
    /// Whether the limit is kept; a quantity that is no number does not keep it.
    pub fn holds(&self) -> bool {
        match self {
            Margin::Equal(results) | Margin::Holds(results) => *results > 0,
            Margin::AtMost(of) => of.measured <= of.limit,
            Margin::AtLeast(of) => of.measured >= of.limit,
        }
    }
}

impl Display for Margin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Margin::Equal(results) => write!(f, "equal to the bit, {results} results"),
            Margin::Holds(results) => write!(f, "{results} of {results}"),
            Margin::AtMost(of) => write!(f, "{} ≤ {}", of, Number(of.limit)),
            Margin::AtLeast(of) => write!(f, "{} ≥ {}", of, Number(of.limit)),
        }
    }
}

impl Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let separator = if self.unit.is_empty() { "" } else { " " };
        write!(f, "{} {}{separator}{}", self.name, Number(self.measured), self.unit)
    }
}

/// A number with three significant digits.
pub struct Number(pub f64);

impl Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Number(value) = *self;
        if value == 0.0 || !value.is_finite() {
            return write!(f, "{}", value + 0.0);
        }
        let digits = value.abs().log10().floor() as i32;
        match digits {
            3.. => write!(f, "{value:.0}"),
            -4..=2 => {
                let text = format!("{value:.*}", (2 - digits) as usize);
                let short = if text.contains('.') {
                    text.trim_end_matches('0').trim_end_matches('.')
                } else {
                    &text
                };
                f.write_str(short)
            }
            _ => write!(f, "{value:.1e}"),
        }
    }
}
