// SPDX-License-Identifier: MIT OR Apache-2.0
//! Typed access to a table. Every key asked for becomes a known key; when all is read, a key nobody asked for is an error.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

use super::document::join;
use super::{Limits, Node, Value};
use crate::error::{Place, SceneError};

pub(super) type Result<T> = std::result::Result<T, SceneError>;

/// A TOML table that knows its dotted path, and which of its keys have been read.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    path: String,
    place: Place,
    entries: BTreeMap<String, (Node, Cell<bool>)>,
    known: RefCell<Vec<&'static str>>,
    /// Any key is meant, and so is whatever lies below: the overrides of a case.
    free: Cell<bool>,
}

impl Table {
    pub fn new(path: &str, place: Place) -> Self {
        Table {
            path: path.to_string(),
            place,
            entries: BTreeMap::new(),
            known: RefCell::default(),
            free: Cell::new(false),
        }
    }

    pub fn path(&self) -> &str {
        &self.path
    }

    /// The same table as if it stood at `path`.
    pub fn moved_to(&self, path: &str) -> Table {
        let mut moved = Table::new(path, self.place.clone());
        for (key, (node, _)) in &self.entries {
            moved.insert(key, node.moved_to(&join(path, key)));
        }
        moved
    }

    pub fn insert(&mut self, key: &str, node: Node) {
        self.entries.insert(key.to_string(), (node, Cell::new(false)));
    }

    pub fn remove(&mut self, key: &str) {
        self.entries.remove(key);
    }

    /// The value at `key`, read by nobody.
    pub fn find(&mut self, key: &str) -> Option<&mut Node> {
        self.entries.get_mut(key).map(|(node, _)| node)
    }

    /// The table as TOML.
    pub fn to_toml(&self) -> toml::Table {
        self.entries.iter().map(|(key, (node, _))| (key.clone(), node.to_toml())).collect()
    }

    /// The entry at `key`, made by `missing` where there is none.
    pub fn entry(&mut self, key: &str, missing: impl FnOnce() -> Node) -> &mut Node {
        &mut self.entries.entry(key.to_string()).or_insert_with(|| (missing(), Cell::new(false))).0
    }

    /// Puts `node` at `key`; at the top of a scene a table is merged into the table already there, so that
    /// `set = { sheet = { terminal_ohm = 500 } }` changes one key only.
    pub fn merge(&mut self, key: &str, node: Node) {
        let top = self.path.is_empty();
        match (self.entries.get_mut(key), node) {
            (Some((Node { value: Value::Table(old), .. }, _)), Node { value: Value::Table(new), .. }) if top => {
                old.entries.extend(new.entries);
            }
            (_, node) => self.insert(key, node),
        }
    }

    pub fn is_named(&self, name: &str) -> bool {
        matches!(self.entries.get("name"), Some((Node { value: Value::Text(text), .. }, _)) if text == name)
    }

    /// All entries with their keys, for a table whose keys are free: overrides.
    pub fn all(&self) -> impl Iterator<Item = (&str, &Node)> {
        self.free.set(true);
        self.entries.iter().map(|(key, (node, _))| (key.as_str(), node))
    }

    /// The value at `key`, if it is there; `false` counts as absent, which is how an override takes a key away.
    pub fn get(&self, key: &'static str) -> Option<&Node> {
        self.ask(key).filter(|node| !matches!(node.value, Value::Flag(false)))
    }

    fn ask(&self, key: &'static str) -> Option<&Node> {
        let mut known = self.known.borrow_mut();
        if !known.contains(&key) {
            known.push(key);
        }
        self.entries.get(key).map(|(node, used)| {
            used.set(true);
            node
        })
    }

    /// An error about `key`, placed where the key is, or where its table is if it is missing.
    pub fn error(&self, key: &str, message: impl Into<String>) -> SceneError {
        let place = self.entries.get(key).map_or(&self.place, |(node, _)| &node.place);
        SceneError::new(place.clone(), if key.is_empty() { self.path.clone() } else { join(&self.path, key) }, message)
    }

    pub(super) fn wrong<T>(&self, key: &str, expected: impl std::fmt::Display, got: &Value) -> Result<T> {
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
        match self.get(key).map(|node| &node.value) {
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
    pub fn choice(&self, key: &'static str, words: &[&'static str]) -> Result<Option<&'static str>> {
        let Some(node) = self.get(key) else { return Ok(None) };
        let found = words.iter().find(|word| matches!(&node.value, Value::Text(text) if text == *word));
        match found {
            Some(word) => Ok(Some(word)),
            None => self.wrong(key, format_args!("one of {}", quoted(words)), &node.value),
        }
    }

    pub fn number(&self, key: &'static str, limits: Limits) -> Result<Option<f64>> {
        let Some(node) = self.get(key) else { return Ok(None) };
        match node.value.number().filter(|number| limits.holds(*number)) {
            Some(number) => Ok(Some(number)),
            None => self.wrong(key, limits, &node.value),
        }
    }

    pub fn number_or(&self, key: &'static str, limits: Limits, default: f64) -> Result<f64> {
        Ok(self.number(key, limits)?.unwrap_or(default))
    }

    pub fn whole(&self, key: &'static str, low: u64, high: u64) -> Result<Option<u64>> {
        let Some(node) = self.get(key) else { return Ok(None) };
        match node.value {
            Value::Integer(whole) if (low..=high).contains(&u64::try_from(whole).unwrap_or(u64::MAX)) && whole >= 0 => {
                Ok(Some(whole.unsigned_abs()))
            }
            ref other => self.wrong(key, format_args!("an integer from {low} to {high}"), other),
        }
    }

    /// The table at `key`; `false` counts as absent.
    pub fn table(&self, key: &'static str) -> Result<Option<&Table>> {
        match self.get(key).map(|node| &node.value) {
            None => Ok(None),
            Some(Value::Table(table)) => Ok(Some(table)),
            Some(other) => self.wrong(key, "a table", other),
        }
    }

    /// The first key, by line, that nobody asked for is an error; so in every table below that somebody read.
    pub fn refuse_unknown(&self) -> Result<()> {
        match self.unknown().into_iter().min_by_key(|error| match error.place {
            Place::Override => 0,
            Place::Line(line) => line,
            Place::File => usize::MAX,
        }) {
            Some(error) => Err(error),
            None => Ok(()),
        }
    }

    fn unknown(&self) -> Vec<SceneError> {
        let mut errors = Vec::new();
        for (key, (node, used)) in &self.entries {
            match &node.value {
                _ if self.free.get() => {}
                _ if !used.get() => {
                    let known = self.known.borrow();
                    errors.push(match known.iter().find(|known| lacks_unit(key, known)) {
                        Some(known) => self.error(key, format!("expected {known}, since a key names its unit")),
                        None => self.error(key, format!("unknown key, expected one of {}", quoted(&known))),
                    });
                }
                Value::Table(table) => errors.extend(table.unknown()),
                Value::List(list) => {
                    let tables =
                        list.iter().filter_map(|item| if let Value::Table(t) = &item.value { Some(t) } else { None });
                    errors.extend(tables.flat_map(Table::unknown));
                }
                _ => {}
            }
        }
        errors
    }
}

/// Whether `given` is `known` without the unit that it ends with, as `load` is of `load_g`.
fn lacks_unit(given: &str, known: &str) -> bool {
    known.strip_prefix(given).is_some_and(|unit| unit.starts_with('_'))
}

fn quoted(words: &[&str]) -> String {
    words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(", ")
}
