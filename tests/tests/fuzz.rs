// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every fuzz target on its committed corpus, its seeds and mutations of both: what a fuzzer has
//! found once stays found, and what it would find immediately is found here (docs/fuzzing.md).

#[path = "fuzz/values.rs"]
mod values;

use std::fs;
use std::path::Path;

use hapticore_tests::fuzz::{Mutations, run, seeds};

/// The committed inputs of a target.
fn corpus(target: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus-seed").join(target);
    let mut paths: Vec<_> = fs::read_dir(&folder)
        .unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    paths.iter().map(|path| fs::read(path).expect("a file")).collect()
}

/// Runs a target on its corpus and seeds, and on `mutations` mutations of what is accepted: those of
/// what is refused immediately try little.
fn hold(target: &'static str, mutations: usize) {
    let mut all = corpus(target);
    all.extend(seeds::of(target));
    all.retain(|data| run(target, data));
    assert!(!all.is_empty(), "{target}: nothing is accepted");
    let accepted =
        Mutations::new(target, all, 1).take(mutations).filter(|data| run(target, data)).count();
    println!("{target}: {accepted} of {mutations} mutations accepted");
    assert!(accepted > 0 && accepted < mutations, "{target}: {accepted} of {mutations} accepted");
}

#[test]
fn profiles() {
    hold("profile", 2000);
}

#[test]
fn scenes() {
    hold("scene", 1000);
}

#[test]
fn calibrations() {
    hold("calibration", 500);
}

#[test]
fn csv_captures() {
    hold("csv", 5000);
}

#[test]
fn wav_captures() {
    hold("wav", 5000);
}

#[test]
fn sigmf_captures() {
    hold("sigmf", 5000);
}

#[test]
fn tunings() {
    hold("tuning", 500);
}

#[test]
fn sweep_plans() {
    hold("plan", 200);
}

#[test]
fn lab_measurements() {
    hold("lab", 200);
}

#[test]
fn options_of_commands() {
    hold("options", 2000);
}

#[test]
fn packets() {
    hold("packets", 5000);
}

#[test]
fn commands_to_boards() {
    hold("board_commands", 5000);
}

#[test]
fn cores() {
    hold("core", 30);
}
