// SPDX-License-Identifier: MIT OR Apache-2.0
//! The relaxed pad: the check values of docs/physics.md §3, branches, and what no scene may meet.

use super::super::equilibrium::equilibrium_from;
use super::*;

/// The pad of the superseded device, whose patches all bear the load on stiff springs.
const STIFF: &str = "rest_um = [13, 14.5, 16, 17.5, 19.0664, 19.5503, 26, 34]\n\
    area_shares = [0.125, 0.125, 0.125, 0.125, 0.125, 0.125, 0.125, 0.125]\n\
    load_shares = [1, 1, 1, 1, 1, 1, 1, 1]\nspring_pa_per_m = 5e8\ncontact_decay_um = 0.5";

const VOLTS: [f64; 8] = [0.0, 100.0, 150.0, 200.0, 250.0, 300.0, 350.0, 400.0];

const MU: f64 = 0.12;

fn gaps_m(pad: &Rubber, volt: f64, load_g: f64) -> Vec<f64> {
    pad.equilibrium_m(Drive::new(volt, pad.pa_per_g * load_g)).collect()
}

pub fn capacitance_pf(pad: &Rubber, volt: f64, load_g: f64) -> f64 {
    1e12 * pad.capacitance_f(gaps_m(pad, volt, load_g).into_iter())
}

pub fn force_n(pad: &Rubber, volt: f64, gaps_m: &[f64]) -> f64 {
    MU * pad.attraction_n(gaps_m.iter().copied(), Drive::new(volt, 0.0).pull_n)
}

/// docs/physics.md §3: solved apart, by halving from the open side.
#[test]
fn capacitances_and_forces_are_those_of_the_equilibria() {
    let pad = pad("");
    for (load_g, picofarads, newtons) in [
        (
            20.0,
            [299.13, 309.96, 325.32, 384.98, 421.49, 487.58, 557.65, 588.10],
            [0.0, 0.0124, 0.0305, 0.0728, 0.1352, 0.2469, 0.4189, 0.6088],
        ),
        (
            50.0,
            [318.70, 327.04, 339.96, 397.10, 431.38, 495.62, 564.24, 593.56],
            [0.0, 0.0142, 0.0342, 0.0785, 0.1427, 0.2560, 0.4296, 0.6209],
        ),
        (
            100.0,
            [337.06, 344.07, 355.55, 411.00, 443.54, 506.15, 573.32, 601.39],
            [0.0, 0.0162, 0.0384, 0.0853, 0.1524, 0.2685, 0.4447, 0.6387],
        ),
    ] {
        for ((volt, picofarad), newton) in VOLTS.into_iter().zip(picofarads).zip(newtons) {
            let gaps_m = gaps_m(&pad, volt, load_g);
            let found_n = force_n(&pad, volt, &gaps_m);
            let found_pf = 1e12 * pad.capacitance_f(gaps_m.into_iter());
            let near = |found: f64, expected: f64| (found - expected).abs() < 0.00006;
            // As many digits as the table has; within 0.1 %, too.
            assert!((found_pf - picofarad).abs() < 0.006, "{load_g} g, {volt} V: {found_pf} pF");
            assert!(near(found_n, newton), "{load_g} g, {volt} V: {found_n} N");
        }
    }
}

/// The same equations, another device: the prototype's before, docs/physics.md §3.
#[test]
fn capacitances_of_the_superseded_device_are_those_of_its_equilibria() {
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
        let found_pf = capacitance_pf(&pad(STIFF), volt, load_g);
        assert!((found_pf - expected_pf).abs() < 0.006, "{load_g} g, {volt} V: {found_pf} pF");
    }
}

/// The paper's Fig. 4, and what the superseded device did the other way round.
#[test]
fn the_load_moves_the_capacitance_less_the_higher_the_voltage() {
    const LOADS_G: [f64; 5] = [20.0, 35.0, 50.0, 75.0, 100.0];
    let pad = pad("");
    for (n, low_g) in LOADS_G.into_iter().enumerate() {
        for high_g in LOADS_G.into_iter().skip(n + 1) {
            let rise = |step: usize| {
                let volt = 5.0 * step as f64;
                capacitance_pf(&pad, volt, high_g) - capacitance_pf(&pad, volt, low_g)
            };
            let rises: Vec<f64> = (0..=70).map(rise).collect();
            assert!(rises.is_sorted_by(|a, b| a > b), "{low_g} to {high_g} g: {rises:?}");
        }
    }
    let rise = |volt: f64| capacitance_pf(&pad, volt, 100.0) - capacitance_pf(&pad, volt, 20.0);
    for (step, expected_pf) in
        [37.93, 36.91, 34.11, 30.23, 26.03, 22.05, 18.58, 15.67, 13.29].into_iter().enumerate()
    {
        let found_pf = rise(50.0 * step as f64);
        assert!((found_pf - expected_pf).abs() < 0.006, "{} V: {found_pf} pF", 50 * step);
    }
    let stiff = self::pad(STIFF);
    let rise = |volt: f64| capacitance_pf(&stiff, volt, 100.0) - capacitance_pf(&stiff, volt, 20.0);
    assert!(rise(200.0) > 1.5 * rise(0.0));
}

#[test]
fn the_capacitance_rises_suddenly_above_150_v() {
    let pad = pad("");
    for (load_g, expected) in [(20.0, 3.9), (50.0, 4.4), (100.0, 4.8)] {
        let [a, b, c] = [100.0, 150.0, 200.0].map(|volt| capacitance_pf(&pad, volt, load_g));
        let found = (c - b) / (b - a);
        assert!((found - expected).abs() < 0.05, "{load_g} g: {found}");
    }
}

