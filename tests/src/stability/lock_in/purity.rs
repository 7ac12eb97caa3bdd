// SPDX-License-Identifier: MIT OR Apache-2.0
//! The whole chain as a converter: signal to noise and distortion, effective bits, linearity.

use std::f64::consts::{PI, TAU};

use fastrand::Rng;
use hapticore_contract::frame::Measurement;

use super::amplitude::gaussian;
use crate::stability::Outcome;
use crate::stability::bench::{Bench, Pad, rms};
use crate::stability::rivals::measure_with_idsp;

/// Slots of a record, and periods of the sine in it: without a common divisor.
const RECORD: usize = 512;
const PERIODS: usize = 31;
/// Largest amplitude of the haptic voltage, of full scale.
const LOUD: f64 = 0.9;
/// Amplitude of the sine, of the largest force.
const SWING: f64 = 0.475;

/// A sine through force.
pub fn sinad_of_the_force() -> Outcome {
    let mut outcome = Outcome::of("signal to noise and distortion of the force");
    let mut rivals = Vec::new();
    for bench in Bench::all() {
        let forces = forces(&bench);
        let [core, float, idsp] = forces.map(|series| sinad_db(&series));
        let name = &bench.profile.name;
        let limit = -10.0 * (10f64.powf(-float / 10.0) + words(&bench)).log10() - 3.0;
        let name_and_bits = format!("`{name}` ({:.1} bits)", effective_bits(core));
        outcome = outcome.at_least(name_and_bits, core, limit, "dB");
        rivals.push(format!(
            "`{name}`: floating point {float:.1} dB ({:.1} bits), idsp {idsp:.1} dB",
            effective_bits(float)
        ));
    }
    outcome.rivals(rivals.join("; "))
}

/// Noise of the rounding of words, of the power of the record's sine: force, mean square, admittance,
/// capacitance and its square.
fn words(bench: &Bench) -> f64 {
    let (formats, largest) = (&bench.profile.formats, bench.ideal(&loudest(bench)));
    let of = |lsb: f64, full: f64| (lsb / full).powi(2) / 12.0;
    let admittance = largest.capacitance_pf / bench.calibration.capacitance_gain;
    let noise = of(formats.force.lsb(), largest.force_n)
        + of(formats.mean_square.lsb(), largest.mean_square)
        + of(2.0 * formats.capacitance.lsb(), largest.capacitance_pf)
        + of(formats.square.lsb(), largest.capacitance_pf.powi(2))
        + of(2.0 * formats.admittance.lsb(), admittance);
    noise / (SWING * SWING / 2.0)
}

/// The pad at its largest force.
fn loudest(bench: &Bench) -> Pad {
    Pad { haptic: LOUD, ..bench.pad(0.9) }
}

/// Forces of a record, N, of the core, of floating point and of idsp.
fn forces(bench: &Bench) -> [Vec<f64>; 3] {
    let lsb = bench.profile.formats.adc.lsb();
    let mut rng = Rng::with_seed(11);
    let still = loudest(bench);
    let mut series = [const { Vec::new() }; 3];
    let (mut core, mut float) = (bench.fixed(), bench.reference());
    for slot in 0..RECORD {
        let turn = TAU * (slot * PERIODS) as f64 / RECORD as f64;
        // The force goes with the square of the voltage.
        let haptic = LOUD * (0.5 + SWING * turn.sin()).sqrt();
        let pad = Pad { haptic, ..still.clone() };
        let codes = bench
            .window(|n, channel| bench.signal(&pad, n, channel) + 0.5 * lsb * gaussian(&mut rng));
        let found = [
            core.slot(0, &codes).measurement(&bench.profile),
            float.slot(0, &codes),
            measure_with_idsp(bench, &codes),
        ];
        for (series, Measurement { force_n, .. }) in series.iter_mut().zip(found) {
            series.push(force_n);
        }
    }
    series
}

