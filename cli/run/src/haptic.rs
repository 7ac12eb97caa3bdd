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

/// Frequencies that are evaluated on either side, up to the tolerance.
const POINTS: i32 = 32;

/// Slots of all pads that tones are measured from, and of each pad at least.
const SLOTS: usize = 192;

/// See [`SLOTS`].
const FEWEST_SLOTS: usize = 6;

/// Pads that are listened to: what more there are is like these.
const MOST_PADS: usize = 16;

/// Points of a voltage in a window, at least.
const POINTS_PER_WINDOW: usize = 32;

/// Periods within a window beyond which no voltage is slow.
const HIGHEST_PERIODS: f64 = 8.0;

/// Periods within what was listened to, at least.
const SLOWEST: f64 = 0.7;

/// Frequencies that are tried at most.
const MOST_STEPS: usize = 30_000;

/// Tones that are distinguished in a voltage.
const TONES: usize = 2;

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

/// The largest error of the RMS over all phases, and over frequencies within the tolerance, for the
/// mean over `windows` of a pad's windows.
fn error(profile: &Profile, windows: u64, haptic_hz: f64, sample_rate_hz: f64) -> f64 {
    let window_s = profile.slot.integrate as f64 / sample_rate_hz;
    let frame_s = (profile.pads * profile.slot.samples()) as f64 / sample_rate_hz;
    let at = |hz: f64| {
        transform(profile.carrier.window, 2.0 * hz * window_s) * comb(windows, 2.0 * hz * frame_s)
            / 2.0
    };
    // Over many windows, the mean's error has several maxima within the tolerance.
    let parts =
        (-POINTS..=POINTS).map(|point| 1.0 + TOLERANCE * f64::from(point) / f64::from(POINTS));
    parts.map(|part| at(part * haptic_hz)).fold(0.0, f64::max)
}

/// The magnitude of the mean of `count` unit phasors, each `turns` turns from the one before.
fn comb(count: u64, turns: f64) -> f64 {
    let (count, sine) = (count as f64, (PI * turns).sin());
    if sine.abs() < 1e-9 { 1.0 } else { ((PI * count * turns).sin() / (count * sine)).abs() }
}

/// The magnitude of a window's transform at `x` periods per window.
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

/// The tones of the haptic voltage of each pad of a recording, from its first slots.
///
/// A pad's voltage is known in its own slots only, so at each frequency one sine is fitted to all
/// of them together, by least squares: `y(t) = a·cos ωt + b·sin ωt`.
#[derive(Debug)]
pub struct Meter {
    rate_hz: f64,
    bin: usize,
    slots: usize,
    pads: Vec<Listened>,
}

/// What was recorded of a pad's haptic voltage.
#[derive(Debug, Clone, Default)]
struct Listened {
    slots: usize,
    /// Times, s, and means over a bin of samples.
    points: Vec<[f64; 2]>,
    /// Sums over all samples: number, codes, squares.
    sums: [f64; 3],
}

/// A sine in a voltage.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Tone {
    hz: f64,
    /// Its part of the alternating power.
    share: f64,
}

impl Meter {
    /// Of a core of the profile.
    pub fn new(profile: &Profile, sample_rate_hz: f64) -> Self {
        let pads = (profile.pads as usize).min(MOST_PADS);
        Meter {
            rate_hz: sample_rate_hz,
            bin: (profile.slot.integrate as usize / POINTS_PER_WINDOW).max(1),
            slots: (SLOTS / profile.pads as usize).max(FEWEST_SLOTS),
            pads: vec![Listened::default(); pads],
        }
    }

    /// Takes the codes of a slot, all channels of an instant after the other, the haptic voltage
    /// last.
    pub fn append(&mut self, (slot, pad): (usize, usize), codes: &[i32], channels: usize) {
        let Some(listened) = self.pads.get_mut(pad).filter(|pad| pad.slots < self.slots) else {
            return;
        };
        let start_s = (slot * (codes.len() / channels)) as f64 / self.rate_hz;
        let samples: Vec<f64> = codes
            .iter()
            .skip(channels - 1)
            .step_by(channels)
            .map(|code| f64::from(*code))
            .collect();
        for (index, bin) in samples.chunks_exact(self.bin).enumerate() {
            let middle = (index as f64 + 0.5) * self.bin as f64;
            let mean = bin.iter().sum::<f64>() / self.bin as f64;
            listened.points.push([start_s + middle / self.rate_hz, mean]);
        }
        for sample in samples {
            listened.sums[0] += 1.0;
            listened.sums[1] += sample;
            listened.sums[2] += sample * sample;
        }
        listened.slots += 1;
    }

