// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which mutants a small block has, and what each does.

use super::Mutant;
use crate::block::{Block, Interpretation, State};
use crate::format::{BIT, Format};
use crate::interpretations::netlist::Netlist;
use crate::signal::{Wrap, bit, int};

crate::block! {
    /// Counts; `full` says that the last count was 3.
    pub struct Counter("counter") {}
    submodules {}
    inputs(block) { enable: BIT, clear: BIT }
    outputs(block) { count: Format::unsigned(2, 0), full: BIT }
    registers(block) { count: Format::unsigned(2, 0), full: BIT }
}

impl Block for Counter {
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let count = (r.count + i.enable).resize(r.count.format, Wrap);
        let count = i.clear.select(int(0), count).resize(r.count.format, Wrap);
        let full = (!i.clear & r.count.is(3)) | (i.clear & bit(false));
        state.store(self, Registers { count, full });
        Outputs { count: r.count, full: r.full }
    }
}

/// Counts and flags of a counter that is cleared in the third clock of eight.
fn run(mutant: &str) -> [Vec<i64>; 2] {
    let mut simulation = Mutant::simulation(&Netlist::of(&Counter {}), mutant).expect(mutant);
    let mut clock = |clock| simulation.clock(&[1, i64::from(clock == 2)]);
    let outputs: Vec<_> = (0..8).map(&mut clock).collect();
    [0, 1].map(|port| outputs.iter().map(|codes| codes[port]).collect())
}

#[test]
fn every_class_has_its_places() {
    let netlist = Netlist::of(&Counter {});
    let names: Vec<_> =
        Mutant::all(&netlist, netlist.top()).iter().map(ToString::to_string).collect();
    assert_eq!(
        names,
        [
            "counter.count: missing reset",
            "counter.full: missing reset",
            "counter.count of clear: missing clear",
            "counter.full of clear: missing clear",
            "counter.full: sticky flag",
            "counter.full: held one clock",
            "counter.sum 0 operand 0: stale operand",
            "counter.sum 0 operand 1: stale operand",
        ]
    );
}

#[test]
fn mutants_are_what_they_are_called() {
    let quiet = vec![0; 3];
    let full = |rest: [i64; 5]| [quiet.clone(), rest.to_vec()].concat();
    let right = [vec![0, 1, 2, 0, 1, 2, 3, 0], full([0, 0, 0, 0, 1])];
    let cases = [
        ("count: missing reset", [vec![3, 0, 1, 0, 1, 2, 3, 0], vec![0, 1, 0, 0, 0, 0, 0, 1]]),
        ("full: missing reset", [right[0].clone(), vec![1, 0, 0, 0, 0, 0, 0, 1]]),
        ("count of clear: missing clear", [vec![0, 1, 2, 3, 0, 1, 2, 3], full([0, 1, 0, 0, 0])]),
        ("full: held one clock", [right[0].clone(), full([0, 0, 0, 0, 0])]),
        ("sum 0 operand 0: stale operand", [vec![0, 1, 1, 0, 2, 1, 3, 2], full([0, 0, 0, 0, 1])]),
    ];
    for (mutant, expected) in cases {
        assert_eq!(run(&format!("counter.{mutant}")), expected, "{mutant}");
    }
}

#[test]
fn a_flag_sticks() {
    let mut simulation =
        Mutant::simulation(&Netlist::of(&Counter {}), "counter.full: sticky flag").expect("it has");
    let flags: Vec<_> = (0..9).map(|_| simulation.clock(&[1, 0])[1]).collect();
    assert_eq!(flags, [0, 0, 0, 0, 1, 1, 1, 1, 1]);
}

#[test]
fn a_design_without_the_place_has_no_mutant() {
    let netlist = Netlist::of(&Counter {});
    for name in ["counter.none: sticky flag", "count.full: sticky flag", "counter: sticky flag"] {
        assert!(Mutant::simulation(&netlist, name).is_none(), "{name}");
    }
}
