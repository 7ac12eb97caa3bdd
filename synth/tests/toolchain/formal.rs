// SPDX-License-Identifier: MIT OR Apache-2.0
//! Proofs for all inputs: division and square root are right, no two pads are closed. And that the
//! proofs can fail.

use hapticore_contract::profile::Profile;
use hapticore_hdl::block::Block;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::netlist::{Module, Named, Netlist};
use hapticore_model::blocks::core::Core;
use hapticore_model::blocks::divider::Divider;
use hapticore_model::blocks::multiplexer::Multiplexer;
use hapticore_model::blocks::sqrt::SquareRoot;
use hapticore_rtl::board::pads::Pads;
use hapticore_rtl::netlist;
use hapticore_synth::formal::{Claim, Mode, Verdict, broken, mutants, print};
use hapticore_synth::tools::Tools;

type Parameters = Vec<(&'static str, u64)>;

fn format_of(ports: &[Named], name: &str) -> Format {
    ports.iter().find(|port| port.name == name).unwrap_or_else(|| panic!("no port {name}")).format
}

fn widths(format: Format) -> u64 {
    format.width.into()
}

fn of_divider(module: &Module) -> Parameters {
    let [numerator, denominator] =
        ["numerator", "denominator"].map(|name| format_of(&module.inputs, name));
    let quotient = format_of(&module.outputs, "quotient");
    let zeros = quotient.frac - numerator.frac + denominator.frac;
    let latency = Divider::new(numerator, denominator, quotient).latency();
    let [n, d, q] = [numerator, denominator, quotient].map(widths);
    vec![("N", n), ("D", d), ("Q", q), ("PAD", zeros as u64), ("LATENCY", latency)]
}

fn sqrt_parameters(module: &Module) -> Parameters {
    let (radicand, sqrt) =
        (format_of(&module.inputs, "radicand"), format_of(&module.outputs, "sqrt"));
    let zeros = 2 * sqrt.frac - radicand.frac;
    let latency = SquareRoot::new(radicand, sqrt.frac).latency();
    vec![
        ("R", widths(radicand)),
        ("DIGITS", widths(sqrt) - 1),
        ("PAD", zeros as u64),
        ("LATENCY", latency),
    ]
}

fn of_multiplexer(profile: &Profile) -> Parameters {
    let slot = &profile.slot;
    vec![
        ("OPEN", slot.open),
        ("BEGIN", slot.open + slot.settle),
        ("SLOT", slot.samples()),
        ("PADS", profile.pads),
    ]
}

/// The only module of a block that has no others within.
fn module<B: Block>(block: &B) -> Module {
    Netlist::of(block).top().clone()
}

/// The claim about a printed module.
fn claim<'a>(module: &Module, verilog: &'a str, parameters: &Parameters, small: bool) -> Claim<'a> {
    let defines = if small { vec!["SMALL"] } else { Vec::new() };
    Claim { verilog, checker: module.name, parameters: parameters.clone(), defines }
}

fn holds(tools: &Tools, module: &Module, parameters: &Parameters, small: bool) {
    let folder = tempfile::tempdir().expect("a folder");
    let verilog = print(module);
    let found =
        claim(module, &verilog, parameters, small).check(tools, Mode::Prove(4), folder.path());
    assert_eq!(found.unwrap(), Verdict::Holds, "{} with {parameters:?}", module.name);
}

/// Every changed operator breaks the claim within `clocks` clocks after reset, and without a change none does.
fn breaks(tools: &Tools, module: &Module, parameters: &Parameters, clocks: u64) {
    let mutants = mutants(module);
    assert!(mutants.len() > 3, "there are operators to change");
    let all = std::iter::once(module).chain(mutants.iter().map(|(_, mutant)| mutant));
    let texts: Vec<_> = all.map(print).collect();
    let claims: Vec<_> = texts.iter().map(|text| claim(module, text, parameters, true)).collect();
    let folder = tempfile::tempdir().expect("a folder");
    let broken = broken(tools, &claims, clocks, folder.path()).unwrap();
    assert!(!broken[0], "{} as it is", module.name);
    let survivors: Vec<_> = mutants
        .iter()
        .zip(&broken[1..])
        .filter(|(_, broken)| !**broken)
        .map(|(m, _)| &m.0)
        .collect();
    assert!(
        survivors.is_empty(),
        "{} of {}: nobody notices {survivors:#?}",
        module.name,
        mutants.len()
    );
}

/// The widest of this name in the bundled profiles. That the others keep their remainders is decided by
/// another solver, in seconds (`claims.rs`); their results and clocks are those of the reference in tests
/// of the model, not for all operands.
fn widest_of_profiles(name: &str) -> Module {
    let netlists = Profile::all().into_iter().map(|profile| netlist::of_core(&Core::new(&profile)));
    netlists
        .flat_map(|netlist| netlist.modules)
        .filter(|module| module.name == name)
        .max_by_key(|module| module.inputs.iter().map(|port| widths(port.format)).sum::<u64>())
        .unwrap_or_else(|| panic!("no {name}"))
}

fn narrow_divider() -> Module {
    module(&Divider::new(Format::unsigned(4, 2), Format::unsigned(3, 1), Format::unsigned(3, 1)))
}

fn narrow_sqrt() -> Module {
    module(&SquareRoot::new(Format::unsigned(6, 3), 2))
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn division_is_right_for_all_operands() {
    let tools = Tools::find().expect("what synth/tools fetches");
    let narrow = narrow_divider();
    holds(&tools, &narrow, &of_divider(&narrow), true);
    let widest = widest_of_profiles("divider");
    holds(&tools, &widest, &of_divider(&widest), false);
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn a_changed_divider_is_noticed() {
    let tools = Tools::find().expect("what synth/tools fetches");
    let narrow = narrow_divider();
    breaks(&tools, &narrow, &of_divider(&narrow), 12);
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn square_roots_are_right_for_all_radicands() {
    let tools = Tools::find().expect("what synth/tools fetches");
    let narrow = narrow_sqrt();
    holds(&tools, &narrow, &sqrt_parameters(&narrow), true);
    let widest = widest_of_profiles("sqrt");
    holds(&tools, &widest, &sqrt_parameters(&widest), false);
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn a_changed_square_root_is_noticed() {
    let tools = Tools::find().expect("what synth/tools fetches");
    let narrow = narrow_sqrt();
    breaks(&tools, &narrow, &sqrt_parameters(&narrow), 10);
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn no_two_pads_are_closed_and_a_break_comes_before() {
    let tools = Tools::find().expect("what synth/tools fetches");
    for profile in Profile::all() {
        holds(&tools, &module(&Multiplexer::new(&profile)), &of_multiplexer(&profile), false);
    }
    for (pads, dead) in [(4, 250), (1, 1), (7, 12)] {
        holds(
            &tools,
            &module(&Pads::new(pads, dead)),
            &vec![("PADS", pads), ("DEAD", dead)],
            false,
        );
    }
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn a_changed_pad_selection_is_noticed() {
    let tools = Tools::find().expect("what synth/tools fetches");
    let mut profile = Profile::bundled("small").expect("bundled");
    (profile.slot.open, profile.slot.settle, profile.slot.integrate, profile.pads) = (1, 1, 2, 3);
    breaks(&tools, &module(&Multiplexer::new(&profile)), &of_multiplexer(&profile), 16);
    breaks(&tools, &module(&Pads::new(3, 2)), &vec![("PADS", 3), ("DEAD", 2)], 10);
}
