// SPDX-License-Identifier: MIT OR Apache-2.0
//! The mutants, as cargo-mutants lists them.

use anyhow::{Context, Result, ensure};
use serde::Deserialize;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::process::{Command, Stdio};

/// A change of the code at one place.
#[derive(Debug, Clone, Deserialize)]
pub struct Mutant {
    /// File, line, column, and what is changed.
    pub name: String,
    /// Its file, from the root of the tree.
    pub file: String,
    /// What is replaced: an operator, a match arm, all statements of a function.
    pub span: Span,
    /// By what.
    pub replacement: String,
    /// What kind of place it is.
    pub genre: Genre,
}

/// What kind of place is changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[allow(missing_docs)]
pub enum Genre {
    FnValue,
    BinaryOperator,
    UnaryOperator,
    MatchArm,
    MatchArmGuard,
    StructField,
}

/// From a place up to, not including, another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[allow(missing_docs)]
pub struct Span {
    pub start: Place,
    pub end: Place,
}

/// A place in a text; lines and characters of a line count from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[allow(missing_docs)]
pub struct Place {
    pub line: usize,
    pub column: usize,
}

impl Place {
    /// The byte of a text.
    pub fn byte(self, text: &str) -> usize {
        let before = text.split_inclusive('\n').take(self.line - 1).map(str::len).sum::<usize>();
        let line = &text[before..];
        let within = line.char_indices().nth(self.column - 1).map_or(line.len(), |(at, _)| at);
        before + within
    }
}

impl Mutant {
    /// Its name without line and column, as `mutants/survivors.txt` has it.
    pub fn short_name(&self) -> String {
        let (place, change) = self.name.split_once(": ").unwrap_or((&self.name, ""));
        let file = place.split(':').next().expect("a file");
        format!("{file}: {change}")
    }

    /// By which mutants are shuffled: the first are a sample, always the same.
    pub fn draw(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        self.name.hash(&mut hasher);
        hasher.finish()
    }
}

/// The mutants of files (glob patterns) that cargo-mutants finds with further options. Those of one
/// place follow each other.
pub fn list(files: &[String], options: &[String]) -> Result<Vec<Mutant>> {
    let output = cargo_mutants(files, options)
        .args(["--list", "--json"])
        .stderr(Stdio::inherit())
        .output()
        .context(
            "cargo-mutants is needed: cargo install cargo-mutants --version 27.0.0 --locked",
        )?;
    ensure!(output.status.success(), "cargo mutants --list does not succeed");
    let mut mutants: Vec<Mutant> = match output.stdout.is_empty() {
        true => Vec::new(),
        false => serde_json::from_slice(&output.stdout)?,
    };
    mutants.sort_by(|a, b| {
        let key = |m: &Mutant| (m.file.clone(), m.span, m.genre);
        key(a).cmp(&key(b))
    });
    Ok(mutants)
}

/// A command of cargo-mutants about files.
pub fn cargo_mutants(files: &[String], options: &[String]) -> Command {
    let mut command = Command::new("cargo");
    command.args(["mutants", "--config", "mutants/config.toml"]);
    command.args(["--package", "hapticore-hdl", "--package", "hapticore-model"]);
    command.args(files.iter().flat_map(|file| ["-f", file])).args(options);
    command
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_a_byte() {
        let text = "a\n  é + b\n";
        assert_eq!(Place { line: 2, column: 5 }.byte(text), 7, "é has two bytes");
        assert_eq!(&text[7..8], "+");
    }

    #[test]
    fn a_short_name_has_neither_line_nor_column() {
        let mutant: Mutant = serde_json::from_str(
            r#"{"name": "a.rs:3:5: replace + with - in f: g", "file": "a.rs", "replacement": "-", "genre": "BinaryOperator",
                "span": {"start": {"line": 3, "column": 5}, "end": {"line": 3, "column": 6}}}"#,
        )
        .unwrap();
        assert_eq!(mutant.short_name(), "a.rs: replace + with - in f: g");
    }
}
