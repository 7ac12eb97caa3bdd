// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every `Assumed` narrowing of every core fits, for all inputs: decided by solvers, from the graph
//! that is printed. And that the solvers refute what is wrong.

use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::{ForceLaw, Profile, Wall as Rule};
use hapticore_hdl::block::{Block, Inputs};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::netlist::Netlist;
use hapticore_hdl::probe::{sample, variables};
use hapticore_hdl::signal::Signal;
use hapticore_hdl::smt::{Problem, Property, System};
use hapticore_model::blocks::controller::Controller;
use hapticore_model::blocks::core::Core;
use hapticore_model::blocks::currents::Currents;
use hapticore_model::blocks::divider::Divider;
use hapticore_model::blocks::sqrt::SquareRoot;
use hapticore_model::blocks::wall::Wall;
use hapticore_rtl::netlist;
use hapticore_synth::claims::{Answer, Solver, decide, prove};
use hapticore_synth::tools::Tools;
use std::collections::{BTreeMap, BTreeSet};
use std::time::Instant;

/// Every block of a profile: its core with either force law, the controller with every law, a wall
/// of every rule.
fn blocks(profile: &Profile) -> Vec<Netlist> {
    let table = |profile: &Profile| {
        let mut with = profile.clone();
        with.force.law = ForceLaw::Table;
        with
    };
    let controlled = |law| {
        let control = Some(Control::of(profile, law));
        Profile { control, ..profile.clone() }
    };
    let laws = [Law::Open, Law::Proportional, Law::Integral, Law::Inverse].map(controlled);
    let mut all: Vec<Netlist> =
        [profile, &table(profile)].map(|profile| netlist::of_core(&Core::new(profile))).into();
    all.extend(laws.map(|profile| Netlist::of(&Controller::try_new(&profile).expect("a law"))));
    all.extend([Rule::A, Rule::B].map(|rule| {
        let profile = Profile { wall: Some(rule), ..profile.clone() };
        Netlist::of(&Wall::try_new(&profile).expect("a wall"))
    }));
    all
}

/// The systems that have claims of their own, each once.
fn with_claims(netlists: &[Netlist]) -> Vec<System<'_>> {
    let mut found = BTreeMap::new();
    for netlist in netlists {
        for module in 0..netlist.modules.len() {
            let system = System::of(netlist, module);
            if let Some((_, claim)) = system.claims().first() {
                found.entry(system.step(*claim, 1).text).or_insert(system);
            }
        }
    }
    found.into_values().collect()
}

/// Proves everything that a block claims, and says how long it took.
fn holds(tools: &Tools, solver: Solver, system: &System, of: &str) -> BTreeSet<&'static str> {
    let start = Instant::now();
    let proved = prove(tools, solver, system)
        .unwrap_or_else(|error| panic!("{of}, {}: {error:#}", system.name()));
    let clocks = proved.iter().map(|property| property.clocks).max().unwrap_or(0);
    println!(
        "{of}, {}: {} invariants and {} claims over {clocks} clocks, {solver:?}, {:.1} s",
        system.name(),
        system.invariants().len(),
        system.claims().len(),
        start.elapsed().as_secs_f64()
    );
    system.claims().into_iter().map(|(name, _)| name).collect()
}

/// All that bundled profiles assume: the range proof lists the first three for their cores.
const ASSUMPTIONS: [&str; 4] = [
    "a mean of old and new value lies between them",
    "a square is not negative",
    "the remainder of a division stays below its denominator",
    "the remainder of a square root is at most twice the root so far",
];

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn every_assumption_of_a_bundled_profile_is_proved() {
    let tools = Tools::find().expect("what synth/tools fetches");
    let mut found = BTreeSet::new();
    let netlists: Vec<Netlist> = Profile::all().iter().flat_map(blocks).collect();
    for system in with_claims(&netlists) {
        found.extend(holds(&tools, Solver::Bitwuzla, &system, "bundled"));
    }
    assert!(found.iter().eq(&ASSUMPTIONS), "{found:?}");
}

/// The top block of a netlist.
fn top(netlist: &Netlist) -> System<'_> {
    System::of(netlist, netlist.modules.len() - 1)
}

fn narrow_divider() -> Divider {
    Divider::new(Format::unsigned(4, 2), Format::unsigned(3, 1), Format::unsigned(3, 1))
}

