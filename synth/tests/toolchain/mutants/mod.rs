// SPDX-License-Identifier: MIT OR Apache-2.0
//! Mutants of blocks that no test notices and that change no output: proved by clocking them beside the sound design on
//! unknown codes ([`hapticore_synth::equivalence`]).
//!
//! | list | proof |
//! | --- | --- |
//! | `equivalent.txt` | of the block alone, whatever its inputs, in each design that has it |
//! | `equivalent_in_cores.txt` | in cores: a strobe every [`Profile::clocks_per_sample`] clocks from reset on, and a `clear` in some clocks of a round of all pads |
//!
//! In cores, rounds are followed until what is known repeats: then it holds for ever. Slots are as short as they may be,
//! since what happens within does not depend on their length. Codes and calibration are any. The position table is not
//! written meanwhile.
//!
//! `MUTANTS=all` follows every mutant that the tests of the blocks do not notice, in every design, and says where it belongs.

mod cores;

use cores::{CLEARS, Core};
use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::{Profile, Wall};
use hapticore_hdl::interpretations::netlist::Netlist;
use hapticore_hdl::interpretations::netlist::mutants::Mutant;
use hapticore_rtl::board::drive_output::serial::Frame;
use hapticore_rtl::board::drive_output::{Converter, Wave};
use hapticore_rtl::board::{Board, Parameters};
use hapticore_rtl::netlist::{of_board, of_profile};
use hapticore_synth::equivalence::block::is_equivalent;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Mutex;

/// The folders of the lists.
const CORE: &str = "model/src/blocks";
const BOARD: &str = "rtl/tests/board";

/// The lines of a list of mutants.
fn listed(folder: &str, list: &str) -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(folder).join(list);
    let text = std::fs::read_to_string(path).expect("a list");
    text.lines().filter(|line| !line.starts_with('#')).map(String::from).collect()
}

/// The blocks of designs: each netlist once.
fn blocks(designs: Vec<Netlist>) -> Vec<Netlist> {
    let mut all: Vec<Netlist> = Vec::new();
    for design in designs {
        for index in 0..design.modules.len() {
            if !all.iter().any(|own| *own.top() == design.modules[index]) {
                all.push(Netlist { modules: design.modules[..=index].to_vec() });
            }
        }
    }
    all
}

/// Force loops with walls, of each rule and number of parts.
fn loops() -> Vec<Netlist> {
    let walls = [Wall::A, Wall::B, Wall::QUADRANTS];
    let of = |name: &str, wall: Wall| {
        let profile = Profile::bundled(name).expect("bundled");
        let control = Some(Control::of(&profile, Law::Inverse));
        let profile = Profile { control, wall: Some(wall), pads: 2 * wall.parts, ..profile };
        of_profile(&profile).expect("a force loop")
    };
    walls.into_iter().map(|wall| of("small", wall)).collect()
}

/// Boards, with a drive of each converter and without.
fn boards() -> Vec<Netlist> {
    let drives = [
        None,
        Some((Wave::Dc, Converter::Pulses)),
        Some((Wave::Square { turn_slots: 5 }, Converter::Serial(Frame::AD5664))),
        Some((Wave::Sine { points: 16, point_clocks: 20 }, Converter::Parallel { bits: 12 })),
    ];
    let of = |drive: Option<(Wave, Converter)>| {
        let mut profile = Profile::bundled("small").expect("bundled");
        profile.pads = 1;
        profile.control = drive.map(|_| Control::of(&profile, Law::Inverse));
        let drive = drive.map(Into::into);
        let parameters =
            Parameters { clock_hz: 12_000_000, baud: 1_000_000, sclk_latency: 2, drive };
        of_board(&Board::new(&profile, &parameters).expect("a board"))
    };
    drives.into_iter().map(of).collect()
}

