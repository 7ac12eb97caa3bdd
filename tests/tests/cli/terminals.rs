// SPDX-License-Identifier: MIT OR Apache-2.0
//! Devices with another sheet and other terminals than the paper's: they run, and a run says where
//! positions are off.

use std::fs;

use crate::{Table, expect, finish, refuse};

/// A sheet with this many terminals along its edges.
const PLACES: [(usize, &str); 3] = [
    (4, "sheet.terminals=4"),
    (5, "sheet.terminals_mm=[[-430, 250], [-430, -250], [430, -250], [430, 250], [0, 250]]"),
    (
        8,
        "sheet.terminals_mm=[[-430, 250], [-430, -250], [430, -250], [430, 250], [0, 250], [0, -250], [430, 0], [-430, 0]]",
    ),
];

#[test]
fn bundled_profiles_take_the_terminals_of_the_device() {
    let folder = tempfile::tempdir().unwrap();
    for (terminals, places) in PLACES {
        let common = ["simulate", "minimal-sheet", "--set", places, "--waves", "none"];
        let run = |core: &str, out: &str| {
            finish(folder.path(), &[&common[..], &["--core", core, "--out", out]].concat());
            fs::read_to_string(folder.path().join(out).join("frames.csv")).unwrap()
        };
        let (fixed, clock) = (run("fixed", "fixed"), run("clock", "clock"));
        assert_eq!(fixed, clock, "{terminals} terminals");
        let table = Table::read(&folder.path().join("fixed/frames.csv"));
        assert!(
            table.column("flags").iter().all(|flags| !flags.contains("lost")),
            "{terminals} terminals"
        );
        let force = table.numbers("force_n").into_iter().zip(table.numbers("true_force_n"));
        force.for_each(|(force, truth)| {
            assert!((force / truth - 1.0).abs() < 0.02, "{terminals}: {force} {truth} N")
        });
    }
}

#[test]
fn a_capture_of_four_terminals_is_replayed_as_it_was_simulated() {
    let folder = tempfile::tempdir().unwrap();
    let args = [
        "simulate",
        "minimal-sheet",
        "--set",
        "sheet.terminals=4",
        "--waves",
        "none",
        "--out",
        "o",
    ];
    finish(folder.path(), &[&args[..], &["--capture", "c.wav"]].concat());
    expect(folder.path(), &["replay", "c.wav", "--out", "r"], 0);
    let [simulated, replayed] = ["o", "r"].map(|run| {
        Table::read(&folder.path().join(run).join("frames.csv")).numbers("capacitance_pf")
    });
    assert_eq!(simulated, replayed);
}

#[test]
fn a_profile_of_ones_own_keeps_its_number_of_terminals() {
    let folder = tempfile::tempdir().unwrap();
    let text = hapticore_contract::profile::BUNDLED
        .iter()
        .find(|(name, _)| *name == "standard")
        .unwrap()
        .1;
    fs::write(
        folder.path().join("mine.toml"),
        text.replace("name = \"standard\"", "name = \"mine\""),
    )
    .unwrap();
    let set = ["--set", "sheet.terminals=4", "--profile", "mine.toml"];
    let words = ["profile mine", "terminals.x", "expected 4 signs", "got 6"];
    refuse(folder.path(), &[&["simulate", "minimal-sheet"], &set[..]].concat(), &words);
}

/// A device of eight terminals needs only a scene and a profile: no line of the program names them.
#[test]
fn eight_terminals_need_a_profile_and_a_scene_alone() {
    let folder = tempfile::tempdir().unwrap();
    let text = hapticore_contract::profile::BUNDLED
        .iter()
        .find(|(name, _)| *name == "standard")
        .unwrap()
        .1;
    let own = |line: &str| match line.split_once('=').map_or("", |(key, _)| key.trim()) {
        "name" => "name = \"mine\"\n".to_string(),
        "clocks_per_sample" => "clocks_per_sample = 42\n".to_string(),
        "x" => "x = [-1, -1, 1, 1, 0, 0, 1, -1]\n".to_string(),
        "y" => "y = [1, -1, -1, 1, 1, -1, 0, 0]\n".to_string(),
        _ => format!("{line}\n"),
    };
    fs::write(folder.path().join("mine.toml"), text.lines().map(own).collect::<String>()).unwrap();
    let scene = "title = \"eight\"\n[[pad]]\nposition_mm = { raster = { nx = 5, ny = 4, margin_mm = 20 } }\nhaptic_v_rms = 150\n\
                 [[pad]]\nposition_mm = [100, 60]\n[sheet]\nterminal_ohm = 100\nterminals_mm = [[-430, 250], [-430, -250], \
                 [430, -250], [430, 250], [0, 250], [0, -250], [430, 0], [-430, 0]]\n[carrier]\nrung = \"samples\"\n\
                 [sensor]\nquantisation_bits = 18\nnoise_ppm_rms = 10\n[[criterion]]\nname = \"position\"\n\
                 measure = \"rms_error\"\nof = \"position_mm\"\nlimit = 0.1\n";
    fs::write(folder.path().join("eight.toml"), scene).unwrap();
    let run = |core: &str| {
        let args = [
            "simulate",
            "eight.toml",
            "--profile",
            "mine.toml",
            "--waves",
            "none",
            "--core",
            core,
            "--out",
            core,
        ];
        expect(folder.path(), &args, 0);
        fs::read(folder.path().join(core).join("frames.csv")).unwrap()
    };
    assert_eq!(run("fixed"), run("clock"));
    run("float");
    assert_eq!(Table::read(&folder.path().join("fixed/frames.csv")).numbers("x_mm").len(), 40);
}

#[test]
fn a_position_table_that_does_not_fit_its_sheet_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let log = |args: &[&str]| String::from_utf8(finish(folder.path(), args).stderr).unwrap();
    let fits =
        log(&["simulate", "minimal-sheet", "--waves", "none", "--out", "o", "--capture", "c.wav"]);
    assert!(!fits.contains("the position table"), "860 × 500 mm: {fits}");
    // Places that were written down 4 mm too far to either side, in turn: no table fits these.
    let text = fs::read_to_string(folder.path().join("c.wav.calibration.toml")).unwrap();
    let (head, places) = text.split_once("places = [").unwrap();
    let mut by = 4.0;
    let moved = places.lines().map(|line| {
        match line.strip_prefix('[').and_then(|place| place.split_once(',')) {
            Some((x, rest)) => {
                by = -by;
                format!("[{},{rest}\n", x.parse::<f64>().unwrap() + by)
            }
            None => format!("{line}\n"),
        }
    });
    fs::write(
        folder.path().join("off.toml"),
        format!("{head}places = [{}", moved.collect::<String>()),
    )
    .unwrap();
    let off = log(&["replay", "c.wav", "--calibration", "off.toml", "--out", "r"]);
    assert!(off.contains("the position table does not fit this device: "), "{off}");
    let summary = fs::read_to_string(folder.path().join("o/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert!(summary["position_table"]["rms_mm"].as_f64().is_some_and(|rms| rms > 0.0 && rms < 1.0));
}
