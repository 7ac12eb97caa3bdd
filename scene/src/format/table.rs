// SPDX-License-Identifier: MIT OR Apache-2.0
//! Typed access to a table. Every key asked for becomes a known key; when all is read, a key that
//! was not asked for is an error.

use super::kind::Kind;
use super::limits::Limits;
use super::tree::{Table, Value, join};
use crate::error::{Place, SceneError};
use crate::suggest::did_you_mean;

pub(super) type Result<T> = std::result::Result<T, SceneError>;

impl Table {
    pub(super) fn wrong<T>(
        &self,
        key: &str,
        expected: impl std::fmt::Display,
        got: &Value,
    ) -> Result<T> {
        Err(self.error(key, format!("expected {expected}, got {got}")))
    }

    /// `value`, or an error that `key` is missing.
    pub fn require<T>(&self, key: &'static str, expected: &str, value: Option<T>) -> Result<T> {
        let bare = || self.entries.keys().find(|given| lacks_unit(given, key));
        value.ok_or_else(|| match bare() {
            Some(given) => self.error(given, format!("expected {key}, since a key names its unit")),
            None => self.error(key, format!("expected {expected}, but it is missing")),
        })
    }

    pub fn text(&self, key: &'static str) -> Result<Option<String>> {
        match self.node(key).map(|node| &node.value) {
            None => Ok(None),
            Some(Value::Text(text)) => Ok(Some(text.clone())),
            Some(other) => self.wrong(key, "text", other),
        }
    }

    pub fn flag(&self, key: &'static str) -> Result<bool> {
        match self.ask(key).map(|node| &node.value) {
            None => Ok(false),
            Some(Value::Flag(flag)) => Ok(*flag),
            Some(other) => self.wrong(key, "true or false", other),
        }
    }

    /// One of a list of words, as `rung` takes; the word itself comes back from the list.
    pub fn choice(
        &self,
        key: &'static str,
        words: &[&'static str],
    ) -> Result<Option<&'static str>> {
        let Some(node) = self.node(key) else { return Ok(None) };
        let found =
            words.iter().find(|word| matches!(&node.value, Value::Text(text) if text == *word));
        match found {
            Some(word) => Ok(Some(word)),
            None => {
                let given = node.value.text().unwrap_or_default();
                let near = did_you_mean(given, words.iter().copied());
                let got = &node.value;
                Err(self.error(key, format!("expected one of {}, got {got}{near}", quoted(words))))
            }
        }
    }

    pub fn number(&self, key: &'static str, limits: Limits) -> Result<Option<f64>> {
        let Some(node) = self.node(key) else { return Ok(None) };
        match node.value.number().filter(|number| limits.holds(*number)) {
            Some(number) => Ok(Some(number)),
            None => self.wrong(key, limits, &node.value),
        }
    }

    /// An integer, of the kind that says its least and its greatest.
    pub fn whole(&self, key: &'static str, kind: Kind) -> Result<Option<u64>> {
        let (Some(node), Kind::Whole(low, high)) = (self.node(key), kind) else { return Ok(None) };
        match node.value {
            Value::Integer(whole)
                if (low..=high).contains(&u64::try_from(whole).unwrap_or(u64::MAX))
                    && whole >= 0 =>
            {
                Ok(Some(whole.unsigned_abs()))
            }
            ref other => self.wrong(key, format_args!("an integer from {low} to {high}"), other),
        }
    }

    /// The table at `key`; `false` counts as absent.
    pub fn table(&self, key: &'static str) -> Result<Option<&Table>> {
        match self.node(key).map(|node| &node.value) {
            None => Ok(None),
            Some(Value::Table(table)) => Ok(Some(table)),
            Some(other) => self.wrong(key, "a table", other),
        }
    }

    /// The first key, by line, that was not asked for is an error; so in every table below that was
    /// read. `known_elsewhere` says of a dotted path why it is not read here, if it means something.
    pub fn refuse_unknown(&self, known_elsewhere: Elsewhere) -> Result<()> {
        match self.unknown(known_elsewhere).into_iter().min_by_key(|error| match error.place {
            Place::Override => 0,
            Place::Line(line) => line,
            Place::File => usize::MAX,
        }) {
            Some(error) => Err(error),
            None => Ok(()),
        }
    }

    fn unknown(&self, known_elsewhere: Elsewhere) -> Vec<SceneError> {
        let mut errors = Vec::new();
        for (key, (node, used)) in &self.entries {
            match &node.value {
                _ if self.free.get() => {}
                _ if !used.get() => {
                    let known = self.known.borrow();
                    errors.push(match known.iter().find(|known| lacks_unit(key, known)) {
                        Some(known) => {
                            self.error(key, format!("expected {known}, since a key names its unit"))
                        }
                        None => {
                            let message = known_elsewhere(&join(self.path(), key));
                            self.error(key, message.unwrap_or_else(|| unknown(key, &known)))
                        }
                    });
                }
                Value::Table(table) => errors.extend(table.unknown(known_elsewhere)),
                Value::List(list) => {
                    let tables = list.iter().filter_map(|item| {
                        if let Value::Table(t) = &item.value { Some(t) } else { None }
                    });
                    errors.extend(tables.flat_map(|table| table.unknown(known_elsewhere)));
                }
                _ => {}
            }
        }
        errors
    }
}

/// What is said of a key, by its dotted path, that is none of its table's but means something: where it belongs, or what it
/// needs.
pub(crate) type Elsewhere = fn(&str) -> Option<String>;

fn unknown(key: &str, known: &[&str]) -> String {
    let near = did_you_mean(key, known.iter().copied());
    format!("unknown key, expected one of {}{near}", quoted(known))
}

/// Whether `given` is `known` without the unit that it ends with, as `load` is of `load_g`.
fn lacks_unit(given: &str, known: &str) -> bool {
    known.strip_prefix(given).is_some_and(|unit| unit.starts_with('_'))
}

fn quoted(words: &[&str]) -> String {
    words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(", ")
}
