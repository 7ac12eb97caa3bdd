// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whether the core's window, or its last few, is long enough for the haptic voltage.
//!
//! ```text
//!   mean square over the window = V²·(1 + Re(W(2f)·e^{2jφ}))         of √2·V·cos(2πft + φ), W the window's transform, W(0) = 1
//!   rectangular: |W| = |sinc x|     Hann: |W| = |sinc x / (1 − x²)|     x = 2f·T, T the window
//!   over N of a pad's windows:      |D| = |sin πNy / (N sin πy)|         y = 2f·P, P from one to the next
//!   the RMS is off by up to |W·D|/2
//! ```

use std::f64::consts::PI;

use hapticore_contract::profile::{Method, Profile, Window};

/// An error of the RMS that is worth a word.
const WORTH_A_WORD: f64 = 0.01;

/// Windows that a profile averages are two to this power at most.
const LONGEST_MEAN: u32 = 6;

/// How exactly a frequency is known.
const TOLERANCE: f64 = 0.01;

/// Frequencies that are looked at on either side, up to the tolerance.
const POINTS: i32 = 32;

/// Samples that a frequency is measured from.
const SAMPLES: usize = 1 << 17;

/// Alternating voltages below this part of full scale are noise.
const LEAST: f64 = 0.005;

/// A warning, with its cure, where the window is too short for a haptic voltage of this frequency.
pub fn warning(profile: &Profile, haptic_hz: f64, sample_rate_hz: f64) -> Option<String> {
    let off = |windows| error(profile, windows, haptic_hz, sample_rate_hz);
    let now = off(profile.haptic.windows);
    let several =
        (1..=LONGEST_MEAN).map(|power| 1 << power).find(|&windows| off(windows) <= WORTH_A_WORD);
    let several = several.map_or(String::new(), |windows| {
        format!(", or the mean over {windows} windows of each pad (haptic.windows = {windows} in a profile)")
    });
    (now > WORTH_A_WORD).then(|| {
        format!(
            "haptic_v_rms: the core's window of {} samples, {:.3} ms, is too short for a haptic voltage of {} Hz: by \
             its phase the voltage is read up to {:.0} % off, the force twice that. Cure: a window of one of its periods, {} \
             samples (window_samples in a scene, slot.integrate in a profile){several}",
            profile.slot.integrate,
            1e3 * profile.slot.integrate as f64 / sample_rate_hz,
            (100.0 * haptic_hz).round() / 100.0,
            100.0 * now,
            whole_period(profile, haptic_hz, sample_rate_hz)
        )
    })
}

/// The largest error of the RMS over all phases, and frequencies so near, of the mean over so many
/// of a pad's windows.
fn error(profile: &Profile, windows: u64, haptic_hz: f64, sample_rate_hz: f64) -> f64 {
    let window_s = profile.slot.integrate as f64 / sample_rate_hz;
    let frame_s = (profile.pads * profile.slot.samples()) as f64 / sample_rate_hz;
    let at = |hz: f64| {
        transform(profile.carrier.window, 2.0 * hz * window_s) * comb(windows, 2.0 * hz * frame_s)
            / 2.0
    };
    // Over so many windows, the mean's error has several maxima within the tolerance.
    let parts =
        (-POINTS..=POINTS).map(|point| 1.0 + TOLERANCE * f64::from(point) / f64::from(POINTS));
    parts.map(|part| at(part * haptic_hz)).fold(0.0, f64::max)
}

/// The magnitude of the mean of so many unit phasors, each so many turns from the one before.
fn comb(count: u64, turns: f64) -> f64 {
    let (count, sine) = (count as f64, (PI * turns).sin());
    if sine.abs() < 1e-9 { 1.0 } else { ((PI * count * turns).sin() / (count * sine)).abs() }
}