    /// A warning for each slow voltage, with the pads that have it.
    pub fn warnings(&self, profile: &Profile) -> Vec<String> {
        let highest_hz = HIGHEST_PERIODS * self.rate_hz / profile.slot.integrate as f64;
        let full_scale = 1.0 / profile.formats.adc.lsb();
        let mut slow: Vec<(f64, String, Vec<usize>)> = Vec::new();
        for (pad, listened) in self.pads.iter().enumerate() {
            let tones = listened.tones(LEAST * full_scale, highest_hz);
            let off = |tone: &Tone| {
                tone.share * error(profile, profile.haptic.windows, tone.hz, self.rate_hz)
            };
            let worst = tones
                .iter()
                .max_by(|a, b| off(a).total_cmp(&off(b)))
                .filter(|tone| off(tone) > WORTH_A_WORD);
            let Some((hz, text)) =
                worst.and_then(|tone| Some((tone.hz, warning(profile, tone.hz, self.rate_hz)?)))
            else {
                continue;
            };
            match slow.iter_mut().find(|(other, ..)| (other / hz - 1.0).abs() < 2.0 * TOLERANCE) {
                Some((.., pads)) => pads.push(pad),
                None => slow.push((hz, text, vec![pad])),
            }
        }
        let names =
            |pads: &[usize]| pads.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
        let text = |(_, text, pads): &(f64, String, Vec<usize>)| {
            format!("pad{} {}: {text}", if pads.len() > 1 { "s" } else { "" }, names(pads))
        };
        slow.iter().map(text).collect()
    }
}

impl Listened {
    /// The two strongest tones; none where the voltage does not alternate by `least` rms.
    fn tones(&self, least: f64, highest_hz: f64) -> Vec<Tone> {
        let [count, sum, squares] = self.sums;
        let (mean, power) = (sum / count, squares / count - (sum / count).powi(2));
        if power.is_nan() || power.sqrt() < least {
            return Vec::new();
        }
        let mut points: Vec<[f64; 2]> = self.points.iter().map(|[t, y]| [*t, y - mean]).collect();
        let long_s = points[points.len() - 1][0] - points[0][0];
        let (lowest_hz, step_hz) = (SLOWEST / long_s, 0.25 / long_s);
        let steps = (((highest_hz - lowest_hz) / step_hz) as usize).min(MOST_STEPS);
        let mut tones = Vec::new();
        for _ in 0..TONES {
            let power_at = |hz: f64| fit(&points, hz).1;
            let at = |step: usize| lowest_hz + step as f64 * step_hz;
            let powers = spectrum(&points, lowest_hz, step_hz, steps);
            let Some(best) = (0..powers.len()).max_by(|a, b| powers[*a].total_cmp(&powers[*b]))
            else {
                break;
            };
            let hz = peak([at(best) - step_hz, at(best) + step_hz], power_at).max(lowest_hz);
            let ([a, b], tone) = fit(&points, hz);
            tones.push(Tone { hz, share: tone / power });
            for [t, y] in &mut points {
                let phase = 2.0 * PI * hz * *t;
                *y -= a * phase.cos() + b * phase.sin();
            }
        }
        tones
    }
}

/// The power that a fit has at `steps` frequencies, without the correlation of cosine and sine.
fn spectrum(points: &[[f64; 2]], lowest_hz: f64, step_hz: f64, steps: usize) -> Vec<f64> {
    let turn = |hz: f64, t: f64| {
        let phase = 2.0 * PI * hz * t;
        [phase.cos(), phase.sin()]
    };
    let times = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a * c - b * d, a * d + b * c];
    let mut rotors: Vec<[f64; 2]> = points.iter().map(|[t, _]| turn(lowest_hz, *t)).collect();
    let by: Vec<[f64; 2]> = points.iter().map(|[t, _]| turn(step_hz, *t)).collect();
    let mut powers = Vec::with_capacity(steps);
    for _ in 0..steps {
        let mut sums = [0.0; 2];
        for ((rotor, by), [_, y]) in rotors.iter_mut().zip(&by).zip(points) {
            sums[0] += y * rotor[0];
            sums[1] += y * rotor[1];
            *rotor = times(*rotor, *by);
        }
        powers.push(sums[0] * sums[0] + sums[1] * sums[1]);
    }
    powers
}

