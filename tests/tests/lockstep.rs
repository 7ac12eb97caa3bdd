// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clocked model = printed Verilog, every output at every clock: random input and whole scenes, in
//! four simulators.

use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::{self, ForceLaw, Profile};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::verilog::Design;
use hapticore_host::profile::for_terminals;
use hapticore_model::blocks::controller::{self, Controller};
use hapticore_model::blocks::core::Core;
use hapticore_model::blocks::divider::Divider;
use hapticore_model::blocks::drives::{self, Drives};
use hapticore_model::blocks::haptic_voltage::HapticVoltage;
use hapticore_model::blocks::wall::{Inputs, Wall};
use hapticore_rtl::board::Target;
use hapticore_rtl::board::drive_output::serial::Frame;
use hapticore_rtl::board::drive_output::{self, Converter, DriveOutput, Wave};
use hapticore_tests::force_loop::Closed;
use hapticore_tests::lockstep::verilator::{Start, Verilated, Version};
use hapticore_tests::lockstep::{Bench, Mismatch, Trace, cxxrtl, icarus};
use hapticore_tests::peripherals::{Alone, blocks_of_a_drive};
use hapticore_tests::stimulus;
use std::collections::BTreeSet;
use std::time::Instant;

/// Clocks that Verilator runs at least, of each profile.
const CLOCKS: usize = 1_000_000;

fn verilator_runs_what_the_model_runs(profile: &str) {
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
#[cfg_attr(
    not(all(tool = "verilator", tool = "make", tool = "g++")),
    ignore = "needs verilator, make, g++: ./test fetches what is missing"
)]
fn verilator_runs_what_the_model_runs_small() {
    verilator_runs_what_the_model_runs("small");
}

#[test]
#[cfg_attr(
    not(all(tool = "verilator", tool = "make", tool = "g++")),
    ignore = "needs verilator, make, g++: ./test fetches what is missing"
)]
fn verilator_runs_what_the_model_runs_standard() {
    verilator_runs_what_the_model_runs("standard");
}

#[test]
#[cfg_attr(
    not(all(tool = "iverilog", tool = "vvp")),
    ignore = "needs iverilog, vvp: ./test fetches what is missing"
)]
fn icarus_runs_what_the_model_runs() {
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

/// Runs short traces in the simulators that nothing else here uses, and says which, for how many
/// clocks and seconds.
fn other_simulators_run_what_the_model_runs(profile: &str) {
    let bench = Bench::new(profile);
    let (top, ports, text) = (bench.design.top(), &bench.design.ports, bench.design.text());
    let traces = [
        bench.record(stimulus::scene(&bench.profile, "hockey", 2)),
        bench.record(stimulus::random(&bench.profile, 3, 1)),
    ];
    let clocks: usize = traces.iter().map(Trace::clocks).sum();
    let say = |simulator: &str, start: Instant| {
        let seconds = start.elapsed().as_secs_f64();
        println!(
            "{profile}: {clocks} clocks equal in {simulator}, {seconds:.1} s with compilation"
        );
    };
    let start = Instant::now();
    let verilated = Verilated::with(Version::Current, top, ports, &text, Start::Zero);
    for trace in &traces {
        verilated.check(trace).unwrap_or_else(|found| panic!("{profile}, Verilator: {found}"));
    }
    say(&Version::Current.name(), start);
    let start = Instant::now();
    let result = cxxrtl::check(top, &text, &traces);
    result.unwrap_or_else(|found| panic!("{profile}, CXXRTL: {found}"));
    say("CXXRTL", start);
}

#[test]
#[cfg_attr(
    not(all(tool = "verilator-current", tool = "make", tool = "g++", tool = "yosys")),
    ignore = "needs verilator-current, make, g++, yosys: ./test fetches what is missing"
)]
fn other_simulators_run_what_the_model_runs_small() {
    other_simulators_run_what_the_model_runs("small");
}

#[test]
#[cfg_attr(
    not(all(tool = "verilator-current", tool = "make", tool = "g++", tool = "yosys")),
    ignore = "needs verilator-current, make, g++, yosys: ./test fetches what is missing"
)]
fn other_simulators_run_what_the_model_runs_standard() {
    other_simulators_run_what_the_model_runs("standard");
}