/// The magnitude of a window's transform at so many periods of the window.
fn transform(window: Window, x: f64) -> f64 {
    let sinc = if x == 0.0 { 1.0 } else { (PI * x).sin() / (PI * x) };
    match window {
        Window::Rectangular => sinc.abs(),
        Window::Hann if (x - 1.0).abs() < 1e-9 => 0.5,
        Window::Hann => (sinc / (1.0 - x * x)).abs(),
    }
}

/// Samples of about one period, as a window of the profile may have them.
fn whole_period(profile: &Profile, haptic_hz: f64, sample_rate_hz: f64) -> u64 {
    let step: u64 = match profile.carrier.method {
        Method::Products => 4,
        Method::Polyphase => 5,
    };
    step.saturating_mul((sample_rate_hz / haptic_hz / step as f64).round().max(1.0) as u64)
}

/// Measures the frequency of the haptic channel of a capture, from its first samples.
#[derive(Debug, Default)]
pub struct Meter {
    codes: Vec<i32>,
}

impl Meter {
    /// Appends the codes of a slot, all channels of an instant after the other, the haptic voltage
    /// last.
    pub fn append(&mut self, codes: &[i32], channels: usize) {
        let free = SAMPLES - self.codes.len();
        self.codes.extend(codes.iter().skip(channels - 1).step_by(channels).take(free));
    }

    /// The frequency in periods a sample; the period is longer than was listened for where it is
    /// `Err`, which says for how long. None where the voltage does not alternate.
    pub fn frequency(&self, full_scale: f64) -> Option<Result<f64, f64>> {
        let count = self.codes.len() as f64;
        let mean = self.codes.iter().map(|code| f64::from(*code)).sum::<f64>() / count;
        let square =
            self.codes.iter().map(|code| (f64::from(*code) - mean).powi(2)).sum::<f64>() / count;
        let rms = square.sqrt();
        if rms.is_nan() || rms < LEAST * full_scale {
            return None;
        }
        let rises = self.rises(mean, rms / 2.0);
        match (rises.first(), rises.last()) {
            (Some(first), Some(last)) if last > first => {
                Some(Ok((rises.len() - 1) as f64 / (last - first) as f64))
            }
            _ => Some(Err(count)),
        }
    }

