// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clocks a second of the model and of Verilator -O3 on the printed Verilog, same profile, same
//! stimulus, in one run.
//!
//! `cargo bench -p hapticore-tests --bench verilator`. Rounds alternate, figures are medians; the
//! outputs of all clocks must have the same sum. Nothing here asserts a time, for the machine is
//! never quiet: quote the ratio.

mod speed;

use hapticore_contract::profile::Profile;
use hapticore_hdl::verilog::Design;
use hapticore_model::blocks::core::Core;
use hapticore_rtl::netlist;
use hapticore_tests::{stimulus, tools};
use speed::verilator::Verilated;
use speed::{Lap, Workload, model};

const SCENE: &str = "fig6";
/// Slots of the scene, and how often a round runs through them.
const SLOTS: usize = 16;
const PASSES: usize = 8;
const ROUNDS: usize = 7;

fn main() {
    if !tools::have(&["verilator", "make", "g++"]) {
        return;
    }
    println!(
        "{:>10} {:>14} {:>14} {:>7}   {SCENE}, M clocks/s, medians of {ROUNDS}",
        "", "model", "Verilator -O3", "ratio"
    );
    for name in ["small", "standard"] {
        race(&Profile::bundled(name).expect("bundled"));
    }
}

fn race(profile: &Profile) {
    let core = Core::new(profile);
    let workload = Workload::new(profile, stimulus::scene(profile, SCENE, SLOTS), PASSES);
    let verilated = Verilated::new(&Design::print(&netlist::of_core(&core), "a bench"), &workload);
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        let (model, verilog) = (model::run(&core, &workload), verilated.run());
        assert_eq!(model.sum, verilog.sum, "outputs differ: see the lock-step tests for where");
        ours.push(model);
        theirs.push(verilog);
    }
    let rate = |laps| workload.clocks() as f64 / median(laps) / 1e6;
    let (ours, theirs) = (rate(ours), rate(theirs));
    println!(
        "{:>10} {ours:14.1} {theirs:14.1} {:6.1}×   {} clocks a round",
        profile.name,
        ours / theirs,
        workload.clocks()
    );
}

fn median(laps: Vec<Lap>) -> f64 {
    let mut seconds: Vec<_> = laps.into_iter().map(|lap| lap.seconds).collect();
    seconds.sort_by(f64::total_cmp);
    seconds[seconds.len() / 2]
}
