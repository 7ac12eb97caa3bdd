// SPDX-License-Identifier: MIT OR Apache-2.0
//! Slots of pads on a sheet: what a core makes of them beside the ideal estimator, which sees the same
//! samples unrounded, and what is predicted.

use super::random::Random;
use hapticore_contract::calibration::Calibration;
use hapticore_contract::frame::Measurement;
use hapticore_contract::profile::Profile;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::noise::Moments;
use hapticore_model::fidelity::fixed::FixedSimulation;
use hapticore_model::fidelity::noise::{Prediction, Predictor, Signals};
use hapticore_reference::Reference;
use std::f64::consts::TAU;
use xprec::Df64;

/// The measured quantities.
pub const QUANTITIES: [&str; 5] = ["x", "y", "C", "F", "m"];
/// Noise of the analog part, of full scale.
const NOISE: f64 = 18e-6;
/// Slots of each point for which errors are predicted, each at a phase of its own; where channels meet few codes, all
/// measured slots.
const PREDICTED: usize = 4;
/// A converter that rounds nothing away.
const FINE: Format = Format::signed(30, 29);

/// Places of a pad, its current and its haptic voltage.
pub struct Scene {
    points: Vec<Point>,
}

impl Scene {
    /// Slots that are measured.
    pub fn slots(&self) -> usize {
        25 * self.points.len()
    }
}

#[derive(Clone)]
struct Point {
    ratios: [f64; 2],
    /// Sum of all currents, the sensing and the haptic voltage: amplitudes.
    current: f64,
    sense: f64,
    haptic: f64,
}

impl Point {
    /// One nearby: results at one and the same point would all be rounded the same way.
    fn near(&self, random: &mut Random) -> Point {
        let mut by = |part: f64| 1.0 + random.between(-part, part);
        Point {
            ratios: self.ratios.map(|ratio| ratio * by(0.05)),
            current: self.current * by(0.05),
            sense: self.sense * by(0.05),
            haptic: self.haptic * by(0.05),
        }
    }
}

/// Full currents, small ones, and a sweep of the haptic voltage in one place.
pub fn scenes() -> [Scene; 3] {
    let mut random = Random::new(5);
    let mut place = |most: f64| [random.between(-most, most), random.between(-most, most)];
    let full = (0..8).map(|n| Point {
        ratios: place(0.3),
        current: 0.6,
        sense: 0.8,
        haptic: 0.2 + 0.08 * f64::from(n),
    });
    let full = full.collect();
    let small = (0..8).map(|n| Point {
        ratios: place(0.3),
        current: 0.05 + 0.02 * f64::from(n),
        sense: 0.7,
        haptic: 0.5,
    });
    let small = small.collect();
    let sweep = (0..8).map(|n| Point {
        ratios: [0.1, -0.2],
        current: 0.3,
        sense: 0.75,
        haptic: 0.1 + 0.1 * f64::from(n),
    });
    [full, small, sweep.collect()].map(|points| Scene { points })
}

/// Amplitudes and phases (turns) of every channel but the last.
fn tones(profile: &Profile, point: &Point, turn: f64) -> Vec<[f64; 2]> {
    let signs = [&profile.terminals.x, &profile.terminals.y];
    let count = profile.terminals.x.len() as f64;
    let slope = [0, 1].map(|axis| {
        let squares = signs[axis].iter().map(|sign| f64::from(sign * sign)).sum::<f64>();
        let counted = signs[0].iter().zip(signs[1]).filter(|(x, y)| **x != 0 || **y != 0).count();
        point.ratios[axis] * counted as f64 / squares
    });
    let terminal = |n: usize| {
        let lean = slope[0] * f64::from(signs[0][n]) + slope[1] * f64::from(signs[1][n]);
        [point.current / count * (1.0 + lean), turn + 0.25 + 0.003 * n as f64]
    };
    (0..profile.terminals.x.len()).map(terminal).chain([[point.sense, turn]]).collect()
}

