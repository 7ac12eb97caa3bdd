// SPDX-License-Identifier: MIT OR Apache-2.0
//! Data that make no calibration are refused with what is missing.

use std::fs;

use hapticore_scene::ForcePoint;

use super::{
    Files, Noise, SETUP, SHEET, forces, loads_csv, measurements, places_csv, plant, raster,
};
use crate::refuse;

/// Files whose loads are changed, measurement by measurement.
fn with_loads(change: impl Fn(&mut ForcePoint), words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let mut points = forces(9.6e12, 2e-3, &mut Noise::of(2));
    points.iter_mut().for_each(change);
    Files { loads: loads_csv(&points), ..Files::new(folder.path()) }.refused(words);
}

#[test]
fn loads_that_tell_no_force_are_refused() {
    with_loads(
        |point| point.haptic_v_rms = 0.0,
        &["loads.csv", "haptic_v_rms: all are 0", "several"],
    );
    with_loads(
        |point| point.load_g = 20.0,
        &["loads.csv", "load_g: all loads are alike (20 g)", "two loads"],
    );
    with_loads(|point| point.capacitance_pf = 0.0, &["loads.csv", "capacitance_pf: all are 0"]);
    with_loads(|point| point.haptic_v_rms = -1.0, &["loads.csv:2: haptic_v_rms", "below 0", "-1"]);
    with_loads(
        |point| point.force_n = 0.01 * (point.load_g - 60.0),
        &["loads.csv", "does not rise with (C·V)²", "95 %"],
    );
    // A pad whose capacitance is a twentieth: k is 400 times as large.
    with_loads(
        |point| point.capacitance_pf /= 20.0,
        &["loads.csv: device.force_k", "expected at most 4.135e13", "got 3.8", "a larger pad"],
    );
    let alike =
        |point: &mut ForcePoint| (point.haptic_v_rms, point.capacitance_pf) = (200.0, 400.0);
    with_loads(alike, &["loads.csv", "(C·V)² is the same in all measurements", "several voltages"]);
}

#[test]
fn too_few_loads_and_columns_that_are_missing_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let with = |loads: &str, words: &[&str]| {
        Files { loads: loads.into(), ..Files::new(folder.path()) }.refused(words)
    };
    with(
        "haptic_v_rms,capacitance_pf,force_n\n0,350,0\n300,360,0.1\n",
        &["loads.csv", "too few measurements", "3", "got 2"],
    );
    with(
        "haptic_v_rms,capacitance_pf\n0,350\n",
        &["loads.csv:1", "force_n, or friction_n and load_g"],
    );
    with("haptic_v_rms,capacitance_pf,friction_n\n0,350,1\n", &["loads.csv:1", "load_g"]);
    with("haptic_v_rms,force_n\n0,350\n", &["loads.csv:1", "capacitance_pf, or i_total"]);
    with("haptic_v_rms,force_n,i_total\n0,350,1\n", &["loads.csv:1", "v_sense"]);
    with(
        "haptic_v_rms,capacitance_pf,force_n\n0,350,much\n",
        &["loads.csv:2: force_n", "expected a number", "much"],
    );
    // Voltage rises with the load: nothing tells friction from force.
    let rows = (1..6)
        .map(|k: i32| format!("{},350,{},{}\n", 100 * k, 0.01 * f64::from(k * k), 10 * k * k));
    let together: String = rows.collect();
    with(
        &format!("haptic_v_rms,capacitance_pf,friction_n,load_g\n{together}"),
        &["loads.csv", "rise together", "mu in the setup"],
    );
}

#[test]
fn places_that_tell_no_position_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let plant = plant("minimal-sheet", &SHEET);
    let all = measurements(&plant, &raster([13, 9], [140.0, 90.0]), 0.0, &mut Noise::of(1));
    let with = |places: String, words: &[&str]| {
        Files { places, ..Files::new(folder.path()) }.refused(words)
    };
    with(places_csv(&all[..15], true), &["places.csv", "too few places", "got 15"]);
    with(places_csv(&all[..26], true), &["places.csv", "y_mm", "4 different y_mm", "got 2"]);
    let mut open = all.clone();
    open.iter_mut().for_each(|measurement| measurement.currents_a[2] = 0.0.into());
    with(
        places_csv(&open, true),
        &["places.csv", "i3: terminal 3 has no current at any place", "open"],
    );
    let mut same = all.clone();
    same.iter_mut().for_each(|measurement| measurement.currents_a.clone_from(&all[0].currents_a));
    with(places_csv(&same, true), &["places.csv", "ratios that tell the places apart"]);
    let with_line = |line: &str, words: &[&str]| with(places_csv(&all, false) + line, words);
    with_line("1,2,0,1e-4,1e-4,1e-4,1e-4\n", &["places.csv:120: v_sense", "above 0"]);
    with_line("1,2,5,1e-4,-1e-4,1e-4,1e-4\n", &["places.csv:120: i2", "amplitude", "below 0"]);
    with_line("1,2,5,1e-4,1e-4,1e-4,1\n", &["places.csv:120: i4", "current_full_scale_a = 0.004"]);
    with_line("1,2,5,1e-4\n", &["places.csv", "line: 120"]);
    with_line("1,nan,5,1e-4,1e-4,1e-4,1e-4\n", &["places.csv:120: y_mm", "expected a number"]);
}

#[test]
fn a_setup_that_says_too_little_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let with =
        |setup: String, words: &[&str]| Files { setup, ..Files::new(folder.path()) }.refused(words);
    with(SETUP.into(), &["terminals", "x and y, signs of 4 terminals, or places_mm and [sheet]"]);
    with(
        format!("{SETUP}[terminals]\nx = [1, -1]\ny = [1, -1]\n"),
        &["terminals.x", "expected 4", "got 2"],
    );
    with(
        SETUP.replace("carrier_hz = 101e3", "carrier_hz = 0"),
        &["device.toml", "carrier_hz", "above 0"],
    );
    with(SETUP.replace("pads", "pods"), &["device.toml:1: pods", "unknown field"]);
    let files = Files::new(folder.path());
    files.write();
    let refuse = |files: &[&str], words: &[&str]| {
        refuse(folder.path(), &[&["calibrate"], files].concat(), words)
    };
    refuse(&["places.csv", "loads.csv"], &["expected a setup", ".toml"]);
    refuse(&["loads.csv", "device.toml"], &["expected places"]);
    refuse(&["places.csv", "device.toml"], &["expected loads", "force_k in the setup"]);
    refuse(&["places.csv", "places.csv", "device.toml"], &["one file of places, got two"]);
    fs::write(folder.path().join("other.csv"), "a,b\n1,2\n").unwrap();
    refuse(
        &["other.csv", "device.toml"],
        &["other.csv:1", "x_mm, y_mm, i1 …, v_sense", "haptic_v_rms"],
    );
    refuse(&["none.csv"], &["none.csv"]);
}