/// What each simulator says of a divider's Verilog on a trace of its model.
fn in_each_simulator(verilog: &str, top: &str, trace: &Trace) -> Vec<(String, Option<Mismatch>)> {
    let mut results = Vec::new();
    for version in [Version::Distribution, Version::Current] {
        let verilated = Verilated::with(version, top, &trace.ports, verilog, Start::Zero);
        results.push((version.name(), verilated.check(trace).err()));
    }
    results.push(("Icarus".into(), icarus::check(top, verilog, trace).err()));
    let result = cxxrtl::check(top, verilog, std::slice::from_ref(trace));
    results.push(("CXXRTL".into(), result.err()));
    results
}

#[test]
#[cfg_attr(
    not(all(
        tool = "verilator",
        tool = "make",
        tool = "g++",
        tool = "verilator-current",
        tool = "iverilog",
        tool = "vvp",
        tool = "yosys"
    )),
    ignore = "needs verilator, make, g++, verilator-current, iverilog, vvp, yosys: ./test fetches what is missing"
)]
fn each_simulator_notices_a_mutant_at_the_same_clock() {
    let u = hapticore_hdl::format::Format::unsigned;
    let block = Divider::new(u(12, 8), u(11, 7), u(10, 8));
    let design = Design::of(&block, "a test");
    let (top, text) = (design.top(), design.text());
    let trace =
        Trace::record(&block, design.ports.clone(), stimulus::operations(&block, 1, 100, 0, 0));
    for (simulator, found) in in_each_simulator(&text, top, &trace) {
        assert_eq!(found, None, "{simulator}, as printed");
    }
    let mutant = text.replacen("} - {", "} + {", 1);
    assert_ne!(mutant, text, "the divider subtracts");
    let found = in_each_simulator(&mutant, top, &trace);
    for (simulator, mismatch) in &found {
        println!("{simulator}: {mismatch:?}");
        assert_eq!(*mismatch, found[0].1, "{simulator}, {}", found[0].0);
    }
    assert!(found.iter().all(|(_, mismatch)| mismatch.is_some()));
}

/// CXXRTL's assertions are on: an address beyond the words ends the program.
#[test]
#[cfg_attr(
    not(all(tool = "yosys", tool = "g++")),
    ignore = "needs yosys, g++: ./test fetches what is missing"
)]
fn cxxrtl_stops_at_an_address_beyond_a_memory() {
    let mut profile = Profile::bundled("small").expect("bundled");
    profile.haptic.windows = 4;
    let block = HapticVoltage::try_new(&profile).unwrap();
    let design = Design::of(&block, "a test");
    let trace =
        Trace::record(&block, design.ports.clone(), stimulus::operations(&block, 1, 40, 0, 40));
    let (text, traces) = (design.text(), [trace]);
    assert_eq!(cxxrtl::check(design.top(), &text, &traces), Ok(()));
    let shorter = text.replace("squares [0:15]", "squares [0:14]").replace("i < 16", "i < 15");
    assert_ne!(shorter, text, "squares of four windows and four pads");
    let check = || cxxrtl::check(design.top(), &shorter, &traces);
    let panic = std::panic::catch_unwind(check).expect_err("the program ends");
    let message = panic.downcast_ref::<String>().expect("a message");
    assert!(message.contains("out of bounds"), "{message}");
}

/// The bundled profile with a force table.
fn with_force_table(name: &str) -> Bench {
    let mut profile = Profile::bundled(name).expect("bundled");
    profile.force.law = ForceLaw::Table;
    Bench::of(profile)
}

#[test]
#[cfg_attr(
    not(all(tool = "verilator", tool = "make", tool = "g++")),
    ignore = "needs verilator, make, g++: ./test fetches what is missing"
)]
fn verilator_runs_a_force_table_as_the_model_does() {
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
#[cfg_attr(
    not(all(tool = "iverilog", tool = "vvp")),
    ignore = "needs iverilog, vvp: ./test fetches what is missing"
)]
fn icarus_runs_a_force_table_as_the_model_does() {
    let bench = with_force_table("small");
    let trace = bench.record(stimulus::scene(&bench.profile, "hockey", 2));
    if let Err(mismatch) = icarus::check(bench.design.top(), &bench.design.text(), &trace) {
        panic!("{mismatch}");
    }
}

