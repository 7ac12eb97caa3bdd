// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a slot's results are expected to be off, and by which rounding: without running a slot more
//! than once.
//!
//! ```text
//! samples ─┬─[oscillator's words]─ sums as codes ──┐
//!          └─[cosine, sine]─ sums without rounding ─┴─ estimator ─ results, each with its errors by source
//! ```
//!
//! The sums' errors are what the oscillator's words do to these samples or tones, which is known, and
//! the ADC's rounding of each sample, whose variance is a twelfth of a step's square e². Of samples of the same
//! phase, and with the other sign of those half a turn later, it has the part ρ in common:
//!
//! ```text
//! var = e²/12 · ((1 − ρ)·Σ w_n² + ρ·Σ_phases (Σ w_n)²),   ρ = Σ_k 6/(πk)²·e^(−(2πkσ)²)
//! ```
//!
//! with the noise σ of a sample in steps, which the samples show (source: Widrow and Kollár, Quantization Noise, 2008:
//! the Fourier series of the rounding error). Where a channel meets few codes, the rounding of all
//! is what it is for these samples. From there on the estimator is run as [`Noise`], a block after the other, and the
//! position's program by its statements (`position/by_statement.rs`): as in every clock, in a twelfth of the time.

use super::fixed::{FixedSimulation, calibrated, quiet, run};
use super::tone::WindowedSample;
use super::{assert_pad, signals};
use crate::blocks::core::{self, Core};
use crate::blocks::estimator::{In, Inputs};
use hapticore_contract::calibration::Calibration;
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::State;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::noise::{Errors, Mark, Moments, Noise, Recording};
use hapticore_hdl::interpretations::real::Real;
use hapticore_hdl::interpretations::shadow::Shadow;
use hapticore_hdl::signal::{Signal, bit, code, constant};
use std::f64::consts::{PI, TAU};

/// What is in a slot's window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Signals<'a> {
    /// Samples before any ADC, of full scale: a sample after the other, each of all channels.
    Samples(&'a [f64]),
    /// Tones.
    Tones {
        /// Of the terminals and of the sensing voltage: in phase and a quarter turn ahead of the
        /// carrier, full scale.
        amplitudes: &'a [(f64, f64)],
        /// Of the haptic voltage, full scale².
        mean_square: f64,
    },
}

/// A result of the core: its number without rounding, in the unit of its frame's field, and its
/// error.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Expected {
    /// Without rounding.
    pub real: f64,
    /// What the core's is off.
    pub errors: Errors,
}

/// The results of a slot.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Prediction {
    /// Position along the long edges, mm.
    pub x: Expected,
    /// Position along the short edges, mm.
    pub y: Expected,
    /// Capacitance, pF.
    pub capacitance: Expected,
    /// Haptic force, N.
    pub force: Expected,
    /// Mean square of the haptic voltage, full scale².
    pub mean_square: Expected,
    /// The least amplitude of a terminal or of the sensing voltage, in steps of the ADC: see
    /// [`Predictor::FEW_CODES`].
    pub least_codes: f64,
    /// A word is saturated or no place has these ratios: errors are then not those of rounding.
    pub is_flagged: bool,
}

/// The bound of a sum over a window's samples, whose roundings do not all go the same way, in standard
/// deviations: once in 5·10^8 slots it is exceeded.
const SIGMAS: f64 = 6.0;

/// Predicts the errors of a core: one on a thread at a time, for it records what it computes.
pub struct Predictor {
    core: Core,
    recording: Recording,
    /// The estimator before a slot, and when that was.
    state: State<Core, Noise>,
    begun: Mark,
    quiet: In<Noise>,
    pads: usize,
    of_codes: FixedSimulation<i64>,
    of_reals: FixedSimulation<Real>,
    /// The local oscillator over the window, by its words and without rounding.
    waves: [Vec<WindowedSample>; 2],
    /// Variance of the sums that one of each sample gives, in phase and quadrature: each for itself, and one for each phase.
    tone: [[f64; 2]; 2],
    /// Σw² and Σw: of the haptic voltage's squares.
    window: f64,
    window_sum: f64,
    samples: f64,
    adc: Format,
    /// Samples after which a tone of the carrier is the same again, or the same with the other sign.
    repeat: (usize, f64),
}

impl Predictor {
    /// Below this number of steps of the ADC an amplitude meets too few codes for its rounding to be random, where no
    /// noise is added to it. Errors of tones are then up to three times those predicted; those of samples are those of
    /// these very samples, and only many slots say what others have.
    pub const FEW_CODES: f64 = 128.0;

