// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fidelity `float`: a slot's measurement in floating point, from the codes of its window or from
//! phasors.
//!
//! ```text
//! i_k = 2/Σw · Σ w·x_k·cos φ,   q_k = 2/Σw · Σ w·x_k·sin φ,   a_k = √(i_k² + q_k²)          (a full-scale tone gives one)
//! r_x = Σ ±a_k / Σ a_k,   r_y likewise (eqs. 2, 3);   x, y, R: where the table has these ratios;   lost: min a_k < open · Σ a_k;   lifted: C ≤ contact
//! a = |Σ (i_k + j q_k)|,   C = gain · a / √(v² − (a·R)²)    or    gain · a / v (eq. 6)
//! m = 1/Σw · Σ w·h², the mean of the pad's last N once there are as many,   F = gain · C² · m · square_gain (eq. 8)
//! F = gain · factor(C, past) · C² · m · square_gain, past of √(m · square_gain)    with a force table
//! ```
//!
//! Amplitudes enter results as quotients only, so that the core's tone gain cancels; its square
//! gain does not, and a measurement's mean square holds it, as a frame's does. Nothing saturates.

use crate::control::Prompt;
use hapticore_contract::calibration::{Calibration, PastVoltage};
use hapticore_contract::frame::{Flags, Measurement};
use hapticore_contract::profile::{ForceLaw, Profile, Window};
use num_traits::{Float, FloatConst, FromPrimitive};

/// What the equations can be evaluated in: `f32`, `f64`, or a type with more bits.
pub trait Real: Float + FloatConst + FromPrimitive {}

impl<T: Float + FloatConst + FromPrimitive> Real for T {}

/// A number of the profile or the calibration, as it is.
#[inline(always)]
fn real<T: Real>(x: f64) -> T {
    T::from_f64(x).expect("a floating-point type takes every f64")
}

/// The local oscillator and the window at one sample.
#[derive(Debug, Clone, Copy)]
struct WindowedCarrier<T> {
    /// 2 w cos φ / Σw and 2 w sin φ / Σw, per full scale of a code.
    carrier: [T; 2],
    /// w / Σw, per full scale² of a code.
    square: T,
}

/// The results of a pad that stand while there are none.
#[derive(Debug, Clone, Copy)]
struct Held<T> {
    measurement: Measurement<T>,
    eq6: T,
}

impl<T: Real> Held<T> {
    /// What a pad that is lifted reads, at the place that these results have.
    fn at_the_same_place(self, lifted: Held<T>) -> Held<T> {
        let Measurement { r_x, r_y, x_mm, y_mm, sheet, .. } = self.measurement;
        let measurement = Measurement { r_x, r_y, x_mm, y_mm, sheet, ..lifted.measurement };
        Held { measurement, ..lifted }
    }
}

/// A slot's equations.
struct Solution<T> {
    values: Held<T>,
    valid: bool,
    lost: bool,
    lifted: bool,
}

/// A core in floating point, slot by slot.
pub struct Reference<T = f64> {
    window: Vec<WindowedCarrier<T>>,
    channels: usize,
    full_scale: [i32; 2],
    signs: Vec<[T; 2]>,
    sheet_correction: bool,
    square_gain: T,
    calibration: Calibration,
    held: Vec<Held<T>>,
    /// Windows over which squares are averaged, and the last squares of every pad.
    windows: usize,
    squares: Vec<Vec<T>>,
    law: ForceLaw,
    /// The voltage that every pad has had.
    past: Vec<PastVoltage<T>>,
    sums: Vec<[T; 2]>,
    last: usize,
    early: Early<T>,
}

/// What is known of a slot before its place.
#[derive(Debug, Clone, Copy)]
struct Early<T> {
    pad: usize,
    total: T,
    sense: T,
    /// At the pad's last place.
    sheet: T,
    mean_square: T,
    clipped: bool,
}

impl Reference {
    /// A core of a profile in `f64`, calibrated, just before its first slot.
    pub fn new(profile: &Profile, calibration: &Calibration) -> Self {
        Reference::with_precision(profile, calibration)
    }
}

