// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is known of mutants, kept in a file as it becomes known.

use crate::mutant::Mutant;
use anyhow::Result;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::Write;

const FILE: &str = "target/mutants/verdicts.jsonl";

/// What became of a mutant.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Fate {
    /// A test fails.
    Killed {
        /// Its name.
        by: String,
        /// When it was asked ([`crate::area::Area::stage`]).
        stage: u8,
    },
    /// All tests pass.
    Survived {
        /// Whether a test meets it.
        reached: bool,
    },
    /// A test does not end, and none fails.
    TimedOut,
    /// The compiler refuses it.
    Uncompiled,
}

impl Fate {
    /// What the area's own unit tests say.
    pub fn of_own_tests(&self) -> &'static str {
        match self {
            Fate::Killed { stage: 0, .. } => "killed",
            Fate::Killed { .. } | Fate::Survived { .. } => "survives",
            Fate::TimedOut => "timed out",
            Fate::Uncompiled => "does not compile",
        }
    }
}

/// What became of a mutant, with what that rests on.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Verdict {
    /// The mutant.
    pub name: String,
    /// Of the file that has it, without its tests: a verdict holds as long as this stays.
    pub hash: u64,
    /// What became of it.
    pub fate: Fate,
    /// Why it was judged in a build of its own.
    pub unwoven: Option<String>,
}

/// Which verdicts of earlier runs stay, of mutants in unchanged files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kept {
    /// None.
    Nothing,
    /// What was killed and what did not compile.
    Settled,
    /// All, the last of each mutant.
    All,
}

/// The verdicts of this run, and those of earlier ones that hold.
pub struct Verdicts {
    file: File,
    hashes: BTreeMap<String, u64>,
    /// By the mutant's name.
    pub known: BTreeMap<String, Verdict>,
}

impl Verdicts {
    /// Those that are kept of earlier runs.
    pub fn open(mutants: &[Mutant], kept: Kept) -> Result<Self> {
        let resume = kept != Kept::Nothing;
        let mut hashes = BTreeMap::new();
        for mutant in mutants.iter() {
            if !hashes.contains_key(&mutant.file) {
                let mut hasher = DefaultHasher::new();
                untested(&fs::read_to_string(&mutant.file)?).as_bytes().hash(&mut hasher);
                hashes.insert(mutant.file.clone(), hasher.finish());
            }
        }
        let mut known = BTreeMap::new();
        if resume {
            let wanted: BTreeMap<&str, u64> =
                mutants.iter().map(|mutant| (&*mutant.name, hashes[&mutant.file])).collect();
            for line in fs::read_to_string(FILE).unwrap_or_default().lines() {
                let verdict: Verdict = serde_json::from_str(line)?;
                let settled = matches!(verdict.fate, Fate::Killed { .. } | Fate::Uncompiled);
                if (settled || kept == Kept::All)
                    && wanted.get(&*verdict.name) == Some(&verdict.hash)
                {
                    known.insert(verdict.name.clone(), verdict);
                }
            }
        }
        let file =
            File::options().create(true).write(true).append(resume).truncate(!resume).open(FILE)?;
        Ok(Verdicts { file, hashes, known })
    }

    /// Keeps a verdict.
    pub fn add(&mut self, mutant: &Mutant, fate: Fate, unwoven: Option<&str>) -> Result<()> {
        let verdict = Verdict {
            name: mutant.name.clone(),
            hash: self.hashes[&mutant.file],
            fate,
            unwoven: unwoven.map(str::to_string),
        };
        writeln!(self.file, "{}", serde_json::to_string(&verdict)?)?;
        self.known.insert(verdict.name.clone(), verdict);
        Ok(())
    }
}

/// A file's text without the tests at its end.
fn untested(text: &str) -> &str {
    text.split_once("\n#[cfg(test)]\nmod tests {").map_or(text, |(code, _)| code)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_at_the_end_are_not_of_the_code() {
        assert_eq!(untested("fn f() {}\n\n#[cfg(test)]\nmod tests {\n}\n"), "fn f() {}\n");
        assert_eq!(untested("#[cfg(test)]\nmod tests;\n"), "#[cfg(test)]\nmod tests;\n");
    }
}