/// A core of `terminals` terminals, the signs of which differ along both axes.
fn with_terminals(terminals: usize) -> Bench {
    let small = Profile::bundled("small").expect("bundled");
    let sign = |period: usize| move |n: usize| if (n / period).is_multiple_of(2) { 1 } else { -1 };
    let signs = [1, 2].map(|period| (0..terminals).map(sign(period)).collect());
    Bench::of(for_terminals(&small, &signs).expect("3 to 16 terminals"))
}

#[test]
#[cfg_attr(
    not(all(tool = "iverilog", tool = "vvp")),
    ignore = "needs iverilog, vvp: ./test fetches what is missing"
)]
fn icarus_runs_what_the_model_runs_of_other_numbers_of_terminals() {
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
#[cfg_attr(
    not(all(tool = "iverilog", tool = "vvp")),
    ignore = "needs iverilog, vvp: ./test fetches what is missing"
)]
fn icarus_runs_a_mean_over_windows_as_the_model_does() {
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

/// The plant and the loop together: a step of the target, and the clocks in which the force follows.
#[test]
#[cfg_attr(
    not(all(tool = "verilator", tool = "make", tool = "g++")),
    ignore = "needs verilator, make, g++: ./test fetches what is missing"
)]
fn verilator_closes_the_force_loop_as_the_model_does() {
    // In slots of 250 µs an estimate runs on within the next window.
    let own = ["390", "600"];
    for (name, force, [settle, window]) in [
        ("small", "\"eq8\"", own),
        ("standard", "\"table\"", own),
        ("fast", "\"table\"", ["112", "128"]),
    ] {
        let profile = Profile::bundled(name).expect("bundled");
        let target = "{ timeline = [[0, 0], [0.002, 0], [0.002, 0.6]] }";
        let set = [
            ("pad.0.target_n", target),
            ("control.force", force),
            ("settle_samples", settle),
            ("window_samples", window),
        ];
        let set = set.map(|(key, value)| (key.to_string(), value.to_string()));
        let (design, trace) = Closed::new(&profile, ("fig9", 1), &set, 16).record();
        let drives = of_port(&trace, "drive");
        assert!(drives.iter().max() > Some(&0), "{name}: the loop drives the pad");
        let verilated = Verilated::new(design.top(), &design.ports, &design.text(), Start::Zero);
        if let Err(mismatch) = verilated.check(&trace) {
            panic!("{name}: {mismatch}");
        }
    }
}

/// Plant, core and wall together: a pad is pushed into the wall, which holds it, and drawn out.
#[test]
#[cfg_attr(
    not(all(tool = "verilator", tool = "make", tool = "g++")),
    ignore = "needs verilator, make, g++: ./test fetches what is missing"
)]
fn verilator_runs_a_wall_as_the_model_does() {
    for name in ["small", "standard"] {
        runs_a_wall(name, &Profile::bundled(name).expect("bundled"));
    }
}

fn runs_a_wall(name: &str, profile: &Profile) {
    let (design, trace) = Closed::at_a_wall(profile).record();
    let [drive, free] = ["drive", "drive_free"].map(|port| of_port(&trace, port));
    assert!(drive.iter().max() > Some(&0), "{name}: the wall holds the pad");
    assert!(free.iter().max() > Some(&0), "{name}: the wall lets it go");
    let verilated = Verilated::new(design.top(), &design.ports, &design.text(), Start::Zero);
    if let Err(mismatch) = verilated.check(&trace) {
        panic!("{name}: {mismatch}");
    }
}

