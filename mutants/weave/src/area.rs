// SPDX-License-Identifier: MIT OR Apache-2.0
//! Areas of the code, and which tests judge their mutants.

use crate::mutant::Mutant;
use anyhow::{Result, bail};
use std::path::Path;

const HDL: &str = "model/hdl/src";
const BLOCKS: &str = "model/src/blocks";
const PRINTER: [&str; 3] = ["verilog", "smt", "area"];

/// The stage of tests that compare a core's printed Verilog with the committed one. They notice any change
/// of the circuit, right or wrong, so that they are asked last and counted apart.
pub const PRINTED: u8 = 3;

/// A part of the code whose mutants are counted together.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Area {
    /// Formats, signals, interpretations, memories, blocks.
    Language,
    /// Verilog, claims for solvers, area.
    Printer,
    /// A block of the model.
    Block(String),
}

impl Area {
    /// The areas of a word: `language`, `printer`, `blocks`, `all`, or the name of a block.
    ///
    /// # Errors
    /// Where there is no such area.
    pub fn named(word: &str) -> Result<Vec<Area>> {
        Ok(match word {
            "language" => vec![Area::Language],
            "printer" => vec![Area::Printer],
            "blocks" => blocks()?,
            "all" => [vec![Area::Language, Area::Printer], blocks()?].concat(),
            block if blocks()?.contains(&Area::Block(block.into())) => {
                vec![Area::Block(block.into())]
            }
            other => bail!("there is no area {other}, see mutants/run --help"),
        })
    }

    /// The area of a file.
    pub fn of(file: &str) -> Area {
        match file.strip_prefix(BLOCKS) {
            Some(rest) => Area::Block(first_name(rest)),
            None if PRINTER.contains(&&*first_name(file.trim_start_matches(HDL))) => Area::Printer,
            None => Area::Language,
        }
    }

    /// Whether it is a block of the model.
    pub fn is_block(&self) -> bool {
        matches!(self, Area::Block(_))
    }

    /// Its files, as glob patterns.
    pub fn files(&self) -> Vec<String> {
        match self {
            Area::Block(name) => vec![format!("{BLOCKS}/{name}.rs"), format!("{BLOCKS}/{name}/**")],
            Area::Printer => PRINTER
                .iter()
                .flat_map(|name| [format!("{HDL}/{name}.rs"), format!("{HDL}/{name}/**")])
                .collect(),
            Area::Language => {
                let names = [
                    "format",
                    "memory",
                    "block",
                    "bundle",
                    "states",
                    "claims",
                    "declaration",
                    "probe",
                ];
                let files = names.iter().map(|name| format!("{HDL}/{name}.rs"));
                files
                    .chain(
                        ["signal", "interpretations"].iter().map(|name| format!("{HDL}/{name}/**")),
                    )
                    .collect()
            }
        }
    }

    /// When a test of a program is asked about a mutant: 0 for the area's own unit tests, 1 for others of
    /// the same crate and of blocks, 2 for those of whole cores, [`PRINTED`] for those that compare printed
    /// text.
    pub fn stage(&self, program: &str, test: &str) -> u8 {
        match (self, program) {
            (Area::Block(name), "hapticore_model")
                if test.starts_with(&format!("blocks::{name}::")) =>
            {
                0
            }
            (Area::Language | Area::Printer, "hapticore_hdl") => 0,
            (_, "hapticore_model" | "hapticore_hdl") => 1,
            (_, "committed") => PRINTED,
            _ => 2,
        }
    }

    /// The package of its own unit tests, and which of them these are.
    pub fn own_tests(&self) -> (&'static str, Option<String>) {
        match self {
            Area::Block(name) => ("hapticore-model", Some(format!("blocks::{name}::"))),
            _ => ("hapticore-hdl", None),
        }
    }
}

/// The name of a mutant's line in the table: a block, or a file of the language with its folder.
pub fn row(mutant: &Mutant) -> String {
    match Area::of(&mutant.file) {
        Area::Block(name) => name,
        _ => {
            let path = mutant.file.trim_start_matches(HDL).trim_start_matches('/');
            match path.strip_prefix("interpretations/") {
                Some(rest) => first_name(rest),
                None => first_name(path),
            }
        }
    }
}

/// The first name of a path, without an extension.
fn first_name(path: &str) -> String {
    let path = path.trim_start_matches('/');
    path.split(['/', '.']).next().unwrap_or(path).to_string()
}

/// The blocks: files and folders.
fn blocks() -> Result<Vec<Area>> {
    let mut names = Vec::new();
    for entry in Path::new(BLOCKS).read_dir()? {
        let name = first_name(&entry?.file_name().to_string_lossy());
        if name != "mod" {
            names.push(Area::Block(name));
        }
    }
    names.sort();
    names.dedup();
    Ok(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_of_one_area() {
        for (file, area) in [
            ("model/src/blocks/wall/rule.rs", Area::Block("wall".into())),
            ("model/src/blocks/wall.rs", Area::Block("wall".into())),
            ("model/hdl/src/area.rs", Area::Printer),
            ("model/hdl/src/smt/fit.rs", Area::Printer),
            ("model/hdl/src/signal/mod.rs", Area::Language),
        ] {
            assert_eq!(Area::of(file), area, "{file}");
        }
    }

    #[test]
    fn own_tests_are_asked_first() {
        let wall = Area::Block("wall".into());
        assert_eq!(wall.stage("hapticore_model", "blocks::wall::tests::a"), 0);
        assert_eq!(wall.stage("hapticore_model", "blocks::ratio::tests::a"), 1);
        assert_eq!(wall.stage("equality", "slots::a"), 2);
        assert_eq!(wall.stage("committed", "a"), PRINTED);
        assert_eq!(Area::Printer.stage("hapticore_hdl", "smt::tests::a"), 0);
    }
}