    /// A predictor of a profile's core, calibrated.
    ///
    /// # Errors
    /// A core that cannot be.
    pub fn new(profile: &Profile, calibration: &Calibration) -> Result<Self, ProfileError> {
        let mut core = Core::try_new(profile)?;
        core.place_by_statements();
        Ok(Self::of_core(core, profile, calibration))
    }

    fn of_core(core: Core, profile: &Profile, calibration: &Calibration) -> Self {
        let of_codes = FixedSimulation::<i64>::new(profile, calibration);
        let of_reals = FixedSimulation::<Real>::new(profile, calibration);
        let recording = Recording::begin();
        let constants =
            signals::<core::Inputs, Noise>(core.idle_inputs(calibration), core.inputs());
        let mut quiet = quiet(&core, constants);
        // As numbers, so that what their words are off counts.
        let gains = &mut quiet.calibration;
        gains.capacitance_gain =
            constant(calibration.capacitance_gain, gains.capacitance_gain.format);
        gains.force_gain = constant(calibration.force_gain, gains.force_gain.format);
        gains.contact_capacitance =
            constant(calibration.contact_capacitance, gains.contact_capacitance.format);
        let state = calibrated(&core, profile, calibration);
        let begun = recording.mark();
        let waves = [of_codes.windowed(), of_reals.windowed()];
        let power = |of: usize| waves[1].iter().map(|sample| sample[of] * sample[of]).sum::<f64>();
        let repeat = repeat(profile.slot.integrate as usize, profile.carrier.periods as usize);
        let tone = [0, 1].map(|of| [power(of), power_by_phase(&waves[1], of, repeat)]);
        Predictor {
            tone,
            window: power(2),
            window_sum: waves[1].iter().map(|sample| sample[2]).sum(),
            samples: waves[1].len() as f64,
            adc: profile.formats.adc,
            repeat,
            core,
            recording,
            state,
            begun,
            quiet,
            pads: profile.pads as usize,
            of_codes,
            of_reals,
            waves,
        }
    }

    /// What the core's results for a slot with these signals are off.
    ///
    /// # Panics
    /// Where there is no such pad, not an amplitude for each demodulated channel, or a sample for each
    /// channel and time.
    pub fn slot(&mut self, pad: usize, signals: Signals) -> Prediction {
        assert_pad(pad, self.pads);
        self.recording.rewind(self.begun);
        let (sums, least_codes) = self.sums(signals);
        let (pad, clipped) = (code(pad as i64, self.quiet.pad.format), bit(false));
        let quiet = Inputs { pad, clipped, ..self.quiet };
        let mut state = self.state.clone();
        let estimator = &mut state.submodules.estimator;
        let flags = run(self.core.estimator(), estimator, &quiet, &sums, &mut None).flags;
        let is_flagged = flags.saturated || flags.invalid;
        Prediction { least_codes, is_flagged, ..self.results(&state) }
    }

    /// The sums with their errors, of the oscillator's words and of the ADC; and the least amplitude in
    /// steps of the ADC.
    fn sums(&mut self, signals: Signals) -> (Vec<Signal<Noise>>, f64) {
        let format = self.core.demodulator().sum();
        let [mut codes, reals] = match signals {
            Signals::Samples(samples) => {
                self.waves.each_ref().map(|waves| sums_of_samples(waves, samples))
            }
            Signals::Tones { amplitudes, mean_square } => [
                self.of_codes.sums_of_tones(amplitudes, mean_square),
                self.of_reals.sums_of_tones(amplitudes, mean_square),
            ],
        };
        let last = reals.len() - 1;
        let amplitude = |pair: &[f64]| 2.0 * pair[0].hypot(pair[1]) / self.window_sum;
        let least = reals[..last].chunks_exact(2).map(amplitude).fold(f64::INFINITY, f64::min);
        let least_codes = least / self.adc.lsb();
        let step = self.adc.lsb() * self.adc.lsb() / 12.0;
        let mut common = vec![0.0; last / 2];
        let mut is_known = false;
        if let Signals::Samples(samples) = signals {
            is_known = least_codes < Self::FEW_CODES;
            common = self.common(samples);
            if is_known {
                codes = sums_of_samples(&self.waves[0], &self.rounded(samples));
            }
        }
        let mean_square = reals[last] / self.window_sum;
        let sum = |(n, (rounded, real)): (usize, (f64, f64))| {
            let code = format.code_saturating(rounded);
            let [each, by_phase] = self.tone[n % 2];
            // The sum of squares is of (h + e)·w·h, with another step's rounding of w·h.
            let variance = match is_known {
                true if n == last => step * mean_square * self.samples,
                true => 0.0,
                false if n == last => step * mean_square * (4.0 * self.window + self.samples),
                false => step * (each + common[n / 2] * (by_phase - each)),
            };
            let adc = Moments { mean: 0.0, variance, bound: SIGMAS * variance.sqrt() };
            let known = Moments::known(rounded - real);
            self.recording.input("adc", Shadow { code, real }, format, known.plus(adc))
        };
        let sums = codes.into_iter().zip(reals).enumerate().map(sum).collect();
        (sums, least_codes)
    }

