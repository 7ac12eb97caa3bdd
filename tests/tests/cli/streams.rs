// SPDX-License-Identifier: MIT OR Apache-2.0
//! Standard output that is closed or full, signals, full disks: nothing is lost, nothing stays
//! behind, every message says where.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use crate::{Table, expect};

const SHORT: &str = "simulate hockey --set duration_s=0.02 --waves none --out o";

/// Runs a line of shell in which `$H` is the command.
fn shell(folder: &Path, line: &str) -> Output {
    let command = env!("CARGO_BIN_EXE_hapticore-command");
    Command::new("sh")
        .args(["-c", line])
        .env("H", command)
        .current_dir(folder)
        .output()
        .expect("a shell")
}

fn frames(folder: &Path) -> usize {
    Table::read(&folder.join("o/frames.csv")).rows.len()
}

#[test]
fn a_reader_that_goes_loses_no_run() {
    let folder = tempfile::tempdir().unwrap();
    let args = SHORT.split(' ').collect::<Vec<_>>();
    let mut run = crate::command(folder.path(), &args)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(run.stdout.take());
    let output = run.wait_with_output().unwrap();
    assert!(output.status.code().is_some_and(|code| code < 2), "{output:?}");
    let log = crate::without_progress(&output.stderr);
    assert!(log.is_empty() && frames(folder.path()) == 11, "{output:?}");
}

#[test]
fn a_full_standard_output_is_an_error_and_loses_no_run() {
    let folder = tempfile::tempdir().unwrap();
    for line in [&format!("$H {SHORT}"), "$H scenes", "$H scenes --json", "$H hdl --out v"] {
        let output = shell(folder.path(), &format!("{line} > /dev/full"));
        let log = String::from_utf8_lossy(&output.stderr);
        assert!(
            output.status.code() == Some(2) && log.starts_with("error: standard output: "),
            "{line}: {output:?}"
        );
    }
    assert_eq!(frames(folder.path()), 11);
    let output = shell(folder.path(), "$H simulate fig5 2> /dev/full");
    assert_eq!(
        output.status.code(),
        Some(2),
        "a full standard error does not change how a run ends"
    );
}

fn partials(folder: &Path) -> usize {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.filter(|entry| entry.file_name().to_string_lossy().starts_with(".partial-")).count()
}

/// Starts a long run, sends it a signal when it writes, and gives how it ended.
fn signalled(folder: &Path, signal: &str) -> Option<i32> {
    let args = [
        "simulate",
        "hockey",
        "--core",
        "clock",
        "--set",
        "duration_s=600",
        "--capture",
        "big.csv",
    ];
    let mut run = crate::command(folder, &args).stdout(Stdio::null()).spawn().unwrap();
    while partials(folder) == 0 {
        std::thread::sleep(Duration::from_millis(20));
    }
    std::thread::sleep(Duration::from_millis(200));
    Command::new("kill").args([signal, &run.id().to_string()]).status().unwrap();
    run.wait().unwrap().code()
}

#[test]
fn a_run_that_is_told_to_stop_leaves_nothing() {
    for signal in ["-TERM", "-HUP"] {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(signalled(folder.path(), signal), Some(130), "{signal}");
        assert_eq!(
            fs::read_dir(folder.path()).unwrap().count(),
            0,
            "{signal}: nothing stays behind"
        );
    }
}

#[test]
fn what_a_killed_run_left_is_cleared_and_what_a_living_one_writes_is_not() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(signalled(folder.path(), "-KILL"), None);
    let out = fs::read_dir(folder.path().join("out"))
        .unwrap()
        .flatten()
        .next()
        .expect("its folder")
        .path();
    assert_eq!((partials(folder.path()), partials(&out)), (1, 1), "a killed run cannot clear up");
    let args = [
        "simulate",
        "hockey",
        "--core",
        "clock",
        "--set",
        "duration_s=600",
        "--capture",
        "other.csv",
    ];
    let mut living = crate::command(folder.path(), &args).stdout(Stdio::null()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(1500));
    let short = [
        "simulate",
        "hockey",
        "--waves",
        "none",
        "--set",
        "duration_s=0.02",
        "--capture",
        "short.csv",
        "--out",
    ];
    let output = crate::hapticore(folder.path(), &[&short[..], &[out.to_str().unwrap()]].concat());
    assert!(output.status.code().is_some_and(|code| code < 2), "{output:?}");
    assert_eq!((partials(folder.path()), partials(&out)), (1, 1), "those of the run that lives");
    assert!(living.try_wait().unwrap().is_none(), "it still runs");
    Command::new("kill").args(["-TERM", &living.id().to_string()]).status().unwrap();
    living.wait().unwrap();
    assert_eq!((partials(folder.path()), partials(&out)), (0, 0));
}

