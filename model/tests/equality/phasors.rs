// SPDX-License-Identifier: MIT OR Apache-2.0
//! A window's sums from amplitudes against those from the same tones' samples: what is between them
//! is the ADC's rounding.

use crate::device::{Tones, calibration, tone_codes, tones};
use crate::random::Random;
use hapticore_contract::profile::Profile;
use hapticore_model::fidelity::fixed::FixedSimulation;
use std::f64::consts::TAU;

/// The longest period of the haptic voltage, in samples.
const LONGEST_PERIOD: u64 = 50;
const SLOTS: usize = 20;
/// By how much a difference may be more than the ADC's rounding lets expect.
const MORE: f64 = 5.0;

/// Samples in a period of the haptic voltage, so that its ripple falls between the lobes of the
/// window.
fn haptic_period(profile: &Profile) -> u64 {
    let divides = |period: &u64| profile.slot.integrate.is_multiple_of(*period);
    (1..=LONGEST_PERIOD).rev().find(divides).expect("1 does")
}

fn window(profile: &Profile, tones: &Tones) -> Vec<i32> {
    let full = f64::from(1 << (profile.formats.adc.width - 1));
    let period = haptic_period(profile) as f64;
    let sample = |n: u64| {
        let mut codes = tone_codes(profile, tones, n);
        let haptic = full * tones.haptic * (TAU * n as f64 / period).sin();
        *codes.last_mut().expect("there are channels") = haptic.round() as i32;
        codes
    };
    (profile.slot.blanking()..profile.slot.samples()).flat_map(sample).collect()
}

/// What lies between two amplitudes: rounding that repeats with each period, lsb/√12 in each of its
/// samples, and the in-phase and quadrature words' own on either side.
fn rounding(profile: &Profile) -> f64 {
    let (mut common, mut rest) = (profile.slot.integrate, profile.carrier.periods);
    while rest != 0 {
        (common, rest) = (rest, common % rest);
    }
    rounding_of(profile, profile.slot.integrate / common)
}

/// The same of a tone that repeats after `distinct` samples.
fn rounding_of(profile: &Profile, distinct: u64) -> f64 {
    let adc = profile.formats.adc.lsb() * (2.0 / distinct as f64).sqrt();
    let words = profile.formats.iq.lsb() * 2f64.sqrt() / profile.tone_gain();
    adc.hypot(words) / 12f64.sqrt()
}

fn check(profile: &Profile, random: &mut Random) {
    let calibration = calibration(profile);
    let mut sampled = FixedSimulation::<i64>::new(profile, &calibration);
    let mut told = FixedSimulation::<i64>::new(profile, &calibration);
    for _ in 0..SLOTS {
        let tones = tones(profile, random);
        let phasors: Vec<_> = tones
            .phasors
            .iter()
            .map(|&(a, turns)| (a * (TAU * turns).cos(), -a * (TAU * turns).sin()))
            .collect();
        let from_samples = sampled.slot(0, &window(profile, &tones)).measurement(profile);
        let from_phasors = told.phasors(0, &phasors, 0.5 * tones.haptic * tones.haptic);
        let from_phasors = from_phasors.measurement(profile);
        assert_eq!(from_samples.flags, from_phasors.flags, "{}", profile.name);
        let terminals = profile.terminals.x.len() as f64;
        let total: f64 = tones.phasors.iter().take(profile.terminals.x.len()).map(|(a, _)| a).sum();
        let expected = rounding(profile) * (terminals.sqrt() / total + 1.0);
        let off = |a: f64, b: f64| (a - b).abs();
        let capacitance = off(from_samples.capacitance_pf, from_phasors.capacitance_pf);
        let allowed =
            MORE * expected * from_phasors.capacitance_pf + 2.0 * profile.formats.capacitance.lsb();
        assert!(capacitance < allowed, "{}: capacitance {capacitance} pF, {allowed}", profile.name);
        let square = off(from_samples.mean_square, from_phasors.mean_square);
        let allowed = MORE * 2.0 * rounding_of(profile, haptic_period(profile))
            + 2.0 * profile.formats.mean_square.lsb();
        assert!(square < allowed, "{}: mean square {square}, {allowed}", profile.name);
        let ratio = off(from_samples.r_x, from_phasors.r_x);
        let corners: f64 = tones.phasors.iter().take(4).map(|(a, _)| a).sum();
        let allowed =
            MORE * 2.0 * rounding(profile) * 2.0 / corners + 2.0 * profile.formats.ratio.lsb();
        assert!(ratio < allowed, "{}: r_x {ratio}, {allowed}", profile.name);
    }
}

#[test]
fn frames_from_amplitudes_are_those_from_samples_but_for_the_adcs_rounding() {
    let mut random = Random::new(71);
    Profile::all().iter().for_each(|profile| check(profile, &mut random));
}

#[test]
fn amplitudes_beyond_full_scale_are_held_and_flagged() {
    for profile in Profile::all() {
        let mut core = FixedSimulation::<i64>::new(&profile, &calibration(&profile));
        let mut phasors = vec![(0.0, 0.1); profile.channels() - 1];
        assert!(!core.phasors(0, &phasors, 0.1).flags.clipped, "{}", profile.name);
        assert!(
            core.phasors(0, &phasors, 0.6).flags.clipped,
            "{}: the haptic voltage",
            profile.name
        );
        phasors[2] = (3.0, -4.0);
        assert!(core.phasors(0, &phasors, 0.1).flags.clipped, "{}: a current", profile.name);
    }
}
