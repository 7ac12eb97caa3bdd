// SPDX-License-Identifier: MIT OR Apache-2.0
//! A pad that is lifted from the sheet and put back: its flag, its place, its drive and its force.

use crate::{Table, finish};
use std::fs;
use std::path::Path;

/// A pad of 500 pF that is lifted from 0.2 to 0.3 s, where 2 pF are left, and comes back with 700 pF.
const SCENE: &str = "title = \"lifted\"\nduration_s = 0.7\nsettle_samples = 390\nwindow_samples = 600\n[[pad]]\n\
    position_mm = [140, -60]\ntarget_n = 0.3\n\
    capacitance_pf = { timeline = [[0, 500], [0.2, 500], [0.2, 2], [0.3, 2], [0.3, 700]] }\n[sheet]\n[carrier]\n\
    rung = \"samples\"\nhaptic_wave = \"square\"\n[sensor]\nhaptic_full_scale_v = 550\nnoise_ppm_rms = 18\n\
    quantisation_bits = 18\n[control]\n";

const LAWS: [&str; 2] =
    ["law = \"inverse\"\n", "law = \"integral\"\nproportional_v = 64\nintegral_v = 30000\n"];

/// The largest rise of the drive from frame to frame after contact: 1/64 of its full scale of 500 V.
const CONTACT_SLEW_V: f64 = 500.0 / 64.0;

/// The pad of 700 pF, which touches all the time.
const STEP: [&str; 2] = ["--set", "pad.0.capacitance_pf=700"];

fn simulate(folder: &Path, law: &str, core: &str, more: &[&str]) -> Table {
    fs::write(folder.join("scene.toml"), [SCENE, law].concat()).unwrap();
    let args = ["simulate", "scene.toml", "--waves", "none", "--out", "o", "--core", core];
    finish(folder, &[&args, more].concat());
    Table::read(&folder.join("o/frames.csv"))
}

/// Numbers of a column, those of the slots whose beginning and end are within these times.
fn within(table: &Table, name: &str, [from_s, to_s]: [f64; 2]) -> Vec<f64> {
    let times = table.numbers("time_s");
    let rows = times.iter().zip(table.numbers(name));
    rows.filter(|(time_s, _)| (from_s..to_s).contains(*time_s)).map(|(_, x)| x).collect()
}

#[test]
fn a_lifted_pad_is_flagged_and_keeps_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let table = simulate(folder.path(), LAWS[0], "fixed", &[]);
    let (flags, truth) = (table.column("flags"), table.numbers("true_capacitance_pf"));
    let x_mm = table.numbers("x_mm");
    let mut lifted = 0;
    for (row, flags) in flags.iter().enumerate().skip(1) {
        assert_eq!(flags.contains("lifted"), truth[row] < 95.0, "row {row}: {flags}");
        assert!(!flags.contains("invalid"), "row {row}: {flags}");
        if flags.contains("lifted") {
            lifted += 1;
            assert_eq!(x_mm[row], x_mm[row - 1], "row {row}");
        }
    }
    assert!(lifted > 90, "{lifted} frames");
    let read = within(&table, "capacitance_pf", [0.21, 0.29]);
    assert!(read.iter().all(|pf| (pf - 2.0).abs() < 0.5), "{read:?}");
}

#[test]
fn a_lifted_pad_has_no_drive_and_is_driven_gently_after_contact() {
    let folder = tempfile::tempdir().unwrap();
    for law in LAWS {
        let [float, fixed, clock] =
            ["float", "fixed", "clock"].map(|core| simulate(folder.path(), law, core, &[]));
        let step = simulate(folder.path(), law, "fixed", &STEP);
        let most = |forces: Vec<f64>| forces.into_iter().fold(0.0, f64::max);
        let of_step = most(step.numbers("true_force_n"));
        assert_eq!(fixed.column("drive_v_rms"), clock.column("drive_v_rms"), "{law}");
        for table in [float, fixed] {
            let drive = within(&table, "drive_v_rms", [0.202, 0.299]);
            assert!(drive.iter().all(|volt| *volt == 0.0), "{law}: {drive:?}");
            let limited = within(&table, "drive_limited", [0.202, 0.299]);
            assert!(limited.iter().all(|is| *is == 0.0), "{law}: {limited:?}");
            let after = within(&table, "drive_v_rms", [0.299, 0.7]);
            let rise = after.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
            assert!(rise <= CONTACT_SLEW_V * 1.001, "{law}: {rise} V from frame to frame");
            let force = |times| within(&table, "true_force_n", times);
            let first = most(force([0.3, 0.31]));
            assert!(first <= 0.3, "{law}: {first} N in the first frames");
            let back = most(force([0.3, 0.7]));
            assert!(back <= of_step, "{law}: {back} N, {of_step} N of a pad that touches");
            let settled = force([0.6, 0.7]);
            assert!(settled.iter().all(|n| (n - 0.3).abs() < 0.03), "{law}: {settled:?}");
        }
    }
}
