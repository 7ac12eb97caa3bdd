// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clocked model = gates, every output at every clock: the whole core, and the core with its force
//! controller, as Yosys makes them of the printed Verilog, in the cells of both FPGA families. What
//! has no initial value in the cells starts with anything.
//!
//! Clocks per core: slots of two scenes, and corners at random with tables that are written while
//! they are read. Clocks of a force loop: a pad is pushed into a wall and drawn out of it, or its target
//! steps, the plant closed around the model.

use std::fs;

use hapticore_contract::profile::Profile;
use hapticore_hdl::verilog::Design;
use hapticore_synth::tools::{Tools, root};
use hapticore_tests::force_loop::Closed;
use hapticore_tests::lockstep::Bench;
use hapticore_tests::lockstep::verilator::Verilated;
use hapticore_tests::{stimulus, tools};

/// Clocks of each core at least.
const CLOCKS: usize = 100_000;

/// What makes gates of Verilog.
const MAKERS: [&str; 2] = ["synth/netlist", "synth/cells/ecp5.v"];

/// The gates of a design, with what their cells do.
fn gates(family: &str, design: &Design) -> Verilated {
    let tools = Tools::find().expect("what synth/tools fetches");
    let (family, top) = (family.to_owned(), design.top().to_owned());
    let makers = MAKERS.map(|name| fs::read_to_string(root().join(name)).expect("a file"));
    let comment = |line: &str| format!("// {line}\n");
    let made_by: String = makers.iter().flat_map(|text| text.lines()).map(comment).collect();
    let source = format!("// {family}\n{made_by}{}", design.text());
    let gate = format!("{top}_gate");
    Verilated::made(&gate, &design.ports, &source, move |source| {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("design.v"), source).expect("written");
        let script = root().join("synth/netlist");
        let mut command = tools.command(script.to_str().expect("a path"));
        command.args([&family, "design.v", "gates.v"]).env("TOP", &top);
        tools::run(&mut command, folder.path());
        fs::read_to_string(folder.path().join("gates.v")).expect("the gates")
    })
}

fn gates_run_what_the_model_runs(family: &str, profile: &str) {
    let bench = Bench::new(profile);
    let verilated = gates(family, &bench.design);
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

/// A force loop with the plant closed around it.
fn gates_close_the_loop_as_the_model_does(
    family: &str,
    profile: &str,
    of: impl FnOnce(&Profile) -> Closed,
) {
    let (design, trace) = of(&Profile::bundled(profile).expect("bundled")).record();
    let verilated = gates(family, &design);
    if let Err(mismatch) = verilated.check(&trace) {
        panic!("{family}, {profile}: {mismatch}");
    }
    println!("{family}, {profile}: {} clocks of a force loop equal in gates", trace.clocks());
}

/// Not on iCE40: walls fit no such part.
#[test]
#[cfg_attr(
    not(all(
        tool = "synth/tools",
        tool = "verilator",
        tool = "make",
        tool = "g++",
        tool = "iverilog"
    )),
    ignore = "needs synth/tools, verilator, make, g++, iverilog: ./test fetches what is missing"
)]
fn ecp5_gates_run_a_wall_as_the_model_does() {
    gates_close_the_loop_as_the_model_does("ecp5", "small", Closed::at_a_wall);
}

/// A force table is of whole pads: walls have none.
#[test]
#[cfg_attr(
    not(all(
        tool = "synth/tools",
        tool = "verilator",
        tool = "make",
        tool = "g++",
        tool = "iverilog"
    )),
    ignore = "needs synth/tools, verilator, make, g++, iverilog: ./test fetches what is missing"
)]
fn ecp5_gates_close_the_force_loop_with_a_table_as_the_model_does() {
    let target = "{ timeline = [[0, 0.2], [0.0015, 0.2], [0.0015, 0.6]] }".to_string();
    let force = ("control.force".to_string(), "\"table\"".to_string());
    let set = [("pad.0.target_n".to_string(), target), force];
    gates_close_the_loop_as_the_model_does("ecp5", "standard", |profile| {
        Closed::new(profile, ("fig9", 1), &set, 3)
    });
}

#[test]
#[cfg_attr(
    not(all(
        tool = "synth/tools",
        tool = "verilator",
        tool = "make",
        tool = "g++",
        tool = "iverilog"
    )),
    ignore = "needs synth/tools, verilator, make, g++, iverilog: ./test fetches what is missing"
)]
fn ice40_gates_run_what_the_model_runs_small() {
    gates_run_what_the_model_runs("ice40", "small");
}

#[test]
#[cfg_attr(
    not(all(
        tool = "synth/tools",
        tool = "verilator",
        tool = "make",
        tool = "g++",
        tool = "iverilog"
    )),
    ignore = "needs synth/tools, verilator, make, g++, iverilog: ./test fetches what is missing"
)]
fn ecp5_gates_run_what_the_model_runs_small() {
    gates_run_what_the_model_runs("ecp5", "small");
}

#[test]
#[cfg_attr(
    not(all(
        tool = "synth/tools",
        tool = "verilator",
        tool = "make",
        tool = "g++",
        tool = "iverilog"
    )),
    ignore = "needs synth/tools, verilator, make, g++, iverilog: ./test fetches what is missing"
)]
fn ecp5_gates_run_what_the_model_runs_standard() {
    gates_run_what_the_model_runs("ecp5", "standard");
}
