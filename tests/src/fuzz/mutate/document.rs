// SPDX-License-Identifier: MIT OR Apache-2.0
//! A TOML document with other values, keys and arrays.
//!
//! The place of a change is chosen from the root down, each key and element of a table or array
//! alike. So a key of a small table is met as often as all rows of a long array.

use std::sync::OnceLock;

use toml::{Table, Value};

use super::Mutator;
use crate::fuzz::{TARGETS, seeds};

/// Of this many choices of a table or array, one stops there rather than go further down.
const STOPS: u8 = 6;

impl Mutator {
    /// The document of a target with a few changes.
    pub(super) fn toml(&mut self, target: &str, text: &str) -> Option<String> {
        let mut root = Value::Table(text.parse().ok()?);
        if self.rng.u8(..8) == 0 {
            return self.lines(text);
        }
        for _ in 0..self.changes() {
            match root.as_table_mut().filter(|_| self.rng.u8(..8) == 0) {
                Some(table) => {
                    let seed = self.rng.choice(documents(target)).expect("a document");
                    self.restore(table, seed);
                }
                None => self.change(&mut root),
            }
        }
        toml::to_string(root.as_table()?).ok()
    }

    /// A value of a seed in its place. libFuzzer prefers short inputs, so that it loses what has a default: without
    /// this, a key that is gone does not come again.
    fn restore(&mut self, table: &mut Table, seed: &Table) {
        let chosen = self.rng.usize(..seed.len().max(1));
        match seed.iter().nth(chosen) {
            Some((key, Value::Table(inner))) if table.get(key).is_some_and(Value::is_table) => {
                let own = table.get_mut(key).and_then(Value::as_table_mut);
                self.restore(own.expect("a table"), inner);
            }
            Some((key, value)) => drop(table.insert(key.clone(), value.clone())),
            None => {}
        }
    }

    /// A line twice, or in another's place: keys and tables that are there already.
    fn lines(&mut self, text: &str) -> Option<String> {
        let mut lines: Vec<&str> = text.lines().collect();
        let line = *lines.get(self.rng.usize(..lines.len().max(1)))?;
        let at = self.rng.usize(..lines.len());
        if self.rng.bool() {
            lines.insert(at, line)
        } else {
            lines[at] = line
        }
        Some(lines.join("\n") + "\n")
    }

    fn change(&mut self, root: &mut Value) {
        let document = root.clone();
        match self.somewhere(root) {
            Value::Table(table) => self.keys(table, &document),
            Value::Array(array) if self.rng.u8(..8) > 0 => self.elements(array),
            value if self.rng.u8(..16) == 0 => *value = self.of_another_type(value, &document),
            value => *value = self.scalar(value, &document),
        }
    }

    fn somewhere<'a>(&mut self, value: &'a mut Value) -> &'a mut Value {
        let children = match value {
            Value::Table(table) => table.len(),
            Value::Array(array) => array.len(),
            _ => 0,
        };
        if children == 0 || self.rng.u8(..STOPS) == 0 {
            return value;
        }
        let chosen = self.rng.usize(..children);
        let child = match value {
            Value::Table(table) => table.iter_mut().nth(chosen).map(|(_, child)| child),
            Value::Array(array) => array.get_mut(chosen),
            _ => None,
        };
        self.somewhere(child.expect("one of them"))
    }

    /// A key that is removed, renamed, or copied from another table.
    fn keys(&mut self, table: &mut Table, document: &Value) {
        let own = table.keys().nth(self.rng.usize(..table.len().max(1))).cloned();
        let mut entries = Vec::new();
        collect_entries(document, &mut entries);
        let other = entries.get(self.rng.usize(..entries.len().max(1)));
        match (self.rng.u8(..4), own, other) {
            (0, Some(own), _) => drop(table.remove(&own)),
            (1, Some(own), Some((other, _))) => {
                let name = if self.rng.bool() { self.word() } else { other.to_string() };
                let value = table.remove(&own).expect("its own key");
                table.insert(name, value);
            }
            (_, _, Some((name, value))) => {
                table.insert(name.to_string(), (*value).clone());
            }
            _ => {
                table.insert(self.word(), Value::Integer(1));
            }
        }
    }

    /// An array that is longer, shorter, in another order, or of columns in place of rows.
    fn elements(&mut self, array: &mut Vec<Value>) {
        let Some(last) = array.len().checked_sub(1) else { return array.push(Value::Integer(0)) };
        let [a, b] = [0; 2].map(|_| self.rng.usize(..=last));
        match self.rng.u8(..7) {
            0 => array.insert(a, array[b].clone()),
            1 => drop(array.remove(a)),
            2 => array.truncate(a),
            3 => array.extend(array.clone()),
            4 => array.swap(a, b),
            5 => array[a] = array[b].clone(),
            _ => transpose(array),
        }
    }

    /// A value of another type: a number with or without a point, in a list, as a string, or any
    /// other value of the document.
    fn of_another_type(&mut self, value: &Value, document: &Value) -> Value {
        match (self.rng.u8(..4), value) {
            (0, Value::Integer(integer)) => Value::Float(*integer as f64),
            (0, Value::Float(float)) => Value::Integer(*float as i64),
            (1, value) => Value::Array(vec![value.clone()]),
            (2, value) => Value::String(value.to_string()),
            _ => {
                let mut entries = Vec::new();
                collect_entries(document, &mut entries);
                let chosen = self.rng.usize(..entries.len().max(1));
                entries.get(chosen).map_or(Value::Boolean(true), |(_, other)| (*other).clone())
            }
        }
    }
}

/// The documents that fuzzing of a target begins with.
fn documents(target: &str) -> &'static [Table] {
    static SEEDS: [OnceLock<Vec<Table>>; TARGETS.len()] =
        [const { OnceLock::new() }; TARGETS.len()];
    let number = TARGETS.iter().position(|(name, _)| *name == target).expect("a target");
    SEEDS[number].get_or_init(|| {
        let document = |seed: &Vec<u8>| {
            let text = str::from_utf8(seed).ok()?;
            text.split('\0').next()?.parse().ok()
        };
        seeds::of(target).iter().filter_map(document).collect()
    })
}

/// All keys of all tables, with their values.
fn collect_entries<'a>(value: &'a Value, entries: &mut Vec<(&'a str, &'a Value)>) {
    match value {
        Value::Table(table) => table.iter().for_each(|(key, value)| {
            entries.push((key, value));
            collect_entries(value, entries);
        }),
        Value::Array(array) => array.iter().for_each(|value| collect_entries(value, entries)),
        _ => {}
    }
}

/// Rows exchanged for columns; what is no list of lists is turned round.
fn transpose(array: &mut Vec<Value>) {
    let rows: Option<Vec<_>> = array.iter().map(Value::as_array).collect();
    let columns = rows.as_ref().and_then(|rows| rows.iter().map(|row| row.len()).min());
    match (rows, columns.unwrap_or(0)) {
        (Some(rows), columns @ 1..) => {
            let column = |k: usize| rows.iter().map(|row| row[k].clone()).collect();
            *array = (0..columns).map(|k| Value::Array(column(k))).collect();
        }
        _ => array.reverse(),
    }
}
