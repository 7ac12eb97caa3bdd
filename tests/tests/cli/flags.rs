// SPDX-License-Identifier: MIT OR Apache-2.0
//! Flags and warnings that a run promises: open terminals, pads at the edge, pads that touch, slow
//! haptic voltages.

use std::fs;
use std::path::Path;

use crate::{Table, expect, finish};

fn frames(folder: &Path, run: &str) -> Table {
    Table::read(&folder.join(run).join("frames.csv"))
}

/// Simulates a scene of these lines in `folder`, with what else is asked for.
fn simulate(folder: &Path, scene: &str, args: &[&str]) -> Table {
    fs::write(folder.join("scene.toml"), format!("title = \"flags\"\n{scene}")).unwrap();
    finish(folder, &[&["simulate", "scene.toml", "--waves", "none", "--out", "o"], args].concat());
    frames(folder, "o")
}

#[test]
fn a_scene_that_calls_for_no_effect_has_no_flag() {
    let folder = tempfile::tempdir().unwrap();
    for sheet in ["", "[sheet]\n"] {
        let scene = format!("duration_s = 0.02\n[[pad]]\nposition_mm = [30, 20]\n{sheet}");
        let table = simulate(folder.path(), &scene, &[]);
        assert_eq!(table.column("flags"), vec![""; table.column("flags").len()], "{scene}");
    }
}

/// Each of the six terminals in turn loses its contact after the device was calibrated, wherever
/// the pad is.
#[test]
fn a_terminal_that_opens_after_calibration_is_told_in_every_frame() {
    let folder = tempfile::tempdir().unwrap();
    for profile in ["standard", "small"] {
        let common = ["simulate", "minimal-sheet", "--profile", profile, "--waves", "none"];
        finish(
            folder.path(),
            &[&common[..], &["--out", "whole", "--capture", "whole.wav"]].concat(),
        );
        let lost = |table: &Table| {
            table.column("flags").iter().filter(|flags| flags.contains("lost")).count()
        };
        assert_eq!(lost(&frames(folder.path(), "whole")), 0, "{profile}");
        for terminal in 1..=6 {
            let open = format!("sheet.open=[{terminal}]");
            finish(
                folder.path(),
                &[&common[..], &["--set", &open, "--out", "o", "--capture", "open.wav"]].concat(),
            );
            let replay =
                ["replay", "open.wav", "--calibration", "whole.wav.calibration.toml", "--out", "r"];
            expect(folder.path(), &[&replay[..], &["--profile", profile]].concat(), 0);
            // Once after a calibration of the whole device, and once although the device was
            // calibrated so.
            for run in ["r", "o"] {
                let table = frames(folder.path(), run);
                assert_eq!(lost(&table), table.rows.len(), "{profile}, terminal {terminal}, {run}");
            }
        }
    }
}

#[test]
fn pads_over_the_edge_are_told() {
    let folder = tempfile::tempdir().unwrap();
    for (place, expected) in
        [("400, 0", ""), ("425, 0", "at_edge"), ("0, -240", "at_edge"), ("-430, 250", "at_edge")]
    {
        let scene = format!(
            "[[pad]]\nposition_mm = [{place}]\nover_edge = true\n[sheet]\n[carrier]\nrung = \"samples\"\n"
        );
        let table = simulate(folder.path(), &scene, &[]);
        assert!(
            table.column("flags").iter().all(|flags| *flags == expected),
            "{place}: {:?}",
            table.column("flags")
        );
        let truth = if expected.is_empty() { "0" } else { "1" };
        assert!(table.column("true_over_edge").iter().all(|over| *over == truth), "{place}");
    }
}

/// Two pads of 30 mm approach each other along x.
#[test]
fn pads_that_touch_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "duration_s = 0.05\n[[pad]]\nposition_mm = [0, 0]\n[[pad]]\n\
        position_mm = { line = { from_mm = [60, 0], to_mm = [10, 0], period_s = 0.1 } }\n\
        [sheet]\n[coupling]\n[carrier]\nrung = \"phasor\"\n";
    let table = simulate(folder.path(), scene, &[]);
    let told = |name: &str, is: fn(&str) -> bool| {
        table.column(name).into_iter().map(is).collect::<Vec<_>>()
    };
    let (told, truth) = (
        told("flags", |flags| flags.contains("touching")),
        told("true_touching", |flag| flag == "1"),
    );
    let differ = told.iter().zip(&truth).filter(|(told, truth)| told != truth).count();
    assert!(truth.contains(&true) && truth.contains(&false), "{truth:?}");
    // A pad's place is a slot old where the other's is read, and pads that touch shift each
    // other's.
    assert!(differ <= 4 && told.last() == Some(&true), "{told:?}\n{truth:?}");
}

#[test]
fn a_mean_over_windows_reads_a_slow_haptic_voltage() {
    let folder = tempfile::tempdir().unwrap();
    let text = hapticore_contract::profile::BUNDLED
        .iter()
        .find(|(name, _)| *name == "standard")
        .unwrap()
        .1;
    for windows in [1, 16] {
        let own = text
            .replace("name = \"standard\"", "name = \"mine\"")
            .replace("windows = 1", &format!("windows = {windows}"));
        fs::write(folder.path().join("mine.toml"), own).unwrap();
        let scene = "duration_s = 0.2\n[[pad]]\nposition_mm = [50, 20]\nhaptic_v_rms = 100\n\
            [sheet]\n[carrier]\nrung = \"samples\"\nhaptic_hz = 130\n";
        let args = ["--profile", "mine.toml"];
        let outcomes = ["float", "fixed", "clock"].map(|core| {
            let table = simulate(folder.path(), scene, &[&args[..], &["--core", core]].concat());
            let off = |name: &str, truth: &str| {
                let (read, truth) = (table.numbers(name), table.numbers(truth));
                let off = read.iter().zip(truth).map(|(read, truth)| (read / truth - 1.0).abs());
                off.skip(windows).fold(0.0, f64::max)
            };
            (
                off("haptic_v_rms", "true_haptic_v_rms"),
                off("force_n", "true_force_n"),
                table.column("haptic_v_rms").join(","),
            )
        });
        for (voltage, force, _) in &outcomes {
            match windows {
                1 => assert!(*voltage > 0.2 && *force > 0.4, "{voltage} {force}"),
                _ => assert!(*voltage < 0.01 && *force < 0.02, "{voltage} {force}"),
            }
        }
        assert_eq!(outcomes[1].2, outcomes[2].2, "fixed and clock, {windows} windows");
    }
}

#[test]
fn a_wall_that_sticks_is_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    finish(folder.path(), &["new", "wall", "wall.toml"]);
    let warned = |rule: &str| {
        let set = format!("wall.rule={rule}");
        let args = ["simulate", "wall.toml", "--set", &set, "--waves", "none", "--out", rule];
        let output = finish(folder.path(), &args);
        String::from_utf8_lossy(&output.stderr).contains("sticks with")
    };
    assert!(warned("direct") && !warned("sequential"));
}
