// SPDX-License-Identifier: MIT OR Apache-2.0
//! A deliberate fault in a printed operator makes lock-step fail, and say at which clock, in which
//! signal, with which values.
//!
//! Every shape of the printer that can be wrong is a place for a fault: its sign, its width, its
//! rounding, its latency. For each module of the core and each of these kinds, the places are taken
//! as they are printed, in three parts, and the first of each part is tried: in lock-step of the
//! whole core, and of each block that computes alone, which meets thousands of operands in the time
//! in which a core makes one frame.
//!
//! Each of these faults must be noticed, but for those of `faults.txt`, each with the reason why it
//! changes nothing; one of the list that is noticed after all, or is not tried, fails the test,
//! too. `FAULTS=all` tries every place, and lists what is not noticed.

use std::collections::{BTreeMap, BTreeSet};

use hapticore_contract::profile::Profile;
use hapticore_hdl::block::Block;
use hapticore_hdl::verilog::{Design, Heading};
use hapticore_model::blocks::capacitance::Capacitance;
use hapticore_model::blocks::currents::Currents;
use hapticore_model::blocks::demodulator::Demodulator;
use hapticore_model::blocks::force::Force;
use hapticore_model::blocks::haptic_voltage::HapticVoltage;
use hapticore_model::blocks::pace::Pace;
use hapticore_model::blocks::position::Position;
use hapticore_model::blocks::ratio::Ratio;
use hapticore_rtl::header;
use hapticore_synth::certificates::Subject;
use hapticore_tests::faults::campaign::{self, two_at_a_time};
use hapticore_tests::faults::{Fault, Kind, Planted};
use hapticore_tests::lockstep::verilator::{CompiledTrace, Start, Verilated};
use hapticore_tests::lockstep::{Bench, Mismatch, Trace};
use hapticore_tests::stimulus;

/// Into how many parts the places of a module and kind are divided.
const PARTS: usize = 3;

/// Faults that change nothing, each under its reason (`#`).
const NONE: &str = include_str!("faults.txt");

/// A block alone: the name of its module, and a trace.
type Alone = (String, Trace);

/// A block alone, by the name of its module in the core of `small`.
fn design<B: Block>(block: &B) -> Design {
    let prefix = header::prefix(&Profile::bundled("small").expect("bundled"));
    Design::of(block, Heading { prefix, ..Heading::from("a test") })
}

fn alone<B: Block>(block: &B, operations: usize, words: i64, clocks: u32) -> Alone {
    let Design { modules, ports } = design(block);
    let trace =
        Trace::record(block, ports, stimulus::operations(block, 1, operations, words, clocks));
    (modules.last().expect("a module").name.clone(), trace)
}

/// A block that counts clocks between strobes, which come too early, in time and late, and which
/// forgets now and then.
fn strobed(block: &Pace) -> Alone {
    let Design { modules, ports } = design(block);
    let (mut rng, mut left, mut gap) = (fastrand::Rng::with_seed(1), 20_000, 0);
    let trace = Trace::record(block, ports, move |_| {
        left = i32::checked_sub(left, 1).filter(|left| *left > 0)?;
        gap = if gap == 0 { rng.u32(1..60) } else { gap - 1 };
        Some(vec![i64::from(gap == 0), i64::from(rng.u32(..200) == 0)])
    });
    (modules.last().expect("a module").name.clone(), trace)
}

/// The blocks that compute, each alone.
fn blocks(profile: &Profile) -> Vec<Alone> {
    let (currents, position, words) = (
        Currents::try_new(profile).unwrap(),
        Position::new(profile),
        2 * (profile.channels() as i64 - 1),
    );
    let amplitudes = currents.outputs();
    vec![
        // As long as polyphase sums take to be read out.
        alone(&Demodulator::try_new(profile).unwrap(), 500, 0, 640),
        alone(&position, 600, position.table().words as i64, 3),
        alone(&currents, 1000, words, 3),
        alone(&HapticVoltage::try_new(profile).unwrap(), 20_000, words, 3),
        strobed(&Pace::new(profile)),
        alone(
            &Ratio::try_new(profile, (amplitudes.x, amplitudes.corners), amplitudes.least).unwrap(),
            800,
            0,
            3,
        ),
        alone(&Capacitance::try_new(profile, amplitudes.total).unwrap(), 30_000, 0, 3),
        alone(&Force::try_new(profile).unwrap(), 6000, 0, 3),
    ]
}

/// Of each module and kind, the first place of each part, by number; or all.
fn sample(planted: &Planted, all: bool) -> Vec<(usize, &Fault)> {
    let mut groups: BTreeMap<(&str, Kind), Vec<(usize, &Fault)>> = BTreeMap::new();
    for (index, fault) in planted.faults.iter().enumerate() {
        groups.entry((&fault.module, fault.kind)).or_default().push((index + 1, fault));
    }
    let parts = |places: Vec<(usize, _)>| -> Vec<_> {
        places
            .chunks(if all { 1 } else { places.len().div_ceil(PARTS) })
            .map(|part| part[0])
            .collect()
    };
    groups.into_values().flat_map(parts).collect()
}

