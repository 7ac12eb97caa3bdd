// SPDX-License-Identifier: MIT OR Apache-2.0
//! Input of any length: refused in a line, in seconds and within a gigabyte, and nothing stays behind.
//! A run that is stopped at any time leaves each file whole or not at all.
//!
//! What stands here fuzzing cannot show, since its inputs are short (docs/fuzzing.md).
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use fastrand::Rng;
use hapticore_tests::fuzz::commands::run::is_cut_short;

/// Seconds within which any input is refused, on a machine that does other work, too.
const SECONDS: u32 = 60;

/// Kilobytes that a run may have.
const KILOBYTES: u32 = 1 << 20;

/// Runs a line of shell in which `$H` is the command, with a gigabyte and a minute; expects it to
/// refuse in one line that holds all of `words`, and to leave no results.
fn refuse(folder: &Path, line: &str, words: &[&str]) {
    let limited =
        format!("ulimit -v {KILOBYTES}; H=\"timeout {SECONDS} $H\"; {line} --out results");
    let output = Command::new("sh")
        .args(["-c", &limited])
        .env("H", env!("CARGO_BIN_EXE_hapticore-command"))
        .current_dir(folder)
        .output()
        .expect("a shell");
    let log = String::from_utf8(crate::without_progress(&output.stderr)).expect("text");
    assert_eq!(output.status.code(), Some(2), "{line}: {log}");
    assert!(log.lines().count() == 1 && log.len() < 10_000, "{line}: one line, got {log}");
    for word in words {
        assert!(log.contains(word), "{line}: expected \"{word}\" in {log}");
    }
    assert!(!folder.join("results").exists(), "{line}: leaves nothing behind");
}

#[test]
fn input_without_an_end_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refuse = |line: &str, words: &[&str]| refuse(folder.path(), line, words);
    let text = "expected a text of at most 4194304 bytes";
    refuse("$H simulate /dev/zero", &["/dev/zero", text]);
    refuse("$H simulate fig6 --profile /dev/zero", &["/dev/zero", text]);
    refuse("$H sweep /dev/zero", &["/dev/zero", text]);
    refuse("$H calibrate /dev/zero", &["/dev/zero", text]);
    refuse("$H replay - < /dev/zero", &["standard input:1", "at most 1048576 bytes"]);
    refuse("yes | tr -d '\\n' | $H replay -", &["standard input:1", "at most 1048576 bytes"]);
    refuse("yes | $H replay -", &["standard input:1", "\"y\""]);
    fs::write(folder.path().join("c.csv"), "").unwrap();
    refuse("$H replay c.csv --calibration /dev/zero", &["/dev/zero", text]);
    for name in ["zero.csv", "zero.wav"] {
        std::os::unix::fs::symlink("/dev/zero", folder.path().join(name)).unwrap();
        refuse(&format!("$H replay {name}"), &[name, "expected"]);
    }
}

#[test]
fn lines_of_a_million_columns_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let columns = format!("i1,i2,i3,i4,i5,i6,v_sense,v_haptic{}\n", ",_".repeat(1_000_000));
    fs::write(folder.path().join("wide.csv"), columns).unwrap();
    refuse(folder.path(), "$H replay wide.csv", &["wide.csv:1", "at most 1048576 bytes"]);
    let names: Vec<_> = (0..400_000).map(|n| format!("c{n}")).collect();
    fs::write(folder.path().join("lab.csv"), names.join(",") + "\n").unwrap();
    refuse(folder.path(), "$H calibrate lab.csv", &["lab.csv:1", "columns of places"]);
}

#[test]
fn folders_and_empty_files_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for extension in ["csv", "wav", "toml", "sigmf-meta", "sigmf-data"] {
        fs::create_dir(folder.path().join(format!("folder.{extension}"))).unwrap();
        fs::write(folder.path().join(format!("empty.{extension}")), "").unwrap();
    }
    for name in ["folder", "empty"] {
        for extension in ["csv", "wav", "sigmf-meta"] {
            let file = format!("{name}.{extension}");
            refuse(folder.path(), &format!("$H replay {file}"), &[&file]);
        }
        for command in ["simulate", "sweep", "calibrate", "simulate fig6 --profile"] {
            let file = format!("{name}.toml");
            refuse(folder.path(), &format!("$H {command} {file}"), &[&file]);
        }
    }
}

