// SPDX-License-Identifier: MIT OR Apache-2.0
//! A scene as a tree: values that know where they were written, and tables that remember which of
//! their keys were read.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::fmt;

use crate::error::{Place, SceneError};

/// A value and where it was written.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub place: Place,
    pub value: Value,
}

/// A TOML value; dates stay text, since no key of a scene takes one.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Text(String),
    Integer(i64),
    Number(f64),
    Flag(bool),
    List(Vec<Node>),
    Table(Table),
}

impl Node {
    /// The same value as if it had been written at `path`: what a case's override becomes.
    pub fn moved_to(&self, path: &str) -> Node {
        let value = match &self.value {
            Value::Table(table) => Value::Table(table.moved_to(path)),
            Value::List(list) => Value::List(
                list.iter()
                    .enumerate()
                    .map(|(n, item)| item.moved_to(&join(path, &n.to_string())))
                    .collect(),
            ),
            plain => plain.clone(),
        };
        Node { place: self.place.clone(), value }
    }
}

impl Node {
    /// The value as TOML.
    pub fn to_toml(&self) -> toml::Value {
        match &self.value {
            Value::Text(text) => text.clone().into(),
            Value::Integer(whole) => (*whole).into(),
            Value::Number(number) => (*number).into(),
            Value::Flag(flag) => (*flag).into(),
            Value::List(list) => list.iter().map(Node::to_toml).collect::<Vec<_>>().into(),
            Value::Table(table) => table.to_toml().into(),
        }
    }
}

impl Value {
    /// The text, where it is one.
    pub fn text(&self) -> Option<&str> {
        if let Value::Text(text) = self { Some(text) } else { None }
    }

    /// An integer is a number too: `500` and `500.0` mean the same.
    pub fn number(&self) -> Option<f64> {
        match *self {
            Value::Integer(whole) => Some(whole as f64),
            Value::Number(number) => Some(number),
            _ => None,
        }
    }
}

/// The value as an error message shows it, never longer than one line.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Text(text) => {
                let short: String = text.chars().take(40).flat_map(char::escape_debug).collect();
                write!(f, "\"{short}{}\"", if text.chars().count() > 40 { "…" } else { "" })
            }
            Value::Integer(whole) => write!(f, "{whole}"),
            Value::Number(number) => write!(f, "{number}"),
            Value::Flag(flag) => write!(f, "{flag}"),
            Value::List(list) => write!(f, "a list of {}", list.len()),
            Value::Table(_) => write!(f, "a table"),
        }
    }
}

/// A TOML table that knows its dotted path, and which of its keys have been read.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    path: String,
    place: Place,
    pub(super) entries: BTreeMap<String, (Node, Cell<bool>)>,
    pub(super) known: RefCell<Vec<&'static str>>,
    /// Any key is meant, and so is whatever lies below: the overrides of a case.
    pub(super) free: Cell<bool>,
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

    /// The value at `key`, which does not count as read.
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

    /// Puts `node` at `key`; at the top of a scene a table is merged into the table already there,
    /// so that `set = { sheet = { terminal_ohm = 500 } }` changes one key only.
    pub fn merge(&mut self, key: &str, node: Node) {
        let top = self.path.is_empty();
        match (self.entries.get_mut(key), node) {
            (
                Some((Node { value: Value::Table(old), .. }, _)),
                Node { value: Value::Table(new), .. },
            ) if top => {
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

    /// Dotted paths of the keys that were asked for, here and in the tables below.
    pub fn asked(&self) -> Vec<String> {
        let mut asked: Vec<_> =
            self.known.borrow().iter().map(|key| join(&self.path, key)).collect();
        for (node, _) in self.entries.values().filter(|_| !self.free.get()) {
            match &node.value {
                Value::Table(table) => asked.extend(table.asked()),
                Value::List(list) => asked.extend(list.iter().flat_map(|item| match &item.value {
                    Value::Table(table) => table.asked(),
                    _ => Vec::new(),
                })),
                _ => {}
            }
        }
        asked
    }

    /// The value at `key`, if it is there; `false` counts as absent, which is how an override takes
    /// a key away.
    pub fn node(&self, key: &'static str) -> Option<&Node> {
        self.ask(key).filter(|node| !matches!(node.value, Value::Flag(false)))
    }

    pub(super) fn ask(&self, key: &'static str) -> Option<&Node> {
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
        SceneError::new(
            place.clone(),
            if key.is_empty() { self.path.clone() } else { join(&self.path, key) },
            message,
        )
    }
}

/// `a` and `b` to `a.b`, the form keys take in messages and overrides.
pub(super) fn join(path: &str, key: &str) -> String {
    let short: String = key.chars().take(60).flat_map(char::escape_debug).collect();
    if path.is_empty() { short } else { format!("{path}.{short}") }
}
