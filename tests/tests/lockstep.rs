// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clocked model = printed Verilog, every output at every clock: random input and whole scenes, in two simulators.

use hapticore_model::blocks::core::Core;
use hapticore_model::profile::Profile;
use hapticore_rtl::verilog::Design;
use hapticore_tests::lockstep::verilator::{Speed, Verilated};
use hapticore_tests::lockstep::{Trace, icarus};
use hapticore_tests::stimulus::{self, Stimulus};
use hapticore_tests::tools;

struct Bench {
    core: Core,
    design: Design,
}

impl Bench {
    fn new(profile: &Profile) -> Bench {
        let core = Core::new(profile);
        Bench { design: Design::of(&core, "a test"), core }
    }

    fn record(&self, mut stimulus: Stimulus) -> Trace {
        Trace::record(&self.core, self.design.ports.clone(), |outputs| stimulus.next(outputs))
    }
}

/// Clocks that Verilator runs at least, of each profile.
const CLOCKS: usize = 1_000_000;

fn verilator_runs_what_the_model_runs(profile: &str) {
    if !tools::have(&["verilator", "make", "g++"]) {
        return;
    }
    let profile = Profile::bundled(profile).expect("bundled");
    let bench = Bench::new(&profile);
    let verilated = Verilated::new(bench.design.top(), &bench.design.ports, &bench.design.text(), Speed::Compile);
    let mut clocks = 0;
    for stimulus in [
        stimulus::scene(&profile, "fig6", 16),
        stimulus::scene(&profile, "hockey", 20),
        stimulus::random(&profile, 1, 8),
        stimulus::random(&profile, 2, 8),
    ] {
        let trace = bench.record(stimulus);
        clocks += trace.clocks();
        if let Err(mismatch) = verilated.check(&trace) {
            panic!("{}: {mismatch}", profile.name);
        }
    }
    println!("{}: {clocks} clocks equal in Verilator", profile.name);
    assert!(clocks >= CLOCKS, "{clocks} clocks");
}

#[test]
fn verilator_runs_what_the_model_runs_small() {
    verilator_runs_what_the_model_runs("small");
}

#[test]
fn verilator_runs_what_the_model_runs_standard() {
    verilator_runs_what_the_model_runs("standard");
}

#[test]
fn icarus_runs_what_the_model_runs() {
    if !tools::have(&["iverilog", "vvp"]) {
        return;
    }
    for name in ["small", "standard"] {
        let profile = Profile::bundled(name).expect("bundled");
        let bench = Bench::new(&profile);
        for stimulus in [stimulus::scene(&profile, "hockey", 2), stimulus::random(&profile, 3, 2)] {
            if let Err(mismatch) = icarus::check(bench.design.top(), &bench.design.text(), &bench.record(stimulus)) {
                panic!("{name}: {mismatch}");
            }
        }
    }
}
