// SPDX-License-Identifier: MIT OR Apache-2.0
//! The carrier and the window, sample by sample.
//!
//! ```text
//! φ[n] = n · [1/P] mod 1,   ψ[m] = m · [1/N] mod 1        ([·]: to a 32-bit fraction of a turn)
//! wave(φ) = [A sin 2π (j + ½)/M],   j = ⌊φ M⌋,   M = 4 · 2^address,   A = 1 − lsb
//! cosine = wave(φ + ¼),   sine = wave(φ),   window = [(1 − wave(ψ + ¼)) / 2]  or one
//! ```

use super::{Exact, round, round_real};
use crate::format::Format;
use crate::profile::{Profile, Window};
use std::f64::consts::TAU;

/// A sample of the carrier.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// The cosine.
    pub cosine: Exact,
    /// The sine.
    pub sine: Exact,
    /// The window.
    pub window: Exact,
}

/// The carrier and the window of a profile.
#[derive(Debug, Clone)]
pub struct Oscillator {
    format: Format,
    /// M, the steps of a turn.
    steps: u64,
    /// [1/P] and [1/N], in 2^-32 turns.
    increments: [u64; 2],
    window: Window,
}

/// A turn, in units of a phase.
const TURN: u64 = 1 << 32;

impl Oscillator {
    /// That of a profile.
    pub fn new(profile: &Profile) -> Self {
        let fraction = |of: u64| (TURN as f64 / of as f64).round() as u64;
        Oscillator {
            format: profile.formats.oscillator,
            steps: 4 << profile.carrier.quarter_address,
            increments: [profile.carrier.samples_per_period, profile.slot.integrate].map(fraction),
            window: profile.carrier.window,
        }
    }

    /// The sine of a phase, in 2^-32 turns, at the middle of the step in which it lies.
    pub fn wave(&self, phase: u64) -> Exact {
        let step = (phase % TURN) / (TURN / self.steps);
        let amplitude = 1.0 - 2f64.powi(-i32::from(self.format.frac));
        round_real(amplitude * (TAU * (step as f64 + 0.5) / self.steps as f64).sin(), self.format)
    }

    /// Sample `n` of a slot, which is sample `m` of its window.
    pub fn sample(&self, n: u64, m: u64) -> Sample {
        let [carrier, window] = [n * self.increments[0], m * self.increments[1]];
        Sample {
            cosine: self.wave(carrier + TURN / 4),
            sine: self.wave(carrier),
            window: self.weight(self.wave(window + TURN / 4)),
        }
    }

    fn weight(&self, cosine: Exact) -> Exact {
        let one = Exact::new(1, 0);
        match self.window {
            Window::Hann => round((one - cosine).scaled(-1), self.format).value,
            Window::Rectangular => round(one, self.format).value,
        }
    }
}

/// The local oscillator: [w cos φ] and [w sin φ].
pub fn weighted(profile: &Profile, sample: &Sample) -> [Exact; 2] {
    [sample.cosine, sample.sine].map(|wave| round(sample.window * wave, profile.formats.oscillator).value)
}