#[test]
fn sizes_that_no_file_has_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut wav =
        b"RIFF\xff\xff\xff\xffWAVEfmt \x10\0\0\0\x01\0\x08\0\x40\x42\x0f\0\0\x24\xf4\0\x10\0\x10\0"
            .to_vec();
    wav.extend(b"data\xf0\xff\xff\xff\0\0\0\0");
    fs::write(folder.path().join("long.wav"), &wav).unwrap();
    refuse(folder.path(), "$H replay long.wav", &["long.wav: sample 0", "268435455 samples"]);
    wav[22..24].copy_from_slice(&[0xff; 2]);
    fs::write(folder.path().join("wide.wav"), &wav).unwrap();
    refuse(folder.path(), "$H replay wide.wav", &["wide.wav", "got 65535"]);
    let meta = "{\"global\": {\"core:datatype\": \"ri16_le\", \"core:sample_rate\": 1e6, \
                \"core:num_channels\": 18446744073709551615}}";
    fs::write(folder.path().join("wide.sigmf-meta"), meta).unwrap();
    fs::write(folder.path().join("wide.sigmf-data"), "").unwrap();
    refuse(
        folder.path(),
        "$H replay wide.sigmf-meta",
        &["core:num_channels", "18446744073709551615"],
    );
    fs::write(folder.path().join("wide.sigmf-meta"), "[".repeat(1_000_000)).unwrap();
    refuse(folder.path(), "$H replay wide.sigmf-meta", &["recursion limit"]);
}

/// A scene of one pad, of which each adds a line 4 and further.
const PAD: &str = "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n";

#[test]
fn scenes_of_any_size_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refuse = |text: &str, words: &[&str]| {
        fs::write(folder.path().join("large.toml"), text).unwrap();
        refuse(folder.path(), "$H simulate large.toml", words);
    };
    let sweep = "{ sweep = { from = 1, to = 2, points = 1000000 } }";
    let raster = PAD.replace("[0, 0]", "{ raster = { nx = 1000, ny = 1000, margin_mm = 15 } }");
    refuse(
        &format!("{raster}load_g = {sweep}\nhaptic_v_rms = {sweep}\ncapacitance_pf = {sweep}\n"),
        &["pad: expected at most 10000000 points of a sweep"],
    );
    refuse(
        &format!("dwell_slots = 1000000\n{PAD}load_g = {sweep}\n"),
        &["at most 10000000 slots of all cases, got 1000000000000"],
    );
    refuse(
        &format!(
            "{PAD}[device]\nwidth_mm = 10000\nheight_mm = 10000\n[sheet]\nrung = \"grid-1.25-mm\"\n"
        ),
        &["large.toml:8: sheet.rung", "at most 600000 nodes", "coarser"],
    );
    refuse(
        &format!("{PAD}[carrier]\nhaptic_wave = \"square\"\nhaptic_turn_s = 1e-300\n"),
        &["large.toml:6: carrier.haptic_turn_s"],
    );
    refuse(&format!("{PAD}{}", "[[case]]\n".repeat(300_000)), &["at most 256 tables", "300000"]);
    let pads = "[[pad]]\nposition_mm = [0, 0]\n".repeat(100_000);
    refuse(&format!("title = \"t\"\n{pads}"), &["1 to 16 tables", "100000"]);
    refuse(&format!("a = [{}]\n", "1,".repeat(2_000_000)), &["title", "missing"]);
    let deep = vec!["a"; 100_000].join(".");
    refuse(&format!("{deep} = 1\n"), &["recursion limit"]);
    let set = vec!["a"; 100].join(".");
    refuse(&format!("{PAD}[[case]]\nname = \"c\"\nset = {{ \"{set}\" = 1 }}\n"), &["16 parts"]);
    refuse(&format!("a = {}", "[".repeat(100_000)), &["recur"]);
    refuse(&format!("title = \"{}", "\u{202e}\u{301}".repeat(100_000)), &["large.toml:1"]);
}