fn narrow_sqrt() -> SquareRoot {
    SquareRoot::new(Format::unsigned(6, 3), 2)
}

/// Dividers and square roots of other widths than the profiles'.
#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn division_and_square_root_of_any_width_keep_their_remainder() {
    let tools = Tools::find().expect("what synth/tools fetches");
    let mut rng = fastrand::Rng::with_seed(15);
    for _ in 0..4 {
        let [numerator, denominator] =
            [0; 2].map(|_| Format::unsigned(rng.u8(1..=24), rng.i8(-4..=20)));
        let least = numerator.frac - denominator.frac;
        let quotient = Format::unsigned(rng.u8(2..=24), least + rng.i8(0..=8));
        let of = format!("{numerator} / {denominator} as {quotient}");
        let netlist = Netlist::of(&Divider::new(numerator, denominator, quotient));
        holds(&tools, Solver::Bitwuzla, &top(&netlist), &of);
        let radicand = Format::unsigned(rng.u8(2..=40), rng.i8(0..=10));
        let netlist =
            Netlist::of(&SquareRoot::new(radicand, (radicand.frac + 1) / 2 + rng.i8(0..=4)));
        holds(&tools, Solver::Bitwuzla, &top(&netlist), &format!("√{radicand}"));
    }
}

/// Another solver on the smallest of these problems of each block, without products: its time grows
/// faster with their widths.
#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn another_solver_agrees() {
    let tools = Tools::find().expect("what synth/tools fetches");
    let netlists = blocks(&Profile::bundled("small").expect("bundled"));
    let mut systems = with_claims(&netlists);
    systems.sort_by_key(|system| (system.name(), system.step(system.claims()[0].1, 1).text.len()));
    systems.dedup_by_key(|system| system.name());
    for system in systems.iter().filter(|system| system.name() != "currents") {
        holds(&tools, Solver::Cvc5, system, "small");
    }
}

/// A solver's answer on the first claim with `less` fewer bits, from any state after `clocks` clocks.
fn narrowed(tools: &Tools, system: &System, less: u8, clocks: usize) -> Answer {
    let Some((_, Property::Claim(wire, _))) = system.claims().first().copied() else {
        panic!("{} has a claim", system.name())
    };
    answer(tools, system.step(Property::Claim(wire, less), clocks))
}

fn answer(tools: &Tools, problem: Problem) -> Answer {
    decide(tools, Solver::Bitwuzla, &[problem]).expect("a solver decides").remove(0)
}

/// The signals of a counterexample.
fn example(answer: Answer) -> String {
    match answer {
        Answer::Refuted(example) => example.to_string(),
        Answer::Proved => panic!("a claim that is wrong is refuted"),
    }
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn a_claim_with_a_bit_less_is_refuted_with_the_signals_values() {
    let tools = Tools::find().expect("what synth/tools fetches");
    let profile = Profile::bundled("standard").expect("bundled");
    let netlists = blocks(&profile);
    for system in with_claims(&netlists) {
        // The format of a square has room for the sign that it never has: one bit less still holds.
        let (less, clocks) = if system.name() == "currents" { (2, 2) } else { (1, 0) };
        let signals = example(narrowed(&tools, &system, less, clocks));
        println!("{}: {}", system.name(), signals.chars().take(200).collect::<String>());
        let register = match system.name() {
            "divider" | "sqrt" => "remainder@0",
            "currents" => "multiplier.product@2",
            _ => "filtered@0",
        };
        assert!(signals.contains(register), "{}: {signals}", system.name());
    }
}

/// From reset on: operands that bring about the overflow.
#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn a_bit_less_is_refuted_by_a_division_from_reset_on() {
    let tools = Tools::find().expect("what synth/tools fetches");
    for netlist in [Netlist::of(&narrow_divider()), Netlist::of(&narrow_sqrt())] {
        let system = top(&netlist);
        let Some((_, Property::Claim(wire, _))) = system.claims().first().copied() else {
            panic!("{} has a claim", system.name())
        };
        let problem = system.base(Property::Claim(wire, 1), 8);
        let signals = example(answer(&tools, problem));
        println!("{}: {signals}", system.name());
        assert!(signals.contains("start@0 ") && signals.contains("busy@0 0 (u1.0)"), "{signals}");
    }
}

