// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pull-in voltage, squeezed film, delay above the fold.

use std::f64::consts::PI;

use super::*;
use crate::device::EPSILON_0;

/// The patch without contact: what the closed forms are of.
fn bare() -> Law {
    Law { contact_pa: 0.0, ..law(AIR_PA_S) }
}

#[test]
fn one_patch_pulls_in_where_the_closed_form_says() {
    let closed_v = pull_in_v(&bare(), PATCH, ROUNDED_EPSILON_0);
    assert_eq!(format!("{closed_v:.3}"), "356.577");
    let gap = |volt: f64| {
        let drive = Drive { pull_n: 0.5 * ROUNDED_EPSILON_0 * volt * volt, pressure_pa: 0.0 };
        equilibrium(&bare(), PATCH, drive)
    };
    assert!((gap(closed_v * (1.0 - 1e-9)) + 5e-6 - 19.66e-6 * 2.0 / 3.0).abs() < 1e-9);
    assert_eq!(gap(closed_v * (1.0 + 1e-9)), 0.0);
}

/// Contact adds at most p₀e^(−g/λ) at the fold: 4e-2 of the spring's pressure for the lowest spot, nothing for the
/// others. Crests, in contact from the start, do not fold.
#[test]
fn each_spot_of_the_pad_pulls_in_at_its_closed_form() {
    let pad = pad("");
    let drive = |volt: f64| Drive::new(volt, pad.pa_per_g * 50.0);
    let mut folds_v = Vec::new();
    for patch in &pad.patches[1..] {
        let fold_v = pull_in_v(&pad.law, *patch, EPSILON_0);
        let height = |volt: f64| equilibrium(&pad.law, *patch, drive(volt)) + pad.law.insulator_m;
        let rest_m = patch.rest_m + pad.law.insulator_m;
        assert!(height(0.999 * fold_v) > rest_m * 2.0 / 3.0, "{patch:?}");
        let closed = height(1.05 * fold_v);
        assert!(closed < rest_m * 0.55, "{patch:?}: {closed:e}");
        folds_v.push(fold_v.round());
    }
    assert_eq!(folds_v, [166.0, 179.0, 195.0, 239.0, 290.0, 309.0, 501.0]);
    let crest = |step: usize| equilibrium(&pad.law, pad.patches[0], drive(5.0 * step as f64));
    let falls = (1..=80).map(|step| crest(step - 1) - crest(step));
    assert!(
        falls.clone().all(|fall_m| (0.0..0.05e-6).contains(&fall_m)),
        "{:e}",
        falls.fold(0.0, f64::max)
    );
}

/// Rubber that has not crept is stiffer by 1 + r: it folds at √(1 + r)·V_PI.
#[test]
fn before_it_creeps_a_patch_pulls_in_at_a_voltage_that_is_higher_by_the_root_of_1_plus_r() {
    let law = Law { creep_share: 0.6, creep_s: 1e6, ..bare() };
    let fold_v = 1.6f64.sqrt() * pull_in_v(&law, PATCH, EPSILON_0);
    let gap_after =
        |volt: f64| run(By::Dynamic(Method::TrBdf2), &law, |_| volt, 1e-4, 1.0, 1.0)[0].gap_m;
    let (below, above) = (gap_after(fold_v * (1.0 - 1e-4)), gap_after(fold_v * (1.0 + 1e-4)));
    assert!(below > 8.1e-6 && above < 1e-6, "{below:e} {above:e}");
}

/// Stefan: t = (cs/2p)(1/h₂² − 1/h₁²), c·s being the damping times h³.
#[test]
fn a_squeezed_film_takes_stefans_time() {
    let law = Law { spring_pa_per_m: 1e-3, inertia_kg_m2: 1e-9, ..bare() };
    let (from_m, to_m, pressure_pa): (f64, f64, f64) = (20e-6, 2e-6, 1e3);
    let stefan_s = law.film_n_s / (2.0 * pressure_pa) * (to_m.powi(-2) - from_m.powi(-2));
    for method in [Method::Trapezoid, Method::TrBdf2] {
        let mut at = State { gap_m: from_m - 0.7e-6, speed_m_s: 0.0, crept_pa: 0.0 };
        let pressed = method.stages(|_| Drive { pull_n: 0.0, pressure_pa });
        for _ in 0..10_000 {
            at = step_alone(method, &law, PATCH, at, stefan_s / 10_000.0, &pressed);
        }
        let off = (at.gap_m + 0.7e-6) / to_m - 1.0;
        assert!(off.abs() < 1e-5, "{method:?}: {off:e}");
    }
}

