// SPDX-License-Identifier: MIT OR Apache-2.0
//! The carrier and the window, sample by sample.
//!
//! ```text
//! wave(k) = [A sin 2π k/N],   cosine = wave(n·M + N/4),   sine = wave(n·M)              ([·]: to the nearest word)
//! window = ⌊T(m+1)/2⌋ − ⌊T(m)/2⌋,   T(m) = Σ_{k<m} (A − wave(k + N/4))   in words;   or A
//! local oscillator = {C(m+1)} − {C(m)},   C(m) = Σ_{k<m} window·cosine; the sine likewise     ({·}: ⌊· + ½⌋ of a word)
//! ```
//!
//! Polyphase: window = [A sin² π m/N], the cosine that of five samples per period, no sine.

use super::{Exact, round_real};
use hapticore_contract::format::Format;
use hapticore_contract::profile::{Method, Profile, Window};
use std::f64::consts::{PI, TAU};

/// A sample of the carrier.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// Cosine of the carrier, fraction of its amplitude.
    pub cosine: Exact,
    /// Sine of the carrier, fraction of its amplitude.
    pub sine: Exact,
    /// Window value, from 0 to 1.
    pub window: Exact,
}

/// The carrier and the window of a profile.
#[derive(Debug, Clone)]
pub struct Oscillator {
    format: Format,
    /// N, the samples of a window.
    samples: u64,
    /// M, the periods in a window.
    periods: u64,
    /// A, the number that stands for one.
    amplitude: f64,
    polyphase: bool,
    window: Window,
    /// T(m) for m up to N, in words.
    cosine_sums: Vec<i128>,
}

impl Oscillator {
    /// That of a profile.
    pub fn new(profile: &Profile) -> Self {
        let format = profile.formats.oscillator;
        let mut oscillator = Oscillator {
            format,
            samples: profile.slot.integrate,
            periods: profile.carrier.periods,
            amplitude: profile.carrier.amplitude as f64 * 2f64.powi(-i32::from(format.frac)),
            polyphase: profile.carrier.method == Method::Polyphase,
            window: profile.carrier.window,
            cosine_sums: vec![0],
        };
        let one = i128::from(profile.carrier.amplitude);
        for m in 0..oscillator.samples {
            let cosine = oscillator.wave(m + oscillator.samples / 4).code(format);
            oscillator
                .cosine_sums
                .push(oscillator.cosine_sums[m as usize] + one - i128::from(cosine));
        }
        oscillator
    }

    /// The sine of a phase, in parts of a turn as many as there are samples in a window.
    pub fn wave(&self, phase: u64) -> Exact {
        let phase = phase % self.samples;
        let turns = phase as f64 / self.samples as f64;
        // Of the quadrants, the first: an f64 of another one's sine differs in its last bits.
        let folded = (turns * 2.0).fract() / 2.0;
        let folded = folded.min(0.5 - folded);
        let sign = if turns < 0.5 { 1.0 } else { -1.0 };
        // At a twelfth of a turn it is one half, and the product may be a tie.
        let twelfths = [1, 5, 7, 11].map(|k| k * self.samples);
        let sine = if twelfths.contains(&(12 * phase)) { 0.5 } else { (TAU * folded).sin() };
        round_real(sign * self.amplitude * sine, self.format)
    }

    /// Sample `n` of a slot, which is sample `m` of its window.
    pub fn sample(&self, n: u64, m: u64) -> Sample {
        if self.polyphase {
            let cosine = round_real((TAU * (n % 5) as f64 / 5.0).cos(), self.format);
            return Sample { cosine, sine: Exact::ZERO, window: self.window_at(m) };
        }
        let phase = n % self.samples * self.periods;
        Sample {
            cosine: self.wave(phase + self.samples / 4),
            sine: self.wave(phase),
            window: self.window_at(m),
        }
    }

    /// sin² π m/N; in sixths and quarters of a turn exactly.
    fn hann(&self, m: u64) -> f64 {
        match m.min(self.samples - m) {
            m if 6 * m == self.samples => 0.25,
            m if 4 * m == self.samples => 0.5,
            m if 3 * m == self.samples => 0.75,
            m => (PI * m as f64 / self.samples as f64).sin().powi(2),
        }
    }

    fn window_at(&self, m: u64) -> Exact {
        let total = |m: u64| {
            let whole = i128::from(m / self.samples) * self.cosine_sums[self.samples as usize];
            whole + self.cosine_sums[(m % self.samples) as usize]
        };
        match self.window {
            Window::Hann if self.polyphase => {
                round_real(self.amplitude * self.hann(m % self.samples), self.format)
            }
            Window::Hann => {
                let code = total(m + 1).div_euclid(2) - total(m).div_euclid(2);
                Exact::new(code, -i32::from(self.format.frac))
            }
            Window::Rectangular => round_real(self.amplitude, self.format),
        }
    }
}

/// The local oscillator over the samples of a window: w cos φ and w sin φ, what rounding leaves
/// over carried on.
pub fn windowed_lo(profile: &Profile, samples: &[Sample]) -> Vec<[Exact; 2]> {
    let frac = profile.formats.oscillator.frac;
    let half = Exact::new(1, -1);
    let word = |sum: Exact| Exact::new((sum.scaled(frac) + half).floor(), -i32::from(frac));
    let (mut sums, mut words) = ([Exact::ZERO; 2], Vec::new());
    for sample in samples {
        let products = [sample.window * sample.cosine, sample.window * sample.sine];
        words.push([0, 1].map(|part| {
            let before = sums[part];
            sums[part] = before + products[part];
            word(sums[part]) - word(before)
        }));
    }
    words
}