    /// Samples as the ADC rounds them.
    fn rounded(&self, samples: &[f64]) -> Vec<f64> {
        samples.iter().map(|sample| self.adc.real(self.adc.code_saturating(*sample))).collect()
    }

    /// ρ of each demodulated channel: which part of its rounding samples of the same phase have in common.
    fn common(&self, samples: &[f64]) -> Vec<f64> {
        let ((lag, sign), count) = (self.repeat, self.waves[0].len());
        let channels = samples.len() / count;
        let of = |channel: usize| {
            let sample = |n: usize| samples[n * channels + channel];
            let differences = (lag..count).map(|n| sample(n) - sign * sample(n - lag));
            // Half the square of a difference of two has the noise's variance.
            let variance = differences.map(|of| of * of).sum::<f64>() / (2 * (count - lag)) as f64;
            correlation(variance / (self.adc.lsb() * self.adc.lsb()))
        };
        (0..channels - 1).map(|channel| if lag < count { of(channel) } else { 0.0 }).collect()
    }

    fn results(&self, state: &State<Core, Noise>) -> Prediction {
        let within = &state.submodules.estimator.submodules;
        let of = |value: Noise| Expected {
            real: value.shadow.real,
            errors: self.recording.errors(value),
        };
        let by_eq8 = within.force_estimator.as_ref().map(|force| force.registers.haptic_force);
        let by_table = within.force_table.as_ref().map(|force| force.registers.haptic_force);
        Prediction {
            x: of(within.position.registers.x),
            y: of(within.position.registers.y),
            capacitance: of(within.capacitance.registers.capacitance),
            force: of(by_eq8.or(by_table).expect("one law or the other")),
            mean_square: of(within.haptic_voltage.registers.mean_square),
            ..Prediction::default()
        }
    }
}

/// Samples after which a carrier of `periods` periods in a window's samples has its phase again, or half a turn more:
/// then with the sign −1.
fn repeat(samples: usize, periods: usize) -> (usize, f64) {
    let (mut a, mut b) = (samples, periods);
    while b != 0 {
        (a, b) = (b, a % b);
    }
    let turn = samples / a;
    if turn.is_multiple_of(2) { (turn / 2, -1.0) } else { (turn, 1.0) }
}

/// The sum over the phases of the squares of what one for each sample of a phase gives.
fn power_by_phase(waves: &[WindowedSample], of: usize, (lag, sign): (usize, f64)) -> f64 {
    let mut phases = vec![0.0; lag];
    for (n, sample) in waves.iter().enumerate() {
        let turned = if (n / lag).is_multiple_of(2) { 1.0 } else { sign };
        phases[n % lag] += turned * sample[of];
    }
    phases.iter().map(|of| of * of).sum()
}

/// ρ of noise of this variance, in squares of a step.
fn correlation(variance: f64) -> f64 {
    let term = |k: f64| 6.0 / (PI * k).powi(2) * (-(TAU * k).powi(2) * variance).exp();
    // As many terms as leave less than a hundredth without noise.
    (1..=64).map(|k| term(f64::from(k))).sum()
}

/// The sums of a window: in phase and quadrature of each channel but the last, of which the squares
/// are summed up.
fn sums_of_samples(waves: &[WindowedSample], samples: &[f64]) -> Vec<f64> {
    let channels = samples.len() / waves.len();
    assert_eq!(samples.len(), channels * waves.len(), "a sample for each channel and time");
    let mut sums = vec![0.0; 2 * channels - 1];
    for (samples, [cosine, sine, window]) in samples.chunks_exact(channels).zip(waves) {
        for (pair, sample) in sums.chunks_exact_mut(2).zip(samples) {
            pair[0] += sample * cosine;
            pair[1] += sample * sine;
        }
        let haptic = samples[channels - 1];
        sums[2 * channels - 2] += window * haptic * haptic;
    }
    sums
}

#[cfg(test)]
mod tests;
