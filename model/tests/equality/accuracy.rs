// SPDX-License-Identifier: MIT OR Apache-2.0
//! What word lengths cost on clean tones: the deviation of fixed point from floating point on the
//! same codes, beside the deviation that the word lengths predict.
//!
//!   q(f) = lsb / √12                                     the deviation of rounding to f.
//!   ε² = carrier² + 2 q(iq)² / (g a)²           of an amplitude a, relative; g the tone gain.
//!   q(iq) 2^-by where words are moved up by bits; the total's and the sensing voltage's amplitudes then add q(total).
//!   carrier = 2 q(oscillator) / √N                       the local oscillator's words, of N samples.
//!
//! Onward, δr = Σ (±1 − r) δa / Σ a; a position follows its table's slope; capacitance and force
//! add their words' own q.

use crate::device::{Tones, calibration, tone_codes};
use crate::random::Random;
use hapticore_contract::calibration::Calibration;
use hapticore_contract::frame::Field;
use hapticore_contract::frame::Measurement;
use hapticore_contract::profile::Profile;
use hapticore_hdl::format::Format;
use hapticore_model::fidelity::fixed::FixedSimulation;
use hapticore_reference::Reference;

const SLOTS: usize = if cfg!(optimised) { 300 } else { 60 };
const NAMES: [&str; 5] = ["r_x", "x_mm", "capacitance", "force", "mean_square"];
/// By how much a deviation may be more, and less, than predicted.
const MORE: f64 = 1.5;
const LESS: f64 = 3.0;

fn q(format: Format) -> f64 {
    2f64.powi(-i32::from(format.frac)) / 12f64.sqrt()
}

fn norm(terms: &[f64]) -> f64 {
    terms.iter().map(|term| term * term).sum::<f64>().sqrt()
}

/// A pad, its currents' phases spread wider than a sheet would, so that their errors have little in
/// common.
fn spread_tones(profile: &Profile, random: &mut Random) -> Tones {
    let phase = random.unit();
    let mut phasors: Vec<_> = (0..profile.terminals.x.len())
        .map(|_| (random.between(0.04, 0.14), phase + random.between(-0.12, 0.12)))
        .collect();
    phasors.push((random.between(0.7, 0.9), random.unit()));
    Tones { phasors, haptic: random.between(0.5, 0.9) }
}

/// The relative deviation of an amplitude from the local oscillator's words, one error for each
/// sample of the window.
fn carrier(profile: &Profile) -> f64 {
    q(profile.formats.oscillator) * 2.0 / (profile.slot.integrate as f64).sqrt()
}

/// The deviation of a position: of its ratios and of the table's words, by the slope of the place
/// over the ratios, and of the words of the place itself.
fn position(
    profile: &Profile,
    calibration: &Calibration,
    ideal: &Measurement,
    of_ratio: [f64; 2],
) -> f64 {
    let f = &profile.formats;
    let x = |dx: f64, dy: f64| calibration.position.look_up(ideal.r_x + dx, ideal.r_y + dy).x;
    let step = 1e-3;
    let slopes = [x(step, 0.0) - x(-step, 0.0), x(0.0, step) - x(0.0, -step)]
        .map(|rise| rise / (2.0 * step));
    // The measured ratio and what is left of it; nine coefficients, each by its weight (0.3 in
    // all); three rows' values likewise (0.55). Errors of the weights, whose sum is one, count by
    // how much neighbours differ: next to nothing.
    let words = q(f.table) * norm(&[1.0, 1.0, 0.3, 0.55]);
    let along = |axis: usize| slopes[axis] * norm(&[of_ratio[axis], words]);
    let cells = (profile.position.columns - 2) as f64;
    // As fine as a place's word, or the last of sixteen digits of a step's quotient.
    let place = 2f64.powi((6 - i32::from(f.table.width)).max(3 - 16)) / 12f64.sqrt();
    norm(&[along(0), along(1), place * 800.0 / cells, q(f.position)])
}