/// An assumption of the default device: spots that bear 1 % of the crests' load per area turn the trend round.
#[test]
fn spots_that_bear_load_break_the_trend() {
    let bearing = |share: f64| {
        let crest = 1.0 / (0.365 + 0.635 * share);
        let spots = vec![crest * share; 7];
        let pad = pad(&format!(
            "load_shares = [{crest}, {}]",
            format!("{spots:?}").trim_matches(['[', ']'])
        ));
        capacitance_pf(&pad, 300.0, 100.0) - capacitance_pf(&pad, 300.0, 20.0)
    };
    let (none, some) = (bearing(0.0), bearing(0.01));
    println!("C(100 g) − C(20 g) at 300 V: {none:.1} pF, with 1 % on the spots {some:.1} pF");
    assert!((none - 18.58).abs() < 0.01 && (some - 57.0).abs() < 0.5, "{none} {some}");
}

#[test]
fn every_patch_is_in_balance_wherever_it_floats() {
    for pad in [pad(""), pad(STIFF)] {
        for (patch, step) in
            pad.patches.iter().flat_map(|patch| (0..120).map(move |step| (*patch, step)))
        {
            let drive = Drive::new(5.0 * f64::from(step), 300.0);
            let gap_m = equilibrium(&pad.law, patch, drive);
            let balance = pad.law.relaxed(gap_m, patch, drive);
            assert!(
                balance.value.abs() < 1e-6 && balance.slope < 0.0,
                "{patch:?} {drive:?}: {balance:?} at {gap_m}"
            );
        }
    }
}

/// Scans down from the open side, with any decay length that a scene may have.
#[test]
fn the_gap_is_the_largest_at_which_a_scan_finds_no_pressure() {
    for decay_um in [0.5, 1.25, 2.0, 2.5] {
        let pad = pad(&format!("contact_decay_um = {decay_um}"));
        for (patch, step) in
            pad.patches.iter().flat_map(|patch| (0..100).map(move |step| (*patch, step)))
        {
            let drive = Drive::new(6.0 * f64::from(step), pad.pa_per_g * 50.0);
            let gap_m = equilibrium(&pad.law, patch, drive);
            let top_m = patch.rest_m + 10e-6;
            let scanned = (0..20_000)
                .map(|n| top_m * (1.0 - f64::from(n) / 20_000.0))
                .find(|gap_m| pad.law.relaxed(*gap_m, patch, drive).value >= 0.0);
            let scanned_m = scanned.unwrap_or(0.0);
            assert!(
                (gap_m - scanned_m).abs() < 2.0 * top_m / 20_000.0,
                "{decay_um} µm, {patch:?}, {drive:?}: {gap_m:e}, scan {scanned_m:e}"
            );
        }
    }
}

#[test]
fn capacitance_rises_with_load_and_voltage() {
    let pad = pad("");
    for load_g in [0.0, 20.0, 50.0, 100.0] {
        let rising: Vec<f64> =
            (0..80).map(|step| capacitance_pf(&pad, 10.0 * f64::from(step), load_g)).collect();
        assert!(rising.is_sorted(), "{load_g} g: {rising:?}");
        assert!(capacitance_pf(&pad, 300.0, load_g) < capacitance_pf(&pad, 300.0, load_g + 10.0));
    }
}

/// 20 g: the prototype's forces of the superseded device on the way up and down. Spots of the default device stay
/// closed less far down: their contact is softer.
#[test]
fn closed_patches_stay_closed_on_the_way_down() {
    let up_and_down = |pad: &Rubber| {
        let mut gaps_m = gaps_m(pad, 0.0, 20.0);
        let mut at = |volt: f64| {
            let drive = Drive::new(volt, pad.pa_per_g * 20.0);
            for (gap_m, patch) in gaps_m.iter_mut().zip(&pad.patches) {
                *gap_m = equilibrium_from(&pad.law, *patch, drive, *gap_m);
                let balance = pad.law.relaxed(*gap_m, *patch, drive);
                assert!(balance.value.abs() < 1e-6 && balance.slope < 0.0, "{volt} V: {balance:?}");
            }
            force_n(pad, volt, &gaps_m)
        };
        let up: Vec<f64> = (0..=80).map(|step| at(5.0 * f64::from(step))).collect();
        let down: Vec<f64> = (0..=80).rev().map(|step| at(5.0 * f64::from(step))).collect();
        assert_eq!(down[80], 0.0);
        let back = at(5.0);
        assert!((back - up[1]).abs() < 1e-12, "without a voltage they open: {back}, {}", up[1]);
        [60, 65, 35].map(|step| [up[step], down[80 - step]])
    };
    let found = up_and_down(&pad(STIFF));
    for ([up, down], [upwards, downwards]) in
        found.into_iter().zip([[0.400, 0.517], [0.504, 0.653]])
    {
        assert!((up - upwards).abs() < 0.001 && (down - downwards).abs() < 0.001, "{found:?}");
    }
    let found = up_and_down(&pad(""));
    println!("default, 300, 325 and 175 V, up and down: {found:.4?} N");
    let [[up, down], ..] = found;
    assert!((up - 0.2469).abs() < 6e-5 && (down - 0.2730).abs() < 6e-5, "{found:?}");
}

#[test]
fn from_open_the_branch_is_the_open_one_at_any_voltage() {
    let pad = pad("");
    for (patch, step) in
        pad.patches.iter().flat_map(|patch| (0..60).map(move |step| (*patch, step)))
    {
        let drive = Drive::new(10.0 * f64::from(step), 300.0);
        let open_m = equilibrium(&pad.law, patch, drive);
        assert_eq!(equilibrium_from(&pad.law, patch, drive, patch.rest_m), open_m);
    }
}
