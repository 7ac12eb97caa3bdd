// SPDX-License-Identifier: MIT OR Apache-2.0
//! The relaxed pad.

use super::super::pad::Rubber;
use super::*;

const HEIGHTS_UM: [f64; 8] = [13.0, 14.5, 16.0, 17.5, 19.106, 19.585, 26.0, 34.0];

fn pad() -> Rubber {
    let pad_m2 = std::f64::consts::PI * 0.015 * 0.015;
    let rest_m = HEIGHTS_UM.map(|um| 1e-6 * (um - 5.0)).to_vec();
    Rubber {
        law: Law { creep_spring_pa_per_m: 1.75e8, ..law(AIR_PA_S) },
        patch_m2: pad_m2 / 8.0,
        pa_per_g: 0.01 / pad_m2,
        rest_m,
    }
}

fn capacitance_pf(pad: &Rubber, volt: f64, load_g: f64) -> f64 {
    1e12 * pad.capacitance_f(pad.equilibrium_m(Drive::new(volt, pad.pa_per_g * load_g)))
}

/// docs/physics.md §3, to the prototype's last digit.
#[test]
fn capacitance_at_rest_is_353_to_373_pf_from_20_to_50_g() {
    let at = |load_g| capacitance_pf(&pad(), 0.0, load_g);
    assert!(
        (at(20.0) - 353.0).abs() < 0.5 && (at(50.0) - 373.0).abs() < 0.5,
        "{} {}",
        at(20.0),
        at(50.0)
    );
}

#[test]
fn every_patch_is_in_balance_wherever_it_floats() {
    let pad = pad();
    for (rest_m, step) in pad.rest_m.iter().flat_map(|rest| (0..60).map(move |step| (*rest, step)))
    {
        let drive = Drive::new(10.0 * f64::from(step), 300.0);
        let gap_m = equilibrium(&pad.law, rest_m, drive);
        let balance = pad.law.relaxed(gap_m, rest_m, drive);
        assert!(
            balance.value.abs() < 1e-6 && balance.slope < 0.0,
            "{rest_m} {drive:?}: {balance:?} at {gap_m}"
        );
    }
}

#[test]
fn the_branch_is_the_open_one_up_to_the_fold() {
    let pad = pad();
    for rest_m in &pad.rest_m {
        let open_m = rest_m + 5e-6;
        let fold_v = (8.0 * 5e8 * open_m.powi(3) / (27.0 * ROUNDED_EPSILON_0)).sqrt();
        let height = |volt: f64| equilibrium(&pad.law, *rest_m, Drive::new(volt, 0.0)) + 5e-6;
        assert!(height(0.999 * fold_v) > open_m * 2.0 / 3.0, "{rest_m}");
        assert!(height(1.15 * fold_v) < open_m * 0.6, "{rest_m}: {}", height(1.15 * fold_v));
    }
}

#[test]
fn capacitance_rises_with_load_and_voltage() {
    let pad = pad();
    for load_g in [0.0, 20.0, 50.0, 100.0] {
        let rising: Vec<f64> =
            (0..80).map(|step| capacitance_pf(&pad, 10.0 * f64::from(step), load_g)).collect();
        assert!(rising.windows(2).all(|pair| pair[0] <= pair[1]), "{load_g} g: {rising:?}");
        assert!(capacitance_pf(&pad, 300.0, load_g) < capacitance_pf(&pad, 300.0, load_g + 10.0));
    }
}
