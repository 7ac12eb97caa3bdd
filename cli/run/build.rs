// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tells the command which commit it is built from. Without git, or outside a repository, it is
//! built without knowing.

use std::process::Command;

/// The crates that the command is made of, beside this one.
const SOURCES: [&str; 9] = [
    "src",
    "../src",
    "../files/src",
    "../report/src",
    "../../host",
    "../../model",
    "../../rtl/src",
    "../../scene",
    "../../waveforms/src",
];

fn main() {
    let commit = git(&["describe", "--always", "--exclude=*", "--abbrev=40", "--dirty=-modified"]);
    println!("cargo::rustc-env=HAPTICORE_COMMIT={}", commit.unwrap_or_default());
    // Not the index: it changes with every `git status`.
    let head = git(&["rev-parse", "--git-path", "logs/HEAD"]);
    let watched = head.into_iter().chain(SOURCES.map(String::from));
    watched.for_each(|path| println!("cargo::rerun-if-changed={path}"));
}

fn git(args: &[&str]) -> Option<String> {
    let output =
        Command::new("git").args(args).output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_string())
}
