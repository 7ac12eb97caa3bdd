// SPDX-License-Identifier: MIT OR Apache-2.0
//! For build scripts: sets `cfg(tool = "…")` for each external tool that is there, so that a test that needs another one is
//! ignored, with the reason, and not counted as passed. In CI (`CI=true`) all are set: there a missing tool fails.

use std::path::{Path, PathBuf};

/// Commands that tests run, on the path.
const COMMANDS: [&str; 15] = [
    "awk",
    "bash",
    "diff",
    "g++",
    "gcc",
    "gtkwave",
    "iverilog",
    "make",
    "parallel",
    "python3",
    "verilator",
    "verilator-current",
    "vvp",
    "xvfb-run",
    "yosys",
];

/// What `synth/tools` fetches, together.
const FETCHED: &str = "synth/tools";

/// Prints what cargo is to know, for the crate whose folder is `to_root` from the workspace.
///
/// Another `PATH`, as that of a virtual environment, builds nothing anew: `./test` changes this file's time where it finds other
/// commands than before.
pub fn set(to_root: &str) {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=CI");
    let names = COMMANDS.iter().chain([&FETCHED]).map(|name| format!("{name:?}"));
    println!("cargo::rustc-check-cfg=cfg(tool, values({}))", names.collect::<Vec<_>>().join(", "));
    let ci = std::env::var("CI").is_ok_and(|ci| ci == "true");
    for command in COMMANDS.iter().filter(|command| ci || on_path(command).is_some()) {
        println!("cargo::rustc-cfg=tool={command:?}");
    }
    let fetched = Path::new(to_root).join(".tools/bin/yosys");
    if fetched.is_file() {
        println!("cargo::rerun-if-changed={}", fetched.display());
    }
    if ci || fetched.is_file() {
        println!("cargo::rustc-cfg=tool={FETCHED:?}");
    }
}

fn on_path(command: &str) -> Option<PathBuf> {
    let paths = std::env::var_os("PATH")?;
    std::env::split_paths(&paths).map(|folder| folder.join(command)).find(|file| file.is_file())
}
