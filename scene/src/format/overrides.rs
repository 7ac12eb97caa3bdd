// SPDX-License-Identifier: MIT OR Apache-2.0
//! Overrides: `sheet.terminal_ohm = 500`, from a case of the scene or from `--set`.
//!
//! A key is dotted; a list is entered by index or, where its tables have names, by name:
//! `pad.0.load_g`, `pad.mallet.load_g`. Tables on the way are made where they are missing, so that
//! an override can switch an effect on; setting an effect's table or an optional key to `false`
//! takes it away.

use super::document::parse_one;
use super::tree::{Node, Table, Value, join};
use crate::error::{Place, SceneError};

/// Reads the VALUE of `--set KEY=VALUE`.
pub(crate) fn parse_value(key: &str, text: &str) -> Result<Node, SceneError> {
    parse_one(key, text)
}

/// The most parts of a key: none of a scene has as many, and tables are walked one in another.
const MOST_PARTS: usize = 16;

/// Puts `node` at `key`. Whether the key means anything shows when the table is read.
pub(crate) fn apply(root: &mut Table, key: &str, node: Node) -> Result<(), SceneError> {
    let place = node.place.clone();
    let fail = |message: String| SceneError::new(place.clone(), key, message);
    if key.split('.').nth(MOST_PARTS).is_some() {
        return Err(fail(format!("expected a key of at most {MOST_PARTS} parts")));
    }
    let mut parts = key.split('.').peekable();
    let mut here = Step::Table(root);
    while let Some(part) = parts.next() {
        if part.is_empty() {
            return Err(fail("expected a key such as sheet.terminal_ohm".into()));
        }
        if parts.peek().is_none() {
            return here.put(part, node).map_err(fail);
        }
        here = here.enter(part, &place).map_err(&fail)?;
    }
    Ok(())
}

enum Step<'a> {
    Table(&'a mut Table),
    List(&'a mut Vec<Node>),
}

impl<'a> Step<'a> {
    fn enter(self, part: &str, place: &Place) -> Result<Step<'a>, String> {
        let node = match self {
            Step::Table(table) => {
                let path = join(table.path(), part);
                table.entry(part, || Node {
                    place: place.clone(),
                    value: Value::Table(Table::new(&path, place.clone())),
                })
            }
            Step::List(list) => find(list, part)?,
        };
        if let Value::Flag(false) = node.value {
            node.value = Value::Table(Table::new(part, place.clone()));
        }
        match &mut node.value {
            Value::Table(table) => Ok(Step::Table(table)),
            Value::List(list) => Ok(Step::List(list)),
            other => Err(format!("expected a table at {part}, got {other}")),
        }
    }

    fn put(self, part: &str, node: Node) -> Result<(), String> {
        match self {
            Step::Table(table) => table.merge(part, node),
            Step::List(list) => *find(list, part)? = node,
        }
        Ok(())
    }
}

/// An entry of a list, by its number or its name.
fn find<'a>(list: &'a mut [Node], part: &str) -> Result<&'a mut Node, String> {
    let named = |node: &Node| matches!(&node.value, Value::Table(table) if table.is_named(part));
    let index = part.parse().ok().or_else(|| list.iter().position(named));
    let last = list.len().saturating_sub(1);
    let entry = index.and_then(|index| list.get_mut(index));
    entry.ok_or_else(|| format!("expected an entry's number, 0 to {last}, or its name, got {part}"))
}
