// SPDX-License-Identifier: MIT OR Apache-2.0
//! What users of the Verilog find in `rtl/verilog/` works: the Makefile, the cocotb test and the
//! FuseSoC core.

use hapticore_synth::certificates::Subject;
use hapticore_synth::tools::{Tools, root};
use std::fs;
use std::path::Path;

/// What users have of `rtl/verilog/`; beside it may lie what they have built.
const USERS: [&str; 7] =
    ["Makefile", "hapticore.core", "cocotb", "vectors", "small", "standard", "loop"];

/// A copy, in which things may be left and changed.
fn copy(from: &Path, to: &Path) {
    if !from.is_dir() {
        fs::copy(from, to).expect("a file");
        return;
    }
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from).expect("a folder").flatten() {
        copy(&entry.path(), &to.join(entry.file_name()));
    }
}

/// Runs what depends on nothing but the users' files and how this test runs them.
fn once(what: &str, check: fn()) {
    let files = USERS.map(|name| format!("rtl/verilog/{name}"));
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    Subject::new()
        .and(what)
        .and_files(&files)
        .and_files(&["synth/tests/toolchain/downstream.rs"])
        .holds(&format!("downstream: {what}"), check);
}

fn users_copy() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for name in USERS {
        copy(&root().join("rtl/verilog").join(name), &folder.path().join(name));
    }
    folder
}

fn python() -> String {
    format!("PYTHON={}", root().join(".tools/venv/bin/python").display())
}

/// A target of the Makefile that simulates, and the file of words that it compares: its column of words.
const TARGETS: [(&str, (&str, usize)); 2] =
    [("sim_core", ("frames.csv", 2)), ("sim_loop", ("loop_drives.csv", 1))];

/// Every word of a file of the vectors is one more.
fn falsify(folder: &Path, (name, column): (&str, usize)) {
    let path = folder.join("vectors").join(name);
    let text = fs::read_to_string(&path).expect("the vectors");
    let changed = text.lines().map(|line| {
        let mut fields: Vec<String> = line.split(',').map(String::from).collect();
        if let Ok(word) = fields[column].parse::<i64>() {
            fields[column] = (word + 1).to_string();
        }
        fields.join(",") + "\n"
    });
    fs::write(path, changed.collect::<String>()).expect("the vectors");
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn the_makefile_lints_and_simulates() {
    once("make", make_lints_and_simulates);
}

fn make_lints_and_simulates() {
    let tools = Tools::find().expect("what synth/tools fetches");
    let folder = users_copy();
    for profile in ["PROFILE=small", "PROFILE=standard", "PROFILE=loop"] {
        let log = tools.run("make", &["lint", profile], folder.path()).unwrap();
        assert!(!log.contains("%Warning"), "{log}");
    }
    for (target, file) in TARGETS {
        let log = tools.run("make", &[target], folder.path()).unwrap();
        assert!(log.contains("PASSED"), "{log}");
        falsify(folder.path(), file);
        let run = tools.run("make", &[target], folder.path());
        let error = run.expect_err("a wrong word").to_string();
        assert!(error.contains("FAILED"), "{error}");
    }
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn cocotb_sees_the_frame_of_the_model() {
    once("cocotb", cocotb_compares);
}

fn cocotb_compares() {
    let tools = Tools::find().expect("what synth/tools fetches");
    let folder = users_copy();
    let log = tools.run("make", &["test", &python()], folder.path()).unwrap();
    assert!(log.contains("2 tests, 0 failures"), "{log}");
    for (_, file) in TARGETS {
        falsify(folder.path(), file);
    }
    let error = tools.run("make", &["test", &python()], folder.path()).expect_err("wrong words");
    assert!(error.to_string().contains("2 tests, 2 failures"), "{error}");
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn fusesoc_lints_and_simulates() {
    once("fusesoc", fusesoc_runs);
}

fn fusesoc_runs() {
    let tools = Tools::find().expect("what synth/tools fetches");
    let folder = users_copy();
    let run = |target: &str, flags: &[&str]| {
        let mut arguments =
            vec!["--cores-root", ".", "run", "--work-root", target, "--target", target];
        arguments.extend(flags);
        arguments.push("hapticore:hapticore:core");
        tools.run("fusesoc", &arguments, folder.path()).unwrap()
    };
    for flags in [&["--flag", "small"][..], &["--flag", "loop"], &[]] {
        let log = run("lint", flags);
        assert!(!log.contains("%Warning"), "{log}");
    }
    for target in ["sim", "sim_loop"] {
        let log = run(target, &[]);
        assert!(log.contains("PASSED"), "{log}");
    }
}
