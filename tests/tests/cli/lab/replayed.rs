// SPDX-License-Identifier: MIT OR Apache-2.0
//! A lab's calibration at work: a recording of the device, replayed with it, gives positions and
//! forces as they were.

use std::fs;
use std::path::Path;

use super::{
    Files, Measurement, Noise, SETUP, SHEET, TERMINALS, loads_csv, measurements, places_csv, plant,
    raster,
};
use crate::{Table, expect, finish};

/// Parts of a current that are noise, and newtons of a force.
const NOISE: [f64; 2] = [2e-5, 2e-3];

/// Position errors of a replay, mm, and the largest error of the force and of the capacitance, as
/// shares.
struct Errors {
    rms_mm: f64,
    worst_mm: f64,
    force: f64,
    capacitance: f64,
}

/// Calibrates with the files, records the device, replays, and compares with what the plant knows.
fn replay(files: &Files) -> Errors {
    let folder = files.folder;
    files.write();
    expect(
        folder,
        &["calibrate", "places.csv", "loads.csv", "device.toml", "--out", "mine.toml"],
        0,
    );
    let mut args =
        vec!["simulate", "minimal-sheet", "--waves", "none", "--out", "o", "--capture", "c.wav"];
    SHEET.iter().for_each(|key| args.extend(["--set", key]));
    finish(folder, &args);
    expect(folder, &["replay", "c.wav", "--calibration", "mine.toml", "--out", "r"], 0);
    compare(folder)
}

fn compare(folder: &Path) -> Errors {
    let [truth, replayed] = ["o", "r"].map(|run| Table::read(&folder.join(run).join("frames.csv")));
    assert!(replayed.column("flags").iter().all(|flags| flags.is_empty()), "flags");
    assert_eq!(truth.rows.len(), replayed.rows.len());
    let pairs = |name: &str| {
        let truth = truth.numbers(&format!("true_{name}"));
        truth.into_iter().zip(replayed.numbers(name)).collect::<Vec<_>>()
    };
    let error = |((x, a), (y, b)): (&(f64, f64), &(f64, f64))| (a - x).hypot(b - y);
    let errors: Vec<f64> = pairs("x_mm").iter().zip(&pairs("y_mm")).map(error).collect();
    let share = |name: &str| {
        pairs(name).iter().map(|(truth, got)| (got / truth - 1.0).abs()).fold(0.0, f64::max)
    };
    Errors {
        rms_mm: (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64)
            .sqrt(),
        worst_mm: errors.iter().copied().fold(0.0, f64::max),
        force: share("force_n"),
        capacitance: share("capacitance_pf"),
    }
}

/// The device, measured at places.
fn measured(places: &[[f64; 2]], seed: u64) -> (Vec<Measurement>, String) {
    let plant = plant("minimal-sheet", &SHEET);
    let mut noise = Noise::of(seed);
    let measurements = measurements(&plant, places, NOISE[0], &mut noise);
    let mut points = plant.friction_calibration(
        &[20.0, 100.0],
        &[0.0, 50.0, 100.0, 150.0, 200.0, 250.0, 300.0, 350.0],
    );
    points.iter_mut().for_each(|point| point.force_n += NOISE[1] * noise.normal());
    (measurements, loads_csv(&points))
}

#[test]
fn a_raster_with_phases_gives_positions_and_forces_within_limits() {
    let folder = tempfile::tempdir().unwrap();
    let (measurements, loads) = measured(&raster([29, 19], [140.0, 90.0]), 3);
    let setup = format!("{SETUP}{TERMINALS}");
    let errors = replay(&Files {
        places: places_csv(&measurements, true),
        loads,
        setup,
        folder: folder.path(),
    });
    assert!(
        errors.rms_mm < 0.2 && errors.worst_mm < 0.5,
        "{} {} mm",
        errors.rms_mm,
        errors.worst_mm
    );
    assert!(
        errors.force < 0.02 && errors.capacitance < 1e-3,
        "{} {}",
        errors.force,
        errors.capacitance
    );
}

#[test]
fn amplitudes_alone_do_with_the_resistance_of_the_film() {
    let folder = tempfile::tempdir().unwrap();
    let (measurements, loads) = measured(&raster([29, 19], [140.0, 90.0]), 4);
    let setup = format!("{SETUP}{TERMINALS}ohm_per_square = 150\n");
    let errors = replay(&Files {
        places: places_csv(&measurements, false),
        loads,
        setup,
        folder: folder.path(),
    });
    assert!(
        errors.rms_mm < 0.2 && errors.capacitance < 1e-3,
        "{} mm {}",
        errors.rms_mm,
        errors.capacitance
    );
}

