// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files that command lines name. Each run has copies of those that its line names, in a folder of its own.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::fuzz::seeds;

/// Scenes that make captures: other numbers of pads, of terminals, of parts, and of a closed loop.
const CAPTURED: [(&str, &[&str]); 5] = [
    ("one.wav", &["minimal-sheet", "--set", "pad.0.position_mm=[0, 0]"]),
    ("one.csv", &["minimal-sheet", "--set", "pad.0.position_mm=[9, 9]", "--profile", "small"]),
    ("four.wav", &["hockey", "--set", "duration_s=0.007"]),
    ("corners.csv", &["minimal-sheet", "--set", CORNERS, "--set", "pad.0.position_mm=[0, 0]"]),
    ("parts.wav", &["fig15", "--case", "rule B, two halves", "--set", "duration_s=0.002"]),
];

/// Four terminals, one at each corner.
const CORNERS: &str = "sheet.terminals_mm=[[-430, 250], [-430, -250], [430, -250], [430, 250]]";

/// A plan of few points, each quickly run.
const PLAN: &str = "scene = \"minimal-sheet\"\nprofile = \"small\"\nslots = 2\n[axes.profile]\ncapacitance = [13, 15]\n\
    [axes.scene]\nsheet.rung = [\"bilinear\"]\n";

/// Files by what they are for.
#[derive(Debug, Default)]
pub struct Files {
    /// Scenes.
    pub scenes: Vec<String>,
    /// Profiles.
    pub profiles: Vec<String>,
    /// Calibrations.
    pub calibrations: Vec<String>,
    /// Tunings of force controllers.
    pub tunings: Vec<String>,
    /// Captures.
    pub captures: Vec<String>,
    /// Plans of sweeps.
    pub plans: Vec<String>,
    /// What a laboratory measured.
    pub measurements: Vec<String>,
    /// Lines of a sweep's chunks.
    pub chunks: Vec<String>,
}

/// A folder of files, and the command.
#[derive(Debug)]
pub struct Desk {
    folder: tempfile::TempDir,
    /// Programs that a run may start: those of a shell, without HDL tools and engines of other hosts.
    pub tools: tempfile::TempDir,
    /// The command.
    pub program: PathBuf,
    /// The files' names.
    pub files: Files,
}

impl Desk {
    /// Makes the files: from the seeds and the committed inputs of fuzz targets, and by the command itself.
    ///
    /// # Panics
    /// A file cannot be written, or the command fails.
    pub fn new(program: &Path) -> Self {
        let mut desk = Desk::of_seeds(program);
        desk.captures();
        desk.tuned();
        desk.sweep();
        desk
    }

