// SPDX-License-Identifier: MIT OR Apache-2.0
//! 95 % intervals hold the truth in 95 % of a thousand labs.

use std::ops::RangeInclusive;

use hapticore_run::lab::least_squares::Estimate;
use hapticore_run::lab::loads::{Force, Load, Loads};
use hapticore_run::lab::setup::Setup;

use super::{Noise, SETUP};

const LABS: u32 = 1000;

/// Not that of the runs in which the labs were thought out.
const SEED: u64 = 20_261_122;

/// 94 to 96 %.
const WITHIN: RangeInclusive<f64> = 0.94..=0.96;

/// True k of eq. 8, N/(F·V)².
const K: f64 = 9.6e12;
const MU: f64 = 0.12;
const SCALE: f64 = 1.03;

/// A lab: a few loads and voltages, friction with noise of 1 to 10 mN, both capacitances.
fn lab(noise: &mut Noise, friction: bool) -> Loads {
    let loads = [vec![20.0, 100.0], vec![10.0, 50.0, 120.0]][noise.0.usize(..2)].clone();
    let (voltages, sd_n) = (noise.0.u32(3..=12), 1e-3 + 9e-3 * noise.0.f64());
    let mut measurements = Vec::new();
    for load_g in loads {
        for step in 0..voltages {
            let haptic_v_rms = 350.0 * f64::from(step) / f64::from(voltages - 1);
            let capacitance_pf = 310.0 + 0.8 * load_g + 60.0 * (haptic_v_rms / 350.0).powi(2);
            let press_n = if friction { MU * load_g * 9.806_65e-3 } else { 0.0 };
            measurements.push(Load {
                haptic_v_rms,
                newtons: press_n
                    + K * (1e-12 * capacitance_pf * haptic_v_rms).powi(2)
                    + sd_n * noise.normal(),
                load_g: Some(load_g),
                reference_pf: Some(capacitance_pf),
                sensed_pf: None,
                time_s: None,
            });
        }
    }
    Loads { file: "loads.csv".into(), loads: measurements, friction, timed: false }
}

/// A lab whose bridge has noise of 0.5 pF, and whose currents' full scale is not what the setup
/// says.
fn with_currents(noise: &mut Noise) -> Loads {
    let mut lab = lab(noise, false);
    for load in &mut lab.loads {
        load.sensed_pf = load.reference_pf.map(|pf| pf / SCALE);
        load.reference_pf = load.reference_pf.map(|pf| pf + 0.5 * noise.normal());
    }
    lab
}

fn coverage(
    seed: u64,
    lab: impl Fn(&mut Noise) -> Loads,
    of: impl Fn(&Force) -> (Estimate, f64),
) -> f64 {
    let setup: Setup = toml::from_str(SETUP).unwrap();
    let mut noise = Noise::of(seed);
    let holds = (0..LABS).filter(|_| {
        let (Estimate { interval: [low, high], .. }, truth) =
            of(&lab(&mut noise).fit(&setup).unwrap());
        (low..=high).contains(&truth)
    });
    holds.count() as f64 / f64::from(LABS)
}

#[test]
fn intervals_hold_the_truth_as_often_as_they_say() {
    for (what, share) in [
        ("force_k", coverage(SEED, |noise| lab(noise, false), |force| (force.force_k, K))),
        (
            "force_k beside mu",
            coverage(SEED + 1, |noise| lab(noise, true), |force| (force.force_k, K)),
        ),
        ("mu", coverage(SEED + 2, |noise| lab(noise, true), |force| (force.mu.unwrap(), MU))),
        ("scale", coverage(SEED + 3, with_currents, |force| (force.current_scale.unwrap(), SCALE))),
    ] {
        println!("{what}: {:.1} % of {LABS}", 100.0 * share);
        assert!(WITHIN.contains(&share), "{what}: {share}");
    }
}
