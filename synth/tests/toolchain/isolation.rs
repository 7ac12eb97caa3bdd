// SPDX-License-Identifier: MIT OR Apache-2.0
//! Nothing of one pad's slot can change another's frame, whatever the inputs; and what would let it
//! is found.

use hapticore_contract::profile::Profile;
use hapticore_hdl::interpretations::netlist::{Module, Named, Netlist, Op};
use hapticore_model::blocks::core::Core;
use hapticore_rtl::netlist;
use hapticore_synth::isolation::{Seen, State};

/// A profile with slots as short as they may be: what happens within does not depend on their
/// length.
pub(super) fn short(mut profile: Profile) -> Profile {
    let samples = 4 * profile.samples_per_period().round() as u64;
    profile = profile.with_window(samples);
    profile.slot.open = 2;
    profile.slot.settle = 0;
    while hapticore_model::check(&profile).is_err() {
        profile.slot.settle += 1;
        assert!(
            profile.slot.settle < 10_000,
            "{}: {:?}",
            profile.name,
            hapticore_model::check(&profile)
        );
    }
    profile
}

pub(super) fn place(ports: &[Named], name: &str) -> usize {
    ports.iter().position(|port| port.name == name).unwrap_or_else(|| panic!("no port {name}"))
}

/// What is found of a pad's frames.
#[derive(Debug, PartialEq, Eq)]
enum Found {
    /// The number of words, all its own.
    Own(usize),
    /// A word or flag that another pad may reach: in which round and field.
    Reached(u64, String),
    /// It goes on changing.
    Open,
}

/// Follows the core for three rounds. Of the codes, those in the slots of `pad` are the same in
/// both runs; the others are not, nor any in the pad's own slots if `own` is not set.
fn follow(netlist: &Netlist, profile: &Profile, pad: u64, own: bool) -> Found {
    let top: &Module = netlist.top();
    let mut state = State::new(netlist, top);
    state.calibrate(netlist, top, "map", "words");
    let (strobe, code, write) =
        (place(&top.inputs, "strobe"), place(&top.inputs, "code"), place(&top.inputs, "write"));
    let output = |name: &str| place(&top.outputs, name);
    let (valid, whose) = (output("valid"), output("pad"));
    let mut inputs = vec![Seen::Same; top.inputs.len()];
    inputs[write] = Seen::Known(0);
    inputs[place(&top.inputs, "clear")] = Seen::Known(0);
    let (mut words, mut rounds) = (0, Vec::new());
    for round in 0..3 {
        for slot in 0..profile.pads {
            inputs[code] = if slot == pad && own { Seen::Same } else { Seen::Other };
            for clock in 0..profile.slot.samples() * profile.clocks_per_sample {
                inputs[strobe] =
                    Seen::Known(i64::from(clock.is_multiple_of(profile.clocks_per_sample)));
                let outputs = state.clock(netlist, top, &inputs);
                for schedule in ["valid", "index", "done", "pad", "serve", "closed", "channel"] {
                    let seen = outputs[output(schedule)];
                    assert!(
                        matches!(seen, Seen::Known(_)),
                        "the schedule is known: {schedule} is {seen:?}"
                    );
                }
                if outputs[valid] == Seen::Known(1) && outputs[whose] == Seen::Known(pad as i64) {
                    words += 1;
                    for field in ["frame", "clipped", "saturated", "invalid", "lost", "lifted"] {
                        if outputs[output(field)] == Seen::Other {
                            return Found::Reached(round, field.into());
                        }
                    }
                }
            }
        }
        rounds.push(state.clone());
    }
    if rounds[1] == rounds[2] { Found::Own(words) } else { Found::Open }
}

fn netlist(profile: &Profile) -> Netlist {
    netlist::of_core(&Core::new(profile))
}

#[test]
fn no_pad_reaches_anothers_frame() {
    for profile in Profile::of_distinct_words().into_iter().map(short) {
        let netlist = netlist(&profile);
        for pad in 0..profile.pads {
            // The last pad's third frame comes after the third round.
            let frames = if pad == profile.pads - 1 { 2 } else { 3 };
            assert_eq!(
                follow(&netlist, &profile, pad, true),
                Found::Own(8 * frames),
                "{}, pad {pad}",
                profile.name
            );
        }
    }
}

#[test]
fn the_slots_of_the_boards_are_followed_as_they_are() {
    let profile = Profile::bundled("small").expect("bundled");
    assert_eq!(follow(&netlist(&profile), &profile, 1, true), Found::Own(8 * 3));
}

#[test]
fn a_pads_own_codes_reach_its_frame() {
    let profile = short(Profile::bundled("small").expect("bundled"));
    assert_eq!(follow(&netlist(&profile), &profile, 1, false), Found::Reached(0, "frame".into()));
}

/// The netlist with one module changed.
fn changed(netlist: &Netlist, name: &str, change: impl Fn(&mut Module) -> bool) -> Netlist {
    let mut netlist = netlist.clone();
    let module = netlist.modules.iter_mut().find(|module| module.name == name).expect("a module");
    assert!(change(module), "{name} has what is to be changed");
    netlist
}

/// A sum that goes on from the window before: the selection of a zero in its place is gone.
fn keep(module: &mut Module) -> bool {
    let wires = module.wires.clone();
    let mut found = false;
    for wire in &mut module.wires {
        if let Op::Select(bit, a, b) = wire.op {
            let zero = wires[a.0 as usize].op == Op::Constant(0);
            if zero && matches!(wires[b.0 as usize].op, Op::Data(_)) {
                (wire.op, found) = (Op::Select(bit, b, b), true);
            }
        }
    }
    found
}

/// Words held for a pad lie where every pad's do.
fn mix(module: &mut Module) -> bool {
    let inputs: Vec<_> =
        module.inputs.iter().filter(|input| input.name == "pad").map(|input| input.node).collect();
    for node in &inputs {
        module.wires[node.0 as usize].op = Op::Constant(0);
    }
    !inputs.is_empty()
}

#[test]
fn a_leak_is_found() {
    let profile = short(Profile::bundled("small").expect("bundled"));
    let netlist = netlist(&profile);
    let leaks = [
        ("demodulator", changed(&netlist, "demodulator", keep)),
        ("frames", changed(&netlist, "frames", mix)),
    ];
    for (name, leak) in leaks {
        let found = follow(&leak, &profile, 1, true);
        assert!(matches!(found, Found::Reached(..)), "{name}: {found:?}");
    }
}