    /// Makes the files that the command need not make.
    ///
    /// # Panics
    /// A file cannot be written.
    pub fn of_seeds(program: &Path) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let (program, files) = (program.to_owned(), Files::default());
        let mut desk = Desk { folder, tools: tools(), program, files };
        desk.files.scenes = desk.texts("scene");
        desk.files.profiles = desk.texts("profile");
        desk.files.calibrations = desk.texts("calibration");
        desk.files.tunings = desk.texts("tuning");
        desk.files.plans = desk.texts("plan");
        desk.files.measurements = desk.measurements();
        desk.write("folder.toml/inner", b"");
        desk.write("empty.csv", b"");
        desk
    }

    /// A file's path.
    pub fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Puts copies of all files that a line names into a folder.
    ///
    /// # Panics
    /// A file cannot be copied.
    pub fn lay_out(&self, line: &[OsString], folder: &Path) {
        let text = line.join(OsStr::new(" ")).to_string_lossy().into_owned();
        for entry in fs::read_dir(self.folder.path()).expect("a folder").flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            // Beside a capture lie its calibration and, of SigMF, its data.
            let of = name.trim_end_matches(".calibration.toml").trim_end_matches("-data");
            if text.contains(of) {
                copy(&entry.path(), &folder.join(&name));
            }
        }
    }

    fn write(&self, name: &str, bytes: &[u8]) -> String {
        let path = self.at(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, bytes).expect("a file");
        name.into()
    }

    /// The seeds and the committed inputs of a target of TOML.
    fn texts(&self, target: &str) -> Vec<String> {
        let committed = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus-seed");
        let mut paths: Vec<_> = fs::read_dir(committed.join(target))
            .expect("the committed inputs")
            .map(|entry| entry.expect("an entry").path())
            .collect();
        paths.sort();
        let committed = paths.iter().map(|path| fs::read(path).expect("a file"));
        let all: Vec<_> = seeds::of(target).into_iter().chain(committed).collect();
        let name = |number| format!("{target}{number}.toml");
        all.iter().enumerate().map(|(number, text)| self.write(&name(number), text)).collect()
    }

    /// The files of each laboratory.
    fn measurements(&self) -> Vec<String> {
        const NAMES: [&str; 3] = ["device.toml", "places.csv", "loads.csv"];
        let mut names = Vec::new();
        for (number, lab) in seeds::of("lab").iter().enumerate() {
            for (text, name) in lab.split(|byte| *byte == 0).zip(NAMES) {
                names.push(self.write(&format!("lab{number}{name}"), text));
            }
        }
        names
    }

    fn captures(&mut self) {
        for (name, scene) in CAPTURED {
            self.hapticore(
                &[&["simulate"][..], scene, &["--waves", "none", "--capture", name]].concat(),
            );
            self.files.captures.push(name.into());
            self.files.calibrations.push(format!("{name}.calibration.toml"));
        }
        for (target, end) in [("csv", "csv"), ("wav", "wav")] {
            for (number, seed) in seeds::of(target).iter().enumerate() {
                // The first byte is the target's options.
                let name = self.write(&format!("{target}{number}.{end}"), &seed[1..]);
                self.files.captures.push(name);
            }
        }
        for (number, seed) in seeds::of("sigmf").iter().enumerate() {
            let end = seed.iter().position(|byte| *byte == 0).expect("meta data, then a zero");
            let name = self.write(&format!("sigmf{number}.sigmf-meta"), &seed[1..end]);
            self.write(&format!("sigmf{number}.sigmf-data"), &seed[end + 1..]);
            self.files.captures.push(name);
        }
    }

    /// The profile and the tuning of a run with a force controller.
    fn tuned(&mut self) {
        const LOOP: &str = "sine 0.3 N, closed loop";
        let run = ["simulate", "fig9", "--case", LOOP, "--waves", "none", "--out", "loop"];
        self.hapticore(&run);
        self.files.profiles.push("loop/profile.toml".into());
        self.files.tunings.push("loop/tuning.toml".into());
    }

    /// A store with a plan and all but the results of its points.
    fn sweep(&mut self) {
        self.files.plans.push(self.write("few.toml", PLAN.as_bytes()));
        let list = self.hapticore(&["sweep", "few.toml", "--store", "store", "--list"]);
        self.files.chunks = list.lines().map(String::from).collect();
        assert!(!self.files.chunks.is_empty(), "a plan has chunks");
    }

    /// Runs the command among the files; what it prints.
    fn hapticore(&self, args: &[&str]) -> String {
        let mut command = Command::new(&self.program);
        command.args(args).current_dir(self.folder.path()).stdin(Stdio::null());
        let output = command.output().expect("the command starts");
        let log = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code().is_some_and(|code| code < 2), "{args:?}: {log}");
        String::from_utf8(output.stdout).expect("text")
    }
}

/// A folder of the programs that commands of `sweep submit` take for given, and `timeout`, which ends servers.
fn tools() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["sh", "cat", "mkdir", "mv", "wc", "sed", "timeout"] {
        let found = crate::tools::find(name).expect("a shell's programs");
        std::os::unix::fs::symlink(found, folder.path().join(name)).expect("a link");
    }
    folder
}

/// Copies a file, or a folder with all in it.
fn copy(from: &Path, to: &Path) {
    if !from.is_dir() {
        fs::copy(from, to).expect("a copy");
        return;
    }
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from).expect("a folder").flatten() {
        copy(&entry.path(), &to.join(entry.file_name()));
    }
}