/// What a core's results at these points are expected to be off, on average over the first slots of a seed; and the
/// least amplitude in steps of the ADC.
pub fn predicted(
    profile: &Profile,
    calibration: &Calibration,
    scene: &Scene,
    seed: u64,
) -> ([Moments; 5], f64) {
    let mut predictor = Predictor::new(profile, calibration).expect("a core");
    let (mut sums, mut least_codes) = ([[0.0; 3]; 5], f64::INFINITY);
    let mut count = 0;
    for samples in slots(profile, scene, seed) {
        if count >= PREDICTED * scene.points.len() && least_codes >= Predictor::FEW_CODES {
            break;
        }
        let Prediction { x, y, capacitance, force, mean_square, least_codes: codes, .. } =
            predictor.slot(0, Signals::Samples(&samples));
        least_codes = least_codes.min(codes);
        for (sum, of) in sums.iter_mut().zip([x, y, capacitance, force, mean_square]) {
            let total = of.errors.total;
            *sum = [sum[0] + total.mean, sum[1] + total.rms().powi(2), sum[2].max(total.bound)];
        }
        count += 1;
    }
    (sums.map(|sum| averaged(sum, count)), least_codes)
}

/// The samples of all slots, from a seed.
fn slots(profile: &Profile, scene: &Scene, seed: u64) -> impl Iterator<Item = Vec<f64>> {
    let mut random = Random::new(seed);
    (0..scene.slots()).map(move |slot| {
        let point = scene.points[slot % scene.points.len()].near(&mut random);
        samples(profile, &point, &mut random)
    })
}

/// Moments of errors one after the other.
fn averaged([mean, square, bound]: [f64; 3], count: usize) -> Moments {
    let mean = mean / count as f64;
    Moments { mean, variance: square / count as f64 - mean * mean, bound }
}

/// What a core's results are off the ideal estimator's, at these points in turn.
pub fn measured(
    profile: &Profile,
    calibration: &Calibration,
    scene: &Scene,
    seed: u64,
) -> [Moments; 5] {
    measured_against(profile, profile, calibration, scene, seed)
}

/// The same against the ideal estimator of another profile with the same slots.
pub fn measured_against(
    ideal: &Profile,
    profile: &Profile,
    calibration: &Calibration,
    scene: &Scene,
    seed: u64,
) -> [Moments; 5] {
    let mut core = FixedSimulation::<i64>::new(profile, calibration);
    let mut ideal = Reference::new(&finely_sampled(ideal), calibration);
    let mut sums = [[0.0; 3]; 5];
    for samples in slots(profile, scene, seed) {
        let core = core.slot(0, &codes(&samples, profile.formats.adc)).measurement(profile);
        let (core, ideal) = (values(&core), values(&ideal.slot(0, &codes(&samples, FINE))));
        for (sum, (core, ideal)) in sums.iter_mut().zip(core.into_iter().zip(ideal)) {
            let error = core - ideal;
            *sum = [sum[0] + error, sum[1] + error * error, sum[2].max(error.abs())];
        }
    }
    sums.map(|sum| averaged(sum, scene.slots()))
}

/// What each result of the floating-point reference is off in single and in double precision: root of the
/// mean square, against double-double.
pub fn reference_errors(
    profile: &Profile,
    calibration: &Calibration,
    scene: &Scene,
    seed: u64,
) -> [[f64; 5]; 2] {
    let fine = finely_sampled(profile);
    let mut single = Reference::<f32>::with_precision(&fine, calibration);
    let mut double = Reference::new(&fine, calibration);
    let mut exact = Reference::<Df64>::with_precision(&fine, calibration);
    let (mut squares, count) = ([[0.0; 5]; 2], scene.slots());
    for samples in slots(profile, scene, seed) {
        let codes = codes(&samples, FINE);
        let exact = values(&exact.slot(0, &codes));
        let single = values(&single.slot(0, &codes).map(f64::from)).map(Df64::from);
        let double = values(&double.slot(0, &codes)).map(Df64::from);
        for (squares, of) in squares.iter_mut().zip([single, double]) {
            for ((square, of), exact) in squares.iter_mut().zip(of).zip(exact) {
                *square += f64::from(of - exact).powi(2);
            }
        }
    }
    squares.map(|of| of.map(|square| (square / count as f64).sqrt()))
}