#[test]
fn plans_of_any_size_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refuse = |axes: &str, words: &[&str]| {
        let plan = format!("scene = \"minimal-sheet\"\nprofile = \"small\"\n{axes}\n");
        fs::write(folder.path().join("plan.toml"), plan).unwrap();
        refuse(folder.path(), "$H sweep plan.toml", words);
    };
    let range = "{ from = 0, to = 1, step = 0.00000101 }";
    let many = |n: usize| (0..n).map(|k| format!("a{k:03} = {range}\n")).collect::<String>();
    refuse(
        &format!("[axes.profile]\n{}", many(100)),
        &["profile.a001: expected at most 1000000 values of all axes"],
    );
    refuse("[random]\ncount = 1000000000000\n", &["at most 10000000 points, got 1000000000000"]);
    let list: Vec<_> = (0..300_000).map(|n| n.to_string()).collect();
    refuse(
        &format!("[axes.profile]\nadc = [{}, 7]\n", list.join(",")),
        &["each value once, got 7"],
    );
    refuse("[axes.profile]\nadc = [16, 16.0]\n", &["plan.toml:4: profile.adc", "once", "16.0"]);
    refuse(
        "[random]\ncount = 1\n[random.scene]\n\"pad.0.load_g\" = { from = -1.7e308, to = 1.7e308 }\n",
        &["plan.toml:6: scene.pad.0.load_g"],
    );
}

#[test]
fn what_a_message_cites_moves_no_cursor() {
    let folder = tempfile::tempdir().unwrap();
    let header = "i1,i2,i3,i4,i5,i6,v_sense,v_haptic\n";
    let cited = format!("{header}1,2,3,\u{1b}[2J\u{202e}{},5,6,7,8\n", "x".repeat(500_000));
    fs::write(folder.path().join("c.csv"), cited).unwrap();
    refuse(
        folder.path(),
        "$H replay c.csv --bits 18",
        &["c.csv:2: i4", "\"\\u{1b}[2J\\u{202e}xxx", "…"],
    );
}

fn named_pipe(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().expect("mkfifo").success());
}

/// Sends a signal to a run; how it ended, and after how long.
fn end(mut run: std::process::Child, signal: &str) -> (Option<i32>, Duration) {
    Command::new("kill").args([signal, &run.id().to_string()]).status().unwrap();
    let start = Instant::now();
    (run.wait().unwrap().code(), start.elapsed())
}

#[test]
fn a_run_that_waits_for_a_writer_can_be_stopped() {
    let folder = tempfile::tempdir().unwrap();
    ["pipe.csv", "pipe.toml"].iter().for_each(|name| named_pipe(&folder.path().join(name)));
    for (args, most_s) in [(["replay", "pipe.csv"], 5), (["simulate", "pipe.toml"], 30)] {
        let run = crate::command(folder.path(), &args).stderr(Stdio::null()).spawn().unwrap();
        sleep(Duration::from_millis(500));
        let (code, after) = end(run, "-TERM");
        assert_eq!(code, Some(130), "{args:?}");
        assert!(after.as_secs() < most_s, "{args:?}: {after:?}");
    }
}

#[test]
fn comments_without_an_end_can_be_stopped() {
    let folder = tempfile::tempdir().unwrap();
    named_pipe(&folder.path().join("pipe"));
    let mut writer = Command::new("sh")
        .args(["-c", "exec yes '#' > pipe"])
        .current_dir(folder.path())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let input = fs::File::open(folder.path().join("pipe")).unwrap();
    let run = crate::command(folder.path(), &["replay", "-"])
        .stdin(input)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    sleep(Duration::from_millis(500));
    assert_eq!(end(run, "-TERM").0, Some(130));
    writer.wait().expect("it ends with its reader");
}

