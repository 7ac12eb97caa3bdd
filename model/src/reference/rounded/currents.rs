// SPDX-License-Identifier: MIT OR Apache-2.0
//! Amplitudes, and the sums of eqs. 2 and 3.
//!
//! ```text
//! i_k = [sum / 2^s],   i = [..[[i_1 + i_2] + i_3]..] over the terminals,   q likewise      ([·]: held at the rails, too)
//! a_k = [√(i_k² + q_k²)],   a = [√(i² + q²)]
//! x = Σ ±a_k,   y = Σ ±a_k,   corners = Σ a_k of those in x or y,   lost where 2^shift · min a_k < a
//! ```

use super::{Exact, round, round_root};
use crate::profile::{Method, Profile, Window};

/// Amplitudes and sums.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Currents {
    /// a, of the sum over all terminals.
    pub total: Exact,
    /// Of the sensing voltage.
    pub sense: Exact,
    /// The numerator of r_x.
    pub x: Exact,
    /// The numerator of r_y.
    pub y: Exact,
    /// Their denominator.
    pub corners: Exact,
    /// Whether a terminal's current is missing.
    pub lost: bool,
    /// Whether a word is held at a rail.
    pub saturated: bool,
}

/// The least power of two that is no less.
pub(super) fn power_above(scale: f64) -> i8 {
    (0..).find(|&power| 2f64.powi(power) >= scale).expect("a window is finite") as i8
}

/// Σw · share: of the window's weights, what a sum grows by.
pub(super) fn growth(profile: &Profile, share: f64) -> f64 {
    let mean = match profile.carrier.window {
        Window::Hann => 0.5,
        Window::Rectangular => 1.0,
    };
    profile.slot.integrate as f64 * mean * share
}

/// The currents from a window's sums: in phase and quadrature of the terminals and the sensing voltage.
pub fn currents(profile: &Profile, sums: &[[Exact; 2]]) -> Currents {
    let f = &profile.formats;
    let mut saturated = false;
    let mut held = |x: Exact, to| {
        let rounded = round(x, to);
        saturated |= rounded.held;
        rounded.value
    };
    let smaller = match profile.carrier.method {
        Method::Products => 0,
        Method::Polyphase => (power_above(growth(profile, 0.4)) - 1).max(0),
    };
    let shift = power_above(growth(profile, 0.5)) - smaller;
    let words: Vec<[Exact; 2]> = sums.iter().map(|sum| sum.map(|part| held(part.scaled(-shift), f.iq))).collect();
    let (terminals, sense) = words.split_at(profile.terminals.x.len());
    let mut add = |sum: Exact, word: Exact| held(sum + word, f.total);
    let total = terminals.iter().fold([Exact::ZERO; 2], |[i, q], word| [add(i, word[0]), add(q, word[1])]);
    let amplitude = |[i, q]: [Exact; 2]| round_root(i * i + q * q, f.total.frac);
    let amplitudes: Vec<Exact> = terminals.iter().map(|&word| amplitude(word)).collect();
    let total = amplitude(total);
    let sum = |signs: &[i8]| {
        let signed = |(&a, &sign): (&Exact, &i8)| a * Exact::new(sign.into(), 0);
        amplitudes.iter().zip(signs).map(signed).fold(Exact::ZERO, |sum, term| sum + term)
    };
    let (x, y) = (&profile.terminals.x, &profile.terminals.y);
    let among: Vec<i8> = x.iter().zip(y).map(|(&x, &y)| i8::from(x != 0 || y != 0)).collect();
    let missing = |a: &Exact| a.scaled(profile.terminals.lost_shift) < total;
    Currents {
        total,
        sense: amplitude(sense[0]),
        x: sum(x),
        y: sum(y),
        corners: sum(&among),
        lost: amplitudes.iter().any(missing),
        saturated,
    }
}
