// SPDX-License-Identifier: MIT OR Apache-2.0
//! `docs/tutorial.md` as its readers follow it: its files written, its commands run, in their
//! order, in an empty folder.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::Table;

/// A fenced block: files have a name behind the language.
#[derive(Debug)]
enum Block {
    File { name: String, text: String },
    Commands(String),
}

/// The tutorial's blocks.
fn blocks() -> Vec<Block> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/tutorial.md");
    let text = fs::read_to_string(path).unwrap();
    let fences: Vec<_> = text.split("```").collect();
    assert_eq!(fences.len() % 2, 1, "every fence is closed");
    let block = |fenced: &&str| {
        let (head, text) = fenced.split_once('\n').unwrap();
        match head.split_once(' ') {
            Some((_, name)) => Block::File { name: name.into(), text: text.into() },
            None => {
                assert_eq!(head, "sh", "a block of commands, or of a file with its name");
                Block::Commands(text.into())
            }
        }
    };
    fences.iter().skip(1).step_by(2).map(block).collect()
}

/// A folder in which the command has its own name.
fn path_to_hapticore(folder: &Path) -> PathBuf {
    let bin = folder.join("bin");
    fs::create_dir(&bin).unwrap();
    fs::hard_link(env!("CARGO_BIN_EXE_hapticore-command"), bin.join("hapticore"))
        .or_else(|_| {
            fs::copy(env!("CARGO_BIN_EXE_hapticore-command"), bin.join("hapticore")).map(|_| ())
        })
        .unwrap();
    bin
}

/// A reader at work.
pub struct Reader {
    bin: tempfile::TempDir,
    desk: tempfile::TempDir,
}

impl Reader {
    /// With an empty desk.
    pub fn new() -> Reader {
        let reader =
            Reader { bin: tempfile::tempdir().unwrap(), desk: tempfile::tempdir().unwrap() };
        path_to_hapticore(reader.bin.path());
        reader
    }

    /// A file on the desk.
    pub fn at(&self, name: &str) -> PathBuf {
        self.desk.path().join(name)
    }

    /// Puts a program beside the command.
    pub fn program(&self, name: &str, text: &str) {
        let path = self.bin.path().join("bin").join(name);
        fs::write(&path, text).unwrap();
        fs::set_permissions(path, PermissionsExt::from_mode(0o755)).unwrap();
    }

    /// Runs a line of shell at the desk.
    pub fn run(&self, commands: &str) -> Output {
        let paths = std::env::var_os("PATH").unwrap_or_default();
        let paths = [self.bin.path().join("bin")].into_iter().chain(std::env::split_paths(&paths));
        let mut shell = Command::new("bash");
        shell.args(["-euo", "pipefail", "-c", commands]).current_dir(self.desk.path());
        shell.env("PATH", std::env::join_paths(paths).unwrap()).output().unwrap()
    }

    /// Does as a block says.
    fn follow(&self, block: &Block) {
        match block {
            Block::File { name, text } => fs::write(self.at(name), text).unwrap(),
            Block::Commands(commands) => {
                let output = self.run(commands);
                let log = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
                assert!(
                    output.status.success(),
                    "{commands}\n{}{}",
                    log(&output.stdout),
                    log(&output.stderr)
                );
            }
        }
    }
}

/// Where the pads of the recording are, slot by slot.
const PADS_MM: [[f64; 2]; 6] =
    [[-100.0, -50.0], [100.0, 60.0], [-60.0, 20.0], [120.0, -75.0], [0.0, 0.0], [35.0, 40.0]];

/// What the recording's pads have: pF, and k = 9.6e12 N/(F·V)² at 200 V.
const CAPACITANCE_PF: f64 = 350.0;
const FORCE_N: f64 = 9.6e12 * (350e-12 * 200.0) * (350e-12 * 200.0);

#[test]
#[cfg_attr(
    not(all(
        tool = "bash",
        tool = "python3",
        tool = "awk",
        tool = "diff",
        tool = "iverilog",
        tool = "vvp"
    )),
    ignore = "needs bash, python3, awk, diff, iverilog, vvp: ./test fetches what is missing"
)]
fn the_tutorial_works_from_an_empty_folder() {
    let reader = Reader::new();
    let blocks = blocks();
    blocks.iter().for_each(|block| reader.follow(block));
    let frames = Table::read(&reader.at("replayed/frames.csv"));
    assert_eq!(frames.rows.len(), PADS_MM.len());
    for (slot, [x, y]) in PADS_MM.into_iter().enumerate() {
        let at = |name: &str| frames.numbers(name)[slot];
        let error = (at("x_mm") - x).hypot(at("y_mm") - y);
        assert!(error < 0.1, "slot {slot}: {error} mm");
        assert!((at("capacitance_pf") / CAPACITANCE_PF - 1.0).abs() < 1e-3, "slot {slot}");
        assert!((at("force_n") / FORCE_N - 1.0).abs() < 0.03, "slot {slot}");
        assert_eq!(
            (frames.column("pad")[slot], frames.column("flags")[slot]),
            (["0", "1"][slot % 2], "")
        );
    }
    // The last command must be able to fail.
    let Some(Block::Commands(compare)) = blocks.last() else {
        panic!("the tutorial ends with its comparison")
    };
    let bench = fs::read_to_string(reader.at("bench.txt")).unwrap();
    assert_eq!(bench.lines().count(), PADS_MM.len(), "{bench}");
    fs::write(reader.at("bench.txt"), bench.replacen("350.00", "350.01", 1)).unwrap();
    assert!(!reader.run(compare).status.success(), "another capacitance is a difference");
}
