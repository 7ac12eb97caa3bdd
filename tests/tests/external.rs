// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore-lockstep` takes anybody's Verilog: a copy of what is printed passes, one line changed
//! is found.

use std::fs;
use std::path::Path;
use std::process::Command;

/// What the command says of a copy of the printed core in which some text is replaced by another,
/// and its exit status.
fn run_example(
    simulator: &[&str],
    file: &str,
    printed: &str,
    instead: &str,
) -> (String, Option<i32>) {
    let folder = tempfile::tempdir().expect("a folder");
    let small = Path::new(env!("CARGO_MANIFEST_DIR")).join("../rtl/verilog/small");
    let mut command = Command::new(env!("CARGO_BIN_EXE_hapticore-lockstep"));
    command.args(simulator).arg("small");
    for entry in fs::read_dir(small).expect("the printed core").flatten() {
        if entry.path().extension().is_none_or(|extension| extension != "v") {
            continue; // what benches include is no module
        }
        let (name, text) = (entry.file_name(), fs::read_to_string(entry.path()).expect("a file"));
        let changed = if name == file { text.replacen(printed, instead, 1) } else { text.clone() };
        assert!(name != file || printed == instead || changed != text, "{file} has {printed}");
        let path = folder.path().join(name);
        fs::write(&path, changed).expect("written");
        command.arg(path);
    }
    let output = command.output().expect("the command runs");
    (String::from_utf8_lossy(&output.stdout).into_owned(), output.status.code())
}

#[test]
#[cfg_attr(
    not(all(tool = "verilator", tool = "make", tool = "g++", tool = "iverilog", tool = "vvp")),
    ignore = "needs verilator, make, g++, iverilog, vvp: ./test fetches what is missing"
)]
fn a_copy_of_the_printed_core_passes_and_a_changed_line_is_named() {
    let (text, status) = run_example(&[], "", "", "");
    assert_eq!(status, Some(0), "{text}");
    assert!(text.starts_with("small: ") && text.ends_with(" clocks equal\n"), "{text}");
    let (text, status) =
        run_example(&["--icarus"], "hapticore_small.v", "assign carrier = ", "assign carrier = ~");
    assert_eq!(status, Some(1), "{text}");
    assert!(text.contains("hockey: clock ") && text.contains(": carrier: model 0x"), "{text}");
}

#[test]
fn arguments_that_are_none_are_told() {
    for (arguments, words) in
        [(&["small"][..], "usage: "), (&["none", "a.v"], "none"), (&["small", "no.v"], "no.v: ")]
    {
        let output = Command::new(env!("CARGO_BIN_EXE_hapticore-lockstep"))
            .args(arguments)
            .output()
            .expect("it runs");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let log = String::from_utf8_lossy(&output.stderr);
        assert!(log.contains(words), "{arguments:?}: {log}");
    }
}