impl<T: Real> Reference<T> {
    /// A core in the precision of `T`, calibrated, just before its first slot.
    ///
    /// ```
    /// # use hapticore_contract::calibration::{Calibration, ForceTable, Point, PositionTable};
    /// # use hapticore_contract::profile::Profile;
    /// use hapticore_reference::Reference;
    ///
    /// # let profile = Profile::bundled("standard")?;
    /// # let place = |k: i32| (f64::from(k % 9 - 4) * 20.0, f64::from(k / 9 - 4) * 10.0);
    /// # let point = |(x, y)| Point { x, y, r_x: x / 100.0, r_y: y / 50.0, sheet: 0.0 };
    /// # let position = PositionTable::fit(&profile, &(0..81).map(place).map(point).collect::<Vec<_>>())?;
    /// # let force_table = ForceTable::default();
    /// # let (capacitance_gain, force_gain, contact_capacitance) = (800.0, 2e-6, 100.0);
    /// # let calibration =
    /// #     Calibration { position, capacitance_gain, force_gain, contact_capacitance, force_table };
    /// let mut double = Reference::new(&profile, &calibration);
    /// let mut single = Reference::<f32>::with_precision(&profile, &calibration);
    /// let phasors = [(0.11, 0.0), (0.12, 0.0), (0.1, 0.0), (0.09, 0.0), (0.1, 0.0), (0.1, 0.0), (0.3, 0.4)];
    /// let (double, single) = (double.phasors(0, &phasors, 0.1), single.phasors(0, &phasors, 0.1));
    /// let error = (f64::from(single.capacitance_pf) / double.capacitance_pf - 1.0).abs();
    /// assert!(error > 0.0 && error < 1e-6, "24 bits: {error}");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_precision(profile: &Profile, calibration: &Calibration) -> Self {
        let pair = |(&x, &y): (&i8, &i8)| [x, y].map(|sign| real(sign.into()));
        let terminals = &profile.terminals;
        let half = 1i32 << (profile.formats.adc.width - 1);
        Reference {
            window: window(profile),
            channels: terminals.x.len() + 2,
            full_scale: [-half, half - 1],
            signs: terminals.x.iter().zip(&terminals.y).map(pair).collect(),
            sheet_correction: profile.capacitance.sheet_correction,
            square_gain: real(profile.square_gain()),
            calibration: calibration.clone(),
            held: (0..profile.pads as usize).map(nothing).collect(),
            windows: profile.haptic.windows as usize,
            squares: vec![Vec::new(); profile.pads as usize],
            law: profile.force.law,
            past: vec![PastVoltage::default(); profile.pads as usize],
            sums: vec![[T::zero(); 2]; terminals.x.len() + 1],
            last: 0,
            early: Early {
                pad: 0,
                total: T::zero(),
                sense: T::zero(),
                sheet: T::zero(),
                mean_square: T::zero(),
                clipped: false,
            },
        }
    }

    /// The measurement of a slot: `codes` are those of its window, a sample after the other:
    /// terminals, sensing voltage, haptic voltage.
    ///
    /// # Panics
    /// Where `codes` is not one code per channel and sample, or there is no such pad.
    pub fn slot(&mut self, pad: usize, codes: &[i32]) -> Measurement<T> {
        self.assert_pad(pad);
        assert_eq!(
            codes.len(),
            self.window.len() * self.channels,
            "one code a channel and sample of the window"
        );
        let mean_square = match self.channels {
            6 => self.demodulate::<6>(codes),
            8 => self.demodulate::<8>(codes),
            10 => self.demodulate::<10>(codes),
            _ => self.demodulate_each(codes),
        };
        let [low, high] = self.full_scale;
        // Without a branch, so that the compiler compares several codes per instruction.
        let clipped =
            codes.iter().fold(false, |clipped, &code| clipped | (code == low) | (code == high));
        let phasors = std::mem::take(&mut self.sums);
        let measurement = self.estimate(pad, &phasors, mean_square, clipped);
        self.sums = phasors;
        measurement
    }

    /// The measurement of a slot with these phasors (in phase, quadrature; fractions of full scale)
    /// of the terminals and the sensing voltage, and this mean square of the haptic voltage (full
    /// scales squared).
    ///
    /// # Panics
    /// Where `phasors` is not one a terminal and one more, or there is no such pad.
    pub fn phasors(
        &mut self,
        pad: usize,
        phasors: &[(f64, f64)],
        mean_square: f64,
    ) -> Measurement<T> {
        self.assert_pad(pad);
        assert_eq!(
            phasors.len(),
            self.signs.len() + 1,
            "a phasor a terminal, and the sensing voltage's"
        );
        let phasors: Vec<_> = phasors.iter().map(|&(i, q)| [i, q].map(real)).collect();
        self.estimate(pad, &phasors, real(mean_square), false)
    }

    /// Refuses a pad before anything has changed.
    fn assert_pad(&self, pad: usize) {
        let pads = self.held.len();
        assert!(pad < pads, "pad: expected below {pads}, got {pad}");
    }

    /// The capacitance of the last slot by eq. 6 alone, in picofarads: what it is without the
    /// sheet's resistance.
    pub fn capacitance_eq6(&self) -> T {
        self.held[self.last].eq6
    }

    /// Phasors into `sums`; gives the mean square. With the number of channels known at compile time, the compiler adds
    /// two channels per instruction.
    fn demodulate<const CHANNELS: usize>(&mut self, codes: &[i32]) -> T {
        // The haptic channel's are not used; to leave it out takes longer.
        let [mut in_phase, mut quadrature] = [[T::zero(); CHANNELS]; 2];
        let mut mean_square = T::zero();
        for (codes, windowed) in codes.as_chunks::<CHANNELS>().0.iter().zip(&self.window) {
            let [cosine, sine] = windowed.carrier;
            for channel in 0..CHANNELS {
                let x = of_code::<T>(codes[channel]);
                in_phase[channel] = in_phase[channel] + x * cosine;
                quadrature[channel] = quadrature[channel] + x * sine;
            }
            let haptic = of_code::<T>(codes[CHANNELS - 1]);
            mean_square = mean_square + haptic * haptic * windowed.square;
        }
        let phasors = in_phase.into_iter().zip(quadrature);
        self.sums.iter_mut().zip(phasors).for_each(|(sum, (i, q))| *sum = [i, q]);
        mean_square
    }

    /// As [`Reference::demodulate`], of any number of channels.
    fn demodulate_each(&mut self, codes: &[i32]) -> T {
        let of = |channel: usize| {
            codes[channel..].iter().step_by(self.channels).map(|&code| of_code::<T>(code))
        };
        for (channel, sum) in self.sums.iter_mut().enumerate() {
            *sum = of(channel).zip(&self.window).fold([T::zero(); 2], |[i, q], (x, windowed)| {
                let [cosine, sine] = windowed.carrier;
                [i + x * cosine, q + x * sine]
            });
        }
        let squares = of(self.channels - 1).zip(&self.window);
        squares.fold(T::zero(), |sum, (haptic, windowed)| sum + haptic * haptic * windowed.square)
    }

    fn estimate(
        &mut self,
        pad: usize,
        phasors: &[[T; 2]],
        mean_square: T,
        clipped: bool,
    ) -> Measurement<T> {
        let mean_square = self.mean_square(pad, mean_square * self.square_gain);
        let sheet = self.held[pad].measurement.sheet;
        let [total, sense] = total_and_sense(phasors);
        self.early = Early { pad, total, sense, sheet, mean_square, clipped };
        self.past[pad].follow(&self.calibration.force_table, mean_square.sqrt());
        let solution = self.solve(pad, phasors, mean_square);
        self.last = pad;
        if solution.valid {
            self.held[pad] = match solution.lifted {
                true => self.held[pad].at_the_same_place(solution.values),
                false => solution.values,
            };
        }
        let Solution { valid, lost, lifted, .. } = solution;
        let flags = Flags { clipped, saturated: false, invalid: !valid, lost, lifted };
        Measurement { mean_square, flags, ..self.held[pad].measurement }
    }

    /// The last slot's estimate before its place was known: with the sheet's resistance at the pad's
    /// last place.
    pub fn prompt(&self) -> Prompt {
        let Early { pad, total, sense, sheet, mean_square, clipped } = self.early;
        let (capacitance, left) = self.capacitance(total, sense, sheet);
        let gain = self.force_gain(pad, capacitance);
        let number = |x: T| x.to_f64().unwrap_or(f64::NAN);
        Prompt {
            pad,
            capacitance_pf: number(capacitance),
            force_n: number(gain * capacitance * capacitance * mean_square),
            force_gain: number(gain),
            invalid: clipped || left.is_nan() || left <= T::zero(),
            lifted: self.is_lifted(capacitance),
        }
    }

    /// The capacitance, and what the square root is taken of.
    #[inline(always)]
    fn capacitance(&self, total: T, sense: T, sheet: T) -> (T, T) {
        let drop = if self.sheet_correction { total * sheet } else { T::zero() };
        let left = sense * sense - drop * drop;
        (real::<T>(self.calibration.capacitance_gain) * total / left.sqrt(), left)
    }

    /// Whether a pad of this capacitance does not touch.
    fn is_lifted(&self, capacitance_pf: T) -> bool {
        capacitance_pf <= real(self.calibration.contact_capacitance)
    }

    /// The mean of the pad's last squares, or the newest while they are too few.
    fn mean_square(&mut self, pad: usize, newest: T) -> T {
        let last = &mut self.squares[pad];
        if last.len() == self.windows {
            last.remove(0);
        }
        last.push(newest);
        if last.len() == self.windows {
            sum(last.iter().copied()) / real(self.windows as f64)
        } else {
            newest
        }
    }

    /// The k of eq. 8, or what the table makes of it.
    fn force_gain(&self, pad: usize, capacitance_pf: T) -> T {
        let factor = match self.law {
            ForceLaw::Eq8 => T::one(),
            ForceLaw::Table => self.calibration.force_table.factor(capacitance_pf, self.past[pad]),
        };
        real::<T>(self.calibration.force_gain) * factor
    }

    /// Eqs. 2, 3, 6 and 8 and the sheet's resistance.
    fn solve(&self, pad: usize, phasors: &[[T; 2]], mean_square: T) -> Solution<T> {
        let amplitudes = phasors[..self.signs.len()].iter().map(magnitude);
        let (mut x, mut y, mut corners, mut least) =
            (T::zero(), T::zero(), T::zero(), T::infinity());
        for (amplitude, &[sign_x, sign_y]) in amplitudes.zip(&self.signs) {
            x = x + sign_x * amplitude;
            y = y + sign_y * amplitude;
            corners =
                corners + if sign_x.is_zero() && sign_y.is_zero() { T::zero() } else { amplitude };
            least = amplitude.min(least);
        }
        let [total, sense] = total_and_sense(phasors);
        let (r_x, r_y) = (x / corners, y / corners);
        let place = self.calibration.position.look_up(r_x, r_y);
        let (x_mm, y_mm, sheet) = (place.x, place.y, place.sheet.max(T::zero()));
        let (capacitance_pf, left) = self.capacitance(total, sense, sheet);
        let gain = self.force_gain(pad, capacitance_pf);
        let force_n = gain * capacitance_pf * capacitance_pf * mean_square;
        let flags = Flags::default();
        Solution {
            values: Held {
                measurement: Measurement {
                    pad,
                    r_x,
                    r_y,
                    x_mm,
                    y_mm,
                    sheet,
                    capacitance_pf,
                    force_n,
                    mean_square,
                    flags,
                },
                eq6: real::<T>(self.calibration.capacitance_gain) * total / sense,
            },
            valid: corners > T::zero() && place.is_valid() && left > T::zero(),
            lost: least < real::<T>(self.calibration.position.open_share()) * corners,
            lifted: self.is_lifted(capacitance_pf),
        }
    }
}

