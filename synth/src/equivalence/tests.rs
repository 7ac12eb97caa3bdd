// SPDX-License-Identifier: MIT OR Apache-2.0
//! Mutants that are equivalent under a schedule, and others.

use super::SideBySide;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::interpretations::netlist::Netlist;
use hapticore_hdl::interpretations::netlist::mutants::Mutant;
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{Wrap, bit};

const NUMBER: Format = Format::unsigned(4, 0);

hapticore_hdl::block! {
    /// Doubles a number, keeps the result and gives the one before with it.
    pub struct Doubler("doubler") {}
    submodules {
        kept: Memory,
    }
    inputs(block) { start: BIT, number: NUMBER }
    outputs(block) { done: BIT, twice: NUMBER, before: NUMBER }
    registers(block) { number: NUMBER, twice: NUMBER, busy: BIT, done: BIT }
}

impl Block for Doubler {
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let before = self.kept.data(&mut state.submodules.kept);
        let address = bit(false);
        let write = Write { enable: r.done, address, data: r.twice };
        self.kept.access(&mut state.submodules.kept, address, write);
        let twice = (r.number + r.number).resize(NUMBER, Wrap);
        let next = Registers {
            number: i.start.select(i.number, r.number),
            // While it starts, nothing waits for the result of the number before.
            twice: (r.busy & !i.start).select(twice, r.twice),
            busy: i.start,
            done: r.busy & !i.start,
        };
        state.store(self, next);
        Outputs { done: r.done, twice: r.twice, before }
    }
}

fn netlist() -> Netlist {
    Netlist::of(&Doubler { kept: Memory::new("kept", 2, NUMBER) })
}

/// The mutants that are left after starts every `period` clocks; results are compared as they are done.
fn left(period: usize) -> Vec<String> {
    let netlist = netlist();
    let all = Mutant::all(&netlist, netlist.top()).into_iter().map(|mutant| mutant.to_string());
    let mutants = all.map(|name| {
        let (mutated, starts) = Mutant::netlist(&netlist, &name).expect("a mutant");
        (name, mutated, starts)
    });
    let mut designs = SideBySide::new(&netlist, mutants);
    let mut seen = Vec::new();
    for clock in 0..6 * period {
        let start = designs.known(i64::from(clock % period == 0), BIT);
        let inputs = [start, designs.unknown(NUMBER)];
        designs.clock(&inputs, |port, sound| port == 0 || sound[0] == Some(1));
        if clock % period == 0 {
            seen.push(designs.knowledge(&mut []));
        }
        if clock == 3 * period {
            designs.forget(&mut []);
        }
    }
    assert_eq!(seen[4], seen[5], "what is known repeats");
    designs.names().to_vec()
}

#[test]
fn what_a_schedule_never_does_changes_nothing() {
    let left = left(5);
    let is_left = |place: &str| left.iter().any(|name| *name == format!("doubler.{place}"));
    for equivalent in [
        "number: missing reset",
        "twice: missing reset",
        "twice of start: missing clear",
        "done of start: missing clear",
        "kept.write enable: stale operand",
    ] {
        assert!(is_left(equivalent), "{equivalent}: {left:?}");
    }
    for other in [
        "done: missing reset",
        "busy of start: missing clear",
        "done: sticky flag",
        "busy: held one clock",
        "kept.write data: stale operand",
        "sum 0 operand 0: stale operand",
    ] {
        assert!(!is_left(other), "{other}: {left:?}");
    }
}

#[test]
fn a_denser_schedule_reaches_more() {
    let left = left(1);
    assert!(!left.iter().any(|name| name == "doubler.done of start: missing clear"), "{left:?}");
}
