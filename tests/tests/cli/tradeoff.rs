// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore tradeoff`: its files, what its table says, and the profile that a search finds.

use std::fs;
use std::path::Path;

use hapticore_contract::profile::Profile;
use serde_json::Value;

use crate::{Table, expect, refuse};

const SCENE: [&str; 5] = ["tradeoff", "--scene", "fig6", "--slots", "4"];

fn run(folder: &Path, more: &[&str]) -> Value {
    let args = [&SCENE[..], more, &["--out", "t", "--json"]].concat();
    serde_json::from_slice(&expect(folder, &args, 0).stdout).expect("JSON")
}

/// The measured rms of a quantity at a knob's value.
fn rms(table: &Table, quantity: &str, knob: &str, value: &str) -> f64 {
    let (knobs, values) = (table.column("knob"), table.column("value"));
    let row = (0..knobs.len()).find(|n| knobs[*n] == knob && values[*n] == value);
    table.numbers(&format!("measured_{quantity}_rms"))[row.expect("a row")]
}

#[test]
#[cfg_attr(not(optimised), ignore = "dozens of profiles: run with --release")]
fn a_tradeoff_is_swept_and_the_profile_that_is_found_is_one() {
    let folder = tempfile::tempdir().unwrap();
    let told = run(folder.path(), &["--target", "force=1mN,position=0.5mm", "--explain"]);
    let table = Table::read(&folder.path().join("t/tradeoff.csv"));
    let points = told["points"].as_array().expect("points");
    assert_eq!(table.column("knob").len(), points.len());
    let [short, long] = ["14", "18"].map(|bits| rms(&table, "force", "force", bits));
    assert!(short > 8.0 * long, "four bits: {short} mN, {long} mN");
    let found = &told["found"];
    for (n, most) in [(0, 1.0), (2, 500.0)] {
        let measured = found["judged"]["errors"][n]["rms"].as_f64().expect("a number");
        assert!(measured <= most, "{measured} of {most}");
    }
    let cells = |of: &str| found[of]["luts"].as_f64().expect("a number");
    assert!(cells("cost") < 0.9 * cells("before"), "{} of {}", cells("cost"), cells("before"));
    let next = told["next_bits"].as_array().expect("next bits");
    let most = |n: usize| {
        let less = |of: &&Value| of["less"][n].as_f64().expect("a number");
        let largest = next.iter().max_by(|a, b| less(a).total_cmp(&less(b))).expect("some");
        (largest["knob"].as_str().expect("a key"), less(&largest))
    };
    assert!(most(0).1 > 0.0 && most(2).1 > 0.0, "{next:?}");
    assert_ne!(most(2).0, "force", "no position by bits of the force");
    let text = fs::read_to_string(folder.path().join("t/profile.toml")).unwrap();
    let profile = Profile::parse(&text).expect("a profile");
    assert_eq!(hapticore_model::check(&profile), Ok(()));
    assert_eq!(profile.name, "standard-found");
    assert!(folder.path().join("t/report.html").exists());
}

/// Levels of such a scene are chosen before it is run.
#[test]
#[cfg_attr(not(optimised), ignore = "dozens of profiles: run with --release")]
fn a_scene_with_an_error_budget_is_swept() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["tradeoff", "--scene", "minimal-sheet", "--profile", "small", "--slots", "1"];
    expect(folder.path(), &[&args[..], &["--out", "t"]].concat(), 0);
}

/// A scene of a user's own without `[sensor]`, which asks for a window: as `simulate` runs it.
#[test]
#[cfg_attr(not(optimised), ignore = "dozens of profiles: run with --release")]
fn a_file_is_swept_with_the_window_that_it_asks_for() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "title = \"t\"\nwindow_samples = 400\n[[pad]]\nposition_mm = [90, 40]\nhaptic_v_rms = 150\n[sheet]\n";
    fs::write(folder.path().join("mine.toml"), scene).unwrap();
    let args = ["tradeoff", "--profile", "small", "--slots", "1", "--out", "t", "--scene"];
    let age_us = |scenes: &[&str], warning: &str| {
        let output = expect(folder.path(), &[&args[..], scenes].concat(), 0);
        let log = String::from_utf8(output.stderr).unwrap();
        assert!(log.contains(warning) && log.is_empty() == warning.is_empty(), "{log}");
        Table::read(&folder.path().join("t/tradeoff.csv")).numbers("age_us")[0]
    };
    let asked = age_us(&["mine.toml"], "");
    // Half of the 100 samples that the profile's own window is longer, at a megasample per second.
    let own = age_us(&["mine.toml", "--scene", "fig6"], "mine: window_samples");
    assert!((own - asked - 50.0).abs() < 1e-9, "{own} {asked}");
}

#[test]
fn targets_and_scenes_that_cannot_be_are_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |args: &[&str], words: &[&str]| {
        refuse(folder.path(), &[&["tradeoff", "--slots", "1"], args].concat(), words);
    };
    refused(&["--target", "force"], &["--target", "force=1mN", "got \"force\""]);
    refused(&["--target", "force=1mm"], &["--target", "force", "mN", "got \"mm\""]);
    refused(&["--target", "force=-1mN"], &["--target", "got \"force=-1mN\""]);
    refused(&["--scene", "nowhere"], &["nowhere"]);
}