#[test]
fn a_full_disk_is_an_error_that_names_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let limited = |blocks: u32, args: &str| {
        shell(folder.path(), &format!("trap '' XFSZ; ulimit -f {blocks}; exec $H {args}"))
    };
    for (blocks, args, name) in [
        (8, SHORT.replace("0.02", "2"), "o/frames.csv: "),
        (200, SHORT.replace("--waves none", "--waves vcd"), "waves.vcd: "),
        (100, format!("{SHORT} --capture c.csv"), "c.csv: "),
        (100, format!("{SHORT} --capture c.wav"), "c.wav: "),
    ] {
        let output = limited(blocks, &args);
        let log = String::from_utf8(crate::without_progress(&output.stderr)).expect("text");
        assert_eq!(output.status.code(), Some(2), "{args}: {log}");
        assert!(log.contains(name) && log.lines().count() == 1, "{args}: expected {name} in {log}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "{args}: nothing stays behind");
    }
}

#[test]
fn a_replay_that_waits_for_standard_input_can_be_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = crate::command(folder.path(), &["replay", "-"])
        .stdin(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let input = run.stdin.take();
    std::thread::sleep(Duration::from_millis(500));
    Command::new("kill").args(["-TERM", &run.id().to_string()]).status().unwrap();
    assert_eq!(run.wait().unwrap().code(), Some(130));
    drop(input);
}

/// Places that lie anywhere, of which equations of thousands of unknowns are made.
fn many_places(folder: &Path) {
    let mut text = String::from("x_mm,y_mm,i1,i2,i3,i4,v_sense\n");
    for n in 0..5000u32 {
        let along = |step: f64| 2.0 * (f64::from(n) * step).fract() - 1.0;
        let [x, y] = [along(3f64.sqrt()), along(7f64.sqrt())];
        let current = |side: f64, end: f64| 1e-4 * (1.0 + 0.8 * side * x) * (1.0 + 0.8 * end * y);
        let [a, b, c, d] =
            [current(-1.0, 1.0), current(-1.0, -1.0), current(1.0, -1.0), current(1.0, 1.0)];
        text += &format!("{},{},{a},{b},{c},{d},5\n", 140.0 * x, 90.0 * y);
    }
    fs::write(folder.join("places.csv"), text).unwrap();
    let setup = "pads = 1\nsample_rate_hz = 1e6\ncarrier_hz = 101e3\ncurrent_full_scale_a = 0.004\nsense_full_scale_v = 8\n\
        haptic_full_scale_v = 600\nforce_k = 9.6e12\n[terminals]\nx = [-1, -1, 1, 1]\ny = [1, -1, -1, 1]\n";
    fs::write(folder.join("setup.toml"), setup).unwrap();
}

#[test]
fn a_calibration_that_is_told_to_stop_stops_within_a_second() {
    let folder = tempfile::tempdir().unwrap();
    many_places(folder.path());
    let args = ["calibrate", "places.csv", "setup.toml", "--out", "mine.toml"];
    let mut run = crate::command(folder.path(), &args).stderr(Stdio::null()).spawn().unwrap();
    std::thread::sleep(Duration::from_secs(2));
    assert!(run.try_wait().unwrap().is_none(), "it takes longer");
    let start = std::time::Instant::now();
    Command::new("kill").args(["-INT", &run.id().to_string()]).status().unwrap();
    assert_eq!(run.wait().unwrap().code(), Some(130));
    assert!(start.elapsed() < Duration::from_secs(1), "{:?}", start.elapsed());
    assert!(!folder.path().join("mine.toml").exists());
}

#[test]
fn readme_runs_as_it_says() {
    let folder = tempfile::tempdir().unwrap();
    let readme = include_str!("../../../README.md");
    assert!(readme.contains("hapticore simulate fig6 --set pad.0.load_g=50 "));
    expect(folder.path(), &["simulate", "fig6", "--set", "pad.0.load_g=50"], 0);
}
