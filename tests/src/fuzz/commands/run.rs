// SPDX-License-Identifier: MIT OR Apache-2.0
//! A run of a command line as a process with limits, and what is wrong with how it ended.

use std::ffi::OsString;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::desk::Desk;

/// The most seconds of processor time that a run may take, all threads together: beyond is a hang.
const PROCESSOR_SECONDS: u32 = 120;

/// The most seconds that a run may last: one that waits takes no processor time.
const SECONDS: u64 = 600;

/// The most memory of a run, KiB.
const KILOBYTES: u32 = 1 << 21;

/// Ends a server as Ctrl-C does, after a second.
const CTRL_C: &str = "timeout --preserve-status --signal=INT 1";

/// How a run ended.
#[derive(Debug)]
pub struct Ended {
    /// Exit status; none where a signal ended it.
    pub status: Option<i32>,
    /// Standard output.
    pub output: String,
    /// Standard error.
    pub log: String,
    /// How long it took.
    pub took: Duration,
    /// What is wrong: a line each.
    pub findings: Vec<String>,
}

/// Runs a line in a folder of its own, and checks what holds of every line. It ends in time with status 0, 1 or 2,
/// without a panic. A refusal is one line and leaves no results. Results are whole, and every number in them is
/// finite.
///
/// # Panics
/// The run cannot be started.
pub fn run(desk: &Desk, line: &[OsString]) -> Ended {
    let folder = tempfile::tempdir().expect("a folder");
    let [work, apart] = ["work", "apart"].map(|name| folder.path().join(name));
    [&work, &apart].iter().for_each(|folder| fs::create_dir(folder).expect("a folder"));
    desk.lay_out(line, &work);
    let before = files(&work);
    let mut ended = execute(desk, line, &work, &apart);
    let after = files(&work);
    let new: Vec<_> = after.iter().filter(|path| !before.contains(path)).collect();
    let mut findings = about_the_end(&ended, interrupted(line));
    if findings.is_empty() {
        findings.extend(new.iter().filter_map(|path| unfinished(path)));
        if ended.status == Some(2) && !keeps_what_it_ran(line) {
            findings.extend(new.first().map(|path| format!("a refusal leaves {}", path.display())));
        }
    }
    ended.findings = findings;
    ended
}

/// The status of a server, or of a board's host, that Ctrl-C ends before it is at work.
fn interrupted(line: &[OsString]) -> Option<i32> {
    line.first().is_some_and(|word| word == "live" || word == "host").then_some(130)
}

/// A sweep keeps its store: what was run is not run again.
fn keeps_what_it_ran(line: &[OsString]) -> bool {
    line.first().is_some_and(|word| word == "sweep")
}

fn execute(desk: &Desk, line: &[OsString], work: &Path, apart: &Path) -> Ended {
    let [output, log] = ["output", "log"].map(|name| apart.join(name));
    let until = if interrupted(line).is_some() { CTRL_C } else { "" };
    let limits = format!(
        "ulimit -t {PROCESSOR_SECONDS}; ulimit -v {KILOBYTES}; ulimit -c 0; exec {until} \"$0\" \"$@\""
    );
    let mut command = Command::new("/bin/sh");
    command.args(["-c", &limits]).arg(&desk.program).args(line);
    command.current_dir(work).env("PATH", desk.tools.path());
    let input = input(desk, line);
    command.stdin(input).stdout(File::create(&output).expect("a file"));
    command.stderr(File::create(&log).expect("a file"));
    let start = Instant::now();
    let mut child = command.spawn().expect("a shell");
    let status = loop {
        match child.try_wait().expect("a child") {
            Some(status) => break status.code(),
            None if start.elapsed().as_secs() > SECONDS => {
                child.kill().expect("a child");
                child.wait().expect("a child");
                break None;
            }
            None => sleep(Duration::from_millis(2)),
        }
    };
    let read = |path: &Path| String::from_utf8_lossy(&fs::read(path).expect("a file")).into_owned();
    let (output, log) = (read(&output), read(&log));
    Ended { status, output, log, took: start.elapsed(), findings: Vec::new() }
}

/// Standard input: a capture, or a chunk of a sweep, for lines that read it.
fn input(desk: &Desk, line: &[OsString]) -> Stdio {
    let reads = line.iter().any(|word| word == "-");
    let path = match line.first() {
        Some(word) if reads && word == "replay" => {
            desk.at(&desk.files.captures[line.len() % desk.files.captures.len()])
        }
        _ => return Stdio::null(),
    };
    File::open(path).map_or(Stdio::null(), Stdio::from)
}

fn about_the_end(ended: &Ended, interrupted: Option<i32>) -> Vec<String> {
    let mut findings = Vec::new();
    if ended.log.contains("panicked at") {
        findings.push(format!("a panic: {}", ended.log.trim()));
    }
    match ended.status {
        Some(0..=2) => (),
        status if status == interrupted => (),
        Some(status) => findings.push(format!("exit status {status}: {}", ended.log.trim())),
        None => findings.push(format!("ended by a signal after {:?}", ended.took)),
    }
    let errors = ended.log.lines().filter(|line| line.starts_with("error: ")).count();
    if ended.status == Some(2) && errors != 1 {
        findings.push(format!("a refusal is one error, got {errors}: {}", ended.log.trim()));
    }
    findings
}

/// All files below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        match path.is_dir() && !path.is_symlink() {
            true => found.extend(files(&path)),
            false => found.push(path),
        }
    }
    found
}

/// What is wrong with a file that a run left: it is unfinished or cut short, or a number in it is none.
pub fn unfinished(path: &Path) -> Option<String> {
    let hidden =
        path.components().any(|part| part.as_os_str().to_string_lossy().starts_with(".partial-"));
    if hidden {
        return Some(format!("leaves {}", path.display()));
    }
    let bytes = fs::read(path).ok()?;
    if is_cut_short(path, &bytes) {
        return Some(format!("{} is cut short", path.display()));
    }
    let table = path.extension().is_some_and(|of| of == "csv");
    let no_number = |cell: &str| matches!(cell, "NaN" | "nan" | "inf" | "-inf" | "-nan");
    let wrong = |line: &&str| line.split(',').any(no_number);
    let lines = String::from_utf8_lossy(&bytes);
    let line = lines.lines().find(wrong).filter(|_| table)?;
    Some(format!("{}: no number in {line}", path.display()))
}

/// Whether a file is not whole: text ends with a line, other formats with what they end with.
pub fn is_cut_short(path: &Path, bytes: &[u8]) -> bool {
    let end: &[u8] = match path.extension().and_then(|of| of.to_str()) {
        Some("json") => b"}",
        Some("parquet") => b"PAR1",
        Some("html") => b"</html>",
        // A head of eight bytes, and sixteen for each point of a store's part.
        Some("index") => return bytes.len() % 16 != 8,
        // A lock: nothing is in it.
        Some("claim") => return !bytes.is_empty(),
        // Formats whose end has no mark.
        Some("wav" | "fst" | "sigmf-data") => return false,
        _ => b"\n",
    };
    let text = bytes.strip_suffix(b"\n").filter(|_| end != b"\n").unwrap_or(bytes);
    !text.ends_with(end)
}
