// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore calibrate` of capacitances under loads: a scene with the tables that it writes has these capacitances.

use std::fs;

use crate::{Table, expect, refuse};

/// κ, rest, p₀, λ of a patch of 30 mm: no default of a scene.
const RUBBER: [f64; 4] = [6e7, 21e-6, 4e5, 1.1e-6];

/// d of the insulators, as a scene has them by default, and the pad's area.
const INSULATOR_M: f64 = 5e-6;
const AREA_M2: f64 = 7.0686e-4;

const LOADS_G: [f64; 7] = [10.0, 20.0, 35.0, 50.0, 70.0, 100.0, 150.0];

/// Capacitance under a load, pF: the balance is halved until it is known.
fn capacitance_pf(load_g: f64) -> f64 {
    let [spring, rest, contact, decay] = RUBBER;
    let pressure = 1e-3 * load_g * 9.80665 / AREA_M2;
    let (mut low, mut high) = (0.0, 1e-2);
    for _ in 0..100 {
        let gap = 0.5 * (low + high);
        let opens = spring * (rest - gap) + contact * (-gap / decay).exp() > pressure;
        *(if opens { &mut low } else { &mut high }) = gap;
    }
    1e12 * 8.854_187_812_8e-12 * AREA_M2 / (low + INSULATOR_M)
}

#[test]
fn a_scene_with_the_gap_that_was_fitted_has_the_capacitances_that_were_measured() {
    let folder = tempfile::tempdir().unwrap();
    let row = |load_g: f64| format!("{load_g},{}\n", capacitance_pf(load_g));
    let rows: String = LOADS_G.into_iter().map(row).collect();
    fs::write(folder.path().join("c.csv"), format!("load_g,capacitance_pf\n{rows}")).unwrap();
    let output = expect(folder.path(), &["calibrate", "c.csv", "--out", "gap.toml"], 0);
    let log = String::from_utf8(output.stdout).unwrap();
    assert!(log.contains("% RMS of 7 capacitances"), "{log}");
    let tables = fs::read_to_string(folder.path().join("gap.toml")).unwrap();
    let case = |load_g: f64| {
        format!("[[case]]\nname = \"{load_g} g\"\nset = {{ \"pad.0.load_g\" = {load_g} }}\n")
    };
    let cases: String = LOADS_G.into_iter().map(case).collect();
    let scene = format!("title = \"a pad\"\n[[pad]]\nposition_mm = [0, 0]\n{tables}{cases}");
    fs::write(folder.path().join("pad.toml"), scene).unwrap();
    let args = ["simulate", "pad.toml", "--core", "float", "--out", "out"];
    expect(folder.path(), &args, 0);
    let frames = Table::read(&folder.path().join("out/frames.csv"));
    let (cases, found_pf) = (frames.column("case"), frames.numbers("true_capacitance_pf"));
    for load_g in LOADS_G {
        let row = cases.iter().position(|case| *case == format!("{load_g} g")).expect("the case");
        let off = found_pf[row] / capacitance_pf(load_g) - 1.0;
        assert!(off.abs() < 1e-3, "{load_g} g: {off}");
    }
}

#[test]
fn a_profile_and_unknown_columns_are_refused_with_capacitances() {
    let folder = tempfile::tempdir().unwrap();
    let csv = "load_n,capacitance_pf,time\n1,30,0\n";
    fs::write(folder.path().join("c.csv"), csv).unwrap();
    let args = ["calibrate", "c.csv"];
    refuse(folder.path(), &args, &["c.csv:1", "time", "unknown column"]);
    let csv = "load_n,capacitance_pf\n1,30\n2,33\n";
    fs::write(folder.path().join("c.csv"), csv).unwrap();
    refuse(folder.path(), &args, &["c.csv", "6 readings"]);
    let rows: String = (1..=6).map(|load_n| format!("{load_n},{}\n", 300 + load_n)).collect();
    fs::write(folder.path().join("c.csv"), format!("load_n,capacitance_pf\n{rows}")).unwrap();
    refuse(folder.path(), &["calibrate", "c.csv", "--profile", "small"], &["--profile"]);
}
