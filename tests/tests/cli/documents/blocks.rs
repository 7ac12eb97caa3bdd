// SPDX-License-Identifier: MIT OR Apache-2.0
//! Blocks that are no commands: each language has a check, so that a block of a new kind does not stand unread.

use std::fs;
use std::process::Command;

use hapticore_host::DeviceCalibration;
use hapticore_sweep::plan::Plan;
use hapticore_tests::fuzz::seeds;
use hapticore_tests::tools::have;
use toml::Table;

use super::FOLLOWED;
use super::extract::Block;
use crate::expect;

/// What is held of a block, by language and page.
fn check(block: &Block, before: &[Block]) {
    let (page, _) = block.place.split_once(':').expect("page and line");
    match (block.head.as_str(), page) {
        // Commands: `parse.rs` and `running.rs`. Diagrams, output and formulas: no code.
        ("sh" | "text" | "math", _) | (_, FOLLOWED) => (),
        ("toml", "docs/sweep.md") => plan(block, before),
        ("toml", "docs/formats.md") => calibration(block),
        ("csv", "docs/formats.md") => capture(block),
        // The line's frames: `host/protocol`. Its library is not of this project.
        ("python", "docs/boards.md") => python(block),
        (head, _) => panic!("{}: a block of \"{head}\" that nothing checks", block.place),
    }
}

#[test]
fn every_block_has_a_check() {
    let blocks = super::all_blocks();
    for (number, block) in blocks.iter().enumerate() {
        check(block, &blocks[..number]);
    }
    assert!(blocks.len() > 30, "{} blocks are found", blocks.len());
}

/// A plan is read; the page's second one has the axes of its first replaced.
fn plan(block: &Block, before: &[Block]) {
    let first = before.iter().rfind(|other| other.head == "toml").map(|first| first.text.as_str());
    let head = first.and_then(|first| first.split_once("[axes.")).map_or("", |(head, _)| head);
    let whole = block.text.starts_with("scene = ");
    let text = if whole { block.text.clone() } else { format!("{head}\n{}", block.text) };
    let plan =
        Plan::parse(&text, "plan.toml").unwrap_or_else(|error| panic!("{}: {error}", block.place));
    assert!(plan.len() > 1, "{}: {} points", block.place, plan.len());
}

/// A calibration is read, once its two abridged arrays are whole.
fn calibration(block: &Block) {
    let mut calibration: Table =
        block.text.parse().unwrap_or_else(|error| panic!("{}: {error}", block.place));
    let whole: Table =
        String::from_utf8(seeds::of("calibration").swap_remove(0)).unwrap().parse().unwrap();
    for key in ["columns", "places"] {
        calibration["map"][key] = whole["map"][key].clone();
    }
    let row = calibration["force"]["rows"][0].clone();
    calibration["force"]["rows"] = vec![row; 11].into();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    fs::write(&path, calibration.to_string()).unwrap();
    DeviceCalibration::read(&path).unwrap_or_else(|error| panic!("{}: {error}", block.place));
}

/// A capture is replayed, its row repeated for a slot.
fn capture(block: &Block) {
    let folder = tempfile::tempdir().unwrap();
    let row = block.text.lines().last().unwrap();
    fs::write(
        folder.path().join("c.csv"),
        format!("{}{}", block.text, format!("{row}\n").repeat(2000)),
    )
    .unwrap();
    expect(folder.path(), &["replay", "c.csv", "--pads", "1", "--out", "results"], 0);
}

/// Python is compiled.
fn python(block: &Block) {
    if !have(&["python3"]) {
        return;
    }
    let compile = format!("compile({:?}, 'block', 'exec')", block.text);
    let output = Command::new("python3").args(["-c", &compile]).output().unwrap();
    assert!(
        output.status.success(),
        "{}: {}",
        block.place,
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
#[should_panic(expected = "that nothing checks")]
fn a_block_of_a_new_kind_is_noticed() {
    check(&Block { place: "docs/x.md:1".into(), head: "yaml".into(), text: String::new() }, &[]);
}