/// Of these mutants those that are equivalent in each of these blocks that has them.
fn proved_alone(blocks: &[Netlist], names: &[String]) -> BTreeSet<String> {
    let (work, proved) = (Mutex::new(names.iter()), Mutex::new(BTreeSet::new()));
    let has = |block: &&Netlist, name: &str| {
        name.strip_prefix(block.top().name).is_some_and(|rest| rest.starts_with('.'))
            && Mutant::all(block, block.top()).iter().any(|mutant| mutant.to_string() == name)
    };
    let search = || {
        loop {
            let next = work.lock().expect("no panic").next();
            let Some(name) = next else { return };
            let mut own = blocks.iter().filter(|block| has(block, name)).peekable();
            if own.peek().is_some() && own.all(|block| is_equivalent(block, name)) {
                proved.lock().expect("no panic").insert(name.clone());
            }
        }
    };
    std::thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(search))));
    proved.into_inner().expect("no panic")
}

/// Of a list every `step`-th.
fn sample(list: &[String], step: usize) -> Vec<String> {
    list.iter().step_by(step).cloned().collect()
}

/// Holds that what is listed is proved; prints what else is.
fn check(listed: &[String], proved: &BTreeSet<String>, kind: &str) {
    let wrong: Vec<_> = listed.iter().filter(|name| !proved.contains(*name)).collect();
    assert!(wrong.is_empty(), "not proved: {wrong:#?}");
    let new = proved.iter().filter(|name| !listed.contains(name));
    new.for_each(|name| println!("{kind}: {name}"));
}

/// Mutants of `small` that tests notice.
const NOTICED: [&str; 3] = [
    "ratio.done: held one clock",
    "frames.busy: sticky flag",
    "frames.count of start: missing clear",
];

fn asks_for_all() -> bool {
    std::env::var_os("MUTANTS").is_some()
}

/// With `MUTANTS` all in every design; else a sample.
#[test]
fn mutants_that_are_listed_as_equivalent_are() {
    let (cores, listed) = (Core::all(), |list: &str| listed(CORE, list));
    let own = sample(&listed("equivalent.txt"), if asks_for_all() { 1 } else { 12 });
    let mut names = own.clone();
    let mut designs: Vec<_> = cores.iter().map(|core| core.netlist.clone()).collect();
    if asks_for_all() {
        names.extend([listed("equivalent_in_cores.txt"), listed("mutants.txt")].concat());
        designs.extend(loops());
    }
    let noticed = NOTICED.map(String::from);
    let asked = [&names[..], &noticed].concat();
    let proved = proved_alone(&blocks(designs), &asked);
    check(&own, &proved, "alone");
    assert!(noticed.iter().all(|name| !proved.contains(name)), "tests notice them: {proved:?}");
}

/// With `MUTANTS` all in every core; else a sample in the first one, without a `clear`.
#[test]
fn mutants_that_are_listed_as_equivalent_in_cores_are() {
    let (cores, listed) = (Core::all(), |list: &str| listed(CORE, list));
    let noticed = NOTICED.map(String::from);
    let (cores, names, clears) = if asks_for_all() {
        (&cores[..], listed("equivalent_in_cores.txt"), CLEARS)
    } else {
        (&cores[..1], sample(&listed("equivalent_in_cores.txt"), 32), 0)
    };
    let missed = if asks_for_all() { listed("mutants.txt") } else { Vec::new() };
    let [proved, open] = cores::proved(cores, &[&names[..], &missed, &noticed].concat(), clears);
    let asked = |name: &String| proved.contains(name) || open.contains(name);
    let asked: Vec<_> = names.into_iter().filter(asked).collect();
    check(&asked, &proved, "in cores");
    assert!(!proved.is_empty(), "some are proved");
    assert!(noticed.iter().all(|name| open.contains(name)), "tests notice them: {open:?}");
}

/// With `MUTANTS` all; else a sample.
#[test]
fn mutants_that_are_listed_as_equivalent_of_boards_are() {
    let list = listed(BOARD, "equivalent.txt");
    let names = sample(&list, if asks_for_all() { 1 } else { 8 });
    let missed = if asks_for_all() { listed(BOARD, "mutants.txt") } else { Vec::new() };
    let proved = proved_alone(&blocks(boards()), &[&names[..], &missed].concat());
    check(&names, &proved, "alone");
}
