// SPDX-License-Identifier: MIT OR Apache-2.0
//! The blocks of a board in lock-step with what is printed of them, and every fault that is planted
//! in their text noticed.
//!
//! Faults are those of `tests/tests/faults.rs`, at every place of every block; `board_faults/`
//! lists those that change nothing. The iCEBreaker's blocks are tried always, those of all boards
//! with `FAULTS=all`.

use std::collections::BTreeSet;

use hapticore_rtl::board::Target;
use hapticore_synth::certificates::Subject;
use hapticore_tests::faults::Planted;
use hapticore_tests::faults::campaign::{self, two_at_a_time};
use hapticore_tests::lockstep::verilator::{Start, Verilated};
use hapticore_tests::peripherals::{Alone, blocks};

/// Faults that change nothing, each under its reason (`#`).
fn none(target: Target) -> &'static str {
    match target {
        Target::Icebreaker => include_str!("board_faults/icebreaker.txt"),
        Target::Ulx3s => include_str!("board_faults/ulx3s.txt"),
    }
}

/// Which faults of a block nobody notices, and how many there are.
fn survivors(target: Target, Alone { design, trace }: &Alone) -> (Vec<String>, usize) {
    let planted = Planted::new(design);
    // Those of a block within are tried with that block.
    let own = (1..).zip(&planted.faults).filter(|(_, fault)| fault.module == design.top());
    let own: Vec<(usize, _)> = own.collect();
    let subject = Subject::new()
        .and(&planted.verilog)
        .and(trace.bytes())
        .and(include_str!("board_faults.rs"));
    let missed = campaign::missed(design.top(), subject, || {
        let verilog = planted.alone(design.top());
        let compiled = Verilated::new("alone", &design.ports, &verilog, Start::Zero);
        let given = compiled.with_trace(trace.clone());
        assert_eq!(given.check(0), Ok(()), "{target:?}, {}", design.top());
        own.iter()
            .map(|(number, _)| *number)
            .filter(|number| given.check(*number).is_ok())
            .collect()
    });
    let tried = own.len();
    println!("{target:?}, {}: {} of {tried} faults noticed", design.top(), tried - missed.len());
    let survivors = own.iter().filter(|(number, _)| missed.contains(number));
    (survivors.map(|(_, fault)| fault.to_string()).collect(), tried)
}

#[test]
#[cfg_attr(
    not(all(tool = "verilator", tool = "make", tool = "g++")),
    ignore = "needs verilator, make, g++: ./test fetches what is missing"
)]
fn faults_in_the_blocks_of_a_board_are_noticed() {
    let targets: &[Target] = if campaign::all() { &Target::ALL } else { &[Target::Icebreaker] };
    for &target in targets {
        let found = two_at_a_time(&blocks(target), |block| survivors(target, block));
        let tried: usize = found.iter().map(|(_, tried)| tried).sum();
        let missed: BTreeSet<&str> =
            found.iter().flat_map(|(missed, _)| missed).map(String::as_str).collect();
        println!("{target:?}: {} of {tried} faults noticed", tried - missed.len());
        missed.iter().for_each(|fault| println!("not noticed: {fault}"));
        let none = campaign::equivalent(none(target));
        let survivors: Vec<_> = missed.difference(&none).collect();
        assert!(survivors.is_empty(), "{target:?}, not noticed: {survivors:#?}");
        let stale: Vec<_> = none.difference(&missed).collect();
        assert!(stale.is_empty(), "{target:?}, noticed after all, or not tried: {stale:#?}");
    }
}
