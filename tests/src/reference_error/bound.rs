// SPDX-License-Identifier: MIT OR Apache-2.0
//! How far the reference's `f64` can be from the equations, to first order in `u = 2^-53`. Each
//! operation rounds by `u` of its result, and multiplies an operand's error by its condition
//! number.
//!
//! | result | bound, in units of `u` | why |
//! | --- | --- | --- |
//! | w | 13 of the largest weight | sin²θ at θ ≤ π that is off by 3 roundings |
//! | cos φ, sin φ | 19 of one | φ ≤ 2π that is off by 3 roundings, and its own |
//! | a_k | `e_k = √2·((2n + 8)·A_k + 32·B_k) + 4·a_k` | n terms are summed here and in Σw; `A_k = 2/Σw·Σ w·abs x`, `B_k` without w |
//! | r | `((E + K·S)·(1 + abs r))/S + 2·abs r` | `S = Σ a_k`, `E = Σ e_k` over the K terminals of the ratio |
//! | x, y | `J⁻¹` of r's bound and of [`SPLINE`], and [`PLACE`] roundings of the table's range | Newton's steps end where only the error of the ratio's evaluation is left |
//! | R | `∂R/∂r` of the same, and [`SPLINE`] of R | nine products and their sum |
//! | C | `δ_T + ½·(v²·(2δ_v + 2) + (TR)²·(2δ_T + 2δ_R + 4))/(v² − (TR)²) + 5` of C | the difference under the square root |
//! | C by eq. 6 | `δ_T + δ_v + 4` of C | a quotient |
//! | V | half of m's, and 3, of V | `m = Σ w·h²/Σw` has `2n + 16` and 32 of `Σ h²/Σ w·h²` |
//! | F | `2δ_C + δ_m + 5` of F | eq. 8 |
//!
//! The sums of n terms are bounded by n roundings though they behave as √n of them, so that a sum
//! over 1000 samples is found well within its bound. Everything that follows the sums is bounded
//! tightly.

use hapticore_contract::calibration::Calibration;
use hapticore_contract::frame::Measurement;
use hapticore_contract::profile::{Profile, Window};
use hapticore_run::engine::Signals;
use std::f64::consts::{PI, SQRT_2, TAU};

/// One rounding of an `f64`, of its result.
const U: f64 = 1.0 / (1u64 << 53) as f64;
/// Roundings of a spline's value: weights, nine products, their sum; and of the place at which it
/// is taken.
const SPLINE: f64 = 32.0;
/// Roundings of a place, of the table's range.
const PLACE: f64 = 6.0;

/// A number and its error, in units of `u`.
#[derive(Debug, Clone, Copy, Default)]
struct Rough {
    value: f64,
    error: f64,
}

impl Rough {
    /// The error as a share of the number.
    fn share(self) -> f64 {
        if self.error == 0.0 { 0.0 } else { self.error / self.value }
    }
}

/// What the sums over a window leave.
struct Sums {
    /// Phasors of the terminals and the sensing voltage, each part with the error of its amplitude.
    phasors: Vec<([f64; 2], f64)>,
    mean_square: Rough,
}

impl Sums {
    fn of(profile: &Profile, signals: &Signals) -> Sums {
        match signals {
            Signals::Samples { codes, blanking } => Sums::of_samples(profile, &codes[*blanking..]),
            Signals::Phasors { amplitudes, mean_square } => Sums {
                phasors: amplitudes.iter().map(|&(i, q)| ([i, q], 4.0 * i.hypot(q))).collect(),
                mean_square: Rough { value: *mean_square, error: 2.0 * mean_square },
            },
        }
    }

    fn of_samples(profile: &Profile, codes: &[i32]) -> Sums {
        let (n, channels) = (profile.slot.integrate, profile.channels());
        let turns = |m: u64| {
            ((profile.slot.blanking() + m) * profile.carrier.periods % n) as f64 / n as f64
        };
        let window = |m: u64| match profile.carrier.window {
            Window::Hann => (PI * m as f64 / n as f64).sin().powi(2),
            Window::Rectangular => 1.0,
        };
        let weights: Vec<_> = (0..n).map(|m| (window(m), (TAU * turns(m)).sin_cos())).collect();
        let (total, lsb) =
            (weights.iter().map(|weight| weight.0).sum::<f64>(), profile.formats.adc.lsb());
        let sum = |channel: usize, of: &dyn Fn(f64, (f64, f64), f64) -> f64| -> f64 {
            let samples =
                codes.iter().skip(channel).step_by(channels).map(|&code| f64::from(code) * lsb);
            samples.zip(&weights).map(|(x, &(w, wave))| of(x, wave, w)).sum::<f64>() / total
        };
        let roundings = 2.0 * n as f64;
        let phasor = |channel: usize| {
            let part = |of: &dyn Fn(f64, (f64, f64), f64) -> f64| 2.0 * sum(channel, of);
            let (i, q) = (part(&|x, wave, w| w * x * wave.1), part(&|x, wave, w| w * x * wave.0));
            let (weighted, plain) = (part(&|x, _, w| w * x.abs()), part(&|x, _, _| x.abs()));
            ([i, q], SQRT_2 * ((roundings + 8.0) * weighted + 32.0 * plain) + 4.0 * i.hypot(q))
        };
        let (squares, plain) =
            (sum(channels - 1, &|x, _, w| w * x * x), sum(channels - 1, &|x, _, _| x * x));
        let mean_square =
            Rough { value: squares, error: (roundings + 16.0) * squares + 32.0 * plain };
        Sums { phasors: (0..channels - 1).map(phasor).collect(), mean_square }
    }
}

