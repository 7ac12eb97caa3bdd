// SPDX-License-Identifier: MIT OR Apache-2.0
//! Commands of documents, run at a reader's desk: in the order of the page, among files of the names that it uses.

use std::fs;

use hapticore_tests::fuzz::seeds;
use hapticore_tests::tools::have;

use super::FOLLOWED;
use super::extract::{Snippet, is_variable};
use super::parse::{self, commands, is_placeholder};
use crate::tutorial::Reader;

/// Commands that `DOCUMENTS=all` alone runs, by how they begin: seconds to minutes.
const SLOW: [&str; 5] = [
    "hapticore tradeoff",      // tradeoff.rs runs one on few slots
    "hapticore simulate fig3", // 336 places, four cases; gallery.rs runs it
    "hapticore simulate hockey --waves fst",
    "hapticore simulate fig9",
    "hapticore hdl --board ulx3s --control", // a board with its loop
];

/// Commands that are never run here, by a word of theirs, each with its reason.
const NEVER: [(&str, &str); 9] = [
    ("--synth", "needs the HDL tools, minutes; synth/tests/toolchain runs a synthesis"),
    ("hq", "needs a server of HyperQueue"),
    ("parallel", "needs GNU parallel; sweep.rs runs the same lines where it is there"),
    ("--engine", "needs the engine; sweep.rs runs them with --dry-run"),
    ("S/chunks.jsonl", "one of a page's lines for an engine; sweep.rs runs such lines"),
    ("run/profile.toml", "needs the run of a slow line; printed_loop.rs goes the same way"),
    ("live", "runs until Ctrl-C; live.rs starts it"),
    ("host", "runs until Ctrl-C, or in real time; host.rs starts it"),
    ("-p", "another program of this workspace, which takes minutes"),
];

/// A reader's desk with what pages take for given.
fn desk() -> Reader {
    let reader = Reader::new();
    let write = |name: &str, text: &str| fs::write(reader.at(name), text).unwrap();
    write(
        "my-scene.toml",
        "title = \"mine\"\n[[pad]]\nposition_mm = [0, 0]\n[sheet]\nrung = \"distance\"\n[carrier]\nrung = \"samples\"\n",
    );
    let text = |target: &str, number: usize| {
        String::from_utf8(seeds::of(target).swap_remove(number)).unwrap()
    };
    write("my-words.toml", &text("profile", 0));
    write("plan.toml", &text("plan", 0));
    let lab = text("lab", 0).replace("pads = 1", "pads = 4");
    for (name, text) in ["device.toml", "places.csv", "loads.csv"].iter().zip(lab.split('\0')) {
        write(name, text);
    }
    let under_loads = "load_g,capacitance_pf\n20,299\n35,310\n50,318.7\n70,327\n100,337\n200,352\n";
    write("c-over-load.csv", under_loads);
    write("pad.toml", "[device]\npad_diameter_mm = 30\n");
    let volts =
        "t,i1,i2,i3,i4,i5,i6,v_sense,v_haptic\n".to_string() + &"0,1,1,1,1,1,1,2,0\n".repeat(8000);
    write("scope.csv", &volts);
    run(&reader, "hapticore calibrate places.csv loads.csv device.toml --out mine.toml");
    run(
        &reader,
        "hapticore simulate hockey --set duration_s=0.01 --waves none --capture hockey.wav --out hockey",
    );
    reader.program("recorder", "#!/bin/sh\ncat hockey.wav\n");
    reader
}

fn run(reader: &Reader, line: &str) -> Option<String> {
    let output = reader.run(line);
    let log = || String::from_utf8_lossy(&output.stderr).into_owned();
    output.status.code().is_none_or(|code| code >= 2).then(log)
}

/// The line with the command called by its name, as after `cargo install`.
fn called_by_name(snippet: &Snippet) -> String {
    let line = snippet.text.replace("cargo run --release --", "hapticore");
    let first = line.split(' ').next().unwrap_or_default();
    if parse::is_subcommand(first) { format!("hapticore {line}") } else { line }
}

/// How a line is run here; none where it is not.
fn runnable(snippet: &Snippet, all: bool) -> Option<String> {
    let line = called_by_name(snippet);
    let commands = commands(&line);
    let words: Vec<&str> = commands.iter().flatten().map(String::as_str).collect();
    let of_hapticore = commands.iter().any(|words| words[0] == "hapticore");
    // A folder that the reader names is made; other placeholders are part of a line.
    let placeholder =
        |word: &&str| is_placeholder(word) && *word != "DIR" || word.contains(['[', '|', '…']);
    let never = NEVER.iter().any(|(word, _)| words.contains(word));
    let slow = SLOW.iter().any(|start| line.starts_with(start));
    let is_part = |words: &Vec<String>| words[0] == "hapticore" && !parse::is_whole(&words[1..]);
    let whole = !commands.iter().any(is_part);
    let followed = snippet.place.starts_with(FOLLOWED);
    let variable = words.first().is_some_and(|word| is_variable(word));
    let runs = of_hapticore
        && whole
        && !followed
        && !variable
        && !never
        && (all || !slow)
        && !words.iter().any(placeholder);
    runs.then_some(line)
}

#[test]
fn commands_of_documents_run() {
    if !have(&["bash"]) {
        return;
    }
    let all = std::env::var("DOCUMENTS").is_ok_and(|which| which == "all");
    let reader = desk();
    let (mut ran, mut errors) = (Vec::new(), Vec::new());
    for snippet in super::all_snippets() {
        let Some(line) = runnable(&snippet, all).filter(|line| !ran.contains(line)) else {
            continue;
        };
        errors.extend(run(&reader, &line).map(|log| format!("{}: {line}: {log}", snippet.place)));
        ran.push(line);
    }
    assert!(errors.is_empty(), "{}", errors.join("\n"));
    assert!(ran.len() >= 15, "{} commands are run: {ran:#?}", ran.len());
    println!("{}", ran.join("\n"));
}

#[test]
fn every_exception_is_needed() {
    let snippets = super::all_snippets();
    let lines: Vec<String> = snippets.iter().map(called_by_name).collect();
    for start in SLOW {
        assert!(lines.iter().any(|line| line.starts_with(start)), "{start} is in no document");
    }
    for (word, reason) in NEVER {
        assert!(
            lines.iter().any(|line| line.split(' ').any(|other| other == word)),
            "{word} ({reason}) is in no document"
        );
    }
}
