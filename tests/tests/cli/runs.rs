// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a run is made of and where it goes: keys that are set, criteria that do not apply, folders,
//! frames, the summary.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::{Table, expect, finish, refuse};

fn summary(folder: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.join("summary.json")).unwrap()).unwrap()
}

/// `simulate fig6` with keys set; its summary.
fn fig6(folder: &Path, set: &[&str]) -> Value {
    let set = set.iter().flat_map(|key| ["--set", key]);
    let args: Vec<_> =
        ["simulate", "fig6", "--waves", "none", "--out", "o"].into_iter().chain(set).collect();
    finish(folder, &args);
    summary(&folder.join("o"))
}

#[test]
fn keys_of_the_whole_scene_can_be_set() {
    let folder = tempfile::tempdir().unwrap();
    let set = [
        "seed=5",
        "title=mine",
        "figure=fig4",
        "record=[\"frames\"]",
        "profile=small",
        "window_samples=1200",
    ];
    let summary = fig6(folder.path(), &set);
    let values = ["seed", "title", "figure", "profile"].map(|key| summary[key].clone());
    assert_eq!(
        values,
        [5.into(), "mine".into(), "fig4".into(), "small".into()].map(|value: Value| value)
    );
    let seconds = summary["simulated_seconds"].as_f64().unwrap();
    let other = fig6(folder.path(), &["profile=small"])["simulated_seconds"].as_f64().unwrap();
    assert!(seconds != other, "the window is another: {seconds} s, {other} s");
    refuse(folder.path(), &["simulate", "fig6", "--set", "sed=5"], &["--set sed", "unknown key"]);
    refuse(
        folder.path(),
        &["simulate", "fig6", "--set", "seed=five"],
        &["--set seed", "an integer", "five"],
    );
}

#[test]
fn a_seed_makes_another_noise() {
    let folder = tempfile::tempdir().unwrap();
    let frames = |seed: &str| {
        fig6(folder.path(), &[&format!("seed={seed}"), "dwell_slots=1"]);
        fs::read(folder.path().join("o/frames.csv")).unwrap()
    };
    assert!(frames("5") == frames("5") && frames("5") != frames("6"));
}

#[test]
fn a_criterion_whose_condition_never_occurs_is_not_applicable() {
    let folder = tempfile::tempdir().unwrap();
    let output =
        expect(folder.path(), &["simulate", "fig6", "--set", "pad.0.load_g=50", "--out", "o"], 0);
    let log = String::from_utf8(output.stdout).unwrap();
    assert!(
        log.contains("not applicable") && !log.contains("NaN") && !log.contains("FAIL"),
        "{log}"
    );
    let criteria = summary(&folder.path().join("o"))["criteria"].clone();
    let applicable: Vec<_> =
        criteria.as_array().unwrap().iter().map(|one| one["applicable"].clone()).collect();
    let of_50_g = [true, true, false, false, false, false, true, true, false, false];
    assert_eq!(applicable, of_50_g);
    let report = fs::read_to_string(folder.path().join("o/report.html")).unwrap();
    assert!(report.contains("4 of 4 criteria passed. 6 not applicable"), "the report says so");
    // The condition occurs, and what it asks for does not: that fails still.
    let low = ["simulate", "fig6", "--set", "pad.0.haptic_v_rms=90", "--waves", "none"];
    assert!(String::from_utf8(expect(folder.path(), &low, 1).stdout).unwrap().contains("FAIL"));
}

#[test]
fn no_run_overwrites_another() {
    let folder = tempfile::tempdir().unwrap();
    let short = ["simulate", "hockey", "--set", "duration_s=0.02", "--waves", "none"];
    finish(folder.path(), &[&short[..], &["--capture", "hockey.wav"]].concat());
    finish(folder.path(), &[&short[..], &["--set", "pad.0.load_g=50"]].concat());
    finish(folder.path(), &[&short[..], &["--profile", "small"]].concat());
    finish(folder.path(), &[&short[..], &["--core", "float"]].concat());
    expect(folder.path(), &["replay", "hockey.wav"], 0);
    expect(folder.path(), &["replay", "hockey.wav", "--core", "clock"], 0);
    let mut names: Vec<_> =
        fs::read_dir(folder.path().join("out")).unwrap().map(|e| e.unwrap().file_name()).collect();
    names.sort();
    let expected = [
        "hockey-duration_s=0.02",
        "hockey-duration_s=0.02-pad.0.load_g=50",
        "hockey-float-duration_s=0.02",
        "hockey-small-duration_s=0.02",
        "replay-hockey.wav",
        "replay-hockey.wav-clock",
    ];
    assert_eq!(names, expected);
}

#[test]
fn waves_of_an_earlier_run_do_not_stay() {
    let folder = tempfile::tempdir().unwrap();
    let run = |waves: &str| {
        finish(
            folder.path(),
            &["simulate", "fig6", "--set", "dwell_slots=1", "--waves", waves, "--out", "o"],
        );
        let mut names: Vec<String> = Vec::new();
        for entry in fs::read_dir(folder.path().join("o")).unwrap().flatten() {
            names.push(entry.file_name().into_string().unwrap());
        }
        names.sort();
        names
    };
    assert!(run("vcd").contains(&"waves.vcd".to_string()));
    fs::write(folder.path().join("o/notes.txt"), "mine").unwrap();
    fs::write(folder.path().join("o/waves.txt"), "mine, too").unwrap();
    let names = run("fst");
    assert!(
        names.contains(&"waves.fst".to_string()) && !names.contains(&"waves.vcd".to_string()),
        "{names:?}"
    );
    assert_eq!(
        run("none"),
        ["frames.csv", "notes.txt", "profile.toml", "report.html", "summary.json", "waves.txt"]
    );
}

