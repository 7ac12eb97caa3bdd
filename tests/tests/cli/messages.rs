// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the command says and how it ends.

use std::fs;

use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::{Profile, Wall};
use hapticore_scene::gallery;
use serde_json::Value;

use crate::{expect, finish, refuse};

#[test]
fn scenes_lists_every_bundled_scene() {
    let folder = tempfile::tempdir().unwrap();
    let text = String::from_utf8(expect(folder.path(), &["scenes"], 0).stdout).unwrap();
    let json: Value =
        serde_json::from_slice(&expect(folder.path(), &["scenes", "--json"], 0).stdout).unwrap();
    for (index, (name, _)) in gallery::all().iter().enumerate() {
        assert!(text.contains(name));
        assert_eq!(json[index]["name"], *name);
        assert!(
            !json[index]["effects"].as_array().unwrap().is_empty()
                && json[index]["title"].is_string()
        );
    }
}

#[test]
fn scenes_fit_a_terminal_and_one_is_told_whole() {
    let folder = tempfile::tempdir().unwrap();
    let say = |args: &[&str]| String::from_utf8(expect(folder.path(), args, 0).stdout).unwrap();
    let longest = say(&["scenes"]).lines().map(|line| line.chars().count()).max().unwrap();
    assert!(longest <= 100, "{longest} columns");
    let charge = say(&["scenes", "--show", "minimal-charge"]);
    for part in [
        "Minimal: charge",
        "still reads all of it",
        "  square",
        "  friction under a sine",
        "  charge 0.4 in 0.1 s",
    ] {
        assert!(charge.contains(part), "{part}: {charge}");
    }
    let refused = expect(folder.path(), &["scenes", "--show", "fig66"], 2).stderr;
    let refused = String::from_utf8(refused).unwrap();
    assert!(
        refused.contains("--show: expected a bundled scene") && refused.contains("\"fig66\""),
        "{refused}"
    );
    for (name, _) in gallery::all() {
        let scene: Value =
            serde_json::from_str(&say(&["scenes", "--show", name, "--json"])).unwrap();
        assert!(!scene[0]["summary"].as_str().unwrap().is_empty(), "{name} says what it is about");
    }
}

#[test]
fn a_run_says_less_or_more() {
    let folder = tempfile::tempdir().unwrap();
    let run = |more: &[&str]| {
        let args = ["simulate", "minimal-sheet", "--out", "o"];
        String::from_utf8(expect(folder.path(), &[&args, more].concat(), 0).stdout).unwrap()
    };
    let plain = run(&[]);
    let speed = plain.lines().find(|line| line.contains("s of device time in")).expect("the speed");
    assert!(speed.ends_with("× real time"), "{speed}");
    assert!(
        plain.contains("flags: no frame carries one") && plain.contains("3 of 3 criteria passed"),
        "{plain}"
    );
    assert!(!plain.contains("share of all effects") && !plain.contains('\u{1b}'), "{plain}");
    assert_eq!(run(&["-q"]), "");
    let verbose = run(&["-v"]);
    assert!(verbose.contains("share of all effects") && verbose.contains("· seed "), "{verbose}");
    let version = String::from_utf8(expect(folder.path(), &["--version"], 0).stdout).unwrap();
    let commit = version.trim_end().trim_end_matches(')').split('(').nth(1).expect("a commit");
    assert!(
        commit.trim_end_matches("-modified").len() == 40 && verbose.contains(commit),
        "{version}"
    );
}

#[test]
fn a_sticking_force_has_one_value_in_a_report() {
    let folder = tempfile::tempdir().unwrap();
    let quick = ["--core", "float", "--set", "carrier.rung=phasor"];
    finish(folder.path(), &[&["simulate", "fig15", "--out", "o"][..], &quick].concat());
    let summary: Value =
        serde_json::from_slice(&fs::read(folder.path().join("o/summary.json")).unwrap()).unwrap();
    let criteria = summary["criteria"].as_array().unwrap();
    let named =
        criteria.iter().filter(|it| it["name"].as_str().unwrap().contains("sticking force"));
    let measured: Vec<f64> = named.map(|it| it["measured"].as_f64().unwrap()).collect();
    let sticking =
        |case: usize| summary["findings"]["tracking"][case]["sticking_n"].as_f64().unwrap();
    assert_eq!(measured, [sticking(0)]);
    let report = fs::read_to_string(folder.path().join("o/report.html")).unwrap();
    for case in ["rule A", "rule B", "eq. 11", "larger", "smaller"] {
        let cell = |table: &str| {
            let table = report.split(&format!("aria-label=\"{table}\"")).nth(1).expect("the table");
            let row =
                table.split("<tr>").find(|row| row.contains(case)).expect("the case").to_string();
            let cell = row
                .split("</td>")
                .find(|cell| cell.contains("mean sticking force"))
                .map(String::from);
            cell.unwrap_or_default().rsplit('>').next().unwrap_or_default().to_string()
        };
        assert_eq!(cell("Tracking"), cell("Felt"), "{case}");
    }
}