/// A pad that is split in four, in the corner of two walls.
#[test]
#[cfg_attr(
    not(all(tool = "verilator", tool = "make", tool = "g++")),
    ignore = "needs verilator, make, g++: ./test fetches what is missing"
)]
fn verilator_runs_walls_along_both_axes_as_the_model_does() {
    let (design, trace) =
        Closed::in_a_corner(&Profile::bundled("small").expect("bundled")).record();
    assert!(of_port(&trace, "drive").into_iter().any(|drive| drive > 0), "the walls hold the pad");
    let verilated = Verilated::new(design.top(), &design.ports, &design.text(), Start::Zero);
    if let Err(mismatch) = verilated.check(&trace) {
        panic!("{mismatch}");
    }
    println!("small, quadrants: {} clocks equal", trace.clocks());
    let driven = driven(&trace);
    let targets: BTreeSet<_> = driven.iter().map(|(_, target)| target).collect();
    assert!(targets.len() > 2, "walls along both axes make targets of their own: {targets:?}");
}

/// The drive words of a trace, and the forces that they are for.
fn driven(trace: &Trace) -> Vec<(i64, i64)> {
    let [valid, drive, target] =
        ["drive_valid", "drive", "drive_target"].map(|port| of_port(trace, port));
    let given = valid.into_iter().zip(drive.into_iter().zip(target));
    given.filter(|(valid, _)| *valid == 1).map(|(_, given)| given).collect()
}

/// The drive words of a wall reach the pins of a converter, with the polarity of their slots.
#[test]
#[cfg_attr(
    not(all(tool = "verilator", tool = "make", tool = "g++")),
    ignore = "needs verilator, make, g++: ./test fetches what is missing"
)]
fn verilator_drives_a_converter_as_the_model_does() {
    let mut profile = Profile::bundled("standard").expect("bundled");
    let (_, of_loop) = Closed::at_a_wall(&profile).record();
    profile.control = Some(Control::of(&profile, Law::Inverse));
    profile.wall = Some(profile::Wall::A);
    profile.pads = 3;
    let (wave, converter) = (Wave::Square { turn_slots: 2 }, Converter::Serial(Frame::AD5664));
    let block =
        DriveOutput::of_profile(&profile, wave, converter, 25_000_000).expect("a force loop");
    let design = Design::of(&block, "a test");
    let names = drive_output::Inputs::FIELDS.iter().map(|field| field.name);
    let inputs: Vec<Vec<i64>> = names.map(|name| drive_input(&of_loop, name)).collect();
    let mut clocks = 0..of_loop.clocks();
    let trace = Trace::record(&block, design.ports.clone(), |_| {
        clocks.next().map(|clock| inputs.iter().map(|input| input[clock]).collect())
    });
    let words: BTreeSet<_> = serial_words(&trace).into_iter().collect();
    let turned = of_port(&trace, "dac_polarity").into_iter().collect::<BTreeSet<_>>();
    assert!(words.iter().any(|word| *word > 1_000) && turned.len() > 1, "both polarities");
    for drive in of_port(&of_loop, "drive").into_iter().collect::<BTreeSet<_>>() {
        let word = (65_536.0 * block.inputs().drive.real(drive)).round_ties_even() as i64;
        assert!(words.contains(&word), "{drive} is at the pins");
    }
    let verilated = Verilated::new(design.top(), &design.ports, &design.text(), Start::Zero);
    if let Err(mismatch) = verilated.check(&trace) {
        panic!("{mismatch}");
    }
}

/// What the drive output receives from the port of the loop that has its name.
fn drive_input(of_loop: &Trace, name: &str) -> Vec<i64> {
    match name {
        "enable" => of_port(of_loop, "clear").into_iter().map(|clear| 1 - clear).collect(),
        name => of_port(of_loop, name),
    }
}

/// The words that a serial converter of 16 bits takes.
fn serial_words(trace: &Trace) -> Vec<i64> {
    let of = |name| of_port(trace, name);
    let (sync_n, sclk, sdi) = (of("dac_sync_n"), of("dac_sclk"), of("dac_sdi"));
    let (mut frame, mut words) = (0, Vec::new());
    for clock in 1..sync_n.len() {
        if sync_n[clock] == 0 && sclk[clock - 1] > sclk[clock] {
            frame = frame << 1 | sdi[clock];
        }
        if sync_n[clock - 1] < sync_n[clock] {
            words.push(frame & 0xffff);
        }
    }
    words
}