#[test]
fn a_capture_does_not_take_the_place_of_what_the_run_writes() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("d.csv")).unwrap();
    for (capture, words) in [
        ("results/frames.csv", ["--capture results/frames.csv", "name of its own"]),
        ("./results/../results/frames.csv", ["--capture", "name of its own"]),
        ("d.csv", ["d.csv", "there is a folder of this name"]),
        ("none/c.csv", ["none/c.csv", "No such file"]),
    ] {
        refuse(
            folder.path(),
            &["simulate", "hockey", "--set", "duration_s=0.02", "--capture", capture],
            &words,
        );
    }
}

#[test]
fn frames_name_case_and_settings() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["simulate", "fig3", "--set", "pad.0.position_mm.raster.nx=2", "--out", "o"];
    finish(folder.path(), &args);
    let table = Table::read(&folder.path().join("o/frames.csv"));
    let cases: Vec<_> = summary(&folder.path().join("o"))["cases"].as_array().unwrap().clone();
    let mut seen = table.column("case");
    seen.dedup();
    assert_eq!(seen, cases.iter().map(|case| case.as_str().unwrap()).collect::<Vec<_>>());
    assert_eq!(table.numbers("set_x_mm"), table.numbers("true_x_mm"));
    fig6(folder.path(), &["dwell_slots=2"]);
    let table = Table::read(&folder.path().join("o/frames.csv"));
    assert_eq!(
        table.names[21..],
        [
            "case",
            "point",
            "true_load_g",
            "true_friction_n",
            "set_load_g",
            "set_haptic_v_rms",
            "true_over_edge",
            "true_touching"
        ]
    );
    let (load, volts) = (table.numbers("set_load_g"), table.numbers("set_haptic_v_rms"));
    assert_eq!((load[0], volts[0], load[215], volts[215]), (20.0, 0.0, 100.0, 350.0));
    assert_eq!(
        table.numbers("point"),
        (0..216).map(|slot| f64::from(slot / 2)).collect::<Vec<_>>()
    );
}

#[test]
fn a_summary_tells_how_to_repeat_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let set = [
        "--set",
        "pad.0.position_mm.raster.nx=3",
        "--set",
        "sheet.terminal_ohm=300",
        "--set",
        "seed=9",
    ];
    finish(
        folder.path(),
        &[&["simulate", "fig3", "--case", "500-ohm", "--out", "o"], &set[..]].concat(),
    );
    let first = summary(&folder.path().join("o"));
    assert_eq!(first["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(
        (first["seed"].as_u64(), first["set"][1].clone()),
        (Some(9), serde_json::json!(["sheet.terminal_ohm", "300"]))
    );
    assert_eq!(first["command"].as_array().unwrap()[1..3], ["simulate", "fig3"]);
    let commit =
        first["commit"].as_str().expect("built from a repository").trim_end_matches("-modified");
    assert!(commit.len() == 40 && commit.bytes().all(|byte| byte.is_ascii_hexdigit()), "{commit}");
    let scene = first["resolved_scene"]["500-ohm"].as_str().expect("the case as a scene");
    assert!(scene.contains("terminal_ohm = 300") && !scene.contains("[[case]]"), "{scene}");
    fs::write(folder.path().join("again.toml"), scene).unwrap();
    finish(folder.path(), &["simulate", "again.toml", "--out", "a"]);
    let again = summary(&folder.path().join("a"));
    let names = |summary: &Value| {
        let criteria = summary["criteria"].as_array().unwrap();
        criteria
            .iter()
            .map(|one| (one["name"].clone(), one["measured"].clone()))
            .collect::<Vec<_>>()
    };
    let frames = |name: &str| {
        let table = Table::read(&folder.path().join(name).join("frames.csv"));
        table.rows.into_iter().map(|row| row[..21].to_vec()).collect::<Vec<_>>()
    };
    let [x, y] = [frames("o"), frames("a")]
        .map(|rows| rows.into_iter().map(|row| row[12..].to_vec()).collect::<Vec<_>>());
    assert!(x == y, "the same truth");
    assert_eq!(names(&first).len(), names(&again).len(), "the same criteria");
}

#[test]
fn a_haptic_voltage_too_slow_for_the_window_is_told_with_its_cure() {
    let folder = tempfile::tempdir().unwrap();
    let run = |set: &[&str]| {
        let set = set.iter().flat_map(|key| ["--set", key]);
        let args = ["simulate", "fig6", "--waves", "none", "--out", "o", "--set", "dwell_slots=1"];
        String::from_utf8(
            finish(folder.path(), &args.into_iter().chain(set).collect::<Vec<_>>()).stderr,
        )
        .unwrap()
    };
    assert_eq!(run(&[]), "", "1 kHz is quick enough");
    let log = run(&["carrier.haptic_hz=200"]);
    assert!(
        log.starts_with("warning: haptic_v_rms") && log.contains("5000 samples (window_samples"),
        "{log}"
    );
    assert!(summary(&folder.path().join("o"))["warnings"][0].as_str().unwrap().contains("200 Hz"));
    assert!(
        fs::read_to_string(folder.path().join("o/report.html"))
            .unwrap()
            .contains("class=\"warning\"")
    );
    assert_eq!(run(&["carrier.haptic_hz=200", "window_samples=5000"]), "", "the cure");
    assert_eq!(run(&["carrier.haptic_hz=200", "pad.0.haptic_v_rms=0"]), "", "nothing alternates");
}
