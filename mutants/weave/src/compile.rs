// SPDX-License-Identifier: MIT OR Apache-2.0
//! Weaves and builds, without the mutants that do not compile, until it builds.

use crate::area::Area;
use crate::errors::{Blame, blame, called_by_constant};
use crate::mutant::Mutant;
use crate::tree;
use crate::weave::{Index, Numbers, Reason, weave};
use anyhow::{Context, Result, bail, ensure};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// What is built of all mutants.
pub struct Build {
    /// The numbers under which they are enabled.
    pub numbers: Numbers,
    /// Those that do not compile.
    pub uncompiled: BTreeSet<Index>,
    /// Those that are not in it, and why.
    pub unwoven: BTreeMap<Index, Reason>,
    /// Functions that constants call.
    constant: BTreeSet<String>,
    /// The test programs.
    pub programs: Vec<Program>,
}

/// A test program.
#[derive(Debug, Clone)]
pub struct Program {
    /// `hapticore_model`, or the name of an integration test.
    pub name: String,
    /// The file to run.
    pub path: PathBuf,
    /// The folder of its crate, where it runs.
    pub folder: PathBuf,
}

/// A line of cargo's messages, the parts that are used.
#[derive(Deserialize)]
struct Line {
    message: Option<Message>,
    target: Option<Target>,
    executable: Option<PathBuf>,
    manifest_path: Option<PathBuf>,
}

#[derive(Deserialize)]
struct Target {
    name: String,
}

#[derive(Deserialize)]
struct Message {
    level: String,
    message: String,
    code: Option<Code>,
    spans: Vec<Place>,
    rendered: Option<String>,
}

#[derive(Deserialize)]
struct Code {
    code: String,
}

#[derive(Deserialize)]
struct Place {
    file_name: String,
    byte_start: usize,
    is_primary: bool,
}

/// Builds the test programs with all mutants that can be in them.
/// Some are known not to compile.
pub fn build(mutants: &[Mutant], uncompiled: BTreeSet<Index>) -> Result<Build> {
    let mut build = Build {
        numbers: Numbers::default(),
        uncompiled,
        unwoven: BTreeMap::new(),
        constant: BTreeSet::new(),
        programs: Vec::new(),
    };
    let files: BTreeSet<String> = mutants.iter().map(|mutant| mutant.file.clone()).collect();
    tree::copy(&files)?;
    for round in 1.. {
        let woven = weave_all(mutants, &files, &mut build)?;
        eprintln!("build {round}: {} mutants woven", build.numbers.0.len());
        let (errors, programs) = cargo(&files)?;
        if errors.is_empty() {
            build.programs = programs;
            break;
        }
        ensure!(
            drop_blamed(&errors, &woven, &mut build),
            "the woven code does not compile:\n{}",
            rendered(&errors)
        );
    }
    Ok(build)
}

/// Weaves all files: their texts.
fn weave_all(
    mutants: &[Mutant],
    files: &BTreeSet<String>,
    build: &mut Build,
) -> Result<BTreeMap<String, String>> {
    build.numbers = Numbers::default();
    let mut texts = BTreeMap::new();
    for file in files {
        let source = std::fs::read_to_string(file)?;
        let left_out =
            |index| build.uncompiled.contains(&index) || build.unwoven.contains_key(&index);
        let here: Vec<_> = mutants
            .iter()
            .enumerate()
            .filter(|(index, mutant)| mutant.file == *file && !left_out(*index))
            .collect();
        let (text, unwoven) = weave(&source, &here, &build.constant, &mut build.numbers)
            .with_context(|| file.clone())?;
        build.unwoven.extend(unwoven);
        tree::write(file, text.as_bytes())?;
        texts.insert(file.clone(), text);
    }
    Ok(texts)
}

/// The programs that judge mutants of files: those of the model only where some are its own.
fn judges(files: &BTreeSet<String>) -> &'static [&'static str] {
    match files.iter().any(|file| Area::of(file).is_block()) {
        true => &[
            "--package=hapticore-hdl",
            "--package=hapticore-model",
            "--package=hapticore-rtl",
            "--lib",
            "--test=equality",
            "--test=fixed",
            "--test=lock_in",
            "--test=noise",
            "--test=committed",
        ],
        false => &["--package", "hapticore-hdl", "--lib"],
    }
}

/// Errors and, where there are none, test programs.
fn cargo(files: &BTreeSet<String>) -> Result<(Vec<Message>, Vec<Program>)> {
    let mut child = Command::new("cargo")
        .args(["test", "--no-run", "--quiet", "--profile", "mutants", "--message-format", "json"])
        .args(["--config", "profile.mutants.opt-level=2"])
        .args(judges(files))
        .current_dir(tree::WOVEN)
        .env("CARGO_TARGET_DIR", std::path::absolute("target/mutants/woven-build")?)
        .env("RUSTFLAGS", "--cap-lints=allow")
        .stdout(Stdio::piped())
        .stderr(Stdio::inherit())
        .spawn()?;
    let (mut errors, mut programs) = (Vec::new(), Vec::new());
    for line in BufReader::new(child.stdout.take().expect("piped")).lines() {
        let line: Line = serde_json::from_str(&line?)?;
        if let Some(message) = line.message.filter(|message| message.level.starts_with("error")) {
            errors.push(message);
        }
        if let (Some(target), Some(path), Some(mut folder)) =
            (line.target, line.executable, line.manifest_path)
        {
            folder.pop();
            programs.push(Program { name: target.name, path, folder });
        }
    }
    if !child.wait()?.success() && errors.is_empty() {
        bail!("cargo test --no-run does not succeed in {}", tree::WOVEN);
    }
    Ok((errors, programs))
}

/// Leaves out the mutants that errors are about; whether there are any.
fn drop_blamed(errors: &[Message], texts: &BTreeMap<String, String>, build: &mut Build) -> bool {
    let left_out =
        |build: &Build| build.uncompiled.len() + build.unwoven.len() + build.constant.len();
    let before = left_out(build);
    for error in errors {
        if let Some(name) = called_by_constant(&error.message) {
            build.constant.insert(name.to_string());
            continue;
        }
        let code = error.code.as_ref().map_or("", |code| &code.code);
        let places = error.spans.iter().filter(|place| place.is_primary);
        for place in places {
            let blamed =
                texts.get(&place.file_name).and_then(|text| blame(text, place.byte_start, code));
            match blamed {
                Some(Blame::Mutants(numbers)) => {
                    build.uncompiled.extend(numbers.map(|number| build.numbers.mutant(number)))
                }
                Some(Blame::Place(numbers)) => {
                    let mutants = numbers.map(|number| {
                        (build.numbers.mutant(number), "in code that does not compile with it")
                    });
                    build.unwoven.extend(mutants);
                }
                None => (),
            }
        }
    }
    left_out(build) > before
}

fn rendered(errors: &[Message]) -> String {
    errors.iter().filter_map(|error| error.rendered.as_deref()).take(5).collect()
}
