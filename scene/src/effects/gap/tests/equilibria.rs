// SPDX-License-Identifier: MIT OR Apache-2.0
//! The relaxed pad.

use super::super::equilibrium::equilibrium_from;
use super::super::rubber::Rubber;
use super::*;

const HEIGHTS_UM: [f64; 8] = [13.0, 14.5, 16.0, 17.5, 19.0664, 19.5503, 26.0, 34.0];

fn pad() -> Rubber {
    let pad_m2 = std::f64::consts::PI * 0.015 * 0.015;
    let rest_m = HEIGHTS_UM.map(|um| 1e-6 * (um - 5.0)).to_vec();
    let law = Law { creep_spring_pa_per_m: 1.75e8, ..law(AIR_PA_S) };
    Rubber::new(law, pad_m2 / 8.0, 0.009_806_65 / pad_m2, rest_m)
}

fn capacitance_pf(pad: &Rubber, volt: f64, load_g: f64) -> f64 {
    1e12 * pad.capacitance_f(pad.equilibrium_m(Drive::new(volt, pad.pa_per_g * load_g)))
}

/// docs/physics.md §3: solved apart, by halving from the open side.
#[test]
fn capacitances_are_those_of_the_equilibria() {
    for (load_g, volt, expected_pf) in [
        (20.0, 0.0, 353.37),
        (50.0, 0.0, 372.22),
        (100.0, 0.0, 408.82),
        (20.0, 150.0, 377.75),
        (20.0, 300.0, 610.71),
        (50.0, 250.0, 542.93),
        (100.0, 300.0, 745.77),
        (100.0, 350.0, 779.72),
    ] {
        let found_pf = capacitance_pf(&pad(), volt, load_g);
        assert!((found_pf - expected_pf).abs() < 0.006, "{load_g} g, {volt} V: {found_pf} pF");
    }
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

fn force_n(pad: &Rubber, volt: f64, gaps_m: &[f64]) -> f64 {
    let pull_n = Drive::new(volt, 0.0).pull_n;
    let each = gaps_m.iter().map(|gap_m| pull_n * pad.patch_m2 / (gap_m + 5e-6).powi(2));
    0.12 * each.sum::<f64>()
}

/// docs/physics.md §3: 20 g, the prototype's forces on the way up and down.
#[test]
fn closed_patches_stay_closed_on_the_way_down() {
    let pad = pad();
    let mut gaps_m: Vec<f64> = pad.equilibrium_m(Drive::new(0.0, pad.pa_per_g * 20.0)).collect();
    let mut at = |volt: f64| {
        let drive = Drive::new(volt, pad.pa_per_g * 20.0);
        for (gap_m, rest_m) in gaps_m.iter_mut().zip(&pad.rest_m) {
            *gap_m = equilibrium_from(&pad.law, *rest_m, drive, *gap_m);
            let balance = pad.law.relaxed(*gap_m, *rest_m, drive);
            assert!(balance.value.abs() < 1e-6 && balance.slope < 0.0, "{volt} V: {balance:?}");
        }
        force_n(&pad, volt, &gaps_m)
    };
    let up: Vec<f64> = (0..=80).map(|step| at(5.0 * f64::from(step))).collect();
    let down: Vec<f64> = (0..=80).rev().map(|step| at(5.0 * f64::from(step))).collect();
    for (step, upwards, downwards) in [(60, 0.400, 0.517), (65, 0.504, 0.653)] {
        let found = [up[step], down[80 - step]];
        assert!((found[0] - upwards).abs() < 0.001, "{found:?}");
        assert!((found[1] - downwards).abs() < 0.001, "{found:?}");
    }
    assert_eq!(down[80], 0.0);
    let back = at(5.0);
    assert!((back - up[1]).abs() < 1e-12, "without a voltage they open: {back} and {}", up[1]);
}

#[test]
fn from_open_the_branch_is_the_open_one_at_any_voltage() {
    let pad = pad();
    for (rest_m, step) in pad.rest_m.iter().flat_map(|rest| (0..60).map(move |step| (*rest, step)))
    {
        let drive = Drive::new(10.0 * f64::from(step), 300.0);
        let open_m = equilibrium(&pad.law, rest_m, drive);
        assert_eq!(equilibrium_from(&pad.law, rest_m, drive, rest_m), open_m);
    }
}
