// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bundled scenes, whole: their criteria hold, `fixed` is `clock` on every frame, long scenes made short, and nothing
//! depends on the number of threads.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use hapticore_contract::profile::Profile;
use hapticore_scene::gallery;
use rayon::prelude::*;
use serde_json::Value;

use crate::{Table, expect, finish};

const HEADER: &str = "time_s,pad,r_x,r_y,x_mm,y_mm,capacitance_pf,sheet_ohm,haptic_v_rms,force_n,direction,flags,\
true_r_x,true_r_y,true_x_mm,true_y_mm,true_capacitance_pf,true_sheet_ohm,true_haptic_v_rms,true_force_n,true_direction,\
case,point,true_load_g,true_friction_n";

fn simulate(folder: &Path, scene: &str, core: &str) -> Value {
    let output = expect(folder, &["simulate", scene, "--core", core, "--out", core, "--json"], 0);
    let summary: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let written = fs::read_to_string(folder.join(core).join("summary.json")).unwrap();
    assert_eq!(
        summary,
        serde_json::from_str::<Value>(&written).unwrap(),
        "what is printed is what is written"
    );
    summary
}

/// Frames with a flag for which there is no reason. `at_edge` is for pads whose reach is at the sheet's edge,
/// `touching` for pads near each other, `at_curve` for drives whose force is short of its target. No other flag
/// has a reason.
fn unexpected_flags(table: &Table, summary: &Value) -> Vec<String> {
    const REACH_MM: f64 = 15.0;
    const NEAR_MM: f64 = 2.0;
    let half_mm = [0, 1].map(|axis| summary["sheet_mm"][axis].as_f64().expect("a size") / 2.0);
    let (x_mm, y_mm) = (table.numbers("true_x_mm"), table.numbers("true_y_mm"));
    let (pads, flags) = (table.column("pad"), table.column("flags"));
    let short = short_of_target(table);
    let runs = table.column("case").into_iter().zip(table.column("point")).collect::<Vec<_>>();
    // The last place of each pad of a run, which is what the host knows of the others.
    let mut last = HashMap::new();
    let mut unexpected = Vec::new();
    for k in 0..flags.len() {
        let at = [x_mm[k], y_mm[k]];
        last.insert((runs[k], pads[k]), at);
        let at_edge = at.iter().zip(half_mm).any(|(at, half)| at.abs() > half - REACH_MM - NEAR_MM);
        let others = last.iter().filter(|((run, pad), _)| *run == runs[k] && *pad != pads[k]);
        let touching = others
            .map(|(_, other)| (at[0] - other[0]).hypot(at[1] - other[1]))
            .any(|distance| distance < 2.0 * REACH_MM + NEAR_MM);
        let expected = |flag: &str| match flag {
            "" => true,
            "at_edge" => at_edge,
            "touching" => touching,
            "at_curve" => short[k],
            _ => false,
        };
        if !flags[k].split('+').all(expected) {
            unexpected.push(format!("frame {k}, pad {} at {at:?}: {}", pads[k], flags[k]));
        }
    }
    unexpected
}

/// Whether the force that each frame reads is more than 5 % and 5 mN below its target.
fn short_of_target(table: &Table) -> Vec<bool> {
    let read_n = table.numbers("force_n");
    if !table.names.iter().any(|name| name == "target_n") {
        return vec![false; read_n.len()];
    }
    let targets_n = table.numbers("target_n");
    read_n.iter().zip(targets_n).map(|(read_n, of_n)| *read_n < 0.95 * of_n - 0.005).collect()
}

/// A force loop has a plant that waits for it, and many cases: of each, every clock of so long.
const LOOP_S: f64 = 0.07;
/// The same of other scenes, and places along either side of a raster.
const LONGEST_S: f64 = 0.5;
const COARSE: [i64; 2] = [13, 8];

/// What makes a scene so short that each of its clocks can be run.
fn shortened(text: &str) -> Vec<String> {
    let scene: toml::Table = text.parse().expect("a bundled scene");
    let longest_s = if scene.contains_key("control") { LOOP_S } else { LONGEST_S };
    let mut set = Vec::new();
    if scene.get("duration_s").and_then(toml::Value::as_float).is_some_and(|s| s > longest_s) {
        set.push(format!("duration_s={longest_s}"));
    }
    let pads = scene["pad"].as_array().expect("pads");
    for (n, pad) in pads.iter().enumerate() {
        let raster = pad.get("position_mm").and_then(|place| place.get("raster"));
        for (side, most) in ["nx", "ny"].into_iter().zip(COARSE) {
            let places = raster.and_then(|raster| raster[side].as_integer());
            if places.is_some_and(|places| places > most) {
                set.push(format!("pad.{n}.position_mm.raster.{side}={most}"));
            }
        }
    }
    set
}

