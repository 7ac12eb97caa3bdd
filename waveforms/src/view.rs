// SPDX-License-Identifier: MIT OR Apache-2.0
//! Views: which signals to show and how, as TOML.
//!
//! ```toml
//! [[group]]
//! name = "Position"
//! signals = [
//!     { show = "core.position.x", as = "step", color = "yellow", alias = "x" },
//!     { show = "core.position.*_valid" },
//! ]
//!
//! [[group]]                              # no name: one group for each scope
//! closed = true
//! signals = [{ show = "core.**" }]
//!
//! [[group]]
//! name = "Truth"
//! optional = true                        # a trace without these signals is shown without them
//! signals = [{ show = "truth.*", as = "line", height = 3 }]
//! ```
//!
//! `show` is a [pattern](crate::pattern). A signal that a group before has shown is not shown again
//! by a pattern, only by its full path, so that a last group can hold all others.

use std::ops::Range;
use std::path::Path;

use serde::Deserialize;
use toml::Spanned;

use crate::Error;

/// The views that come with the project, by name.
const BUNDLED: &[(&str, &str)] = &[
    ("slot", include_str!("../views/slot.toml")),
    ("force_loop", include_str!("../views/force_loop.toml")),
];

/// A view that cannot be read, or that does not fit the trace.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ViewError {
    /// The text is no view. The message names line and key.
    #[error("{view}: {message}")]
    Text {
        /// The name of the view.
        view: String,
        /// What is wrong, and where.
        message: String,
    },
    /// A line of the view that does not fit the trace.
    #[error("{view}:{line}: {reason}, got \"{signal}\"")]
    Signal {
        /// The name of the view.
        view: String,
        /// The line, counted from 1.
        line: usize,
        /// The pattern on that line.
        signal: String,
        /// What was expected.
        reason: &'static str,
    },
    /// No bundled view has this name.
    #[error("expected a view among {known}, got \"{name}\"")]
    Unknown {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
}

/// A view as written.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// Its name in messages: a file, or a bundled name.
    pub name: String,
    /// The groups from top to bottom.
    pub groups: Vec<Group>,
    /// The text it was read from: messages give lines.
    text: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Groups {
    #[serde(rename = "group")]
    groups: Vec<Group>,
}

/// Signals under one heading.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Group {
    /// The heading; without one, every scope that a signal comes from gets a group of its own.
    pub name: Option<String>,
    /// Whether the group starts closed.
    #[serde(default)]
    pub closed: bool,
    /// Whether signals that the trace does not have are passed over; else they are errors.
    #[serde(default)]
    pub optional: bool,
    /// Whether it shows what happens within a window: closed where results are to be seen.
    #[serde(default)]
    pub window: bool,
    /// The signals from top to bottom.
    pub signals: Vec<Entry>,
}

/// One line of a group: a pattern and how to show what fits it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// The pattern of the signals.
    pub show: Spanned<String>,
    /// How to show them; by their kind where not given.
    #[serde(rename = "as")]
    pub style: Option<Style>,
    /// The colour of the trace.
    pub color: Option<Color>,
    /// The name to show; only for a single signal.
    pub alias: Option<String>,
    /// How many lines high an analog trace is.
    pub height: Option<u8>,
}

/// How a signal is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Style {
    /// As the number it stands for, or the name of the state.
    Number,
    /// As raw hexadecimal digits.
    Hex,
    /// As raw binary digits.
    Binary,
    /// As a curve that holds each value until the next.
    Step,
    /// As a curve that joins the values by lines.
    Line,
}

/// The colours of GTKWave, in its order.
#[allow(missing_docs)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Color {
    Red = 1,
    Orange,
    Yellow,
    Green,
    Blue,
    Indigo,
    Violet,
}

impl View {
    /// Reads the view `text`, called `name` in messages.
    ///
    /// # Errors
    /// The text is no view; unknown keys are errors too.
    pub fn parse(name: &str, text: &str) -> Result<Self, ViewError> {
        let wrong = |error: toml::de::Error| ViewError::Text {
            view: name.into(),
            message: error.to_string(),
        };
        let Groups { groups } = toml::from_str(text).map_err(wrong)?;
        Ok(View { name: name.into(), groups, text: text.into() })
    }

    /// Reads a view from a file.
    ///
    /// # Errors
    /// The file cannot be read or is no view.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let text = std::fs::read_to_string(path).map_err(Error::io(path))?;
        Ok(View::parse(&path.display().to_string(), &text)?)
    }

    /// The bundled view `name`.
    ///
    /// # Errors
    /// There is none of this name; the message lists those there are.
    pub fn bundled(name: &str) -> Result<Self, ViewError> {
        match BUNDLED.iter().find(|(known, _)| *known == name) {
            Some((_, text)) => View::parse(name, text),
            None => Err(ViewError::Unknown {
                name: name.into(),
                known: View::names().collect::<Vec<_>>().join(", "),
            }),
        }
    }

    /// Closes the groups that show what happens within a window.
    pub fn close_windows(&mut self) {
        self.groups.iter_mut().for_each(|group| group.closed |= group.window);
    }

    /// The names of the bundled views.
    pub fn names() -> impl Iterator<Item = &'static str> {
        BUNDLED.iter().map(|(name, _)| *name)
    }

    /// All signals as numbers, a group for each scope.
    pub fn everything() -> Self {
        View::parse("everything", "[[group]]\nsignals = [{ show = \"**\" }]").expect("a view")
    }

    /// The error that `entry` does not fit a trace.
    pub(crate) fn misfit(&self, entry: &Entry, reason: &'static str) -> ViewError {
        let line = self.line(entry.show.span());
        ViewError::Signal {
            view: self.name.clone(),
            line,
            signal: entry.show.get_ref().clone(),
            reason,
        }
    }

    fn line(&self, span: Range<usize>) -> usize {
        self.text[..span.start].matches('\n').count() + 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bundled_views_are_views() {
        for name in View::names() {
            assert!(!View::bundled(name).unwrap().groups.is_empty());
        }
        let error = View::bundled("no").unwrap_err().to_string();
        assert_eq!(error, "expected a view among slot, force_loop, got \"no\"");
    }

    #[test]
    fn what_is_no_view_is_named_with_its_line() {
        let cases = [
            ("[[group]]\nsignals = []\ncolour = 1", "line 3"),
            ("[[group]]\nsignals = [\n { show = \"a\", color = \"mauve\" } ]", "line 3"),
            ("[[group]]\nsignals = [ { as = \"step\" } ]", "missing field `show`"),
        ];
        for (text, expected) in cases {
            let error = View::parse("mine.toml", text).unwrap_err().to_string();
            assert!(error.starts_with("mine.toml: ") && error.contains(expected), "{error}");
        }
    }
}
