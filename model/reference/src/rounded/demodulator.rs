// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sums of a window.
//!
//! ```text
//! i_k = Σ x_k · lo_i,   q_k = Σ x_k · lo_q,   m = Σ h · [w h]        ([·]: to the ADC's format)
//! S_p = Σ w·(x + 1) over the samples m ≡ p modulo 5,   L_p = ⌊S_p·2^31 / 2^d⌋,   c_p = 57230 cos 2πp/5 to the nearest integer
//! i_k = ⌊(Σ c_p·L_p + Σ of the c_p below zero) / 2^16⌋ / 2^31,   q_k likewise with sines                     (polyphase)
//! ```
//!
//! d leaves 32 bits of the largest sum that the window lets be.

use super::{Exact, Sample, round, round_real, windowed_lo};
use hapticore_contract::format::Format;
use hapticore_contract::profile::{Method, Profile, Window};
use std::f64::consts::TAU;

/// The sums of a window.
#[derive(Debug, Clone)]
pub struct Sums {
    /// In phase and quadrature of the terminals and the sensing voltage.
    pub phases: Vec<[Exact; 2]>,
    /// Of the haptic voltage's squares.
    pub square: Exact,
    /// Whether a code was at full scale.
    pub clipped: bool,
}

/// Phases of a polyphase carrier.
const PHASES: usize = 5;

/// In phase and quadrature from the sums of the phases.
fn combined(profile: &Profile, sums: [Exact; PHASES]) -> [Exact; 2] {
    let mean = match profile.carrier.window {
        Window::Hann => 0.5,
        Window::Rectangular => 1.0,
    };
    let largest = 2.0 * mean * profile.slot.integrate as f64 / PHASES as f64;
    let dropped =
        (0..).find(|&bits| largest <= 2f64.powi(bits + 1)).expect("a window is finite") as i8;
    let integer = Format { signed: true, width: 30, frac: 0 };
    [f64::cos, f64::sin].map(|wave| {
        let factor = |p: usize| round_real(57230.0 * wave(TAU * p as f64 / PHASES as f64), integer);
        let sum = (0..PHASES).fold(Exact::ZERO, |sum, p| {
            let below = if factor(p) < Exact::ZERO { factor(p) } else { Exact::ZERO };
            sum + factor(p) * Exact::new(sums[p].scaled(31 - dropped).floor(), 0) + below
        });
        Exact::new(sum.scaled(-16).floor(), -31)
    })
}

/// The sums over `codes`, a sample after the other, by phases of the carrier.
fn demodulate_by_phase(profile: &Profile, carrier: &[Sample], codes: &[i32]) -> Sums {
    let (adc, channels) = (profile.formats.adc, profile.terminals.x.len() + 2);
    let mut phases = vec![[Exact::ZERO; PHASES]; channels - 1];
    let (mut square, mut clipped) = (Exact::ZERO, false);
    for ((m, sample), codes) in carrier.iter().enumerate().zip(codes.chunks_exact(channels)) {
        let x = |k: usize| Exact::of(codes[k].into(), adc);
        for (k, sums) in phases.iter_mut().enumerate() {
            sums[m % PHASES] = sums[m % PHASES] + sample.window * (x(k) + Exact::new(1, 0));
        }
        let h = x(channels - 1).magnitude();
        square = square
            + h * round(sample.window * h, Format { signed: false, width: 16, frac: 16 }).value;
        clipped |= codes.iter().any(|&code| code == -32768 || code == 32767);
    }
    Sums {
        phases: phases.into_iter().map(|sums| combined(profile, sums)).collect(),
        square,
        clipped,
    }
}

/// The sums over `codes`, a sample after the other, against the carrier at those samples.
pub fn demodulate(profile: &Profile, carrier: &[Sample], codes: &[i32]) -> Sums {
    if profile.carrier.method == Method::Polyphase {
        return demodulate_by_phase(profile, carrier, codes);
    }
    let adc = profile.formats.adc;
    let channels = profile.terminals.x.len() + 2;
    let mut sums =
        Sums { phases: vec![[Exact::ZERO; 2]; channels - 1], square: Exact::ZERO, clipped: false };
    let local = windowed_lo(profile, carrier);
    for ((codes, sample), [cosine, sine]) in codes.chunks_exact(channels).zip(carrier).zip(local) {
        let x = |k: usize| Exact::of(codes[k].into(), adc);
        for (k, [i, q]) in sums.phases.iter_mut().enumerate() {
            *i = *i + x(k) * cosine;
            *q = *q + x(k) * sine;
        }
        let h = x(channels - 1);
        sums.square = sums.square + h * round(sample.window * h, adc).value;
        let full_scale = 1i64 << (adc.width - 1);
        sums.clipped |= codes
            .iter()
            .any(|&code| i64::from(code) == -full_scale || i64::from(code) == full_scale - 1);
    }
    sums
}
