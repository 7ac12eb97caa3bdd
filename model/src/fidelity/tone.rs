// SPDX-License-Identifier: MIT OR Apache-2.0
//! A window's sums from amplitudes: what a demodulator would sum up of tones that no ADC has
//! rounded.
//!
//! ```text
//! x[n] = p·cos φ[n] − q·sin φ[n]  ⇒  i = p·Σ cos φ·(w·cos) − q·Σ sin φ·(w·cos),   q likewise with (w·sin);   m = h̄²·Σ w
//! ```
//!
//! The sums are linear in p and q, so that four numbers of the local oscillator, found once, stand
//! for the window's samples. Quantisation is absent here, and so is whatever a window passes of the
//! haptic voltage.

use std::f64::consts::TAU;

/// A sample of the window: the oscillator's windowed cosine and sine, and the window.
pub(super) type WindowedSample = [f64; 3];

/// What a window makes of signals of unit amplitude.
#[derive(Debug, Clone)]
pub(super) struct Response {
    /// Both sums of a unit cosine, then of a unit negative sine.
    tones: [[f64; 2]; 2],
    /// The sum of squares of a unit constant.
    square: f64,
    /// The largest amplitude that the ADC takes.
    full_scale: f64,
}

impl Response {
    /// The response of a window that begins `blanking` samples after the carrier.
    pub fn new(
        window: impl Iterator<Item = WindowedSample>,
        blanking: u64,
        turns_per_sample: f64,
        full_scale: f64,
    ) -> Self {
        let mut response = Response { tones: [[0.0; 2]; 2], square: 0.0, full_scale };
        for (sample, [cosine, sine, window]) in (blanking..).zip(window) {
            let phase = TAU * (sample as f64 * turns_per_sample).fract();
            for (tone, wave) in response.tones.iter_mut().zip([phase.cos(), -phase.sin()]) {
                *tone = [tone[0] + wave * cosine, tone[1] + wave * sine];
            }
            response.square += window;
        }
        response
    }

    /// The sums of a window: in phase and quadrature of each tone, then of the squares; and whether
    /// any is saturated.
    pub fn sums(&self, amplitudes: &[(f64, f64)], mean_square: f64) -> (Vec<f64>, bool) {
        let (square, mut held) = self.square(mean_square);
        let mut sums = Vec::with_capacity(2 * amplitudes.len() + 1);
        for &amplitude in amplitudes {
            let (of_tone, of_tone_held) = self.tone(amplitude);
            sums.extend(of_tone);
            held |= of_tone_held;
        }
        sums.push(square);
        (sums, held)
    }

    /// The in-phase and quadrature sums of a tone, saturated, and whether it was.
    fn tone(&self, (p, q): (f64, f64)) -> ([f64; 2], bool) {
        let amplitude = p.hypot(q);
        let held = (self.full_scale / amplitude).min(1.0);
        let [of_p, of_q] = self.tones;
        (
            [0, 1].map(|phase| held * (p * of_p[phase] + q * of_q[phase])),
            amplitude >= self.full_scale,
        )
    }

    /// The sum of squares of a sine of this mean square, saturated, and whether it was.
    fn square(&self, mean_square: f64) -> (f64, bool) {
        let most = 0.5 * self.full_scale * self.full_scale;
        (mean_square.min(most) * self.square, mean_square >= most)
    }
}
