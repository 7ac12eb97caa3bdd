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

use hapticore_synth::certificates::Subject;
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

/// A bench of the vectors, and what it is compiled and run with.
struct Users {
    folder: &'static str,
    bench: &'static str,
    options: &'static [&'static str],
    /// What the names of its vectors begin with.
    vectors: &'static str,
}

const SMALL: Users = Users { folder: "small", bench: "bench.v", options: &[], vectors: "" };
const LOOP: Users = Users {
    folder: "loop",
    bench: "loop_bench.v",
    options: &["-DLOOP=hapticore_loop_loop", "-DWALLS"],
    vectors: "loop_",
};

/// The bench around a design, compiled.
fn compiled(users: &Users, design: &str) -> tempfile::TempDir {
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
    verilator.args(users.options).arg(format!("-I{}", verilog().join(users.folder).display()));
    tools::run(verilator.arg(verilog().join("cocotb").join(users.bench)), folder.path());
    for file in fs::read_dir(verilog().join("vectors")).expect("the vectors").flatten() {
        let name = file.file_name().into_string().expect("a name");
        let Some(name) = name.strip_prefix(users.vectors) else { continue };
        fs::copy(file.path(), folder.path().join(name)).expect("a file");
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

/// The numbers of faults in a design with which the bench passes.
fn missed(users: &Users, design: &str, numbers: &[usize]) -> Vec<usize> {
    let words: Vec<_> = numbers.iter().map(usize::to_string).collect();
    let files = ["rtl/verilog/vectors", "rtl/verilog/cocotb", "tests/tests/vectors.rs"];
    let subject = Subject::new().and(design).and(words.join(" ")).and_files(&files);
    campaign::missed(&format!("the vectors of {}", users.folder), subject, || {
        let bench = compiled(users, design);
        assert!(passes(bench.path(), 0), "without a fault");
        let passed = two_at_a_time(numbers, |&number| passes(bench.path(), number));
        numbers
            .iter()
            .zip(passed)
            .filter_map(|(number, passed)| passed.then_some(*number))
            .collect()
    })
}

#[test]
#[cfg_attr(
    not(all(tool = "verilator", tool = "make", tool = "g++")),
    ignore = "needs verilator, make, g++: ./test fetches what is missing"
)]
fn faults_in_the_printed_text_are_noticed_by_the_vectors() {
    let design = Bench::new("small").design;
    let faults = Planted::with(&design, &|_| false).faults;
    let chosen = chosen(&faults);
    assert_eq!(chosen.len(), FAULTS);
    let tried: Vec<_> =
        chosen.into_iter().step_by(if campaign::all() { 1 } else { EACH }).collect();

    let planted = Planted::with(&design, &|number| tried.contains(&number));
    let missed = missed(&SMALL, &planted.verilog, &tried);
    let survivors: BTreeSet<_> = missed.iter().map(|n| faults[n - 1].to_string()).collect();
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

/// What wakes a fault.
const HEAD: &str =
    "\n    integer fault;\n    initial if (!$value$plusargs(\"fault=%d\", fault)) fault = 0;\n";

/// How the printed text says that `clear` makes something zero; `clear_faults` is a command of its own.
const NOT_CLEAR: &str = "& not_clear";

/// The name of the instance that a line begins.
fn instance(line: &str) -> Option<&str> {
    let name = line.trim_end().strip_suffix(" (")?.rsplit(' ').next()?;
    name.starts_with("u_").then_some(name)
}

/// Where `clear` acts in the printed text, each number of a fault without it: what an instance is given, what the multiplexer's
/// registers take, what the pace keeps.
fn without_clear(users: &Users) -> (String, Vec<String>) {
    let (mut text, mut faults) = (String::new(), Vec::new());
    let files = fs::read_dir(verilog().join(users.folder)).expect("the Verilog").flatten();
    let mut paths: Vec<_> = files.map(|file| file.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "v"));
    paths.sort();
    for path in paths {
        let module = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let (mut clears, known) = (false, faults.len());
        let (mut body, mut within) = (String::new(), module.clone());
        for line in fs::read_to_string(&path).expect("a module").lines() {
            // What an instance is given is named after it.
            within = instance(line).map_or(within, |name| format!("{module}.{name}"));
            let mut fault = |line: &str| {
                let place = if line.contains(".clear(") { &within } else { &module };
                faults.push(format!("{place}: {}", line.trim()));
                faults.len()
            };
            clears = (clears || line.trim() == "if (clear) begin") && !line.contains("end else");
            let changed = if line.contains(".clear(clear)") {
                line.replace("(clear)", &format!("(clear & fault != {})", fault(line)))
            } else if clears && line.contains("<=") {
                format!("if (fault != {}) {line}", fault(line))
            } else if line.split(NOT_CLEAR).skip(1).any(|rest| !rest.starts_with('_')) {
                line.replace(NOT_CLEAR, &format!("& (not_clear | fault == {})", fault(line)))
            } else {
                line.to_owned()
            };
            body += &(changed + "\n");
        }
        text += &if faults.len() > known {
            body.replacen("\n);\n", &format!("\n);\n{HEAD}"), 1)
        } else {
            body
        };
    }
    (text, faults)
}

/// Faults without which nothing changes: flags that are about a sample, when there is none, and a port that nothing reads.
const EQUIVALENT: [&str; 6] = [
    "restart <= 1'd0;",
    "integrate <= 1'd0;",
    "first <= 1'd0;",
    "last <= 1'd0;",
    // No mean over windows, and no estimate that takes of earlier slots.
    "hapticore_small.u_estimator: .clear(clear),",
    ".u_haptic_voltage: .clear(clear),",
];

/// A fault that the vectors do not notice: a pad's last drive word counts as zero after a `clear` beside it, which a wall asks for
/// only after turns without a drive.
const OPEN: [&str; 1] = ["hapticore_loop_split_pad: wire bit_981e = driven & not_clear; // u1.0"];

/// A clear that does not reach a register keeps what was there: the next pad, a count, a window.
fn check_clears(users: &Users) {
    let (text, faults) = without_clear(users);
    let numbers: Vec<usize> = (1..=faults.len()).collect();
    let missed: Vec<_> =
        missed(users, &text, &numbers).into_iter().map(|number| &faults[number - 1]).collect();
    let is_equivalent = |fault: &&&String| EQUIVALENT.iter().any(|none| fault.ends_with(none));
    let missed: BTreeSet<&str> =
        missed.iter().filter(|fault| !is_equivalent(fault)).map(|fault| fault.as_str()).collect();
    println!(
        "{}: {} of {} clears noticed or without effect",
        users.folder,
        faults.len() - missed.len(),
        faults.len()
    );
    assert!(faults.len() >= 14, "{faults:#?}");
    let of_design = |open: &&str| faults.iter().any(|fault| fault == open);
    assert_eq!(
        missed,
        OPEN.into_iter().filter(of_design).collect(),
        "not noticed, and those listed"
    );
}

#[test]
#[cfg_attr(
    not(all(tool = "verilator", tool = "make", tool = "g++")),
    ignore = "needs verilator, make, g++: ./test fetches what is missing"
)]
fn a_clear_that_is_missing_in_the_core_is_noticed() {
    check_clears(&SMALL);
}

#[test]
#[cfg_attr(
    not(all(tool = "verilator", tool = "make", tool = "g++")),
    ignore = "needs verilator, make, g++: ./test fetches what is missing"
)]
fn a_clear_that_is_missing_in_the_force_loop_is_noticed() {
    check_clears(&LOOP);
}
