// SPDX-License-Identifier: MIT OR Apache-2.0
//! Terms and problems of small blocks that have every operation, narrowing and part, against the
//! committed text. That the relation is the model's, and that solvers decide it, is the matter of
//! the tests of assumptions; this holds each piece of text where it is made.

use super::bits::{any, extend, literal};
use super::places::Place;
use super::state::{At, Unrolled};
use super::{Property, System};
use crate::format::Format;
use crate::interpretations::netlist::Netlist;
use crate::verilog::tests::narrowings::Narrowings;
use crate::verilog::tests::{check_text, parts, store};

#[test]
fn every_narrowing_is_a_term() {
    let netlist = Netlist::of(&Narrowings {});
    let places = Place::all(&netlist, &netlist.modules[0]);
    let mut unrolled = Unrolled::new(&places, false);
    let mut text = String::new();
    for output in &netlist.top().outputs {
        text += &format!("; {} = {}\n", output.name, unrolled.term(At::top(0), output.node));
    }
    text += &unrolled.finish().0;
    check_text("smt/tests/narrowings.smt2", include_str!("tests/narrowings.smt2"), &text);
}

#[test]
fn every_part_is_in_the_problems() {
    let netlist = Netlist::of(&parts::parts());
    let system = System::of(&netlist, netlist.modules.len() - 1);
    let [(_, small), (_, half)] = system.invariants()[..] else { panic!("two invariants") };
    let [(name, claim)] = system.claims()[..] else { panic!("one assumption") };
    let Property::Claim(wire, 0) = claim else { panic!("{claim:?}") };
    assert_eq!((name, system.name()), ("counts are small", "parts"));
    let problems = [
        ("base of an invariant", system.base(small, 2)),
        ("base of the claim", system.base(claim, 1)),
        ("step of an invariant", system.step(half, 1)),
        ("step of the claim", system.step(claim, 1)),
        ("step of the claim with a bit less", system.step(Property::Claim(wire, 1), 0)),
    ];
    let mut text = String::new();
    for (name, problem) in problems {
        let variables: Vec<String> =
            problem.variables.iter().map(|of| format!("{} {}", of.name, of.format)).collect();
        text += &format!("; {name}: {}\n{}\n", variables.join(", "), problem.text);
    }
    check_text("smt/tests/problems.smt2", include_str!("tests/problems.smt2"), &text);
}

#[test]
fn memories_are_arrays_in_the_problems() {
    let netlist = Netlist::of(&store::store());
    let system = System::of(&netlist, 0);
    let mut text = String::new();
    for (name, claim) in system.claims() {
        text += &format!("; base of {name}\n{}\n", system.base(claim, 3).text);
        text += &format!("; step of {name}\n{}\n", system.step(claim, 1).text);
    }
    check_text("smt/tests/store.smt2", include_str!("tests/store.smt2"), &text);
}

#[test]
fn a_trace_is_compared_with_the_relation() {
    let netlist = Netlist::of(&parts::parts());
    let system = System::of(&netlist, netlist.modules.len() - 1);
    let names = ["step", "count", "idle", "last", "kept", "a.sum", "b.sum", "wide.sum"];
    let registers =
        |codes: [i64; 8]| names.map(str::to_owned).into_iter().zip(codes).collect::<Vec<_>>();
    let trace = [registers([0; 8]), registers([1, 0, 0, -2, -3, 5, 6, 7]), registers([1; 8])];
    let problem = system.replay(&trace, &[vec![1, -9, 5], vec![0, 7, 2], vec![0, 0, 0]]);
    check_text("smt/tests/replay.smt2", include_str!("tests/replay.smt2"), &problem.text);
}

#[test]
fn terms_are_bit_vectors() {
    assert_eq!(literal(-1, 5), "(_ bv31 5)");
    assert_eq!(literal(-1, 127), format!("(_ bv{} 127)", i128::MAX));
    assert_eq!(literal(-1, 128), format!("(_ bv{} 128)", u128::MAX));
    let [signed, unsigned] = [Format::signed(3, 0), Format::unsigned(3, 0)];
    assert_eq!(extend("a", signed, 5), "((_ sign_extend 2) a)");
    assert_eq!(extend("a", unsigned, 5), "((_ zero_extend 2) a)");
    assert_eq!(
        (extend("a", signed, 3), extend("a", Format::NONE, 1)),
        ("a".to_string(), "a".to_string())
    );
    let terms = ["a", "b"].map(str::to_owned);
    assert_eq!([&terms[..0], &terms[..1], &terms].map(any), ["false", "a", "(or a b)"]);
}