/// The profile with a converter that rounds nothing away.
fn finely_sampled(profile: &Profile) -> Profile {
    let mut fine = profile.clone();
    fine.formats.adc = FINE;
    fine
}

/// Samples as an ADC gives them.
fn codes(samples: &[f64], adc: Format) -> Vec<i32> {
    samples.iter().map(|sample| (sample / adc.lsb()).round_ties_even() as i32).collect()
}

fn values<T: Copy + std::fmt::Debug>(of: &Measurement<T>) -> [T; 5] {
    assert!(
        !of.flags.invalid && !of.flags.saturated && !of.flags.clipped && !of.flags.lifted,
        "{:?}",
        of.flags
    );
    [of.x_mm, of.y_mm, of.capacitance_pf, of.force_n, of.mean_square]
}

/// A window's samples, of full scale.
fn samples(profile: &Profile, point: &Point, random: &mut Random) -> Vec<f64> {
    let tones = tones(profile, point, random.unit());
    let haptic_phase = random.unit();
    let mut samples = Vec::new();
    for n in profile.slot.blanking()..profile.slot.samples() {
        let turns = n as f64 * profile.turns_per_sample();
        let tone = |&[amplitude, phase]: &[f64; 2]| amplitude * (TAU * (turns + phase)).cos();
        let haptic = point.haptic * (TAU * (0.00137 * n as f64 + haptic_phase)).cos();
        let clean = tones.iter().map(tone).chain([haptic]);
        samples.extend(clean.map(|sample| sample + NOISE * gaussian(random)));
    }
    samples
}

/// The amplitude of an undithered tone of `periods` periods in the window, from the first channel's sums, with a
/// carrier of nearly full scale as the measure.
pub fn amplitude_of_tone(profile: &Profile, amplitude: f64, turn: f64, periods: f64) -> f64 {
    const MEASURE: f64 = 0.9;
    let mut core = FixedSimulation::<i64>::new(profile, &super::device::calibration(profile));
    let (channels, count, lsb) =
        (profile.channels(), profile.slot.integrate, profile.formats.adc.lsb());
    let mut magnitude = |amplitude: f64, periods: f64| {
        let code = |n: u64| {
            let phase = TAU * (periods * n as f64 / count as f64 + turn);
            (amplitude * phase.cos() / lsb).round_ties_even() as i32
        };
        let mut codes = vec![0; channels * count as usize];
        for (n, codes) in (0..).zip(codes.chunks_exact_mut(channels)) {
            codes[0] = code(n);
        }
        let sums = core.sums(&codes);
        sums[0].hypot(sums[1])
    };
    MEASURE * magnitude(amplitude, periods) / magnitude(MEASURE, profile.carrier.periods as f64)
}

/// Of twelve uniform numbers.
fn gaussian(random: &mut Random) -> f64 {
    (0..12).map(|_| random.unit()).sum::<f64>() - 6.0
}

/// Ratios, of which some percentiles are asked for.
#[derive(Default)]
pub struct Scatter(Vec<f64>);

impl Scatter {
    pub fn add(&mut self, ratio: f64) {
        self.0.push(ratio);
        self.0.sort_by(f64::total_cmp);
    }

    /// The ratio that this part of all are below.
    pub fn at(&self, part: f64) -> f64 {
        self.0[((self.0.len() - 1) as f64 * part).round() as usize]
    }

    pub fn text(&self) -> String {
        let [least, low, median, high, most] =
            [0.0, 0.05, 0.5, 0.95, 1.0].map(|part| self.at(part));
        format!(
            "least {least:.3}, 5 % {low:.3}, median {median:.3}, 95 % {high:.3}, most {most:.3}"
        )
    }
}
