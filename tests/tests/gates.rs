// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clocked model = gates, every output at every clock: the whole core as Yosys makes it of the
//! printed Verilog, in the cells of both FPGA families. What has no initial value in the cells
//! starts with anything.
//!
//! Clocks per core: slots of two scenes, and corners at random with tables that are written while
//! they are read.

use std::fs;

use hapticore_synth::tools::{Tools, root};
use hapticore_tests::lockstep::Bench;
use hapticore_tests::lockstep::verilator::{Start, Verilated};
use hapticore_tests::{stimulus, tools};

/// Clocks of each core at least.
const CLOCKS: usize = 100_000;

/// The gates of a design, with what their cells do, as Verilog.
fn gates(tools: &Tools, family: &str, bench: &Bench) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("design.v"), bench.design.text()).expect("written");
    let script = root().join("synth/netlist");
    let mut command = tools.command(script.to_str().expect("a path"));
    tools::run(command.args([family, "design.v", "gates.v"]), folder.path());
    fs::read_to_string(folder.path().join("gates.v")).expect("the gates")
}

fn gates_run_what_the_model_runs(family: &str, profile: &str) {
    let Some(tools) = Tools::or_skip() else { return };
    if !tools::have(&["verilator", "make", "g++", "iverilog"]) {
        return;
    }
    let bench = Bench::new(profile);
    let top = format!("{}_gate", bench.design.top());
    let verilated =
        Verilated::new(&top, &bench.design.ports, &gates(&tools, family, &bench), Start::Anything);
    let mut clocks = 0;
    for stimulus in [
        stimulus::scene(&bench.profile, "fig6", 3),
        stimulus::scene(&bench.profile, "hockey", 2),
        stimulus::random(&bench.profile, 4, 3),
    ] {
        let trace = bench.record(stimulus);
        clocks += trace.clocks();
        if let Err(mismatch) = verilated.check(&trace) {
            panic!("{family}, {profile}: {mismatch}");
        }
    }
    println!("{family}, {profile}: {clocks} clocks equal in gates");
    assert!(clocks >= CLOCKS, "{clocks} clocks");
}

#[test]
fn ice40_gates_run_what_the_model_runs_small() {
    gates_run_what_the_model_runs("ice40", "small");
}

#[test]
fn ecp5_gates_run_what_the_model_runs_small() {
    gates_run_what_the_model_runs("ecp5", "small");
}

#[test]
fn ecp5_gates_run_what_the_model_runs_standard() {
    gates_run_what_the_model_runs("ecp5", "standard");
}
