// SPDX-License-Identifier: MIT OR Apache-2.0
//! A table of numbers: CSV with a header; lines that begin with `#` are comments.

use std::collections::HashSet;

use anyhow::{Context, Result, anyhow, bail};
use hapticore_scene::did_you_mean;

/// A table of numbers.
#[derive(Debug, Clone)]
pub struct Table {
    /// Name of the file, for messages.
    pub file: String,
    names: Vec<String>,
    rows: Vec<Row>,
}

/// A row of a table.
#[derive(Debug, Clone)]
pub struct Row {
    /// Its line in the file.
    pub line: u64,
    numbers: Vec<f64>,
}

impl Table {
    /// The table that a text is, called `file` in messages.
    ///
    /// # Errors
    /// It is not of finite numbers; the message names file, line and column.
    pub fn parse(text: &str, file: &str) -> Result<Table> {
        let file = file.to_string();
        let mut builder = csv::ReaderBuilder::new();
        let mut reader =
            builder.comment(Some(b'#')).trim(csv::Trim::All).from_reader(text.as_bytes());
        let header = reader.headers().with_context(|| file.clone())?;
        let names: Vec<String> =
            header.iter().map(|name| name.trim_start_matches('\u{feff}').to_lowercase()).collect();
        let mut known = HashSet::new();
        if let Some(twice) = names.iter().find(|name| !known.insert(*name)) {
            bail!("{file}:1: {twice} comes twice");
        }
        let mut table = Table { file, names, rows: Vec::new() };
        for record in reader.records() {
            let record = record.with_context(|| table.file.clone())?;
            let line = record.position().map_or(0, csv::Position::line);
            let number = |(text, name): (&str, &String)| {
                let number = text.parse().ok().filter(|number: &f64| number.is_finite());
                number.ok_or_else(|| {
                    anyhow!("{}:{line}: {name}: expected a number, got \"{text}\"", table.file)
                })
            };
            let numbers = record.iter().zip(&table.names).map(number).collect::<Result<_>>()?;
            table.rows.push(Row { line, numbers });
        }
        Ok(table)
    }

    /// Whether it has a column.
    pub fn has(&self, name: &str) -> bool {
        self.names.iter().any(|known| known == name)
    }

    /// The number of a column.
    ///
    /// # Errors
    /// It has no such column.
    pub fn column(&self, name: &str) -> Result<usize> {
        let found = self.names.iter().position(|known| known == name);
        found.ok_or_else(|| {
            anyhow!("{}:1: expected a column {name}, got {}", self.file, self.names.join(", "))
        })
    }

    /// Refuses columns but these.
    ///
    /// # Errors
    /// The first that is none of them.
    pub fn only(&self, known: &[&str]) -> Result<()> {
        match self.names.iter().find(|name| !known.contains(&name.as_str())) {
            None => Ok(()),
            Some(name) => {
                let near = did_you_mean(name, known.iter().copied());
                bail!(
                    "{}:1: {name}: unknown column, expected {}{near}",
                    self.file,
                    known.join(", ")
                )
            }
        }
    }

    /// Data rows with their line numbers.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// How many columns `PREFIX1SUFFIX`, `PREFIX2SUFFIX`, … there are.
    pub fn count(&self, prefix: &str, suffix: &str) -> usize {
        (1..).take_while(|k| self.has(&format!("{prefix}{k}{suffix}"))).count()
    }
}

impl Row {
    /// The number in a column.
    pub fn at(&self, column: usize) -> f64 {
        self.numbers[column]
    }
}
