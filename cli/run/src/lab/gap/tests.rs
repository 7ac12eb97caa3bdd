// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rubbers that come back, pins that were measured, runs that differ, and what is refused.

use hapticore_scene::Compression;

use super::*;

/// Pads of §10 of the studies that docs/physics.md names: width, κ, rest, p₀, λ.
const PINS: [[f64; 5]; 2] =
    [[21.0, 2.156e10, 7.949, 1.243e9, 0.4814], [66.7, 1.721e9, 21.591, 1.2013e6, 1.7650]];

fn diameter_mm(area_mm2: f64) -> f64 {
    2.0 * (area_mm2 / std::f64::consts::PI).sqrt()
}

fn files(csv: String, area_mm2: f64) -> Vec<(String, String)> {
    let setup = format!(
        "[device]\npad_diameter_mm = {:?}\n[gap]\ninsulator_um = 0.622\ninsulator_permittivity = 1.0\n",
        diameter_mm(area_mm2)
    );
    vec![("c.csv".into(), csv), ("pad.toml".into(), setup)]
}

fn fit(csv: String, area_mm2: f64) -> Outcome {
    Data::of(&files(csv, area_mm2)).unwrap().unwrap().fit().unwrap()
}

#[test]
fn a_rubber_comes_back_from_its_capacitances() {
    for [area_mm2, spring, rest_um, contact_pa, decay_um] in PINS {
        let of = Compression {
            spring_pa_per_m: spring,
            rest_m: 1e-6 * (rest_um - 0.622),
            contact_pa,
            contact_decay_m: 1e-6 * decay_um,
        };
        let row = |n: i32| {
            let load_n = 0.1 * 1.5f64.powi(n);
            let gap_m = of.gap_m(1e6 * load_n / area_mm2);
            let pf = 1e12 * EPSILON_0 * 1e-6 * area_mm2 / (gap_m + 0.622e-6);
            format!("{load_n},{pf}\n")
        };
        let csv = (0..14).fold(String::from("load_n,capacitance_pf\n"), |csv, n| csv + &row(n));
        let found = fit(csv, area_mm2);
        assert!(found.rms_percent < 0.02, "{found:?}");
        assert!((found.spring_pa_per_m / spring - 1.0).abs() < 0.02, "{found:?}");
        assert!((found.contact_decay_um / decay_um - 1.0).abs() < 0.01, "{found:?}");
    }
}

/// Measured at 0.5, 1, 2, 4, 8 N by Rauf and Follmer (2025): docs/physics.md §3.
#[test]
fn measured_pins_are_fitted_within_3_percent() {
    for (area_mm2, measured_pf) in
        [(21.0, [26.5, 30.0, 33.3, 36.9, 40.7]), (66.7, [34.8, 44.0, 63.9, 85.3, 114.1])]
    {
        let mut csv = String::from("load_n,capacitance_pf\n");
        for (load_n, pf) in [0.5, 1.0, 2.0, 4.0, 8.0].into_iter().zip(measured_pf) {
            // Twice, for the least number of readings.
            csv += &format!("{load_n},{pf}\n").repeat(2);
        }
        let found = fit(csv, area_mm2);
        assert!(found.rms_percent < 3.0, "{found:?}");
    }
}

#[test]
fn a_run_that_differs_is_named() {
    let mut csv = String::from("run,load_g,capacitance_pf\n");
    for run in 1..=3 {
        for load_g in [20.0, 35.0, 50.0, 70.0, 100.0, 150.0f64] {
            let scale = if run == 3 { 1.1 } else { 1.0 };
            let pf = scale * (250.0 + 20.0 * load_g.ln());
            csv += &format!("{run},{load_g},{pf}\n");
        }
    }
    let found = Data::of(&[("c.csv".into(), csv)]).unwrap().unwrap().fit().unwrap();
    assert_eq!(found.runs.len(), 3);
    assert!(found.warnings.iter().any(|warning| warning.contains("run 3")), "{found:?}");
}

#[test]
fn a_pad_that_one_patch_does_not_describe_is_warned_of() {
    let row = |n: i32| format!("{},{}\n", 20 * n, if n % 2 == 0 { 300 } else { 240 } + 10 * n);
    let csv = (1..=10).fold(String::from("load_g,capacitance_pf\n"), |csv, n| csv + &row(n));
    let found = Data::of(&[("c.csv".into(), csv)]).unwrap().unwrap().fit().unwrap();
    assert!(
        found.warnings.iter().any(|warning| warning.contains("does not describe")),
        "{found:?}"
    );
}

#[test]
fn what_is_no_capacitance_under_a_load_is_refused() {
    let refused = |csv: &str| {
        let data = Data::of(&[("c.csv".into(), csv.into())]);
        data.and_then(|data| data.expect("capacitances").fit()).unwrap_err().to_string()
    };
    let rows = "1,300\n2,310\n3,315\n4,318\n5,320\n6,321\n";
    for (csv, words) in [
        (format!("load_n,capacitance_pf,colour\n{}", rows.replace('\n', ",1\n")), "colour"),
        (format!("load,capacitance_pf\n{rows}"), "load_g or load_n"),
        ("load_n,capacitance_pf\n1,300\n".into(), "6 readings"),
        (format!("load_n,capacitance_pf\n{rows}7,3000\n"), "c.csv:8"),
        (format!("load_n,capacitance_pf\n{rows}0,300\n"), "above 0"),
        (format!("load_g,capacitance_pf\n{}", rows.replace(",3", "e-2,3")), "in kilograms"),
        ("load_n,capacitance_pf\n1,6\n2,5\n3,4\n4,3\n5,2\n6,1\n".into(), "rises with the load"),
    ] {
        let error = refused(&csv);
        assert!(error.contains(words), "{words}: {error}");
    }
    assert!(Data::of(&[("c.csv".into(), "haptic_v_rms\n1\n".into())]).unwrap().is_none());
}