#[test]
fn a_criterion_that_fails_is_exit_code_1_and_the_results_are_there() {
    let folder = tempfile::tempdir().unwrap();
    let scene = gallery::find("fig6").unwrap().replace("limit = 0.03", "limit = 1e-9");
    fs::write(folder.path().join("strict.toml"), scene).unwrap();
    let log = expect(
        folder.path(),
        &[
            "simulate",
            "strict.toml",
            "--set",
            "dwell_slots=1",
            "--waves",
            "none",
            "--out",
            "out/strict",
        ],
        1,
    )
    .stdout;
    assert!(String::from_utf8(log).unwrap().contains("FAIL"));
    for name in ["frames.csv", "summary.json", "report.html", "profile.toml"] {
        assert!(folder.path().join("out/strict").join(name).exists(), "{name}");
    }
    assert_eq!(
        fs::read_dir(folder.path().join("out/strict")).unwrap().count(),
        4,
        "nothing else stays behind"
    );
}

#[test]
fn a_run_says_first_which_effects_are_on() {
    let folder = tempfile::tempdir().unwrap();
    let log = expect(folder.path(), &["simulate", "fig6", "--set", "dwell_slots=1"], 0).stdout;
    let log = String::from_utf8(log).unwrap();
    let line = log.lines().find(|line| line.starts_with("effects:")).expect("a line of effects");
    for effect in
        ["sheet bicubic", "gap static", "friction coulomb", "carrier samples", "sensor.noise"]
    {
        assert!(line.contains(effect), "{effect} in {line}");
    }
}

#[test]
fn bad_input_is_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let refuse = |args: &[&str], words: &[&str]| refuse(folder.path(), args, words);
    refuse(&["simulate", "fig5"], &["fig3", "hockey", "\"fig5\""]);
    refuse(&["simulate", "none.toml"], &["none.toml"]);
    refuse(
        &["simulate", "fig6", "--set", "sheet.rung=marble"],
        &["fig6.toml", "--set sheet.rung", "marble"],
    );
    refuse(&["simulate", "fig6", "--profile", "huge"], &["standard", "\"huge\""]);
    refuse(&["simulate", "fig3", "--case", "best"], &["--case", "rest", "\"best\""]);
    refuse(&["simulate", "fig3", "--capture", "c.csv"], &["--capture", "one case", "--case"]);
    refuse(&["simulate", "fig6", "--capture", "c.mp3"], &["c.mp3", ".csv or .wav"]);
    refuse(
        &["simulate", "fig6", "--core", "clock", "--set", "carrier.rung=phasor"],
        &["fig6", "carrier.rung", "--set carrier.rung=samples"],
    );
    refuse(
        &["simulate", "fig6", "--waves", "vcd", "--waves-window", "7..8"],
        &["--waves-window", "s"],
    );
    fs::write(folder.path().join("bad.toml"), "name = \"x\"\npads = \"four\"\n").unwrap();
    refuse(&["simulate", "fig6", "--profile", "bad.toml"], &["bad.toml:2: pads", "four"]);
    fs::write(
        folder.path().join("scene.toml"),
        "title = \"x\"\n[[pad]]\nposition_mm = [0, 0]\ncolour = 1\n",
    )
    .unwrap();
    refuse(&["simulate", "scene.toml"], &["scene.toml:4: ", "colour"]);
    fs::write(folder.path().join("file"), "").unwrap();
    let log = expect(folder.path(), &["simulate", "fig6", "--out", "file"], 2).stderr;
    assert_eq!(String::from_utf8(log).unwrap().lines().count(), 1);
}

/// What a controller's words do not hold is refused, with its key, the limit and what was given.
#[test]
fn a_controller_that_cannot_be_is_one_line_with_key_and_limit() {
    let folder = tempfile::tempdir().unwrap();
    for (set, words) in [
        ("control.law=\"magic\"", ["--set control.law", "\"inverse\"", "\"magic\""]),
        ("control.rail_v=600", ["control.rail_v", "to 500", "600"]),
        ("control.rail_v=nan", ["control.rail_v", "to 500", "NaN"]),
        ("control.filter=0", ["control.filter", "expected", "0"]),
        ("control.slew_v=-1", ["control.slew_v", "expected", "-1"]),
        ("control.force=\"spring\"", ["control.force", "\"eq8\", \"table\"", "spring"]),
        ("pad.0.target_n=50", ["pad.0.target_n", "at most 2.000 N", "50"]),
        ("pad.0.target_n=-0.1", ["pad.0.target_n", "expected", "-0.1"]),
        ("sensor.haptic_full_scale_v=5000", ["control.full_scale_v", "at least", "got 500"]),
    ] {
        let case = "sine 0.3 N, closed loop";
        let no_cases = ["--set", "case=[]", "--set", "criterion=[]"];
        let args = [&["simulate", "fig9", "--set", set], &no_cases[..]].concat();
        let args = if set.starts_with("pad") {
            args
        } else {
            vec!["simulate", "fig9", "--set", set, "--case", case]
        };
        refuse(folder.path(), &args, &words);
    }
    for (law, key, limit) in
        [("proportional", "proportional_v", "4000"), ("integral", "proportional_v", "2000")]
    {
        let set = [format!("control.law={law}"), format!("control.{key}=90000")];
        let args = [
            "simulate",
            "fig9",
            "--case",
            "sine 0.3 N, closed loop",
            "--set",
            &set[0],
            "--set",
            &set[1],
        ];
        refuse(folder.path(), &args, &[&format!("control.{key}"), "at most", limit, "90000"]);
    }
}

