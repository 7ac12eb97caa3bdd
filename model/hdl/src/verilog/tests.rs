// SPDX-License-Identifier: MIT OR Apache-2.0
//! The printed text of small blocks that have every operation, every narrowing and every part,
//! against the committed one. That printed text does what the model does is the matter of
//! lock-step (`tests/tests/lockstep.rs`); this holds each piece of it where it is made.
//!
//! A text that differs is shown whole by a test that fails: it is what to commit, where it is right.

pub(crate) mod narrowings;
pub(crate) mod parts;
pub(crate) mod store;

use super::*;

/// Holds that a text is that of a file of this crate.
pub(crate) fn check_text(path: &str, committed: &str, text: &str) {
    let differ = text.lines().zip(committed.lines()).find(|(line, expected)| line != expected);
    if let Some((line, expected)) = differ {
        panic!("{text}\n{path}\n     got: {line}\nexpected: {expected}");
    }
    assert_eq!(text.len(), committed.len(), "{text}\n{path}: the lengths differ");
}

#[test]
fn every_narrowing_is_printed() {
    let design = Design::of(&narrowings::Narrowings {}, "a test");
    check_text("verilog/tests/narrowings.v", include_str!("tests/narrowings.v"), &design.text());
}

#[test]
fn every_part_is_printed() {
    let heading = Heading {
        command: "a test".into(),
        source: "version 1".into(),
        interface: vec!["For users.".into(), String::new()],
        prefix: PREFIX.into(),
    };
    let design = Design::of(&parts::parts(), heading);
    check_text("verilog/tests/parts.v", include_str!("tests/parts.v"), &design.text());
    assert_eq!(design.top(), "hapticore_parts");
    let ports = design
        .ports
        .iter()
        .map(|port| format!("{:?} {} {}", port.direction, port.name, port.format));
    assert_eq!(
        ports.take(3).collect::<Vec<_>>(),
        ["Input start u1.0", "Input case_2 s5.2", "Input count u3.0"]
    );
}

#[test]
fn memories_and_what_nothing_needs_are_printed() {
    let design = Design::of(&store::store(), "a test");
    check_text("verilog/tests/store.v", include_str!("tests/store.v"), &design.text());
}