/// What a port gave, clock by clock.
fn of_port(trace: &Trace, name: &str) -> Vec<i64> {
    let at = trace.ports.iter().position(|port| port.name == name).expect("a port");
    (0..trace.clocks()).map(|clock| trace.row(clock)[at]).collect()
}

/// Each law, its operands anywhere.
#[test]
#[cfg_attr(
    not(all(tool = "iverilog", tool = "vvp")),
    ignore = "needs iverilog, vvp: ./test fetches what is missing"
)]
fn icarus_runs_each_law_of_the_controller_as_the_model_does() {
    for name in ["small", "standard"] {
        for law in [Law::Open, Law::Proportional, Law::Integral, Law::Inverse] {
            let mut profile = Profile::bundled(name).expect("bundled");
            profile.control = Some(Control::of(&profile, law));
            let block = Controller::try_new(&profile).expect("a controller");
            let design = Design::of(&block, "a test");
            let cells = profile.control.as_ref().map_or(0, |control| control.cells as i64);
            let trace = Trace::record(&block, design.ports.clone(), with_curve(&block, cells + 1));
            if let Err(mismatch) = icarus::check(design.top(), &design.text(), &trace) {
                panic!("{name}, {law:?}: {mismatch}");
            }
        }
    }
}

/// Controller and walls of each law, their operands anywhere.
#[test]
#[cfg_attr(
    not(all(tool = "iverilog", tool = "vvp")),
    ignore = "needs iverilog, vvp: ./test fetches what is missing"
)]
fn icarus_runs_drives_as_the_model_does() {
    let walls = [None, Some(profile::Wall::A), Some(profile::Wall::B), None];
    let quadrants = (Law::Inverse, Some(profile::Wall::QUADRANTS));
    for (law, wall) in Law::ALL.into_iter().zip(walls).chain([quadrants]) {
        for name in ["small", "standard"] {
            let mut profile = Profile::bundled(name).expect("bundled");
            profile.control = Some(Control::of(&profile, law));
            (profile.wall, profile.pads) = (wall, 2 * wall.map_or(1, |wall| wall.parts));
            let prompt = Core::try_new(&profile).expect("a core").outputs().prompt;
            let block = Drives::try_new(&profile, prompt).expect("drives");
            let design = Design::of(&block, "a test");
            let estimates = estimates(&block, profile.pads);
            let trace = Trace::record(&block, design.ports.clone(), estimates);
            let given = of_port(&trace, "drive_valid").into_iter().zip(of_port(&trace, "drive"));
            let driven = given.filter(|(valid, drive)| *valid == 1 && *drive > 0).count();
            assert!(driven > 5, "{name}, {law:?}: {driven} drive words that are not zero");
            if let Err(mismatch) = icarus::check(design.top(), &design.text(), &trace) {
                panic!("{name}, {law:?}: {mismatch}");
            }
        }
    }
}

/// The clocks after a part's estimate in which `split_pad` reads its pad's place, x and y.
const PLACES_ARE_READ: [i64; 2] = [1, 2];