/// t → πc/(κ√(1.5ε)), c at the fold; the path to the fold and from it adds a share that falls as
/// √ε. docs/physics.md §3 has the form; the limits were set after measuring.
#[test]
fn delay_above_the_fold_tends_to_the_closed_form() {
    let law = Law { inertia_kg_m2: 1e-3, ..bare() };
    let fold = law.film(19.66e-6 * 2.0 / 3.0 - 5e-6).value / 5e8;
    let excess = |epsilon: f64| {
        let volt = pull_in_v(&law, PATCH, ROUNDED_EPSILON_0) * (1.0 + epsilon);
        let pull_n = 0.5 * ROUNDED_EPSILON_0 * volt * volt;
        let (mut at, mut time_s, step_s) = (undriven(&law), 0.0, 20e-6);
        let pulled = Method::TrBdf2.stages(|_| Drive { pull_n, pressure_pa: 0.0 });
        while at.gap_m > 4e-6 {
            at = step_alone(Method::TrBdf2, &law, PATCH, at, step_s, &pulled);
            time_s += step_s;
        }
        time_s / (PI * fold / (1.5 * epsilon).sqrt()) - 1.0
    };
    let [near, nearer, nearest] = [1e-4, 1e-5, 1e-6].map(excess);
    println!("off by {near:e} {nearer:e} {nearest:e}");
    assert!(
        nearest.abs() < 2e-4 && nearer.abs() < 6e-4 && near.abs() < 2e-3,
        "{near:e} {nearer:e} {nearest:e}"
    );
}

/// While the gap moves slower than the rubber creeps, P − z = τ·Ṗ: creep is a damping of r·κ·τ beside the film's, so
/// t → π(c/κ + rτ)/√(1.5ε). The limits were set after measuring.
#[test]
fn creep_delays_above_the_fold_as_a_damping_of_r_kappa_tau() {
    let law = Law { creep_share: 0.6, creep_s: 0.02, ..bare() };
    let fold_s = law.film(19.66e-6 * 2.0 / 3.0 - 5e-6).value / law.spring_pa_per_m;
    let excess = |epsilon: f64| {
        let volt = pull_in_v(&law, PATCH, EPSILON_0) * (1.0 + epsilon);
        let (mut at, mut time_s, step_s) = (undriven(&law), 0.0, 1e-4);
        let pulled = Method::TrBdf2.stages(|_| Drive::new(volt, 0.0));
        while at.gap_m > 4e-6 {
            at = step_alone(Method::TrBdf2, &law, PATCH, at, step_s, &pulled);
            time_s += step_s;
        }
        time_s / (PI * (fold_s + 0.6 * 0.02) / (1.5 * epsilon).sqrt()) - 1.0
    };
    let [near, nearest] = [1e-4, 1e-6].map(excess);
    println!("off by {near:e} {nearest:e}");
    assert!(nearest.abs() < 2e-3 && near.abs() < 2e-2, "{near:e} {nearest:e}");
}

#[test]
fn just_below_the_fold_nothing_pulls_in_and_just_above_it_does() {
    let fold_v = pull_in_v(&bare(), PATCH, EPSILON_0);
    let gap_after = |epsilon: f64, by: By, step_s: f64| {
        run(by, &bare(), |_| fold_v * (1.0 + epsilon), step_s, 1.0, 1.0)[0].gap_m
    };
    for by in [By::Dynamic(Method::ImplicitEuler), By::Dynamic(Method::TrBdf2), By::QuasiStatic] {
        for step_s in [1e-4, 1e-3] {
            let (below, above) = (gap_after(-1e-4, by, step_s), gap_after(1e-4, by, step_s));
            assert!(below > 8.1e-6 && above < 1e-6, "{by:?} {step_s}: {below:e} {above:e}");
        }
    }
}
