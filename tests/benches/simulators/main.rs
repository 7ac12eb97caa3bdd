// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clocks a second of the model and of simulators of the printed Verilog, same profile, same
//! stimulus, in one run.
//!
//! `cargo bench -p hapticore-tests --bench simulators`. Rounds alternate, figures are medians; the
//! outputs of all clocks must have the same sum. Nothing here asserts a time, for the machine is
//! never quiet: quote the ratios. Needs what `synth/tools` fetches, with `.tools/bin` on the path; a simulator that is
//! not there is left out, and named.

mod speed;

use hapticore_contract::profile::Profile;
use hapticore_hdl::verilog::Design;
use hapticore_model::blocks::core::Core;
use hapticore_rtl::netlist;
use hapticore_tests::{stimulus, tools};
use speed::simulator::{Simulated, Simulator};
use speed::{Lap, Workload, model};

const SCENE: &str = "fig6";
/// Slots of the scene, and how often a round runs through them.
const SLOTS: usize = 16;
const PASSES: usize = 8;
const ROUNDS: usize = 7;

fn main() {
    let simulators: Vec<_> =
        Simulator::ALL.into_iter().filter(|simulator| tools::have(&simulator.commands())).collect();
    for name in ["small", "standard"] {
        race(&Profile::bundled(name).expect("bundled"), &simulators);
    }
}

fn race(profile: &Profile, simulators: &[Simulator]) {
    let core = Core::new(profile);
    let workload = Workload::new(profile, stimulus::scene(profile, SCENE, SLOTS), PASSES);
    let design = Design::print(&netlist::of_core(&core), "a bench");
    let simulated: Vec<_> =
        simulators.iter().map(|&simulator| Simulated::new(simulator, &design, &workload)).collect();
    let mut ours = Vec::new();
    let mut theirs = vec![Vec::new(); simulators.len()];
    for _ in 0..ROUNDS {
        let model = model::run(&core, &workload);
        for (simulated, laps) in simulated.iter().zip(&mut theirs) {
            let lap = simulated.run();
            assert_eq!(model.sum, lap.sum, "outputs differ: see the lock-step tests for where");
            laps.push(lap);
        }
        ours.push(model);
    }
    let rate = |laps| workload.clocks() as f64 / median(laps) / 1e6;
    let ours = rate(ours);
    println!(
        "{}, {SCENE}, {} clocks a round, medians of {ROUNDS} rounds",
        profile.name,
        workload.clocks()
    );
    println!("{:>32} {ours:6.1} M clocks/s", "model");
    for (simulator, laps) in simulators.iter().zip(theirs) {
        let theirs = rate(laps);
        println!(
            "{:>32} {theirs:6.1} M clocks/s: the model makes {:.1} × as many",
            simulator.name(),
            ours / theirs
        );
    }
}

fn median(laps: Vec<Lap>) -> f64 {
    let mut seconds: Vec<_> = laps.into_iter().map(|lap| lap.seconds).collect();
    seconds.sort_by(f64::total_cmp);
    seconds[seconds.len() / 2]
}