/// A curve, then estimates of pads in turn, as far apart as their drive words take, and anything else at any clock.
fn estimates(block: &Drives, pads: u64) -> impl FnMut(&[i64]) -> Option<Vec<i64>> + use<> {
    let (formats, apart, pads) = (block.inputs(), block.latency() as i64 + 5, pads as i64);
    let words = block.words_of_curve() as i64;
    let (mut rng, mut clock) = (fastrand::Rng::with_seed(9), -words);
    let mut estimate = drives::Inputs::of(0).estimate;
    move |_| {
        let mut inputs = <drives::Inputs as Bundle>::map(formats, |format| match format.width {
            0 => 0,
            1 => i64::from(rng.u32(..30) == 0),
            _ => stimulus::shaped(&mut rng, format),
        });
        let any = &mut inputs;
        for pad in [&mut any.placed_pad, &mut any.target.target_pad, &mut any.wall.wall_pad] {
            *pad %= pads;
        }
        any.tuning.curve_address %= words;
        // What stops drives comes rarely enough that most are not zero.
        inputs.tuning.enable = i64::from(rng.u32(..2000) != 0);
        if rng.u32(..8) != 0 {
            inputs.tuning.force_cap = formats.tuning.force_cap.max_code() as i64;
        }
        inputs.clear &= i64::from(rng.u32(..60) == 0);
        inputs.drives_clear &= i64::from(rng.u32(..60) == 0);
        // The curve is written while no drive word is being made.
        let rests = clock % apart > apart - 5;
        inputs.tuning.curve_write = i64::from(rests && rng.bool());
        if clock < 0 {
            (inputs.tuning.curve_write, inputs.tuning.curve_address) = (1, clock + words);
        }
        // A memory that does not care gives anything for a place that is written in the clock in which it is read.
        inputs.placed &= i64::from(!PLACES_ARE_READ.contains(&(clock % apart)));
        if clock >= 0 && clock % apart == 0 {
            (estimate, estimate.prompt) = (inputs.estimate, 1);
            estimate.prompt_pad = clock / apart % pads;
        }
        inputs.estimate = estimate;
        inputs.estimate.prompt = i64::from(clock >= 0 && clock % apart == 0);
        clock += 1;
        let mut codes = Vec::new();
        <drives::Inputs as Bundle>::each(
            <drives::Inputs as Bundle>::zip(inputs, formats),
            |_, (code, format)| codes.extend((!format.is_none()).then_some(code)),
        );
        (clock < 192 * apart).then_some(codes)
    }
}

/// A curve of any words, then operations.
fn with_curve(block: &Controller, words: i64) -> impl FnMut(&[i64]) -> Option<Vec<i64>> {
    let names = stimulus::ports::<controller::Inputs>(block.inputs());
    let at = |name: &str| names.iter().position(|found| found.0 == name).expect("a port");
    let [write, address, word] = ["curve_write", "curve_address", "curve_word"].map(at);
    let (start, format) = (at("start"), block.inputs().tuning.curve_word);
    let [clear, lifted, tick, enable] = ["clear", "lifted", "tick", "enable"].map(at);
    let (mut operations, mut rng) =
        (stimulus::operations(block, 7, 200, words, 0), fastrand::Rng::with_seed(7));
    let mut addresses = 0..words;
    move |outputs| {
        let Some(next) = addresses.next() else {
            let mut row = operations(outputs)?;
            (row[write], row[address]) = (0, 0);
            // Rarely enough that most drive words are not void.
            let mut rarely = |clocks: u32| i64::from(rng.u32(..clocks) == 0);
            (row[clear], row[tick], row[enable]) = (rarely(800), rarely(40), 1 - rarely(800));
            row[lifted] &= rarely(4);
            return Some(row);
        };
        let mut row = vec![0; names.len()];
        (row[write], row[address], row[start]) = (1, next, 0);
        row[word] = stimulus::shaped(&mut rng, format);
        Some(row)
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
#[cfg_attr(
    not(all(tool = "iverilog", tool = "vvp", tool = "verilator", tool = "make", tool = "g++")),
    ignore = "needs iverilog, vvp, verilator, make, g++: ./test fetches what is missing"
)]
fn both_simulators_run_a_wall_as_the_model_does() {
    for (profile, rule) in [("small", profile::Wall::B), ("standard", profile::Wall::A)] {
        let (design, trace) = wall(profile, rule);
        if let Err(mismatch) = icarus::check(design.top(), &design.text(), &trace) {
            panic!("{profile}, Icarus: {mismatch}");
        }
        let verilated = Verilated::new(design.top(), &design.ports, &design.text(), Start::Zero);
        if let Err(mismatch) = verilated.check(&trace) {
            panic!("{profile}, Verilator: {mismatch}");
        }
        println!("{profile}: {} clocks equal", trace.clocks());
    }
}

#[test]
#[cfg_attr(
    not(all(tool = "iverilog", tool = "vvp")),
    ignore = "needs iverilog, vvp: ./test fetches what is missing"
)]
fn blocks_of_a_board_with_a_drive_run_as_in_the_model() {
    for Alone { design, trace } in blocks_of_a_drive(Target::Ulx3s) {
        if let Err(mismatch) = icarus::check(design.top(), &design.text(), &trace) {
            panic!("{}: {mismatch:?}", design.top());
        }
    }
}
