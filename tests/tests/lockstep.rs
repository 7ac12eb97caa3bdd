// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clocked model = printed Verilog, every output at every clock: random input and whole scenes, in
//! two simulators.

use hapticore_contract::profile::{self, Profile};

use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::verilog::Design;
use hapticore_host::profile::for_terminals;
use hapticore_model::blocks::haptic_voltage::HapticVoltage;
use hapticore_model::blocks::wall::{Inputs, Wall};
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

/// A wall and its trace: pads that are dragged through it in turn, and between them any words.
fn wall(profile: &str, rule: profile::Wall) -> (Design, Trace) {
    let bundled = Profile::bundled(profile).expect("bundled");
    let block = Wall::try_new(&Profile { wall: Some(rule), ..bundled }).unwrap();
    let (f, latency, mut clocks) = (block.inputs(), block.latency(), 0..);
    let mut rng = fastrand::Rng::with_seed(7);
    let mut held = Inputs::of(0);
    let design = Design::of(&block, "a test");
    let trace = Trace::record(&block, design.ports.clone(), move |_| {
        let clock: u64 = clocks.next()?;
        let (frame, within) = (clock / (latency + 3), clock % (latency + 3));
        if within == 0 {
            let turns = (frame / 2) as f64 / 300.0;
            let x_mm = 2.0 * (std::f64::consts::TAU * turns).cos();
            let push = -0.02 * (std::f64::consts::TAU * turns).sin() + 0.01 * (rng.f64() - 0.5);
            held = <Inputs as Bundle>::map(f, |format| {
                rng.i64(format.min_code() as i64..=format.max_code() as i64)
            });
            (held.pad, held.restart) = ((frame % 2) as i64, i64::from(rng.u32(..500) == 0));
            if rng.u32(..16) != 0 {
                held.c_left = f.c_left.code_saturating(170.0 * (1.0 - push));
                held.c_right = f.c_right.code_saturating(170.0 * (1.0 + push));
                held.x = f.x.code_saturating(x_mm);
                held.at_zero = i64::from(x_mm > 0.0);
                held.stiffness = f.stiffness.code_saturating(0.5);
                held.most = f.most.code_saturating(1.0);
                held.factory = 0;
            }
        }
        let mut inputs = Vec::new();
        let given = Inputs { start: i64::from(within == 0), ..held };
        <Inputs as Bundle>::map(given, |code| inputs.push(code));
        (frame < 1500).then_some(inputs)
    });
    (design, trace)
}

#[test]
fn both_simulators_run_a_wall_as_the_model_does() {
    for (profile, rule) in [("small", profile::Wall::B), ("standard", profile::Wall::A)] {
        let (design, trace) = wall(profile, rule);
        if tools::have(&["iverilog", "vvp"])
            && let Err(mismatch) = icarus::check(design.top(), &design.text(), &trace)
        {
            panic!("{profile}, Icarus: {mismatch}");
        }
        if tools::have(&["verilator", "make", "g++"]) {
            let verilated =
                Verilated::new(design.top(), &design.ports, &design.text(), Start::Zero);
            if let Err(mismatch) = verilated.check(&trace) {
                panic!("{profile}, Verilator: {mismatch}");
            }
        }
        println!("{profile}: {} clocks equal", trace.clocks());
    }
}