#[test]
fn places_that_lie_anywhere_do_as_well() {
    let folder = tempfile::tempdir().unwrap();
    let mut random = fastrand::Rng::with_seed(5);
    let mut places: Vec<_> =
        (0..500).map(|_| [280.0 * (random.f64() - 0.5), 180.0 * (random.f64() - 0.5)]).collect();
    places.extend(raster([15, 2], [140.0, 90.0]));
    places.extend(raster([2, 11], [140.0, 90.0]).into_iter().filter(|place| place[1].abs() < 90.0));
    let (measurements, loads) = measured(&places, 5);
    let setup = format!("{SETUP}{TERMINALS}");
    let errors = replay(&Files {
        places: places_csv(&measurements, true),
        loads,
        setup,
        folder: folder.path(),
    });
    assert!(
        errors.rms_mm < 0.2 && errors.worst_mm < 0.5,
        "{} {} mm",
        errors.rms_mm,
        errors.worst_mm
    );
    let text = fs::read_to_string(folder.path().join("mine.toml")).unwrap();
    assert!(
        text.contains(&format!("{} places (scattered)", places.len())),
        "{}",
        text.lines().nth(1).unwrap()
    );
}

#[test]
fn a_full_scale_that_is_wrong_comes_out_of_loads_with_both_capacitances() {
    let folder = tempfile::tempdir().unwrap();
    let (mut measurements, _) = measured(&raster([29, 19], [140.0, 90.0]), 6);
    let device = plant("minimal-sheet", &SHEET).device();
    // The lab's ammeter reads 5 % low, and so does the core's channel, whose full scale it was
    // found with.
    measurements.iter_mut().for_each(|measurement| {
        measurement.currents_a.iter_mut().for_each(|current| *current /= 1.05)
    });
    let mut loads = String::from("load_g,haptic_v_rms,capacitance_pf,i_total,v_sense,force_n\n");
    let ohm = plant("minimal-sheet", &SHEET).measurements(&[[0.0; 2]])[0].sheet_ohm;
    let mut noise = Noise::of(8);
    for (load_g, capacitance_pf) in [(20.0, 350.0), (100.0, 410.0)] {
        for step in 0..8 {
            let (volts, omega) = (50.0 * f64::from(step), std::f64::consts::TAU * 101e3);
            let admittance = omega * 1e-12 * capacitance_pf;
            let current = 5.0 * admittance / (1.0 + (admittance * ohm).powi(2)).sqrt() / 1.05;
            let force = device.force_k * (1e-12 * capacitance_pf * volts).powi(2)
                + NOISE[1] * noise.normal();
            loads += &format!(
                "{load_g},{volts},{},{current:e},5,{force}\n",
                capacitance_pf + 0.1 * noise.normal()
            );
        }
    }
    let setup = format!("{SETUP}{TERMINALS}").replace(
        "current_full_scale_a = 0.004",
        &format!("current_full_scale_a = {}", 0.004 / 1.05),
    );
    let errors = replay(&Files {
        places: places_csv(&measurements, true),
        loads,
        setup,
        folder: folder.path(),
    });
    assert!(
        errors.force < 0.02 && errors.capacitance < 1e-3,
        "{} {}",
        errors.force,
        errors.capacitance
    );
    let text = fs::read_to_string(folder.path().join("mine.toml")).unwrap();
    assert!(
        text.contains("current_full_scale_a times 1.05"),
        "{}",
        text.lines().take(8).collect::<String>()
    );
}

#[test]
fn what_is_left_is_printed_plotted_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let files = Files::new(folder.path());
    files.write();
    let args = ["calibrate", "places.csv", "loads.csv", "device.toml", "--out", "mine.toml"];
    let output = expect(folder.path(), &args, 0);
    let log = String::from_utf8(output.stdout).unwrap();
    for words in [
        "117 places (13 × 9), 4 terminals",
        "over its own places",
        "every other position held out of the table",
        "force_k = ",
        "(95 %: ",
    ] {
        assert!(log.contains(words), "{words}: {log}");
    }
    let report = fs::read_to_string(folder.path().join("mine.toml.report.html")).unwrap();
    for words in
        ["Error of the position table", "Force and eq. 8", "Residuals of the force", "<svg"]
    {
        assert!(report.contains(words), "{words}");
    }
    let output = expect(folder.path(), &[&args[..], &["--json"]].concat(), 0);
    let told: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let [low, high] = [0, 1].map(|end| told["force"]["force_k"]["interval"][end].as_f64().unwrap());
    assert!(low < 9.6e12 && 9.6e12 < high && high / low < 1.1, "{low} {high}");
    let rms_mm = |told: &serde_json::Value, of: &str| told[of]["rms_mm"].as_f64().unwrap();
    // Of places that are measured without noise and lie near each other both leave little.
    assert!(rms_mm(&told, "held_out") < 0.01 && rms_mm(&told, "own_places") < 0.01, "{told}");
    // Places too far from each other: those held out are found less well, and that is a warning.
    let plant = plant("minimal-sheet", &SHEET);
    let few = measurements(&plant, &raster([5, 4], [140.0, 90.0]), 0.0, &mut Noise::of(1));
    let setup = format!("{SETUP}[terminals]\nx = [-1, -1, 1, 1]\ny = [1, -1, -1, 1]\n");
    Files { places: places_csv(&few, true), setup, ..files }.write();
    let output = expect(folder.path(), &args, 0);
    let log = String::from_utf8(output.stderr).unwrap();
    assert!(
        log.starts_with("warning: places that the table was not made from are found less well"),
        "{log}"
    );
    let output = expect(folder.path(), &[&args[..], &["--json"]].concat(), 0);
    let told: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(rms_mm(&told, "held_out") > 10.0 * rms_mm(&told, "own_places"), "{told}");
}
