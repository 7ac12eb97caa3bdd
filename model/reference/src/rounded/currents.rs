// SPDX-License-Identifier: MIT OR Apache-2.0
//! Amplitudes, and the sums of eqs. 2 and 3.
//!
//! ```text
//! i_k = [sum / 2^s],   i = [..[[i_1 + i_2] + i_3]..] over the terminals,   q likewise      ([·]: saturated, too)
//! a_k = [√(i_k² + q_k²)],   a = [√(i² + q²)]
//! x = Σ ±a_k,   y = Σ ±a_k,   corners = Σ a_k of those in x or y,   least = min a_k
//! ```

use super::{Exact, round, round_sqrt};
use hapticore_contract::format::Format;
use hapticore_contract::profile::{Method, Profile, Window};

/// Amplitudes and sums.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Currents {
    /// a, of the sum over all terminals.
    pub total: Exact,
    /// Of the sensing voltage.
    pub sense: Exact,
    /// Numerator of r_x: the terminals' amplitudes with their signs.
    pub x: Exact,
    /// Numerator of r_y: the terminals' amplitudes with their signs.
    pub y: Exact,
    /// Denominator of both ratios.
    pub corners: Exact,
    /// The least of the terminals' amplitudes.
    pub least: Exact,
    /// The result is saturated.
    pub saturated: bool,
}

/// The least power of two that is no less.
pub(super) fn power_above(scale: f64) -> i8 {
    (0..).find(|&power| 2f64.powi(power) >= scale).expect("a window is finite") as i8
}

/// Σw · share: the sum of the window, by which a sum of samples grows.
pub(super) fn growth(profile: &Profile, share: f64) -> f64 {
    let mean = match profile.carrier.window {
        Window::Hann => 0.5,
        Window::Rectangular => 1.0,
    };
    profile.slot.integrate as f64 * mean * share
}

/// Words of 2^-B of a word's step, moved up together by as many bits, B at most, as leave the
/// largest its sign: by how many, and the words.
fn moved(profile: &Profile, words: &[[Exact; 2]]) -> (i8, Vec<[Exact; 2]>) {
    let (iq, most) = (profile.formats.iq, profile.formats.block_shift as i8);
    let one = Exact::new(1, i32::from(iq.width) - 1 - i32::from(iq.frac));
    let fits = |by: i8| {
        words.iter().flatten().all(|word| word.scaled(by) < one && word.scaled(by) >= -one)
    };
    let by = (0..=most).rev().find(|&by| fits(by)).expect("words are within full scale");
    (by, words.iter().map(|word| word.map(|part| round(part.scaled(by), iq).value)).collect())
}

/// The currents where the words of the terminals have one exponent, and those of the sensing
/// voltage another.
///
/// Amplitudes of terminals count 2^-by. The total is first rounded by as many bits as the
/// terminals' number has. The amplitudes of total and sensing voltage are then brought back:
/// ⌊a·2^-by⌋ in a word's step, then to the nearest of their output format.
fn block_currents(profile: &Profile, sums: &[[Exact; 2]], shift: i8) -> Currents {
    let f = &profile.formats;
    let wide =
        Format { width: f.iq.width + f.block_shift, frac: f.iq.frac + f.block_shift as i8, ..f.iq };
    let mut saturated = false;
    let mut kept = |part: Exact| {
        let down = Exact::new(part.scaled(wide.frac).floor(), -i32::from(wide.frac));
        let rounded = round(down, wide);
        saturated |= rounded.held;
        rounded.value
    };
    let words: Vec<[Exact; 2]> =
        sums.iter().map(|sum| sum.map(|part| kept(part.scaled(-shift)))).collect();
    let (terminals, sense) = words.split_at(profile.terminals.x.len());
    let ((by, terminals), (by_sense, sense)) = (moved(profile, terminals), moved(profile, sense));
    let amplitude = |[i, q]: [Exact; 2]| round_sqrt(i * i + q * q, f.iq.frac);
    let down = (0..).find(|&bits| terminals.len() < 1 << bits).expect("few terminals") as i8;
    let total = terminals.iter().fold([Exact::ZERO; 2], |[i, q], word| [i + word[0], q + word[1]]);
    let total = amplitude(total.map(|part| round(part.scaled(-down), f.iq).value)).scaled(down);
    let amplitudes: Vec<Exact> = terminals.iter().map(|&word| amplitude(word)).collect();
    let given = Format { signed: false, width: f.total.width + 1, frac: f.total.frac };
    let mut back = |a: Exact, by: i8| {
        let step = Exact::new(a.scaled(f.iq.frac - by).floor(), -i32::from(f.iq.frac));
        let rounded = round(step, given);
        saturated |= rounded.held;
        rounded.value
    };
    let (total, sense) = (back(total, by), back(amplitude(sense[0]), by_sense));
    let [x, y, corners] = numerators(profile, &amplitudes);
    Currents { total, sense, x, y, corners, least: least(&amplitudes), saturated }
}

/// x, y and corners.
fn numerators(profile: &Profile, amplitudes: &[Exact]) -> [Exact; 3] {
    let (x, y) = (&profile.terminals.x, &profile.terminals.y);
    let in_ratios: Vec<i8> = x.iter().zip(y).map(|(&x, &y)| i8::from(x != 0 || y != 0)).collect();
    [x, y, &in_ratios].map(|signs| {
        let signed = |(&a, &sign): (&Exact, &i8)| a * Exact::new(sign.into(), 0);
        amplitudes.iter().zip(signs).map(signed).fold(Exact::ZERO, |sum, term| sum + term)
    })
}

/// The currents from a window's sums: in phase and quadrature of the terminals and the sensing
/// voltage.
pub fn currents(profile: &Profile, sums: &[[Exact; 2]]) -> Currents {
    let f = &profile.formats;
    let smaller = match profile.carrier.method {
        Method::Products => 0,
        Method::Polyphase => (power_above(growth(profile, 0.4)) - 1).max(0),
    };
    let shift = power_above(growth(profile, 0.5)) - smaller;
    if f.block_shift > 0 {
        return block_currents(profile, sums, shift);
    }
    let mut saturated = false;
    let mut held = |x: Exact, to| {
        let rounded = round(x, to);
        saturated |= rounded.held;
        rounded.value
    };
    let words: Vec<[Exact; 2]> =
        sums.iter().map(|sum| sum.map(|part| held(part.scaled(-shift), f.iq))).collect();
    let (terminals, sense) = words.split_at(profile.terminals.x.len());
    let mut add = |sum: Exact, word: Exact| held(sum + word, f.total);
    let total =
        terminals.iter().fold([Exact::ZERO; 2], |[i, q], word| [add(i, word[0]), add(q, word[1])]);
    let amplitude = |[i, q]: [Exact; 2]| round_sqrt(i * i + q * q, f.total.frac);
    let amplitudes: Vec<Exact> = terminals.iter().map(|&word| amplitude(word)).collect();
    let total = amplitude(total);
    let [x, y, corners] = numerators(profile, &amplitudes);
    Currents {
        total,
        sense: amplitude(sense[0]),
        x,
        y,
        corners,
        least: least(&amplitudes),
        saturated,
    }
}

/// The least of the terminals' amplitudes.
fn least(amplitudes: &[Exact]) -> Exact {
    let smaller =
        |least: Exact, &amplitude: &Exact| if amplitude < least { amplitude } else { least };
    amplitudes.iter().skip(1).fold(amplitudes[0], smaller)
}