/// The sine that fits best at a frequency, and its power.
fn fit(points: &[[f64; 2]], hz: f64) -> ([f64; 2], f64) {
    let mut sums = [0.0; 5];
    for [t, y] in points {
        let phase = 2.0 * PI * hz * t;
        let (c, s) = (phase.cos(), phase.sin());
        for (sum, part) in sums.iter_mut().zip([c * c, s * s, c * s, y * c, y * s]) {
            *sum += part;
        }
    }
    let [cc, ss, cs, yc, ys] = sums;
    let determinant = cc * ss - cs * cs;
    if determinant <= 1e-6 * cc * ss {
        return ([0.0; 2], 0.0);
    }
    let (a, b) = ((yc * ss - ys * cs) / determinant, (ys * cc - yc * cs) / determinant);
    ([a, b], (a * yc + b * ys) / points.len() as f64)
}

/// Where a function is largest between two ends, by golden section.
fn peak([mut low, mut high]: [f64; 2], of: impl Fn(f64) -> f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    for _ in 0..24 {
        let [a, b] = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
        if of(a) > of(b) { high = b } else { low = a }
    }
    (low + high) / 2.0
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

    /// Slots of the profile with a haptic voltage, by pad and time, s, of this part of full scale.
    fn listen(profile: &Profile, slots: usize, voltage: impl Fn(usize, f64) -> f64) -> Meter {
        let mut meter = Meter::new(profile, 1e6);
        let (length, pads) = (profile.slot.samples() as usize, profile.pads as usize);
        for slot in 0..slots {
            let code = |n: usize| {
                (131_072.0 * voltage(slot % pads, (slot * length + n) as f64 * 1e-6)) as i32
            };
            let codes: Vec<i32> = (0..length).flat_map(|n| [1, 2, code(n)]).collect();
            meter.append((slot, slot % pads), &codes, 3);
        }
        meter
    }

    fn sine(hz: f64, t: f64) -> f64 {
        (2.0 * PI * hz * t + 0.3).sin()
    }

    #[test]
    fn pads_with_different_voltages_are_judged_each_for_itself() {
        let profile = profile(Window::Hann, 1000);
        let meter = listen(&profile, 200, |pad, t| [0.1, 0.5, 0.02, 0.9][pad] * sine(1000.0, t));
        assert_eq!(meter.warnings(&profile), Vec::<String>::new());
        let meter =
            listen(&profile, 200, |pad, t| 0.5 * sine([1000.0, 233.0, 50.0, 233.0][pad], t));
        let warnings = meter.warnings(&profile);
        assert_eq!(warnings.len(), 2, "{warnings:?}");
        assert!(
            warnings[0].starts_with("pads 1, 3: ") && warnings[0].contains(" 233 Hz"),
            "{}",
            warnings[0]
        );
        assert!(
            warnings[1].starts_with("pad 2: ") && warnings[1].contains(" 50 Hz"),
            "{}",
            warnings[1]
        );
    }

    #[test]
    fn of_two_tones_the_worse_is_named() {
        let profile = profile(Window::Hann, 1000);
        for (fast, slow) in [(1000.0, 200.0), (1500.0, 60.0)] {
            let meter = listen(&profile, 200, |_, t| 0.4 * sine(fast, t) + 0.3 * sine(slow, t));
            let warnings = meter.warnings(&profile);
            let named: f64 = warnings[0]
                .split("voltage of ")
                .nth(1)
                .unwrap()
                .split(' ')
                .next()
                .unwrap()
                .parse()
                .unwrap();
            assert!((named / slow - 1.0).abs() < 0.02, "{fast} {slow}: {warnings:?}");
        }
    }

    #[test]
    fn direct_and_fast_voltages_are_not_slow() {
        let profile = profile(Window::Hann, 1000);
        let voltages: [fn(f64) -> f64; 3] =
            [|_| 0.3, |t| 0.5 * sine(20_000.0, t), |t| 0.5 * sine(2000.0, t)];
        for voltage in voltages {
            assert_eq!(
                listen(&profile, 100, |_, t| voltage(t)).warnings(&profile),
                Vec::<String>::new()
            );
        }
    }
}