#[inline(always)]
fn of_code<T: Real>(code: i32) -> T {
    T::from_i32(code).expect("a floating-point type takes every code")
}

fn sum<T: Real>(numbers: impl Iterator<Item = T>) -> T {
    numbers.fold(T::zero(), |sum, x| sum + x)
}

/// The amplitudes of the current into all terminals and of the sensing voltage.
#[inline(always)]
fn total_and_sense<T: Real>(phasors: &[[T; 2]]) -> [T; 2] {
    let (sense, terminals) = phasors.split_last().expect("the sensing voltage is the last");
    let of_all = |part: usize| sum(terminals.iter().map(|phasor| phasor[part]));
    [magnitude(&[of_all(0), of_all(1)]), magnitude(sense)]
}

fn magnitude<T: Real>(phasor: &[T; 2]) -> T {
    (phasor[0] * phasor[0] + phasor[1] * phasor[1]).sqrt()
}

/// The windowed carrier. The carrier's phase is zero at the first sample of the slot.
fn window<T: Real>(profile: &Profile) -> Vec<WindowedCarrier<T>> {
    let samples = profile.slot.integrate;
    let count = |n: u64| real::<T>(n as f64);
    let window_at = |m: u64| match profile.carrier.window {
        Window::Hann => (T::PI() * count(m) / count(samples)).sin().powi(2),
        Window::Rectangular => T::one(),
    };
    let total = sum((0..samples).map(window_at));
    let full = real::<T>(2f64.powi(profile.formats.adc.frac.into()));
    let windowed = |m: u64| {
        let step = (profile.slot.blanking() + m) * profile.carrier.periods % samples;
        let (sine, cosine) = (T::TAU() * count(step) / count(samples)).sin_cos();
        let scale = count(2) * window_at(m) / total / full;
        WindowedCarrier {
            carrier: [cosine, sine].map(|wave| scale * wave),
            square: window_at(m) / total / full / full,
        }
    };
    (0..samples).map(windowed).collect()
}

