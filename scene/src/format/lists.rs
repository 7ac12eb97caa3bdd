// SPDX-License-Identifier: MIT OR Apache-2.0
//! Typed access to the lists in a table.

use super::limits::Limits;
use super::table::Result;
use super::tree::{Node, Table, Value};

impl Table {
    /// A list of texts.
    pub fn texts(&self, key: &'static str) -> Result<Option<Vec<String>>> {
        let Some(node) = self.node(key) else { return Ok(None) };
        let text = |item: &Node| {
            if let Value::Text(text) = &item.value { Some(text.clone()) } else { None }
        };
        let texts = if let Value::List(list) = &node.value {
            list.iter().map(text).collect()
        } else {
            None
        };
        match texts {
            Some(texts) => Ok(Some(texts)),
            None => self.wrong(key, "a list of texts", &node.value),
        }
    }

    /// A number, or a list of them, in a stated range, not empty.
    pub fn one_or_several(&self, key: &'static str, limits: Limits) -> Result<Option<Vec<f64>>> {
        match self.node(key).is_some_and(|node| node.value.number().is_some()) {
            true => Ok(self.number(key, limits)?.map(|number| vec![number])),
            false => self.numbers(key, limits),
        }
    }

    /// A list of numbers in a stated range, not empty.
    pub fn numbers(&self, key: &'static str, limits: Limits) -> Result<Option<Vec<f64>>> {
        let Some(node) = self.node(key) else { return Ok(None) };
        let list = match &node.value {
            Value::List(list) if !list.is_empty() => list,
            other => return self.wrong(key, format_args!("a list, each {limits}"), other),
        };
        let number = |item: &Node| match item.value.number().filter(|number| limits.holds(*number))
        {
            Some(number) => Ok(number),
            None => self.wrong(key, format_args!("a list, each {limits}"), &item.value),
        };
        list.iter().map(number).collect::<Result<_>>().map(Some)
    }

    /// Two numbers, `[x, y]`.
    pub fn pair(&self, key: &'static str, limits: Limits) -> Result<Option<[f64; 2]>> {
        let Some(numbers) = self.numbers(key, limits)? else { return Ok(None) };
        let pair = numbers.as_slice().try_into();
        pair.map(Some)
            .map_err(|_| self.error(key, format!("expected two numbers, got {}", numbers.len())))
    }

    /// A list of pairs, not empty.
    pub fn pairs(&self, key: &'static str) -> Result<Option<Vec<[f64; 2]>>> {
        let Some(node) = self.node(key) else { return Ok(None) };
        let pair = |item: &Node| match &item.value {
            Value::List(list) if list.len() == 2 => {
                Some([list[0].value.number()?, list[1].value.number()?])
            }
            _ => None,
        };
        let pairs = match &node.value {
            Value::List(list) if !list.is_empty() => {
                list.iter().map(pair).collect::<Option<Vec<_>>>()
            }
            _ => None,
        };
        match pairs.filter(|pairs| pairs.iter().flatten().all(|number| number.is_finite())) {
            Some(pairs) => Ok(Some(pairs)),
            None => self.wrong(key, "a list of pairs of numbers", &node.value),
        }
    }

    /// The list of tables at `key`, `[[key]]`; empty where there is none.
    pub fn tables(&self, key: &'static str) -> Result<Vec<&Table>> {
        let Some(node) = self.node(key) else { return Ok(Vec::new()) };
        let Value::List(list) = &node.value else {
            return self.wrong(key, format_args!("tables, each headed [[{key}]]"), &node.value);
        };
        let table = |item: &'_ Node| match &item.value {
            Value::Table(_) => Ok(()),
            other => self.wrong(key, format_args!("tables, each headed [[{key}]]"), other),
        };
        list.iter().try_for_each(table)?;
        Ok(list
            .iter()
            .filter_map(
                |item| if let Value::Table(table) = &item.value { Some(table) } else { None },
            )
            .collect())
    }
}
