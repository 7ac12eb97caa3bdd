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
            return here.put(part, node).ok_or_else(|| fail(format!("there is no {part} here")));
        }
        here = here
            .enter(part, &place)
            .ok_or_else(|| fail(format!("there is no {part} that could be entered")))?;
    }
    Ok(())
}

enum Step<'a> {
    Table(&'a mut Table),
    List(&'a mut Vec<Node>),
}

impl<'a> Step<'a> {
    fn enter(self, part: &str, place: &Place) -> Option<Step<'a>> {
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
            Value::Table(table) => Some(Step::Table(table)),
            Value::List(list) => Some(Step::List(list)),
            _ => None,
        }
    }

    fn put(self, part: &str, node: Node) -> Option<()> {
        match self {
            Step::Table(table) => table.merge(part, node),
            Step::List(list) => *find(list, part)? = node,
        }
        Some(())
    }
}

fn find<'a>(list: &'a mut [Node], part: &str) -> Option<&'a mut Node> {
    let named = |node: &Node| matches!(&node.value, Value::Table(table) if table.is_named(part));
    let index = part.parse().ok().or_else(|| list.iter().position(named))?;
    list.get_mut(index)
}