/// What the proof of a division needs: its invariants, and a caller that holds the denominator.
#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn a_division_is_not_proved_without_its_invariants_or_its_caller() {
    let tools = Tools::find().expect("what synth/tools fetches");
    let whole = Netlist::of(&narrow_divider());
    prove(&tools, Solver::Bitwuzla, &top(&whole)).expect("as it is");
    let mut any_caller = whole.clone();
    any_caller.modules[0].held = None;
    let invariants = (0..3).map(|without| {
        let mut less = whole.clone();
        less.modules[0].invariants.remove(without);
        less
    });
    for less in invariants.chain([any_caller]) {
        let error = prove(&tools, Solver::Bitwuzla, &top(&less)).expect_err("too little is known");
        println!("{}", format!("{error:#}").chars().take(160).collect::<String>());
    }
}

/// Whether the relation that solvers use is the model's: `clocks` clocks from reset, each with the inputs of a function
/// of the clock and the input.
fn follows<B: Block>(
    tools: &Tools,
    block: &B,
    clocks: usize,
    mut give: impl FnMut(usize, &str, Format) -> i64,
) {
    let names = variables(block, "top")
        .into_iter()
        .map(|of| [&of.scope[1..], &[of.name]].concat().join("."));
    let names: Vec<String> = names.collect();
    let (mut state, mut registers, mut inputs) = (block.reset::<i64>(), Vec::new(), Vec::new());
    for clock in 0..clocks {
        let mut codes = Vec::new();
        sample(block, &state, &mut codes);
        registers.push(names.iter().cloned().zip(codes).collect::<Vec<_>>());
        let (mut fields, mut given) = (B::Inputs::FIELDS.iter(), Vec::new());
        let signals: Inputs<B, Signal<i64>> = B::Inputs::map(block.inputs(), |format| {
            let value = give(clock, fields.next().expect("a field").name, format);
            given.push(value);
            Signal { value, format }
        });
        inputs.push(given);
        block.step(&mut state, signals);
    }
    let netlist = Netlist::of(block);
    let decided =
        |registers: &[Vec<(String, i64)>]| answer(tools, top(&netlist).replay(registers, &inputs));
    assert_eq!(decided(&registers), Answer::Proved, "{}: {clocks} clocks", B::NAME);
    let last = registers.last_mut().expect("a clock");
    let live = last.iter_mut().find(|(name, _)| name == "count" || name == "channel");
    live.expect("a register").1 ^= 1;
    assert_ne!(decided(&registers), Answer::Proved, "{}: a wrong code is noticed", B::NAME);
}

/// Starts now and then; other inputs are any codes, held between.
fn now_and_then(every: usize) -> impl FnMut(usize, &str, Format) -> i64 {
    move |clock, name, format| match name {
        "start" => i64::from(clock % every == 1),
        name => {
            let seed = name.len() * 1000 + clock.saturating_sub(1) / every;
            let mut rng = fastrand::Rng::with_seed(seed as u64);
            rng.i64(format.min_code() as i64..=format.max_code() as i64)
        }
    }
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn solvers_are_given_the_model() {
    let tools = Tools::find().expect("what synth/tools fetches");
    follows(&tools, &narrow_divider(), 60, now_and_then(9));
    follows(&tools, &narrow_sqrt(), 60, now_and_then(8));
    let u = |width, frac| Format::unsigned(width, frac);
    follows(&tools, &Divider::new(u(24, 20), u(22, 19), u(20, 19)), 60, now_and_then(27));
    for name in ["small", "standard"] {
        let profile = Profile::bundled(name).expect("bundled");
        // The sums of all channels, one per clock, and then what becomes of the first.
        let currents = Currents::try_new(&profile).expect("bundled");
        let last = 2 * profile.terminals.x.len() + 2;
        let mut any = now_and_then(1);
        follows(&tools, &currents, 90, |clock, name, format| match name {
            "valid" => i64::from(clock <= last),
            "index" => clock.min(last) as i64,
            _ => any(clock, name, format) >> 4,
        });
    }
    let profile = Profile { wall: Some(Rule::A), ..Profile::bundled("small").expect("bundled") };
    follows(&tools, &Wall::try_new(&profile).expect("a wall"), 100, now_and_then(95));
}
