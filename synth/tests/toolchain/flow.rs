// SPDX-License-Identifier: MIT OR Apache-2.0
//! The reports of boards are what the tools give: synthesis and the first seed again, to the byte
//! of the bitstream.

use hapticore_synth::certificates::Subject;
use hapticore_synth::flow::Flow;
use hapticore_synth::report::BoardReport;
use hapticore_synth::sources::{self, File};
use hapticore_synth::target::{Board, TOP, board};
use hapticore_synth::tools::{Tools, root};
use std::fs;

/// What runs the tools.
const RUNNERS: &[&str] =
    &["synth/src/flow.rs", "synth/src/cells.rs", "synth/tests/toolchain/flow.rs"];

fn check(name: &str) {
    let path = root().join(format!("synth/reports/{name}.json"));
    let text = fs::read_to_string(&path)
        .unwrap_or_else(|error| panic!("{}: {error}: synth/run {name}", path.display()));
    let board = board(name).expect("a board");
    let files = sources::board(board.target);
    let subject =
        files.iter().fold(Subject::new().and(&text), |subject, file| subject.and(&file.text));
    subject
        .and_files(RUNNERS)
        .holds(&format!("flow: {name} as reported"), || gives(board, &files, &text));
}

/// The tools give the report.
fn gives(board: &Board, files: &[File], report: &str) {
    let tools = Tools::find().expect("what synth/tools fetches");
    let report: BoardReport = serde_json::from_str(report).expect("a report");
    let (folder, name) = (tempfile::tempdir().expect("a folder"), board.target.name());
    let flow = Flow::new(&tools, board.family, TOP, files, folder.path()).expect("a folder");
    assert_eq!(flow.synthesise().expect("a netlist"), report.cells, "synth/run {name}");
    let placed = flow.place(1).expect("a placement");
    assert_eq!((placed.timing, placed.used), (report.timings[0], report.used), "synth/run {name}");
    assert_eq!(flow.pack(1).expect("a bitstream").1, report.bitstream, "synth/run {name}");
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn ulx3s_is_as_reported() {
    check("ulx3s");
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn icebreaker_is_as_reported() {
    check("icebreaker");
}
