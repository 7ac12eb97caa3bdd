// SPDX-License-Identifier: MIT OR Apache-2.0
//! Synthesised blocks are their Verilog, for all inputs and states: proved register by register
//! (`equiv_opt`).
//!
//! | block | iCE40 | ECP5 | otherwise |
//! | --- | --- | --- | --- |
//! | divider, square root, multiplexer, haptic voltage, pads | proved | proved | |
//! | ratio, estimator, core | – | – | optimised across registers¹ |
//! | oscillator, frames, map, demodulator, currents | – | – | memories, which `equiv_opt` does not take |
//! | capacitance, force | – | – | multipliers: beyond the solver, and cells without a description |
//!
//! ¹ What is not proved here is compared clock by clock in the lock-step tests. Registers and
//! outputs are compared, not the wires between: one that matters only in states that can be reached
//! may do anything in others, and the induction starts from any.

use hapticore_contract::profile::Profile;
use hapticore_hdl::interpretations::netlist::Netlist;
use hapticore_model::blocks::core::Core;
use hapticore_rtl::board::pads::Pads;
use hapticore_rtl::netlist;
use hapticore_synth::certificates::Subject;
use hapticore_synth::formal::{print, top};
use hapticore_synth::tools::Tools;
use std::fs;

const ICE40: (&str, &str) = ("ice40", "synth_ice40 -dsp");
const ECP5: (&str, &str) = ("ecp5", "synth_ecp5");

/// Whether the cells that synthesis makes of a module do the same; `after` may do something to them
/// first.
fn equivalent(
    tools: &Tools,
    verilog: &str,
    (family, synthesis): (&str, &str),
    after: &str,
) -> bool {
    let name = top(verilog).expect("a module");
    let synthesis = format!("{synthesis} -top {name}\n{after}\n");
    let prove =
        format!("equiv_opt -assert -async2sync -map +/{family}/cells_sim.v script synthesis.ys");
    // Wires without a name of their own are not compared.
    let registers = "select -set registers t:$*dff* %x:+[Q] w:* %i; rename -hide w:* @registers %d";
    let commands = format!(
        "read_verilog design.v; hierarchy -top {name}; proc; flatten; opt_clean; {registers}; {prove}"
    );
    // What Yosys says after its logic optimiser has run is only in its log.
    let subject = Subject::new().and(verilog).and(&synthesis).and(&commands);
    let ask = || {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("design.v"), verilog).expect("a file");
        fs::write(folder.path().join("synthesis.ys"), &synthesis).expect("a file");
        let result = tools.run("yosys", &["-q", "-l", "log", "-p", &commands], folder.path());
        let log = fs::read_to_string(folder.path().join("log")).expect("a log");
        let unproven = log.contains("unproven $equiv cells in 'equiv_status -assert'");
        let tail: Vec<_> = log.lines().rev().take(10).collect();
        assert!(result.is_ok() || unproven, "{name}, {synthesis}: {tail:#?}");
        if result.is_ok() { "equivalent" } else { "not proved" }.into()
    };
    subject.verdict(&format!("equivalence: {name} in {family}"), ask) == "equivalent"
}

fn block(name: &str) -> String {
    let netlist = netlist::of_core(&Core::new(&Profile::bundled("small").expect("bundled")));
    print(
        netlist
            .modules
            .iter()
            .find(|module| module.name == name)
            .unwrap_or_else(|| panic!("no {name}")),
    )
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn synthesised_blocks_are_their_verilog() {
    let tools = Tools::find().expect("what synth/tools fetches");
    for name in ["divider", "sqrt", "multiplexer", "haptic_voltage"] {
        for family in [ICE40, ECP5] {
            assert!(equivalent(&tools, &block(name), family, ""), "{name}, {family:?}");
        }
    }
    let pads = print(Netlist::of(&Pads::new(4, 25)).top());
    for family in [ICE40, ECP5] {
        assert!(equivalent(&tools, &pads, family, ""), "pads, {family:?}");
    }
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn another_circuit_is_noticed() {
    let tools = Tools::find().expect("what synth/tools fetches");
    let (ice40, ecp5) =
        ("setparam -set LUT_INIT 16'h8000 t:SB_LUT4", "setparam -set INIT 16'h8000 t:LUT4");
    assert!(!equivalent(&tools, &block("multiplexer"), ICE40, ice40));
    assert!(!equivalent(&tools, &block("multiplexer"), ECP5, ecp5));
}