/// Holds that `fixed` is `clock`, to the bit, in every frame of a scene with these keys set.
fn check_every_clock(folder: &Path, scene: &str, set: &[String]) {
    let frames = |core: &str| {
        let mut args = vec!["simulate", scene, "--core", core, "--out", core];
        set.iter().for_each(|set| args.extend(["--set", set]));
        finish(folder, &args);
        let frames = fs::read_to_string(folder.join(core).join("frames.csv")).unwrap();
        assert!(frames.lines().count() > 100, "{scene}: {} frames", frames.lines().count());
        frames
    };
    assert!(frames("fixed") == frames("clock"), "{scene}: fixed is clock, to the bit");
}

/// Holds the same where a loop does what its first clocks do not show.
fn check_loop_with(scene: &str, set: &[&str]) {
    check_loop_of(None, scene, set);
}

/// The same with a profile of its own.
fn check_loop_of(profile: Option<&Profile>, scene: &str, set: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    if let Some(profile) = profile {
        fs::write(folder.path().join("own.toml"), toml::to_string(profile).unwrap()).unwrap();
    }
    let frames = |core: &str| {
        let mut args = vec!["simulate", scene, "--core", core, "--out", core];
        set.iter().for_each(|set| args.extend(["--set", set]));
        args.extend(profile.iter().flat_map(|_| ["--profile", "own.toml"]));
        finish(folder.path(), &args);
        Table::read(&folder.path().join(core).join("frames.csv"))
    };
    let (fixed, clock) = (frames("fixed"), frames("clock"));
    let drives = fixed.numbers("drive_v_rms");
    assert!(drives.iter().any(|volt| *volt > 100.0), "{scene}: the loop drives the pad");
    for name in &fixed.names {
        assert!(fixed.column(name) == clock.column(name), "{scene}: {name}, fixed and clock");
    }
}

#[test]
#[cfg_attr(not(optimised), ignore = "every clock of a loop: run with --release")]
fn a_force_table_in_a_loop_is_the_same_in_fixed_and_clock() {
    let target = "pad.0.target_n={ timeline = [[0, 0], [0.005, 0], [0.005, 0.6]] }";
    check_loop_with("fig9", &["control.force=\"table\"", "duration_s=0.03", target]);
}

/// In every case of `fig15` a pad that is pushed into the wall and drawn out of it.
#[test]
#[cfg_attr(not(optimised), ignore = "every clock of a loop: run with --release")]
fn a_wall_is_met_and_left_alike_in_fixed_and_clock() {
    let place = "{ timeline = { x_mm = [[0, 0.3], [0.006, -0.8], [0.012, -0.8], [0.02, 0.5]] } }";
    let place = format!("pad.0.position_mm={place}");
    check_loop_with("fig15", &["hand.stiffness_n_per_m=20000", "duration_s=0.024", &place]);
}

/// In `wall-2d` a pad that is pushed into the corner of two walls and drawn out of it.
#[test]
#[cfg_attr(not(optimised), ignore = "every clock of a loop: run with --release")]
fn walls_along_both_axes_are_met_and_left_alike_in_fixed_and_clock() {
    let line = "[[0, 0.3], [0.008, -0.8], [0.016, -0.8], [0.026, 0.5]]";
    let place = format!("pad.0.position_mm={{ timeline = {{ x_mm = {line}, y_mm = {line} }} }}");
    check_loop_with("wall-2d", &["hand.stiffness_n_per_m=20000", "duration_s=0.032", &place]);
}

