// SPDX-License-Identifier: MIT OR Apache-2.0
//! Random devices about the default one: what the paper says holds for almost all of them, so that it does not hang
//! on the fit.

use rand_xoshiro::rand_core::{Rng, SeedableRng};

use super::equilibria::{capacitance_pf, force_n};
use super::*;
use crate::random::Stream;

const DEVICES: u64 = 200;

/// A number with a standard deviation, relative.
fn about(random: &mut Stream, mean: f64, deviation: f64) -> f64 {
    let mut share = || (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let normal = (-2.0 * (1.0 - share()).ln()).sqrt() * (std::f64::consts::TAU * share()).cos();
    mean * (1.0 + deviation * normal).max(0.1)
}

/// Spreads of docs/physics.md §3: κ and λ 10 %, p₀ 20 %, d 5 %, each height 5 %, each area 15 %.
fn random_pad(seed: u64) -> Rubber {
    let mut random = Stream::seed_from_u64(seed);
    let usual = pad("");
    let law = &usual.law;
    let spring = about(&mut random, law.spring_pa_per_m, 0.1);
    let decay_um = about(&mut random, 1e6 * law.contact_decay_m, 0.1);
    let contact = about(&mut random, law.contact_pa, 0.2);
    let insulator_um = about(&mut random, 16.0, 0.05);
    let heights: Vec<f64> = usual
        .patches
        .iter()
        .map(|patch| about(&mut random, 1e6 * (patch.rest_m + law.insulator_m), 0.05))
        .collect();
    let areas: Vec<f64> =
        usual.areas_m2.iter().map(|area| about(&mut random, *area, 0.15)).collect();
    let all: f64 = areas.iter().sum();
    let areas: Vec<f64> = areas.iter().map(|area| area / all).collect();
    pad(&format!(
        "spring_pa_per_m = {spring}\ncontact_decay_um = {decay_um}\ncontact_pa = {contact}\n\
         insulator_um = {insulator_um}\nrest_um = {heights:?}\narea_shares = {areas:?}\n\
         load_shares = [{}, 0, 0, 0, 0, 0, 0, 0]",
        1.0 / areas[0]
    ))
}

/// C(100 g) − C(20 g) falls at every 5 V up to 350 V.
fn load_moves_it_less_and_less(pad: &Rubber) -> bool {
    let rise = |volt: f64| capacitance_pf(pad, volt, 100.0) - capacitance_pf(pad, volt, 20.0);
    (0..=70).map(|step| rise(5.0 * f64::from(step))).is_sorted_by(|a, b| a > b)
}

/// The slope of eq. 10 about the middle falls at every 50 V up to 400 V: halves at ±7.5 mm, 100 g.
fn direction_falls(pad: &Rubber) -> bool {
    let slope = |volt: f64| {
        let [left, right] =
            [-2.0, 2.0].map(|mm| capacitance_pf(pad, volt, 100.0 * (1.0 + mm / 7.5)));
        7.5 * (right - left) / (left + right) / 2.0
    };
    (0..=8).map(|step| slope(50.0 * f64::from(step))).is_sorted_by(|a, b| a > b)
}

/// F/V² grows with the voltage: friction departs from the square law.
fn departs_from_the_square_law(pad: &Rubber) -> bool {
    let over_square = |volt: f64| {
        let gaps_m: Vec<f64> = pad.equilibrium_m(Drive::new(volt, pad.pa_per_g * 50.0)).collect();
        force_n(pad, volt, &gaps_m) / (volt * volt)
    };
    let grows = (1..=14).map(|step| over_square(25.0 * f64::from(step))).is_sorted();
    grows && over_square(350.0) > 1.5 * over_square(100.0)
}

/// C(200 V) − C(150 V) ≥ 2·(C(150 V) − C(100 V)) at 20, 50 and 100 g.
fn rises_suddenly(pad: &Rubber) -> bool {
    [20.0, 50.0, 100.0].into_iter().all(|load_g| {
        let [a, b, c] = [100.0, 150.0, 200.0].map(|volt| capacitance_pf(pad, volt, load_g));
        c - b >= 2.0 * (b - a)
    })
}

#[test]
fn of_200_random_devices_195_keep_every_trend_and_170_rise_suddenly() {
    let pads: Vec<Rubber> = (1..=DEVICES).map(random_pad).collect();
    let count = |holds: fn(&Rubber) -> bool| pads.iter().filter(|pad| holds(pad)).count();
    let trends = [load_moves_it_less_and_less, direction_falls, departs_from_the_square_law];
    let all = pads.iter().filter(|pad| trends.iter().all(|trend| trend(pad))).count();
    let each = trends.map(|trend| count(trend));
    let sudden = count(rises_suddenly);
    println!("all trends {all}, load, direction, square law {each:?}, sudden rise {sudden}");
    assert!(all >= 195 && sudden >= 170, "{all} {each:?} {sudden}");
}
