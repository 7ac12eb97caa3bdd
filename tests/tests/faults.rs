// SPDX-License-Identifier: MIT OR Apache-2.0
//! A deliberate fault in a printed operator makes lock-step fail, and say at which clock, in which signal, with which values.
//!
//! Every shape of the printer that can be wrong is a place for a fault: its sign, its width, its rounding, its latency. For each
//! module of the core and each of these kinds, the places are taken as they are printed, in three parts, and in each part
//! they are tried until a fault is noticed. Not every place can be: a top bit is for −1 · −1 only, a rail for what the range
//! proof says never happens, a clock more for a value that is held anyway, a tie comes once in thousands of words. Those
//! passed by are printed.
//!
//! The test fails where no fault of a kind is noticed in a module that has places for it, and where more than a third of all that
//! are tried are passed by. `FAULTS=all` tries every place (minutes) and lists what is not noticed.

use std::collections::BTreeMap;
use std::sync::Mutex;

use hapticore_tests::faults::{Fault, Kind, Planted};
use hapticore_tests::lockstep::verilator::{Given, Start, Verilated};
use hapticore_tests::lockstep::{Bench, Mismatch};
use hapticore_tests::{stimulus, tools};

/// Into how many parts the places of a module and kind are divided.
const PARTS: usize = 3;

/// Faults of one module and kind, by number.
type Places<'a> = Vec<(usize, &'a Fault)>;

#[derive(Default)]
struct Tried {
    noticed: Vec<(String, Mismatch)>,
    passed_by: Vec<String>,
}

/// The faults by module and kind.
fn groups(planted: &Planted) -> Vec<Places<'_>> {
    let mut groups: BTreeMap<(&str, Kind), Places> = BTreeMap::new();
    for (index, fault) in planted.faults.iter().enumerate() {
        groups.entry((&fault.module, fault.kind)).or_default().push((index + 1, fault));
    }
    groups.into_values().collect()
}

fn first_mismatch(traces: &[Given], number: usize) -> Option<Mismatch> {
    traces.iter().find_map(|trace| trace.check(number).err())
}

/// Tries faults of each part, until one is noticed, or all.
fn tried(traces: &[Given], places: &Places, all: bool) -> Tried {
    let mut tried = Tried::default();
    for part in places.chunks(places.len().div_ceil(PARTS)) {
        for &(number, fault) in part {
            match first_mismatch(traces, number) {
                Some(mismatch) => tried.noticed.push((fault.to_string(), mismatch)),
                None => tried.passed_by.push(fault.to_string()),
            }
            if !all && tried.noticed.last().is_some_and(|(last, _)| *last == fault.to_string()) {
                break;
            }
        }
    }
    tried
}

/// All groups, two at a time.
fn all_tried(traces: &[Given], groups: &[Places]) -> Vec<Tried> {
    let all = std::env::var("FAULTS").is_ok_and(|which| which == "all");
    let (open, done) = (Mutex::new(groups.iter()), Mutex::new(Vec::new()));
    let next = || open.lock().expect("no panic").next();
    let work = || {
        while let Some(places) = next() {
            let tried = tried(traces, places, all);
            done.lock().expect("no panic").push(tried);
        }
    };
    std::thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(work))));
    done.into_inner().expect("no panic")
}

fn report(tried: &Tried) {
    for (fault, mismatch) in &tried.noticed {
        println!("noticed: {fault}\n    {mismatch}");
    }
    for fault in &tried.passed_by {
        println!("passed by: {fault}");
    }
}

#[test]
fn faults_of_each_kind_in_each_module_are_noticed() {
    if !tools::have(&["verilator", "make", "g++"]) {
        return;
    }
    let bench = Bench::new("small");
    let planted = Planted::new(&bench.design);
    let verilated = Verilated::new(bench.design.top(), &bench.design.ports, &planted.verilog, Start::Zero);
    let traces = [1, 2, 3, 4].map(|seed| verilated.given(bench.record(stimulus::tones(&bench.profile, seed, 8))));
    assert_eq!(first_mismatch(&traces, 0), None, "without a fault");
    let tried = all_tried(&traces, &groups(&planted));
    tried.iter().for_each(report);
    let noticed: usize = tried.iter().map(|tried| tried.noticed.len()).sum();
    let passed_by: usize = tried.iter().map(|tried| tried.passed_by.len()).sum();
    println!("{noticed} faults noticed, {passed_by} passed by, of {} places", planted.faults.len());
    let missed: Vec<_> = tried.iter().filter(|tried| tried.noticed.is_empty()).map(|tried| &tried.passed_by).collect();
    assert!(missed.is_empty(), "no fault of a kind is noticed in a module: {missed:#?}");
    assert!(2 * passed_by <= noticed, "{passed_by} passed by, {noticed} noticed");
}
