// SPDX-License-Identifier: MIT OR Apache-2.0
//! The command line, run as its users run it: as a process, with files in and files out.

mod bad_captures;
mod captures;
mod codes;
mod documents;
mod earlier;
mod flags;
mod gallery;
mod hdl;
mod host;
mod knobs;
mod lab;
mod lifted;
mod lines;
mod live;
mod messages;
mod mistakes;
mod printed_loop;
mod recorders;
mod reference;
mod runs;
mod stability;
mod streams;
mod sweep;
mod terminals;
mod tradeoff;
mod tutorial;
mod unbreakable;
mod waves;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Runs the command from within `folder`.
fn hapticore(folder: &Path, args: &[&str]) -> Output {
    let output = command(folder, args).output().expect("the command starts");
    Output { stderr: without_progress(&output.stderr), ..output }
}

/// What standard error says beside progress, of which a slow machine has more.
fn without_progress(log: &[u8]) -> Vec<u8> {
    let lines = log.split_inclusive(|byte| *byte == b'\n');
    lines.filter(|line| !line.starts_with(b"progress: ")).flatten().copied().collect()
}

fn command(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hapticore-command"));
    command.args(args).current_dir(folder);
    command
}

/// Runs the command and expects it to end with `code`.
fn expect(folder: &Path, args: &[&str], code: i32) -> Output {
    let output = hapticore(folder, args);
    let log = String::from_utf8_lossy(&output.stderr);
    assert_eq!(
        output.status.code(),
        Some(code),
        "{args:?}: {log}{}",
        String::from_utf8_lossy(&output.stdout)
    );
    output
}

/// Runs the command on part of a scene, whose criteria may not hold, and expects it to finish.
fn finish(folder: &Path, args: &[&str]) -> Output {
    let output = hapticore(folder, args);
    let log = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code().is_some_and(|code| code < 2), "{args:?}: {log}");
    output
}

/// Runs the command and expects it to refuse: exit code 2, one line on standard error that holds
/// all of `words`, and no folder.
fn refuse(folder: &Path, args: &[&str], words: &[&str]) {
    let args = [args, &["--out", "results"]].concat();
    let output = expect(folder, &args, 2);
    let log = String::from_utf8(output.stderr).expect("text");
    assert_eq!(log.lines().count(), 1, "{args:?}: one line, got {log}");
    for word in words {
        assert!(log.contains(word), "{args:?}: expected \"{word}\" in {log}");
    }
    assert!(!folder.join("results").exists(), "{args:?}: leaves nothing behind");
}

/// The fields of a line: what is quoted may hold commas, as names of cases do.
fn fields(line: &str) -> Vec<String> {
    let mut fields = vec![String::new()];
    for (n, part) in line.split('"').enumerate() {
        let mut pieces =
            if n % 2 == 1 { vec![part] } else { part.split(',').collect() }.into_iter();
        fields.last_mut().expect("a field").extend(pieces.next());
        fields.extend(pieces.map(String::from));
    }
    fields
}

/// A table: names of the columns, and rows of texts.
struct Table {
    names: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn read(path: &Path) -> Table {
        let text =
            fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let mut lines = text.lines();
        Table { names: fields(lines.next().expect("a header")), rows: lines.map(fields).collect() }
    }

    fn column(&self, name: &str) -> Vec<&str> {
        let index = self
            .names
            .iter()
            .position(|known| known == name)
            .unwrap_or_else(|| panic!("no column {name}"));
        self.rows.iter().map(|row| row[index].as_str()).collect()
    }

    fn numbers(&self, name: &str) -> Vec<f64> {
        self.column(name).iter().map(|text| text.parse().expect("a number")).collect()
    }
}
