// SPDX-License-Identifier: MIT OR Apache-2.0
//! Netlists: they elaborate for every profile, and run as the clocked model does.

use crate::device::{short_profiles, short_table_profiles};
use crate::harness::Bench;
use crate::idle::{assert_same_outputs, drive_core, flat};
use crate::interpreter::State;
use hapticore_contract::profile::Profile;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::interpretations::netlist::Netlist;
use hapticore_model::blocks::core::{self, Core};

/// Slots of each profile.
const SLOTS: u64 = if cfg!(optimised) { 8 } else { 1 };

#[test]
fn every_profile_elaborates() {
    for profile in Profile::all() {
        let netlist = Netlist::of(&Core::new(&profile));
        assert_eq!(netlist.top().name, "hapticore");
    }
}

#[test]
fn the_netlist_runs_as_the_clocked_model_does() {
    for profile in short_profiles().into_iter().chain(short_table_profiles()) {
        let core = Core::new(&profile);
        let netlist = Netlist::of(&core);
        let mut state = State::new(&netlist, netlist.top());
        let mut bench = Bench::new(core);
        let names: Vec<String> =
            bench.registers().map(|(v, _)| v.scope.join(".") + "." + &v.name).collect();
        let mut order = None;
        drive_core(&profile, SLOTS, |inputs| {
            let codes: Vec<i128> =
                flat::<core::Inputs>(inputs).into_iter().map(i128::from).collect();
            let outputs = state.clock(&netlist, netlist.top(), &codes);
            let mut outputs = outputs.into_iter().map(|code| code as i64);
            let got = core::Outputs::map(bench.clock(inputs), |code| code);
            let expected =
                core::Outputs::map(bench.block.outputs(), |format| match format.is_none() {
                    true => 0,
                    false => outputs.next().expect("as many outputs"),
                });
            assert_same_outputs::<Core>(bench.clock, inputs, got, expected);
            compare_registers(&netlist, &state, &bench, &names, &mut order);
            got
        });
    }
}

/// Holds that the registers are the same; `order` is where each of the bench's lies among the
/// state's.
fn compare_registers(
    netlist: &Netlist,
    state: &State,
    bench: &Bench<Core>,
    names: &[String],
    order: &mut Option<Vec<usize>>,
) {
    let mut interpreted = Vec::new();
    state.registers(netlist, netlist.top(), netlist.top().name, &mut interpreted);
    let place = |name: &String| {
        interpreted.iter().position(|(other, _)| other == name).expect("the same registers")
    };
    let order = order.get_or_insert_with(|| names.iter().map(place).collect());
    let mut codes = Vec::new();
    hapticore_hdl::probe::sample(&bench.block, &bench.state, &mut codes);
    for ((name, code), &at) in names.iter().zip(codes).zip(order.iter()) {
        let reference = interpreted[at].1;
        assert_eq!(i128::from(code), reference, "clock {}: {name}: clocked, netlist", bench.clock);
    }
}