    /// Where the voltage rises through the mean, coming from `margin` below and going to `margin`
    /// above.
    fn rises(&self, mean: f64, margin: f64) -> Vec<usize> {
        let (mut low, mut at, mut rises) = (false, 0, Vec::new());
        for (index, code) in self.codes.iter().enumerate() {
            let above = f64::from(*code) - mean;
            if above < 0.0 {
                at = index;
            }
            if above < -margin {
                low = true;
            } else if low && above > margin {
                rises.push(at);
                low = false;
            }
        }
        rises
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile(window: Window, integrate: u64) -> Profile {
        let mut profile = Profile::bundled("standard").unwrap();
        (profile.carrier.window, profile.slot.integrate) = (window, integrate);
        profile
    }

    /// The largest error of the RMS over all phases, by the sum itself.
    fn by_sum(window: Window, x: f64) -> f64 {
        let rms = |phase: f64| {
            let (mut sum, mut weights) = (0.0, 0.0);
            for n in 0..1000 {
                let t = (f64::from(n) + 0.5) / 1000.0;
                let w = if window == Window::Hann { 1.0 - (2.0 * PI * t).cos() } else { 1.0 };
                sum += w * 2.0 * (PI * (x * t + phase)).cos().powi(2);
                weights += w;
            }
            (sum / weights).sqrt()
        };
        (0..100).map(|n| (rms(f64::from(n) / 100.0) - 1.0).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn the_formula_is_what_a_sum_gives() {
        for window in [Window::Hann, Window::Rectangular] {
            for x in [1.5, 2.0, 2.3, 3.7] {
                let (formula, sum) = (transform(window, x) / 2.0, by_sum(window, x));
                assert!(
                    (formula - sum).abs() < 0.1 * formula + 1e-6,
                    "{window:?} {x}: {formula} {sum}"
                );
            }
        }
    }

    #[test]
    fn a_window_of_a_period_is_long_enough_and_a_short_one_is_not() {
        for window in [Window::Hann, Window::Rectangular] {
            for hz in [37.0, 50.0, 200.0, 400.0] {
                let text = warning(&profile(window, 1000), hz, 1e6).unwrap();
                let cure = whole_period(&profile(window, 1000), hz, 1e6);
                assert!(text.contains(&format!("{cure} samples")), "{text}");
                assert_eq!(warning(&profile(window, cure), hz, 1e6), None);
            }
        }
    }

    #[test]
    fn the_error_over_several_windows_is_what_a_sum_gives() {
        let (mut profile, hz) = (profile(Window::Hann, 1000), 130.0);
        for (pads, windows) in [(1, 4), (4, 8), (3, 64)] {
            profile.pads = pads;
            let frame = (pads * profile.slot.samples()) as f64;
            let mean_square = |phase: f64| {
                let (mut sum, mut weights) = (0.0, 0.0);
                for (window, n) in
                    (0..windows).flat_map(|window| (0..1000).map(move |n| (window, n)))
                {
                    let w = 1.0 - (2.0 * PI * (f64::from(n) + 0.5) / 1000.0).cos();
                    let t = (window as f64 * frame + f64::from(n)) * 1e-6;
                    sum += w * 2.0 * (2.0 * PI * (hz * t + phase)).cos().powi(2);
                    weights += w;
                }
                sum / weights
            };
            let by_sum = (0..100)
                .map(|k| (mean_square(f64::from(k) / 100.0) - 1.0).abs() / 2.0)
                .fold(0.0, f64::max);
            let at = transform(Window::Hann, 2.0 * hz * 1e-3)
                * comb(windows, 2.0 * hz * frame * 1e-6)
                / 2.0;
            assert!((at - by_sum).abs() < 1e-3, "{pads} pads, {windows} windows: {at} {by_sum}");
        }
    }

    /// The number of windows that a warning names, if it names one.
    fn named(text: &str) -> Option<u64> {
        let number = text.split("haptic.windows = ").nth(1)?.split(' ').next()?;
        Some(number.parse().expect("a number"))
    }

    #[test]
    fn as_many_windows_as_are_named_are_enough_and_half_of_them_are_not() {
        let mut offered = 0;
        for hz in [37.0, 50.0, 90.0, 130.0, 200.0, 400.0] {
            for pads in [1, 4, 16] {
                let profile = |windows| {
                    let mut profile = profile(Window::Hann, 1000);
                    (profile.pads, profile.haptic.windows) = (pads, windows);
                    profile
                };
                let suffices = |windows| warning(&profile(windows), hz, 1e6).is_none();
                match named(&warning(&profile(1), hz, 1e6).expect("too short")) {
                    Some(windows) => {
                        assert!(
                            suffices(windows) && !suffices(windows / 2),
                            "{windows} at {hz} Hz, {pads} pads"
                        );
                        offered += 1;
                    }
                    None => assert!(
                        (1..=LONGEST_MEAN).all(|power| !suffices(1 << power)),
                        "{hz} Hz, {pads} pads"
                    ),
                }
            }
        }
        assert!(offered > 6, "{offered}");
    }

    #[test]
    fn a_meter_finds_the_frequency() {
        let mut meter = Meter::default();
        for slot in 0..100 {
            let sample = |n: i32| {
                (30_000.0 * (2.0 * PI * 233.0e-6 * f64::from(slot * 1000 + n)).sin()) as i32 + 500
            };
            meter.append(&(0..1000).flat_map(|n| [1, 2, sample(n) + n % 7]).collect::<Vec<_>>(), 3);
        }
        let found = meter.frequency(131_072.0).unwrap().unwrap();
        assert!((found / 233.0e-6 - 1.0).abs() < 1e-3, "{found}");
        assert_eq!(Meter { codes: vec![40_000; 1000] }.frequency(131_072.0), None);
    }
}
