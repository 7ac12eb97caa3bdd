// SPDX-License-Identifier: MIT OR Apache-2.0
//! TOML text to a tree of values, each with the line it was written on.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::tree::{Node, Table, Value, join};
use crate::error::{Place, SceneError};

/// Reads a whole document; the error names the line of the first syntax error.
pub(crate) fn parse(text: &str) -> Result<Table, SceneError> {
    let lines = Lines::of(text);
    let root = DeTable::parse(text).map_err(|error| {
        let place = error.span().map_or(Place::File, |span| lines.place(span.start));
        SceneError::new(place, "", first_line(error.message()))
    })?;
    table("", Place::File, root.get_ref(), &|at| lines.place(at))
}

/// Reads one value, as given to `--set`; text that is no TOML value is taken as a string.
pub(super) fn parse_one(path: &str, text: &str) -> Result<Node, SceneError> {
    match DeValue::parse(text) {
        Ok(value) => node(path, &value, &|_| Place::Override),
        Err(_) => Ok(Node { place: Place::Override, value: Value::Text(text.to_string()) }),
    }
}

fn first_line(message: &str) -> String {
    let line = message.lines().next().unwrap_or("not TOML");
    line.chars().take(160).flat_map(char::escape_debug).filter(|c| *c != '\\').collect()
}

fn table(
    path: &str,
    place: Place,
    from: &DeTable<'_>,
    at: &dyn Fn(usize) -> Place,
) -> Result<Table, SceneError> {
    let mut table = Table::new(path, place);
    for (key, value) in from {
        let child = join(path, key.get_ref());
        table.insert(
            key.get_ref(),
            Node { place: at(key.span().start), ..node(&child, value, at)? },
        );
    }
    Ok(table)
}

fn node(
    path: &str,
    from: &Spanned<DeValue<'_>>,
    at: &dyn Fn(usize) -> Place,
) -> Result<Node, SceneError> {
    let place = at(from.span().start);
    let value = match from.get_ref() {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Integer(whole) => {
            Value::Integer(i64::from_str_radix(whole.as_str(), whole.radix()).map_err(|_| {
                SceneError::new(place.clone(), path, "expected an integer of at most 64 bits")
            })?)
        }
        DeValue::Float(number) => Value::Number(number.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(flag) => Value::Flag(*flag),
        DeValue::Datetime(date) => Value::Text(date.to_string()),
        DeValue::Array(list) => Value::List(
            list.iter()
                .enumerate()
                .map(|(index, item)| node(&join(path, &index.to_string()), item, at))
                .collect::<Result<_, _>>()?,
        ),
        DeValue::Table(inner) => Value::Table(table(path, place.clone(), inner, at)?),
    };
    Ok(Node { place, value })
}

/// Byte offsets of line starts, so that a line is found by bisection.
struct Lines(Vec<usize>);

impl Lines {
    fn of(text: &str) -> Self {
        Lines(std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect())
    }

    fn place(&self, at: usize) -> Place {
        Place::Line(self.0.partition_point(|start| *start <= at))
    }
}