/// What is recommended for it is no number of samples that a window could have, but a number.
#[test]
fn a_haptic_voltage_as_slow_as_can_be_is_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    let slow =
        ["simulate", "minimal-supply", "--waves", "none", "--set", "carrier.haptic_hz=0.001"];
    let log = crate::finish(folder.path(), &slow).stderr;
    assert!(String::from_utf8(log).unwrap().contains("warning: haptic_v_rms"));
}

/// Every file below a folder that has its final name is whole: CSV and TOML end with a line, JSON and
/// HTML with what they end with. How many there are, and how many are unfinished.
fn check_whole(folder: &Path) -> [usize; 2] {
    let mut counts = [0, 0];
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
        if name.starts_with(".partial-") {
            counts[1] += 1;
        } else if path.is_dir() {
            let inner = check_whole(&path);
            counts = [0, 1].map(|n| counts[n] + inner[n]);
        } else {
            counts[0] += 1;
            let bytes = fs::read(&path).unwrap();
            assert!(!is_cut_short(&path, &bytes), "{} is cut short", path.display());
        }
    }
    counts
}

/// Runs that are stopped at any time, by any signal: no half file, nothing left by those that can
/// clear up, and what killed ones leave, in `inner` among others, is cleared by the next.
fn stopped_anywhere(args: &[&str], inner: &str, seed: u64) {
    let folder = tempfile::tempdir().unwrap();
    let mut rng = Rng::with_seed(seed);
    let run = || {
        crate::command(folder.path(), args)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap()
    };
    let start = Instant::now();
    assert!(run().wait().unwrap().code().is_some_and(|code| code < 2), "{args:?} runs");
    let whole = start.elapsed();
    for signal in ["-INT", "-TERM", "-HUP", "-KILL", "-KILL"] {
        let run = run();
        sleep(whole.mul_f64(rng.f64()));
        let (code, _) = end(run, signal);
        let [_, unfinished] = check_whole(folder.path());
        match signal {
            "-KILL" => (),
            _ => assert!(unfinished == 0, "{args:?} {signal}, {code:?}: leaves {unfinished}"),
        }
        // What is younger than this may be of a run that has just begun.
        sleep(Duration::from_millis(1100));
    }
    fs::write(folder.path().join(inner).join(".partial-left"), "by a run that was killed").unwrap();
    sleep(Duration::from_millis(1100));
    run().wait().unwrap();
    let [files, unfinished] = check_whole(folder.path());
    assert!(files > 2 && unfinished == 0, "{args:?}: {files} files, {unfinished} left");
}

#[test]
fn a_simulation_that_is_stopped_anywhere_leaves_no_half_file() {
    stopped_anywhere(
        &[
            "simulate",
            "hockey",
            "--set",
            "duration_s=0.3",
            "--waves",
            "none",
            "--capture",
            "c.csv",
            "--out",
            "o",
        ],
        "o",
        1,
    );
}

#[test]
fn a_replay_that_is_stopped_anywhere_leaves_no_half_file() {
    let source = tempfile::tempdir().unwrap();
    let capture = source.path().join("c.csv");
    let capture = capture.to_str().unwrap();
    crate::finish(
        source.path(),
        &["simulate", "hockey", "--set", "duration_s=0.2", "--waves", "none", "--capture", capture],
    );
    stopped_anywhere(&["replay", capture, "--out", "o"], "o", 2);
}

#[test]
fn a_sweep_that_is_stopped_anywhere_leaves_no_half_file() {
    let source = tempfile::tempdir().unwrap();
    let plan = source.path().join("plan.toml");
    let text = "scene = \"minimal-sheet\"\nprofile = \"small\"\nslots = 2\nseeds = [1, 2, 3, 4]\n[axes.profile]\ncapacitance = [13, 14, 15]\n";
    fs::write(&plan, text).unwrap();
    stopped_anywhere(
        &["sweep", plan.to_str().unwrap(), "--store", "s", "--out", "o"],
        "s/parts",
        3,
    );
}
