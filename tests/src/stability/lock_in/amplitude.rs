// SPDX-License-Identifier: MIT OR Apache-2.0
//! A pad's currents from full scale to one step of the ADC.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use fastrand::Rng;
use hapticore_contract::frame::Measurement;
use hapticore_model::fidelity::fixed::FixedSimulation;

use crate::stability::Outcome;
use crate::stability::bench::{Bench, PROFILES, Pad, percent, rms};
use crate::stability::case::Number;
use crate::stability::rivals::measure_with_idsp;

/// Slots at each amplitude.
const SLOTS: usize = 16;

/// Error over that of floating point and the words: an rms of so few slots is off by a quarter by chance.
const LIMIT: f64 = 1.5;

/// Amplitudes of the page's text, as powers of two: 4096, 64, 8 and 1 steps; the first is full scale.
const TOLD: [usize; 4] = [12, 6, 3, 0];

/// Errors of a profile over the amplitude.
#[derive(Debug, Clone)]
pub struct Sweep {
    /// The profile.
    pub name: &'static str,
    /// In octaves from one step of its ADC to full scale.
    pub points: Vec<Point>,
}

/// Errors of the capacitance at an amplitude, percent rms over the slots.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    /// Amplitude of the largest current, steps of the ADC.
    pub steps: f64,
    /// Of the core.
    pub core: f64,
    /// Of floating point on the same codes.
    pub float: f64,
    /// Of idsp's lock-in on the same codes.
    pub idsp: f64,
}

static DITHERED: LazyLock<Vec<Sweep>> =
    LazyLock::new(|| PROFILES.map(|name| sweep(name, 0.5)).into());
static PLAIN: LazyLock<Vec<Sweep>> = LazyLock::new(|| PROFILES.map(|name| sweep(name, 0.0)).into());

/// All profiles, with noise of half a step rms, or without.
pub fn sweeps(dither: bool) -> &'static [Sweep] {
    if dither { &DITHERED } else { &PLAIN }
}

fn sweep(name: &'static str, noise_steps: f64) -> Sweep {
    let bench = Bench::of(name);
    let mut core = bench.fixed();
    let octaves =
        (0..bench.profile.formats.adc.width).map(|octave| 0.98 * 2f64.powi(octave.into()));
    Sweep {
        name,
        points: octaves.map(|steps| point(&bench, &mut core, steps, noise_steps)).collect(),
    }
}

fn point(bench: &Bench, core: &mut FixedSimulation, steps: f64, noise_steps: f64) -> Point {
    let lsb = bench.profile.formats.adc.lsb();
    let mut rng = Rng::with_seed(1);
    // The largest code is a step below full scale.
    let steps = steps.min(1.0 / lsb - 1.0 - 6.0 * noise_steps);
    let mut errors = [const { Vec::new() }; 3];
    for slot in 0..SLOTS {
        // Amplitudes within a fifth, so that no point of the curve has the luck of one rounding.
        let part = slot as f64 / SLOTS as f64;
        let pad = Pad { phase: part, ..bench.pad((1.0 - 0.2 * part) * steps * lsb) };
        let codes = bench.window(|n, channel| {
            let dither = if noise_steps > 0.0 { noise_steps * gaussian(&mut rng) } else { 0.0 };
            bench.signal(&pad, n, channel) + dither * lsb
        });
        let ideal = bench.ideal(&pad).capacitance_pf;
        let error = |of: Measurement| percent(of.capacitance_pf, ideal);
        errors[0].push(error(core.slot(0, &codes).measurement(&bench.profile)));
        errors[1].push(error(bench.measure_in_float(&codes)));
        errors[2].push(error(measure_with_idsp(bench, &codes)));
    }
    let [core, float, idsp] = errors.map(rms);
    Point { steps, core, float, idsp }
}

/// A number of a normal distribution (Box and Muller).
pub fn gaussian(rng: &mut Rng) -> f64 {
    let (u, v) = (1.0 - rng.f64(), rng.f64());
    (-2.0 * u.ln()).sqrt() * (TAU * v).cos()
}

/// Amplitudes with dither.
pub fn with_dither() -> Outcome {
    outcome(sweeps(true))
}

/// Amplitudes without dither.
pub fn without_dither() -> Outcome {
    outcome(sweeps(false))
}

/// The core's error over that of floating point and of its own words.
fn outcome(sweeps: &[Sweep]) -> Outcome {
    let standard = &sweeps[1];
    let mut outcome = Outcome::of(format!("`standard`: {}", told(standard, |point| point.core)));
    for sweep in sweeps {
        let bench = Bench::of(sweep.name);
        let full_scale = sweep.points.last().expect("amplitudes").core;
        let times = |point: &Point| {
            let words = words(&bench, point.steps).hypot(full_scale);
            point.core / point.float.hypot(words)
        };
        let worst = sweep.points.iter().skip(3).map(times).fold(0.0, f64::max);
        let name = format!("`{}` from 8 LSB on, times floating point and words", sweep.name);
        outcome = outcome.at_most(name, worst, LIMIT, "");
    }
    let (float, idsp) = (told(standard, |point| point.float), told(standard, |point| point.idsp));
    outcome.rivals(format!("floating point {float}; idsp {idsp}"))
}

/// What the rounding of words leaves at an amplitude, at most, percent: of capacitance, admittance and
/// the terminals' I and Q. As a resting pad meets the same roundings in every slot, they do not average.
fn words(bench: &Bench, steps: f64) -> f64 {
    let formats = &bench.profile.formats;
    let pad = bench.pad(steps * formats.adc.lsb());
    let half = |lsb: f64, full: f64| 100.0 * lsb / full / 2.0;
    let iq = formats.iq.lsb() * (bench.terminals() as f64).sqrt() / bench.profile.tone_gain();
    let pf = bench.ideal(&pad).capacitance_pf;
    half(formats.capacitance.lsb(), pf)
        + half(formats.admittance.lsb() * bench.calibration.capacitance_gain, pf)
        + half(iq, pad.currents.iter().sum())
}

fn told(sweep: &Sweep, of: fn(&Point) -> f64) -> String {
    let full = sweep.points.len() - 1;
    let numbers: Vec<_> = [full]
        .iter()
        .chain(&TOLD)
        .map(|&octave| Number(of(&sweep.points[octave])).to_string())
        .collect();
    format!("{} % at full scale, 4096, 64, 8, 1 LSB", numbers.join(" / "))
}