/// The deviations of [`NAMES`] that the word lengths predict.
fn predict(
    profile: &Profile,
    calibration: &Calibration,
    tones: &Tones,
    ideal: &Measurement,
) -> [f64; 5] {
    let (f, g) = (&profile.formats, profile.tone_gain());
    let (terminals, sense) = tones.phasors.split_at(profile.terminals.x.len());
    let carrier = carrier(profile);
    let up = |tones: &[(f64, f64)]| {
        let largest = tones.iter().map(|(a, _)| g * a).fold(0.0, f64::max);
        2f64.powi((-largest.log2()).floor().clamp(0.0, f.block_shift.into()) as i32)
    };
    let [of_terminals, of_sense] = [terminals, sense].map(|tones| q(f.iq) / up(tones));
    let relative = |word: f64, words: f64, a: f64| norm(&[carrier, word * words.sqrt() / (g * a)]);
    let given = |a: f64| if f.block_shift > 0 { q(f.total) / (g * a) } else { 0.0 };
    let ratio = |signs: &[i8], r: f64| {
        let corner = |&(a, _): &(f64, f64), sign: i8| {
            (f64::from(sign) - r) * a * relative(of_terminals, 2.0, a)
        };
        let others = profile.terminals.x.iter().zip(&profile.terminals.y);
        let corners =
            terminals.iter().zip(signs).zip(others).filter(|&(_, (&x, &y))| x != 0 || y != 0);
        let (terms, sum) =
            corners.fold((Vec::new(), 0.0), |(mut terms, sum), ((current, &sign), _)| {
                terms.push(corner(current, sign));
                (terms, sum + current.0)
            });
        norm(&[norm(&terms) / sum, q(f.ratio)])
    };
    let of_ratio = [ratio(&profile.terminals.x, ideal.r_x), ratio(&profile.terminals.y, ideal.r_y)];
    let total = ideal.capacitance_pf / calibration.capacitance_gain * sense[0].0;
    let admittance = ideal.capacitance_pf / calibration.capacitance_gain;
    // The total's own word has fewer bits than a terminal's, by as many as their number has.
    let narrowed =
        if f.block_shift > 0 { f64::from(1 << (2 * terminals.len().ilog2() + 2)) } else { 1.0 };
    let words = terminals.len() as f64 + narrowed;
    let capacitance = norm(&[
        relative(of_terminals, words, total),
        relative(of_sense, 2.0, sense[0].0),
        given(total),
        // Its amplitude, and the square root of what the sheet's drop leaves of it.
        2f64.sqrt() * given(sense[0].0),
        q(f.admittance) / admittance,
        q(f.capacitance) / ideal.capacitance_pf,
    ]);
    let square = ideal.capacitance_pf.powi(2);
    let mean_square = norm(&[
        q(f.mean_square) / ideal.mean_square,
        2.0 * norm(&[q(f.adc), q(f.oscillator)])
            / (profile.slot.integrate as f64 * ideal.mean_square).sqrt(),
    ]);
    let gain = f.force_gain.lsb() * (calibration.force_gain / f.force_gain.lsb()).round()
        / calibration.force_gain
        - 1.0;
    let force = norm(&[
        2.0 * capacitance,
        q(f.square) / square,
        mean_square,
        q(f.square) / (square * ideal.mean_square),
        gain,
        q(f.force) / ideal.force_n,
    ]);
    let in_frame = norm(&[of_ratio[0], q(Field::RatioX.format(profile))]);
    [in_frame, position(profile, calibration, ideal, of_ratio), capacitance, force, mean_square]
}

fn deviate(ideal: &Measurement, fixed: &Measurement) -> [f64; 5] {
    [
        fixed.r_x - ideal.r_x,
        fixed.x_mm - ideal.x_mm,
        fixed.capacitance_pf / ideal.capacitance_pf - 1.0,
        fixed.force_n / ideal.force_n - 1.0,
        fixed.mean_square / ideal.mean_square - 1.0,
    ]
}

#[test]
fn deviations_are_those_of_the_word_lengths() {
    let mut table = format!(
        "{:10} {:12} {:>10} {:>10} {:>6}\n",
        "profile", "rms of", "predicted", "measured", "ratio"
    );
    let mut within = true;
    for (seed, profile) in (0..).zip(Profile::all()) {
        let calibration = calibration(&profile);
        let mut fixed: FixedSimulation = FixedSimulation::new(&profile, &calibration);
        let mut reference = Reference::new(&profile, &calibration);
        let mut random = Random::new(seed);
        let mut squares = [[0.0; 2]; NAMES.len()];
        for _ in 0..SLOTS {
            let tones = spread_tones(&profile, &mut random);
            let window = profile.slot.blanking()..profile.slot.samples();
            let codes: Vec<i32> = window.flat_map(|n| tone_codes(&profile, &tones, n)).collect();
            let (ideal, got) = (reference.slot(0, &codes), fixed.slot(0, &codes));
            assert_eq!(got.flags, ideal.flags, "{tones:?}");
            let predicted = predict(&profile, &calibration, &tones, &ideal);
            let measured = deviate(&ideal, &got.measurement(&profile));
            for (square, (p, m)) in squares.iter_mut().zip(predicted.into_iter().zip(measured)) {
                *square = [square[0] + p * p, square[1] + m * m];
            }
        }
        for (name, square) in NAMES.iter().zip(squares) {
            let [predicted, measured] = square.map(|square| (square / SLOTS as f64).sqrt());
            let ratio = measured / predicted;
            table += &format!(
                "{:10} {name:12} {predicted:10.2e} {measured:10.2e} {ratio:6.2}\n",
                profile.name
            );
            within &= ratio < MORE && ratio > 1.0 / LESS;
        }
    }
    println!("{table}");
    assert!(within, "deviations are between 1/{LESS} and {MORE} of those predicted\n{table}");
}