/// The user did not set the gain that no word can represent.
#[test]
fn a_gain_that_follows_from_the_device_and_fits_no_word_is_refused_as_one() {
    let folder = tempfile::tempdir().unwrap();
    let scene =
        format!("{PAD}target_n = 0.003\n[gap]\n[friction]\n[control]\nlaw = \"proportional\"\n");
    fs::write(folder.path().join("tiny.toml"), scene).unwrap();
    let words = ["control.proportional_v", "at most 4000", "follows from device", "give the key"];
    refuse(folder.path(), &["simulate", "tiny.toml"], &words);
}

/// A scene of one pad, of which each adds a line 4 and further.
const PAD: &str = "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n";

#[test]
fn a_bad_scene_is_one_line_that_names_line_and_key() {
    let folder = tempfile::tempdir().unwrap();
    let refuse = |text: &str, place: &str| {
        fs::write(folder.path().join("bad.toml"), text).unwrap();
        refuse(folder.path(), &["simulate", "bad.toml"], &[place]);
    };
    for (added, place) in [
        ("[magnet]\nrung = \"a\"", "bad.toml:4: magnet: unknown key"),
        (
            "[gap]\nrung = \"marble\"",
            "bad.toml:5: gap.rung: expected one of \"static\", \"hysteresis\", \"quasi-static\"",
        ),
        ("load = 20", "bad.toml:4: pad.0.load: expected load_g, since a key names its unit"),
        (
            "[gap]\ninsulator_um = -8",
            "bad.toml:5: gap.insulator_um: expected a number from 0.01 to 10000, got -8",
        ),
        (
            "load_g = { timeline = [] }",
            "bad.toml:4: pad.0.load_g.timeline: expected a list of pairs",
        ),
        (
            "load_g = { timeline = [[0, 1], [1, 2], [0, 1]] }",
            "bad.toml:4: pad.0.load_g.timeline: expected times that",
        ),
        (
            "[gap]\nrung = \"tr-bdf2\"\nstep_us = 1500",
            "bad.toml:6: gap.step_us: expected at most 1000, since near the fold",
        ),
    ] {
        refuse(&format!("{PAD}{added}\n"), place);
    }
    refuse(
        &PAD.replace("[0, 0]", "[500, 0]"),
        "bad.toml:3: pad.0.position_mm: expected the pad's centre within",
    );
    for nonsense in ["%&@\u{0}\u{1b}[2J ", "[[[[", "é\n"] {
        refuse(&nonsense.repeat((1 << 20) / nonsense.len()), "bad.toml:1: ");
    }
}

#[test]
fn phasors_alone_do_for_slots() {
    let folder = tempfile::tempdir().unwrap();
    for core in ["float", "fixed"] {
        expect(
            folder.path(),
            &["simulate", "fig6", "--core", core, "--set", "carrier.rung=phasor", "--errors"],
            0,
        );
    }
}

#[test]
#[cfg(unix)]
fn an_interrupted_run_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
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
    let mut run =
        crate::command(folder.path(), &args).stdout(std::process::Stdio::null()).spawn().unwrap();
    std::thread::sleep(std::time::Duration::from_millis(700));
    assert!(folder.path().join("out").exists(), "the run has begun");
    std::process::Command::new("kill").args(["-INT", &run.id().to_string()]).status().unwrap();
    assert_eq!(run.wait().unwrap().code(), Some(130));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "nothing stays behind");
}

#[test]
fn a_profile_with_walls_of_other_pads_than_the_scenes_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let standard = Profile::bundled("standard").unwrap();
    let (control, wall) = (Some(Control::of(&standard, Law::Inverse)), Some(Wall::B));
    let profile = Profile { control, wall, pads: 2, ..standard };
    fs::write(folder.path().join("halves.toml"), toml::to_string(&profile).unwrap()).unwrap();
    refuse(
        folder.path(),
        &["simulate", "wall-2d", "--profile", "halves.toml"],
        &["wall.parts", "expected 4", "got 2"],
    );
}

#[test]
fn levels_are_chosen_for_a_million_slots_at_most() {
    let folder = tempfile::tempdir().unwrap();
    let scene = gallery::find("hockey").unwrap();
    let long = scene.lines().map(|line| match line.split_once(" = ") {
        Some(("duration_s", _)) => "duration_s = 3600\nerror_budget_percent = 0.1\n".into(),
        Some(("rung", _)) => String::new(),
        _ => format!("{line}\n"),
    });
    fs::write(folder.path().join("long.toml"), long.collect::<String>()).unwrap();
    let words =
        ["long.toml: ", "expected at most 1000000 slots of a case whose levels are compared"];
    refuse(folder.path(), &["simulate", "long.toml"], &words);
}