/// Whether a module is another, or somewhere within it.
fn within(design: &Design, module: &str, other: &str) -> bool {
    let instance = format!("\n    {module} u_");
    let mut parents = design.modules.iter().filter(|file| file.text.contains(&instance));
    module == other || parents.any(|file| within(design, &file.name, other))
}

fn first_mismatch<'a>(
    mut traces: impl Iterator<Item = &'a CompiledTrace<'a>>,
    number: usize,
) -> Option<Mismatch> {
    traces.find_map(|trace| trace.check(number).err())
}

/// The numbers of the faults of a sample that no trace notices: of blocks alone, the last the core, and more of that.
fn missed(
    design: &Design,
    planted: &Planted,
    (alone, more): (Vec<Alone>, Vec<Alone>),
    sample: &[(usize, &Fault)],
) -> Vec<usize> {
    let compiled = two_at_a_time(&alone, |(name, trace)| {
        Verilated::new("alone", &trace.ports, &planted.alone(name), Start::Zero)
    });
    let core = compiled.last().expect("the core");
    let mut traces: Vec<_> = alone
        .into_iter()
        .zip(&compiled)
        .map(|((name, trace), compiled)| (name, compiled.with_trace(trace)))
        .collect();
    traces.extend(more.into_iter().map(|(name, trace)| (name, core.with_trace(trace))));
    assert_eq!(first_mismatch(traces.iter().map(|(_, trace)| trace), 0), None, "without a fault");
    let found = two_at_a_time(sample, |&(number, fault)| {
        let with = traces.iter().filter(|(top, _)| within(design, &fault.module, top));
        first_mismatch(with.map(|(_, trace)| trace), number)
    });
    for ((_, fault), mismatch) in sample.iter().zip(&found) {
        if let Some(mismatch) = mismatch {
            println!("noticed: {fault}\n    {mismatch}");
        }
    }
    let numbers = sample.iter().map(|(number, _)| *number);
    numbers
        .zip(found)
        .filter_map(|(number, mismatch)| mismatch.is_none().then_some(number))
        .collect()
}

#[test]
#[cfg_attr(
    not(all(tool = "verilator", tool = "make", tool = "g++")),
    ignore = "needs verilator, make, g++: ./test fetches what is missing"
)]
fn faults_of_each_kind_in_each_module_are_noticed() {
    let bench = Bench::new("small");
    let planted = Planted::new(&bench.design);
    let of_core = |seed| {
        (bench.design.top().to_owned(), bench.record(stimulus::tones(&bench.profile, seed, 16)))
    };
    let mut alone = blocks(&bench.profile);
    alone.push(of_core(1));
    // Positions that are found: of random codes there are few, and frames hold what was valid last.
    let valid =
        (bench.design.top().to_owned(), bench.record(stimulus::scene(&bench.profile, "hockey", 8)));
    let more: Vec<Alone> = [2, 3, 4].map(of_core).into_iter().chain([valid]).collect();
    let all = campaign::all();
    let sample = sample(&planted, all);
    let none = campaign::equivalent(NONE);
    let numbers: Vec<_> = sample.iter().map(|(number, _)| number.to_string()).collect();
    let subject = Subject::new().and(&planted.verilog).and(numbers.join(" "));
    let subject = alone
        .iter()
        .chain(&more)
        .fold(subject.and(include_str!("faults.rs")), |subject, (name, trace)| {
            subject.and(name).and(trace.bytes())
        });
    let missed = campaign::missed("the core", subject, || {
        missed(&bench.design, &planted, (alone, more), &sample)
    });
    let of_sample = |number: &usize| &planted.faults[number - 1];
    let passed_by: BTreeSet<String> = missed.iter().map(|n| of_sample(n).to_string()).collect();
    let passed_by: BTreeSet<&str> = passed_by.iter().map(String::as_str).collect();
    println!(
        "{} faults noticed, {} not, of {} tried and {} places",
        sample.len() - missed.len(),
        missed.len(),
        sample.len(),
        planted.faults.len()
    );
    println!(
        "{} of those not noticed change nothing (faults.txt)",
        passed_by.intersection(&none).count()
    );
    let survivors: Vec<_> = passed_by.difference(&none).collect();
    if all {
        survivors.iter().for_each(|fault| println!("not noticed: {fault}"));
    } else {
        assert!(survivors.is_empty(), "not noticed: {survivors:#?}");
    }
    let stale: Vec<_> = none.difference(&passed_by).collect();
    assert!(stale.is_empty(), "noticed after all, or not tried: {stale:#?}");
}
