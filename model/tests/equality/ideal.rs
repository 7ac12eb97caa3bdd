// SPDX-License-Identifier: MIT OR Apache-2.0
//! The floating-point reference, against the equations solved backwards.

use crate::device::{self, Sight, calibration, tone_codes, tones};
use crate::random::Random;
use hapticore_contract::frame::Measurement;
use hapticore_contract::profile::Profile;
use hapticore_reference::Reference;
use std::f64::consts::TAU;

fn close(a: f64, b: f64, relative: f64) -> bool {
    (a - b).abs() <= relative * b.abs()
}

fn phasor((amplitude, turns): (f64, f64)) -> (f64, f64) {
    (amplitude * (TAU * turns).cos(), amplitude * (TAU * turns).sin())
}

/// Eq. 5: |I| = y v / √(1 + (y R)²) of an admittance y behind the sheet's R at the pad.
#[test]
fn the_square_root_form_gives_the_capacitance_back() {
    let profile = Profile::bundled("standard").expect("bundled");
    let calibration = calibration(&profile);
    let (mut reference, mut random) =
        (Reference::<f64>::new(&profile, &calibration), Random::new(1));
    for _ in 0..1000 {
        let shares: Vec<f64> =
            tones(&profile, &mut random).phasors.iter().map(|&(share, _)| share).collect();
        let (voltage, terminals) = shares.split_last().expect("there are channels");
        let sum: f64 = terminals.iter().sum();
        let signed = |signs: &[i8]| -> f64 {
            signs.iter().zip(terminals).map(|(&s, share)| f64::from(s) * share).sum()
        };
        let corners: f64 = terminals.iter().sum();
        let (r_x, r_y) =
            (signed(&profile.terminals.x) / corners, signed(&profile.terminals.y) / corners);
        let sheet = calibration.position.look_up(r_x, r_y).sheet;
        let admittance = random.between(0.1, 2.0);
        let behind = (1.0 + (admittance * sheet).powi(2)).sqrt();
        let current = admittance * voltage / behind;
        let turn = random.unit();
        let mut phasors: Vec<_> =
            terminals.iter().map(|share| phasor((share / sum * current, turn))).collect();
        phasors.push(phasor((*voltage, random.unit())));
        let measurement = reference.phasors(0, &phasors, 0.25);
        let expected = 800.0 * admittance;
        assert!(
            close(measurement.capacitance_pf, expected, 1e-12),
            "{measurement:?} of {expected} pF"
        );
        assert!(close(reference.capacitance_eq6(), expected / behind, 1e-12), "eq. 6 reads low");
        assert!(close(measurement.mean_square, 0.25 * profile.square_gain(), 1e-15));
        assert!(close(
            measurement.force_n,
            calibration.force_gain * expected * expected * measurement.mean_square,
            1e-11
        ));
    }
}

/// Codes are rounded to the ADC's step, whose deviation averages over the window.
#[test]
fn a_window_of_codes_reads_as_its_phasors() {
    for (seed, profile) in (0..).zip(Profile::all()) {
        let calibration = calibration(&profile);
        let (mut reference, mut random) =
            (Reference::<f64>::new(&profile, &calibration), Random::new(seed));
        for _ in 0..20 {
            let tones = tones(&profile, &mut random);
            let window = profile.slot.blanking()..profile.slot.samples();
            let codes: Vec<i32> = window.flat_map(|n| tone_codes(&profile, &tones, n)).collect();
            let phasors: Vec<_> = tones.phasors.iter().map(|&tone| phasor(tone)).collect();
            let (of_codes, of_phasors) =
                (reference.slot(0, &codes), reference.phasors(1, &phasors, 0.0));
            // Without dither a period's samples repeat, and so do their roundings: half a step is
            // the bound.
            let step = 0.5f64.powi(profile.formats.adc.frac.into()) / 0.04;
            assert!((of_codes.r_x - of_phasors.r_x).abs() < step, "{tones:?}");
            assert!(close(of_codes.capacitance_pf, of_phasors.capacitance_pf, step), "{tones:?}");
        }
    }
}

#[test]
fn what_is_invalid_holds_the_last_of_its_pad() {
    let profile = Profile::bundled("small").expect("bundled");
    let (mut reference, mut random) =
        (Reference::<f64>::new(&profile, &calibration(&profile)), Random::new(7));
    let mut slot = |pad: usize, sight: Sight| {
        let codes = device::codes(&profile, sight, &mut random);
        let measurement =
            reference.slot(pad, &codes[profile.slot.blanking() as usize * profile.channels()..]);
        (measurement, reference.capacitance_eq6())
    };
    let (valid, eq6) = slot(2, Sight::Tones);
    assert!(!valid.flags.invalid && !valid.flags.lost && !valid.flags.clipped);
    slot(1, Sight::Tones);
    for sight in [Sight::Silence, Sight::NoVoltage] {
        let (held, held_eq6) = slot(2, sight);
        assert!(held.flags.invalid, "{sight:?}");
        assert_eq!(
            (held.r_x, held.x_mm, held.capacitance_pf),
            (valid.r_x, valid.x_mm, valid.capacitance_pf)
        );
        assert_eq!(held_eq6, eq6);
    }
    assert_eq!(slot(3, Sight::Silence).0.capacitance_pf, 0.0, "a pad that never was");
    assert!(slot(0, Sight::Broken).0.flags.lost);
    assert!(slot(0, Sight::FullScale).0.flags.clipped);
}

#[test]
fn a_lifted_pad_keeps_its_place_and_reads_its_own_capacitance() {
    let profile = Profile::bundled("standard").expect("bundled");
    let calibration = calibration(&profile);
    let (mut reference, mut random) =
        (Reference::<f64>::new(&profile, &calibration), Random::new(9));
    let mut slot = |pad: usize, sight: Sight| {
        let codes = device::codes(&profile, sight, &mut random);
        reference.slot(pad, &codes[profile.slot.blanking() as usize * profile.channels()..])
    };
    let touching = slot(2, Sight::Tones);
    assert!(!touching.flags.lifted && touching.capacitance_pf > calibration.contact_capacitance);
    slot(1, Sight::Tones);
    let lifted = slot(2, Sight::Lifted);
    assert!(lifted.flags.lifted && !lifted.flags.invalid, "{lifted:?}");
    let place = |of: &Measurement| [of.r_x, of.r_y, of.x_mm, of.y_mm, of.sheet];
    assert_eq!(place(&lifted), place(&touching));
    assert!(lifted.capacitance_pf > 0.0 && lifted.capacitance_pf < calibration.contact_capacitance);
    let force_n = calibration.force_gain * lifted.capacitance_pf.powi(2) * lifted.mean_square;
    assert!(close(lifted.force_n, force_n, 1e-12), "{lifted:?}");
    let again = slot(2, Sight::Tones);
    assert!(!again.flags.lifted && again.x_mm != touching.x_mm, "{again:?}");
    assert_eq!(place(&slot(3, Sight::Lifted)), [0.0; 5], "a pad that never touched");
}
