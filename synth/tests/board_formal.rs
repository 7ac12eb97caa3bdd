// SPDX-License-Identifier: MIT OR Apache-2.0
//! Proofs of a board's blocks, at the parameters of the boards that one can buy; that what they speak of can happen; and that
//! they can fail.

use hapticore_model::profile::Profile;
use hapticore_model::signal::netlist::{Module, Netlist};
use hapticore_rtl::board::adc_reader::AdcReader;
use hapticore_rtl::board::pads::Pads;
use hapticore_rtl::board::{Parameters, Target};
use hapticore_synth::formal::{Claim, Mode, Verdict, print};
use hapticore_synth::tools::Tools;

fn verdict(
    tools: &Tools,
    verilog: &str,
    module: &'static str,
    parameters: &[(&'static str, u64)],
    mode: Mode,
) -> Verdict {
    let folder = tempfile::tempdir().expect("a folder");
    let claim = Claim { verilog, module, checker: module, parameters: parameters.to_vec(), defines: Vec::new() };
    claim.check(tools, mode, folder.path()).unwrap_or_else(|error| panic!("{module}: {error}"))
}

/// The ADC reader of a board: as printed, and its checker's parameters.
fn reader(profile: &Profile, parameters: &Parameters) -> (String, Vec<(&'static str, u64)>) {
    let module: Module = Netlist::of(&AdcReader::new(profile, parameters)).top().clone();
    let bits = u64::from(profile.formats.adc.width);
    let of = vec![
        ("PERIOD", profile.clocks_per_sample),
        ("CONVERSION", parameters.conversion()),
        ("BITS", bits),
        ("LATENCY", parameters.sclk_latency),
        ("CHANNELS", profile.channels() as u64),
    ];
    (print(&module), of)
}

#[test]
fn the_adc_s_pins_keep_to_their_schedule_whatever_is_enabled_when() {
    let Some(tools) = Tools::or_skip() else { return };
    for target in Target::ALL {
        let (verilog, parameters) = reader(&target.profile(), &target.parameters());
        let found = verdict(&tools, &verilog, "adc_reader", &parameters, Mode::Prove(10));
        assert_eq!(found, Verdict::Holds, "{target:?} with {parameters:?}");
        let found = verdict(&tools, &verilog, "adc_reader", &parameters, Mode::Cover(60));
        assert_eq!(found, Verdict::Holds, "{target:?}: sets and words happen");
    }
}

#[test]
fn a_changed_schedule_is_noticed() {
    let Some(tools) = Tools::or_skip() else { return };
    let target = Target::Icebreaker;
    let (verilog, parameters) = reader(&target.profile(), &target.parameters());
    // What stood there before, or could: each changed in one place of the text.
    for (printed, instead) in [
        ("assign shift = selected & configuring;", "assign shift = configuring;"),
        ("assign shift = selected & configuring;", "assign shift = selected & write;"),
        ("assign cs_n = ~selected;", "assign cs_n = ~(selected & enable);"),
        ("assign sclk_run = run;", "assign sclk_run = run & enable;"),
        ("(((enable | active) | selected) | unload)", "((enable | active) | unload)"),
        ("index == 3'd7", "index == 3'd6"),
    ] {
        let changed = verilog.replacen(printed, instead, 1);
        assert_ne!(changed, verilog, "{printed} is printed");
        let found = verdict(&tools, &changed, "adc_reader", &parameters, Mode::Bounded(40));
        assert_eq!(found, Verdict::Broken, "{instead}");
    }
}

#[test]
fn no_two_pads_of_a_board_are_closed() {
    let Some(tools) = Tools::or_skip() else { return };
    for target in Target::ALL {
        let (pads, dead) = (target.profile().pads, target.parameters().dead());
        let verilog = print(Netlist::of(&Pads::new(pads, dead)).top());
        let parameters = [("PADS", pads), ("DEAD", dead)];
        assert_eq!(verdict(&tools, &verilog, "pads", &parameters, Mode::Prove(4)), Verdict::Holds, "{target:?}");
    }
}