/// Of a record: the sine that fits it best over what is left (IEEE 1057, with a known frequency).
fn sinad_db(series: &[f64]) -> f64 {
    let turn = |slot: usize| TAU * (slot * PERIODS) as f64 / RECORD as f64;
    let count = series.len() as f64;
    let along = |of: fn(f64) -> f64| {
        2.0 / count * series.iter().enumerate().map(|(slot, x)| x * of(turn(slot))).sum::<f64>()
    };
    let (sine, cosine, mean) =
        (along(f64::sin), along(f64::cos), series.iter().sum::<f64>() / count);
    let left = rms(series
        .iter()
        .enumerate()
        .map(|(slot, x)| x - mean - sine * turn(slot).sin() - cosine * turn(slot).cos()));
    20.0 * (sine.hypot(cosine) / 2f64.sqrt() / left).log10()
}

fn effective_bits(sinad_db: f64) -> f64 {
    (sinad_db - 1.76) / 6.02
}

/// A sine of amplitudes.
pub fn integral_nonlinearity() -> Outcome {
    let mut outcome = Outcome::of("departure of the capacitance, over 10 to 90 % of its range");
    for bench in Bench::all() {
        let (input, output) = amplitudes(&bench);
        let name = &bench.profile.name;
        let range = 0.8 * bench.ideal(&bench.pad(1.0)).capacitance_pf;
        let steps =
            from_straight_line(&input, &output) * range / bench.profile.formats.capacitance.lsb();
        outcome = outcome.at_most(format!("`{name}`"), steps, 3.0, "LSB").at_most(
            format!("`{name}`, by histogram"),
            100.0 * by_histogram(&output),
            0.1,
            "%",
        );
    }
    outcome.rivals("4,096 slots resolve 0.04 % by histogram")
}

/// A sine of capacitances as they should be and as the core has them, both from 0 to 1 of their range.
///
/// ```text
/// I = C·V / √(g² + C²R²)      docs/physics.md §2, solved for the total current; g the gain, R the sheet's resistance
/// ```
fn amplitudes(bench: &Bench) -> (Vec<f64>, Vec<f64>) {
    const SLOTS: usize = 4_096;
    let mut fixed = bench.fixed();
    let loudest = bench.pad(1.0);
    let (largest, gain) = (bench.ideal(&loudest), bench.calibration.capacitance_gain);
    let (low, high) = (0.1 * largest.capacitance_pf, 0.9 * largest.capacitance_pf);
    let total: f64 = loudest.currents.iter().sum();
    (0..SLOTS)
        .map(|slot| {
            let x = 0.5 + 0.5 * (TAU * (slot as f64 + 0.5) / SLOTS as f64).sin();
            let c = low + (high - low) * x;
            let current = c * loudest.sense / gain.hypot(c * largest.sheet);
            // Tones that no ADC rounds: its own steps are in other cases.
            let tones = bench.phasors(&bench.pad(current / total));
            let found = fixed.phasors(0, &tones, 0.01).measurement(&bench.profile).capacitance_pf;
            (x, (found - low) / (high - low))
        })
        .unzip()
}

/// Largest departure from the line of least squares, of the range.
fn from_straight_line(input: &[f64], output: &[f64]) -> f64 {
    let count = input.len() as f64;
    let mean = |of: &[f64]| of.iter().sum::<f64>() / count;
    let (x0, y0) = (mean(input), mean(output));
    let (xy, xx) = input
        .iter()
        .zip(output)
        .fold((0.0, 0.0), |(xy, xx), (x, y)| (xy + (x - x0) * (y - y0), xx + (x - x0) * (x - x0)));
    let slope = xy / xx;
    input.iter().zip(output).map(|(x, y)| (y - y0 - slope * (x - x0)).abs()).fold(0.0, f64::max)
}

/// Largest departure of the levels between 32 bins from where a sine's density has them, of the range.
fn by_histogram(output: &[f64]) -> f64 {
    const BINS: usize = 32;
    let count = output.len() as f64;
    let level = |bin: usize| bin as f64 / BINS as f64;
    let departure = |bin: usize| {
        let below = output.iter().filter(|&&y| y < level(bin)).count() as f64 / count;
        ((1.0 - (PI * below).cos()) / 2.0 - level(bin)).abs()
    };
    (1..BINS).map(departure).fold(0.0, f64::max)
}