fn check(scene: &str, text: &str) {
    let folder = tempfile::tempdir().unwrap();
    let mut summary = Value::Null;
    let short = shortened(text);
    let cores =
        if short.is_empty() { &["float", "fixed", "clock"][..] } else { &["float", "fixed"] };
    for core in cores.iter().copied() {
        summary = simulate(folder.path(), scene, core);
        for key in ["scene", "profile", "fidelity", "effects", "simulated_seconds", "wall_seconds"]
        {
            assert!(!summary[key].is_null(), "{scene}: {key}");
        }
        for criterion in summary["criteria"].as_array().expect("criteria") {
            println!(
                "{scene} {core}: {} {} of {}",
                criterion["name"], criterion["measured"], criterion["limit"]
            );
            assert_eq!(criterion["pass"], true, "{scene} {core}: {criterion}");
            assert_eq!(criterion["applicable"], true, "{scene} {core}: {criterion}");
        }
        for effect in summary["effects"].as_array().expect("effects") {
            assert!(effect["rung"].is_string() && effect["seconds"].is_number(), "{effect}");
        }
    }
    let frames = |core: &str| fs::read(folder.path().join(core).join("frames.csv")).unwrap();
    if short.is_empty() {
        assert!(frames("fixed") == frames("clock"), "{scene}: fixed is clock, to the bit");
    }
    let table = Table::read(&folder.path().join("fixed/frames.csv"));
    assert!(table.names.join(",").starts_with(HEADER), "{scene}: {:?}", table.names);
    assert!(table.numbers("time_s").is_sorted());
    let flagged = unexpected_flags(&table, &summary);
    assert!(flagged.is_empty(), "{scene}: {}", flagged.join("\n"));
    let report = fs::read_to_string(folder.path().join("fixed/report.html")).unwrap();
    assert!(
        report.contains("<svg")
            && !report.contains("src=\"http")
            && report.matches("<script").count() == 1
    );
    if !short.is_empty() {
        check_every_clock(folder.path(), scene, &short);
    }
}

#[test]
#[cfg_attr(not(optimised), ignore = "whole scenes, clock by clock: run with --release")]
fn the_criteria_of_every_scene_hold_and_fixed_is_clock() {
    gallery::all().par_iter().for_each(|(name, text)| check(name, text));
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let run = |threads: &str| {
        let args = ["simulate", "fig3", "--set", "pad.0.position_mm.raster.nx=4", "--out", threads];
        let output = crate::command(folder.path(), &args)
            .env("RAYON_NUM_THREADS", threads)
            .output()
            .unwrap();
        let log = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code().is_some_and(|code| code < 2), "{log}");
        fs::read(folder.path().join(threads).join("frames.csv")).unwrap()
    };
    assert!(run("1") == run("5"));
}

#[test]
fn small_and_fine_profiles_run_the_same_scene() {
    let folder = tempfile::tempdir().unwrap();
    for profile in ["small", "fine"] {
        expect(folder.path(), &["simulate", "fig6", "--profile", profile, "--out", profile], 0);
    }
}

/// The largest haptic force that the paper reaches, N: full scale of the claims about force.
const FORCE_FULL_SCALE_N: f64 = 1.0;

/// The largest rounding error of the force over a scene, N, as the shadow interpretation has it.
///
/// Cases of a force loop are many, and differ in what drives the pad: the core's rounding is that of
/// the first.
fn force_error(folder: &Path, (scene, text): (&str, &str), profile: &str) -> f64 {
    let mut args = vec!["simulate", scene, "--errors", "--json", "--profile", profile];
    let parsed: toml::Table = text.parse().expect("a bundled scene");
    let first = parsed.get("case").filter(|_| parsed.contains_key("control"));
    if let Some(name) = first.and_then(|cases| cases[0]["name"].as_str()) {
        args.extend(["--case", name, "--set", "control.force=\"eq8\""]);
    }
    let summary: Value = serde_json::from_slice(&finish(folder, &args).stdout).unwrap();
    let errors = summary["errors"].as_array().expect("errors");
    let force = errors
        .iter()
        .find(|error| error["signal"] == "estimator.force_estimator.haptic_force")
        .expect("the force is a signal");
    force["max_error"].as_f64().expect("a number")
}

#[test]
fn rounding_moves_the_force_by_little() {
    let folder = tempfile::tempdir().unwrap();
    gallery::all().par_iter().for_each(|(scene, text)| {
        for (profile, percent) in [("small", 0.5), ("standard", 0.05)] {
            let error_n = force_error(folder.path(), (scene, text), profile);
            let measured = error_n / FORCE_FULL_SCALE_N * 100.0;
            println!("{scene} {profile}: {measured:.4} % of {FORCE_FULL_SCALE_N} N");
            assert!(
                measured <= percent,
                "{scene} {profile}: {measured} % of full scale, at most {percent}"
            );
        }
    });
}
