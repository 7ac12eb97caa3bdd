// SPDX-License-Identifier: MIT OR Apache-2.0
//! Judges mutants that cannot be woven as cargo-mutants does it: each in a build of its own, by the
//! area's own unit tests.

use crate::area::Area;
use crate::mutant::{Mutant, cargo_mutants};
use crate::verdict::Fate;
use anyhow::{Result, bail};
use std::collections::BTreeMap;
use std::fs;

/// What becomes of mutants, by name.
pub fn judge(mutants: &[&Mutant]) -> Result<BTreeMap<String, Fate>> {
    let mut areas = BTreeMap::<_, Vec<_>>::new();
    for mutant in mutants {
        areas.entry(Area::of(&mutant.file).own_tests()).or_default().push(*mutant);
    }
    let mut all = BTreeMap::new();
    for ((package, filter), mutants) in areas {
        eprintln!(
            "{} mutants one at a time: {package} {}",
            mutants.len(),
            filter.as_deref().unwrap_or("")
        );
        all.extend(fates(package, filter, &mutants)?);
    }
    Ok(all)
}

fn fates(
    package: &str,
    filter: Option<String>,
    mutants: &[&Mutant],
) -> Result<BTreeMap<String, Fate>> {
    let names: Vec<_> = mutants.iter().map(|mutant| escaped(&mutant.name)).collect();
    let mut files: Vec<_> = mutants.iter().map(|mutant| mutant.file.clone()).collect();
    files.dedup();
    let out = "target/mutants/plain";
    fs::create_dir_all(out)?;
    let status = cargo_mutants(&files, &[])
        .args(["--re", &format!("^({})$", names.join("|")), "--output", out, "--cargo-arg=--lib"])
        // A constant of which a mutant never has the value.
        .args(["--build-timeout", "120", "--test-package", package, "--"])
        .args(filter)
        .env("CARGO_TARGET_DIR", std::path::absolute("target/mutants/build")?)
        .status()?;
    // Where some survive, or time out.
    if !matches!(status.code(), Some(0 | 2 | 3)) {
        bail!("cargo mutants does not succeed");
    }
    let by = || Fate::Killed { by: "a build of its own".into(), stage: 0 };
    let of = |file: &str, fate: Fate| {
        let text = fs::read_to_string(format!("{out}/mutants.out/{file}.txt")).unwrap_or_default();
        text.lines().map(|line| (line.to_string(), fate.clone())).collect::<Vec<_>>()
    };
    let lists = [
        of("caught", by()),
        of("missed", Fate::Survived { reached: true }),
        of("timeout", Fate::TimedOut),
        of("unviable", Fate::Uncompiled),
    ];
    Ok(lists.into_iter().flatten().collect())
}

/// A text as a regular expression that it alone matches. There `\<` is the beginning of a word.
fn escaped(text: &str) -> String {
    text.chars()
        .flat_map(|c| {
            [(c.is_ascii_punctuation() && !matches!(c, '<' | '>')).then_some('\\'), Some(c)]
        })
        .flatten()
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_stay_and_other_punctuation_is_escaped() {
        assert_eq!(escaped("+ in <A>::b"), r"\+ in <A>\:\:b");
    }
}
