// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clocked model = printed Verilog, every output at every clock: random input and whole scenes, in
//! two simulators.

use hapticore_contract::profile::{ForceLaw, Profile};
use hapticore_hdl::verilog::Design;
use hapticore_host::profile::for_terminals;
use hapticore_model::blocks::haptic_voltage::HapticVoltage;
use hapticore_tests::lockstep::verilator::{Start, Verilated};
use hapticore_tests::lockstep::{Bench, Trace, icarus};
use hapticore_tests::{stimulus, tools};

/// Clocks that Verilator runs at least, of each profile.
const CLOCKS: usize = 1_000_000;

fn verilator_runs_what_the_model_runs(profile: &str) {
    if !tools::have(&["verilator", "make", "g++"]) {
        return;
    }
    let bench = Bench::new(profile);
    let verilated =
        Verilated::new(bench.design.top(), &bench.design.ports, &bench.design.text(), Start::Zero);
    let mut clocks = 0;
    for stimulus in [
        stimulus::scene(&bench.profile, "fig6", 16),
        stimulus::scene(&bench.profile, "hockey", 20),
        stimulus::random(&bench.profile, 1, 8),
        stimulus::random(&bench.profile, 2, 8),
    ] {
        let trace = bench.record(stimulus);
        clocks += trace.clocks();
        if let Err(mismatch) = verilated.check(&trace) {
            panic!("{profile}: {mismatch}");
        }
    }
    println!("{profile}: {clocks} clocks equal in Verilator");
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
        let bench = Bench::new(name);
        for stimulus in
            [stimulus::scene(&bench.profile, "hockey", 2), stimulus::random(&bench.profile, 3, 2)]
        {
            if let Err(mismatch) =
                icarus::check(bench.design.top(), &bench.design.text(), &bench.record(stimulus))
            {
                panic!("{name}: {mismatch}");
            }
        }
    }
}

/// The bundled profile with a force table.
fn with_force_table(name: &str) -> Bench {
    let mut profile = Profile::bundled(name).expect("bundled");
    profile.force.law = ForceLaw::Table;
    Bench::of(profile)
}

#[test]
fn verilator_runs_a_force_table_as_the_model_does() {
    if !tools::have(&["verilator", "make", "g++"]) {
        return;
    }
    for name in ["small", "standard"] {
        let bench = with_force_table(name);
        let (top, ports, text) = (bench.design.top(), &bench.design.ports, bench.design.text());
        assert!(text.contains("force_table") && !text.contains("force_estimator"));
        let verilated = Verilated::new(top, ports, &text, Start::Zero);
        for stimulus in [
            stimulus::scene(&bench.profile, "fig6", 16),
            stimulus::random(&bench.profile, 5, 8),
            stimulus::tones(&bench.profile, 6, 16),
        ] {
            if let Err(mismatch) = verilated.check(&bench.record(stimulus)) {
                panic!("{name}: {mismatch}");
            }
        }
    }
}

#[test]
fn icarus_runs_a_force_table_as_the_model_does() {
    if !tools::have(&["iverilog", "vvp"]) {
        return;
    }
    let bench = with_force_table("small");
    let trace = bench.record(stimulus::scene(&bench.profile, "hockey", 2));
    if let Err(mismatch) = icarus::check(bench.design.top(), &bench.design.text(), &trace) {
        panic!("{mismatch}");
    }
}

/// A core of so many terminals, the signs of which differ along both axes.
fn with_terminals(terminals: usize) -> Bench {
    let small = Profile::bundled("small").expect("bundled");
    let sign = |period: usize| move |n: usize| if (n / period).is_multiple_of(2) { 1 } else { -1 };
    let signs = [1, 2].map(|period| (0..terminals).map(sign(period)).collect());
    Bench::of(for_terminals(&small, &signs).expect("3 to 16 terminals"))
}

#[test]
fn icarus_runs_what_the_model_runs_of_other_numbers_of_terminals() {
    if !tools::have(&["iverilog", "vvp"]) {
        return;
    }
    for terminals in [3, 8, 16] {
        let bench = with_terminals(terminals);
        assert_eq!(bench.profile.channels(), terminals + 2);
        let trace = bench.record(stimulus::random(&bench.profile, 4, 1));
        if let Err(mismatch) = icarus::check(bench.design.top(), &bench.design.text(), &trace) {
            panic!("{terminals} terminals: {mismatch}");
        }
    }
}

/// Squares of every pad in turn, and now and then `clear`: bundled profiles have one window, and
/// print nothing of this.
#[test]
fn icarus_runs_a_mean_over_windows_as_the_model_does() {
    if !tools::have(&["iverilog", "vvp"]) {
        return;
    }
    let mut profile = Profile::bundled("small").expect("bundled");
    profile.haptic.windows = 4;
    let block = HapticVoltage::try_new(&profile).unwrap();
    let (last, sum, latency) =
        (2 * profile.demodulated() as i64, block.inputs().sum, block.latency() as usize);
    let (mut rng, mut clocks, pads) = (fastrand::Rng::with_seed(6), 0.., profile.pads as usize);
    let design = Design::of(&block, "a test");
    let trace = Trace::record(&block, design.ports.clone(), move |_| {
        let clock: usize = clocks.next()?;
        let (slot, within) = (clock / (latency + 2), clock % (latency + 2));
        let code = rng.i64(sum.min_code() as i64..=sum.max_code() as i64) >> rng.u32(..20);
        let [clear, valid] = [rng.u32(..40) == 0 && within > latency, within == 0].map(i64::from);
        (slot < 800).then(|| vec![clear, (slot % pads) as i64, valid, last, code.abs()])
    });
    if let Err(mismatch) = icarus::check(design.top(), &design.text(), &trace) {
        panic!("{mismatch}");
    }
}