/// A pad of which nothing is known yet.
fn nothing<T: Real>(pad: usize) -> Held<T> {
    let [r_x, r_y, x_mm, y_mm, sheet, capacitance_pf, force_n, mean_square] = [T::zero(); 8];
    let flags = Flags::default();
    let measurement = Measurement {
        pad,
        r_x,
        r_y,
        x_mm,
        y_mm,
        sheet,
        capacitance_pf,
        force_n,
        mean_square,
        flags,
    };
    Held { measurement, eq6: T::zero() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hapticore_contract::calibration::{ForceTable, Point, PositionTable};
    use hapticore_contract::profile::Terminals;

    /// The sums of channels that are added up together are those of each, for any number of them.
    #[test]
    fn channels_together_give_what_each_gives() {
        let profile = Profile::bundled("small").expect("bundled");
        let point = |k: i32| Point {
            x: f64::from(k % 9),
            y: f64::from(k / 9),
            r_x: f64::from(k % 9) / 10.0,
            r_y: f64::from(k / 9) / 10.0,
            sheet: 0.0,
        };
        let points: Vec<_> = (0..81).map(point).collect();
        let calibration = Calibration {
            position: PositionTable::fit(&profile, &points).expect("a raster"),
            capacitance_gain: 800.0,
            force_gain: 2e-6,
            contact_capacitance: 100.0,
            force_table: ForceTable::default(),
        };
        for terminals in [4, 6, 8] {
            let signs =
                |of: usize| (0..terminals).map(|n| if n % 2 == of { 1 } else { -1 }).collect();
            let terminals = Terminals { x: signs(0), y: signs(1) };
            let profile = Profile { terminals, ..profile.clone() };
            let mut reference = Reference::<f64>::with_precision(&profile, &calibration);
            let count = reference.window.len() * reference.channels;
            let codes: Vec<_> =
                (0..count as i32).map(|n| n.wrapping_mul(40_503) % 30_000).collect();
            let square = reference.demodulate_each(&codes);
            let each = std::mem::take(&mut reference.sums);
            reference.sums = vec![[0.0; 2]; each.len()];
            let together = match reference.channels {
                6 => reference.demodulate::<6>(&codes),
                8 => reference.demodulate::<8>(&codes),
                _ => reference.demodulate::<10>(&codes),
            };
            assert_eq!((together, &reference.sums), (square, &each));
            assert!(each.iter().flatten().all(|sum| *sum != 0.0));
        }
    }
}
