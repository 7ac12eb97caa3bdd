// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sums of a window.
//!
//! ```text
//! i_k = Σ x_k · lo_i,   q_k = Σ x_k · lo_q,   m = Σ h · [w h]        ([·]: to the ADC's format)
//! ```

use super::{Exact, Sample, round, weighted};
use crate::profile::Profile;

/// The sums of a window.
#[derive(Debug, Clone)]
pub struct Sums {
    /// In phase and quadrature of the terminals and the sensing voltage.
    pub phases: Vec<[Exact; 2]>,
    /// Of the haptic voltage's squares.
    pub square: Exact,
    /// Whether a code was at a rail.
    pub clipped: bool,
}

/// The sums over `codes`, a sample after the other, against the carrier at those samples.
pub fn demodulate(profile: &Profile, carrier: &[Sample], codes: &[i32]) -> Sums {
    let adc = profile.formats.adc;
    let channels = profile.terminals.x.len() + 2;
    let mut sums = Sums { phases: vec![[Exact::ZERO; 2]; channels - 1], square: Exact::ZERO, clipped: false };
    let local = weighted(profile, carrier);
    for ((codes, sample), [cosine, sine]) in codes.chunks_exact(channels).zip(carrier).zip(local) {
        let x = |k: usize| Exact::of(codes[k].into(), adc);
        for (k, [i, q]) in sums.phases.iter_mut().enumerate() {
            *i = *i + x(k) * cosine;
            *q = *q + x(k) * sine;
        }
        let h = x(channels - 1);
        sums.square = sums.square + h * round(sample.window * h, adc).value;
        let rail = 1i64 << (adc.width - 1);
        sums.clipped |= codes.iter().any(|&code| i64::from(code) == -rail || i64::from(code) == rail - 1);
    }
    sums
}
