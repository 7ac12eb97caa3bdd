// SPDX-License-Identifier: MIT OR Apache-2.0
//! What fuzzing holds, as functions of bytes: `fuzz/` feeds them for as long as one likes, a test
//! (`tests/tests/fuzz.rs`) with a committed corpus and mutations of it in seconds.
//!
//! | target | bytes are | held |
//! | --- | --- | --- |
//! | `profile` | TOML | what is accepted is read again to the same profile |
//! | `scene` | TOML | each case's document is read again to itself; its plant gives a slot |
//! | `calibration` | TOML | what is accepted is read again to the same calibration; a core's words represent it or it is refused |
//! | `csv`, `wav` | options, then a capture | codes are the ADC's; they are written and read again to the same |
//! | `sigmf` | options, meta data, a zero, samples | codes are the ADC's |
//! | `tuning` | TOML | what is accepted is read again to the same tuning; words of its curve are its numbers |
//! | `plan` | TOML | what is accepted is read again to the same plan; its first and last point have names of their own |
//! | `lab` | setup, places and loads, each ended by a zero | what is accepted makes a calibration that is read again to the same, or is refused |
//! | `options` | words of a command line | what options hold is read or refused; a scene with keys set is read again to the same |
//! | `packets` | a profile, then a line | a message that is heard is sent and heard again to the same; the line recovers |
//! | `board_commands` | a profile, then what a host sends | a command that is heard is sent and heard again to the same; the line recovers |
//! | `core` | choices | a random legal profile, calibration and codes: `clock` = `fixed` = rounded reference |
//!
//! Of every reader: no panic, bounded memory and time, and a refusal is one line that names the place.

mod board_commands;
mod calibration;
mod captures;
pub mod commands;
mod core;
mod lab;
mod mutate;
mod mutations;
mod options;
mod packets;
mod plan;
mod profile;
mod scene;
pub mod seeds;
mod tuning;

pub use mutate::{Bytes, cross, mutate};
pub use mutations::Mutations;

use anyhow::Error;

/// A target: its name, and what is held of bytes; whether they are accepted.
pub type Target = (&'static str, fn(&[u8]) -> bool);

/// All targets.
pub const TARGETS: [Target; 13] = [
    ("profile", profile::check),
    ("scene", scene::check),
    ("calibration", calibration::check),
    ("csv", captures::csv),
    ("wav", captures::wav),
    ("sigmf", captures::sigmf),
    ("tuning", tuning::check),
    ("plan", plan::check),
    ("lab", lab::check),
    ("options", options::check),
    ("packets", packets::check),
    ("board_commands", board_commands::check),
    ("core", core::check),
];

/// Holds of bytes what a target holds; whether they are accepted, rather than refused as they should.
///
/// # Panics
/// Where it does not hold, or there is no such target.
pub fn run(target: &str, data: &[u8]) -> bool {
    let (_, check) = TARGETS.iter().find(|(name, _)| *name == target).expect("a target");
    check(data)
}

/// What is called a file in messages.
const TOML: &str = "fuzz.toml";

/// Holds a refusal to be one line that begins with the name of a file and says something; never
/// accepted.
fn refused(error: impl Into<Error>, file: &str) -> bool {
    let error = error.into();
    let line = hapticore::one_line(&error);
    assert!(line.starts_with(file), "expected a message about {file}, got {line}");
    assert!(line.len() > file.len() + 2, "{file}: a message without words");
    assert!(!line.chars().any(char::is_control), "{file}: more than a line: {line:?}");
    false
}

/// The planted bugs, each in a wrapper of this library: with the feature `planted`, that which
/// the environment's `HAPTICORE_PLANTED` names is there, so that a fuzzer can be seen to find it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Planted {
    /// A panic at an accepted profile of four odd values.
    Profile,
    /// Rows for columns in a calibration that is written again: a raster that is taller than wide, of a device with a
    /// force table and many pads.
    Calibration,
    /// The most negative code of a terminal comes out positive in a capture that is written again. This happens in
    /// a row of another pad than the first in which the sensing voltage is at its largest code.
    Csv,
    /// A sequence number that begins again in a packet of a later pad that is sent again after the ADC was late.
    Packets,
    /// A capacitance that is rounded the wrong way at one pattern of six of its bits, where it is valid, of a later pad,
    /// and of a profile that averages four windows.
    Core,
}

/// Whether all conditions of a planted bug hold. They are tested one by one, as a program's statements would: in one
/// expression the compiler makes one branch of them, and a fuzzer that counts branches sees nothing come nearer.
fn all_hold(conditions: &[bool]) -> bool {
    conditions.iter().take_while(|holds| std::hint::black_box(**holds)).count() == conditions.len()
}

/// Whether a bug is there.
#[cfg(feature = "planted")]
fn planted(bug: Planted) -> bool {
    use std::sync::LazyLock;
    static NAME: LazyLock<String> =
        LazyLock::new(|| std::env::var("HAPTICORE_PLANTED").unwrap_or_default());
    format!("{bug:?}").eq_ignore_ascii_case(&NAME)
}

/// Whether a bug is there.
#[cfg(not(feature = "planted"))]
fn planted(_: Planted) -> bool {
    false
}