/// The bounds of a slot's quantities, in the order of [`super::QUANTITIES`]; the sheet's resistance
/// and the haptic voltage in full scales. None at a place where the ratios do not tell places
/// apart.
pub fn bounds(
    profile: &Profile,
    calibration: &Calibration,
    signals: &Signals,
    [measurement_eq6, haptic_v]: [f64; 2],
    measurement: &Measurement,
) -> Option<[f64; super::QUANTITIES.len()]> {
    let sums = Sums::of(profile, signals);
    let (terminals, sense) = sums.phasors.split_at(profile.terminals.x.len());
    let ratios = ratios(profile, terminals, [measurement.r_x, measurement.r_y]);
    let condition = calibration.position.condition(measurement.x_mm, measurement.y_mm)?;
    let position = profile.formats.position;
    let range = position.real(position.max_code() as i64);
    let moved =
        |by: [f64; 2]| by[0].abs() * (ratios[0] + SPLINE) + by[1].abs() * (ratios[1] + SPLINE);
    let place = condition.place.map(|by| moved(by) + PLACE * range);
    let sheet = Rough {
        value: measurement.sheet,
        error: moved(condition.sheet) + SPLINE * measurement.sheet.abs(),
    };
    let (total, sense) =
        (total(terminals), Rough { value: sense[0].0[0].hypot(sense[0].0[1]), error: sense[0].1 });
    let eq6 = total.share() + sense.share() + 4.0;
    let capacitance = total.share() + under_square_root(profile, total, sense, sheet) / 2.0 + 5.0;
    let mean_square = sums.mean_square.share() + profile.haptic.windows as f64;
    let bounds = [
        ratios[0],
        ratios[1],
        place[0],
        place[1],
        capacitance * measurement.capacitance_pf,
        eq6 * measurement_eq6,
        sheet.error,
        (mean_square / 2.0 + 3.0) * haptic_v,
        (2.0 * capacitance + mean_square + 5.0) * measurement.force_n,
    ];
    Some(bounds.map(|bound| bound * U))
}

fn ratios(profile: &Profile, terminals: &[([f64; 2], f64)], ratios: [f64; 2]) -> [f64; 2] {
    let signs = profile.terminals.x.iter().zip(&profile.terminals.y);
    let counted = signs
        .zip(terminals)
        .filter(|((x, y), _)| **x != 0 || **y != 0)
        .map(|(_, terminal)| terminal);
    let (mut sum, mut error, mut count) = (0.0, 0.0, 0.0);
    for ([i, q], of_one) in counted {
        (sum, error, count) = (sum + i.hypot(*q), error + of_one, count + 1.0);
    }
    ratios.map(|r| (error + count * sum) * (1.0 + r.abs()) / sum + 2.0 * r.abs())
}

/// The sum over all terminals, which are nearly in phase: little cancels.
fn total(terminals: &[([f64; 2], f64)]) -> Rough {
    let [i, q] = [0, 1].map(|part| terminals.iter().map(|(phasor, _)| phasor[part]).sum::<f64>());
    let (value, count) = (i.hypot(q), terminals.len() as f64);
    let of_each = terminals.iter().map(|([i, q], error)| error + count * i.hypot(*q));
    Rough { value, error: of_each.sum::<f64>() + 3.0 * value }
}

/// The share of `v² − (TR)²` by which it is off.
fn under_square_root(profile: &Profile, total: Rough, sense: Rough, sheet: Rough) -> f64 {
    let square = sense.value * sense.value;
    let of_sense = square * (2.0 * sense.share() + 2.0);
    if !profile.capacitance.sheet_correction || sheet.value <= 0.0 {
        return of_sense / square;
    }
    let drop = (total.value * sheet.value).powi(2);
    (of_sense + drop * (2.0 * total.share() + 2.0 * sheet.share() + 4.0)) / (square - drop)
}
