// SPDX-License-Identifier: MIT OR Apache-2.0
//! The vectors of `rtl/verilog/` notice faults: users who have no Rust see with `make sim` whether
//! their Verilog is the model's.
//!
//! Faults are those of `tests/tests/faults.rs`, two hundred of them, one of each module and others
//! spaced evenly over all places. Each must be noticed by `rtl/verilog/cocotb/bench.v`, or stand in
//! `vectors.txt` under the reason why it changes nothing, or as open. Some are tried always, all
//! with `FAULTS=all`.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use hapticore_tests::faults::campaign::{self, two_at_a_time};
use hapticore_tests::faults::{Fault, Planted};
use hapticore_tests::lockstep::Bench;
use hapticore_tests::tools;

/// How many faults there are to notice.
const FAULTS: usize = 200;

/// Each of these is tried always.
const EACH: usize = 10;

/// Faults that change nothing, each under its reason (`#`).
const NONE: &str = include_str!("vectors.txt");

/// The faults by number, the first 1: one of each module, and others spaced evenly over all places.
fn chosen(faults: &[Fault]) -> Vec<usize> {
    let mut modules = BTreeSet::new();
    let firsts = (1..).zip(faults).filter(|(_, fault)| modules.insert(&fault.module));
    let mut chosen: BTreeSet<usize> = firsts.map(|(number, _)| number).collect();
    let more = FAULTS - chosen.len();
    for k in 0..more {
        let even = 1 + (2 * k + 1) * faults.len() / (2 * more);
        chosen.extend((even..).find(|number| !chosen.contains(number)));
    }
    chosen.into_iter().collect()
}

/// What users of the Verilog have.
fn verilog() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../rtl/verilog")
}

/// The bench around a design, compiled.
fn compiled(design: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("design.v"), design).expect("written");
    let mut verilator = Command::new("verilator");
    verilator.args([
        "--binary",
        "--timing",
        "-O3",
        "-CFLAGS",
        "-O1",
        "-Wno-lint",
        "-Wno-style",
        "-Wno-fatal",
        "-j",
        "2",
    ]);
    verilator.args(["--top-module", "bench", "--Mdir", ".", "-o", "bench", "design.v"]);
    tools::run(verilator.arg(verilog().join("cocotb/bench.v")), folder.path());
    for file in fs::read_dir(verilog().join("vectors")).expect("the vectors").flatten() {
        fs::copy(file.path(), folder.path().join(file.file_name())).expect("a file");
    }
    folder
}

/// Whether the frames are the model's, with this fault.
fn passes(bench: &Path, fault: usize) -> bool {
    let mut command = Command::new(bench.join("bench"));
    let command = command.arg(format!("+fault={fault}")).current_dir(bench).stderr(Stdio::null());
    let output = command.output().expect("the bench runs");
    String::from_utf8_lossy(&output.stdout).contains("PASSED")
}

#[test]
fn faults_in_the_printed_text_are_noticed_by_the_vectors() {
    if !tools::have(&["verilator", "make", "g++"]) {
        return;
    }
    let design = Bench::new("small").design;
    let faults = Planted::with(&design, &|_| false).faults;
    let chosen = chosen(&faults);
    assert_eq!(chosen.len(), FAULTS);
    let tried: Vec<_> =
        chosen.into_iter().step_by(if campaign::all() { 1 } else { EACH }).collect();

    let planted = Planted::with(&design, &|number| tried.contains(&number));
    let bench = compiled(&planted.verilog);
    assert!(passes(bench.path(), 0), "without a fault");
    let passed = two_at_a_time(&tried, |&number| passes(bench.path(), number));
    let survivors = tried.iter().zip(&passed).filter(|(_, passed)| **passed);
    let survivors: BTreeSet<_> =
        survivors.map(|(&number, _)| faults[number - 1].to_string()).collect();
    let survivors: BTreeSet<&str> = survivors.iter().map(String::as_str).collect();
    println!(
        "{} of {} faults noticed, of {} places",
        tried.len() - survivors.len(),
        tried.len(),
        faults.len()
    );

    let none = campaign::equivalent(NONE);
    let missed: Vec<_> = survivors.difference(&none).collect();
    assert!(missed.is_empty(), "not noticed: {missed:#?}");
    // Which places are tried changes with their number: what is listed of others stays for then.
    let tried: BTreeSet<_> = tried.iter().map(|&number| faults[number - 1].to_string()).collect();
    let places: BTreeSet<_> = faults.iter().map(Fault::to_string).collect();
    let noticed = |listed: &str| tried.contains(listed) && !survivors.contains(listed);
    let stale: Vec<_> =
        none.iter().filter(|listed| noticed(listed) || !places.contains(**listed)).collect();
    assert!(stale.is_empty(), "noticed after all, or no place any more: {stale:#?}");
}
