// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a window makes of tones that are not the carrier's, beside the same window and carrier in
//! floating point.
//!
//! ```text
//! h[n] = w_i[n] − j·w_q[n],   H(f) = Σ h[n] e^(2πj f n),   response(f) = (|H(f)| + |H(−f)|) / (|H(f_c)| + |H(−f_c)|)
//! ```
//!
//! w_i and w_q are what a code adds to the core's sums, found by giving it one; the response is
//! that of the worst phase, relative to a tone on the carrier f_c. Reserve: how many times larger
//! than the carrier's a tone may be that moves the force by 1 %, its amplitude by half of that.

use hapticore_contract::calibration::{Calibration, ForceTable, Point, PositionTable};
use hapticore_contract::profile::Profile;
use hapticore_model::fidelity::fixed::FixedSimulation;
use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;

/// Parts of a bin (one over the window) at which the response is evaluated.
const POINTS_PER_BIN: usize = 16;
/// Below this, in dB, a response is not compared with floating point.
const FLOOR: f64 = -110.0;
/// The reserve is evaluated in this range, Hz.
const RESERVE: [f64; 2] = [50.0, 20e3];
/// The amplitude of the tone whose undithered rounding is measured, in codes, and the number of its
/// phases.
const QUIET: f64 = 256.0;
const PHASES: usize = 256;
/// The bundled profiles and the sample rates of their boards.
const RATES: [(&str, f64); 4] = [("small", 500e3), ("standard", 1e6), ("fine", 1e6), ("fast", 1e6)];

/// In phase and quadrature.
type Pair = [f64; 2];

/// What is measured of a profile; all but the bias in dB.
#[derive(Debug, Clone)]
pub struct Measured {
    pub profile: Profile,
    pub rate_hz: f64,
    /// By how much the response exceeds that of floating point at most, where it is above the
    /// floor.
    pub excess: f64,
    pub excess_hz: f64,
    /// The response to a constant; none where nothing is left of it.
    pub constant: Option<f64>,
    /// The least reserve, and in floating point.
    pub reserve: f64,
    pub float_reserve: f64,
    /// How far a quiet tone's amplitude is off, relative, rms over its phases.
    pub bias: f64,
}

/// Every bundled profile.
pub fn all() -> Vec<Measured> {
    RATES.map(|(name, rate_hz)| measure(Profile::bundled(name).expect("bundled"), rate_hz)).into()
}

fn measure(profile: Profile, rate_hz: f64) -> Measured {
    let mut core = FixedSimulation::new(&profile, &calibration(&profile));
    let (fixed, float) = (windowed_carrier(&profile, &mut core), ideal(&profile));
    let carrier = profile.carrier.periods as usize * POINTS_PER_BIN;
    let [fixed_db, float_db] =
        [&fixed, &float].map(|windowed_carrier| response(windowed_carrier, carrier));
    let hz =
        |k: usize| k as f64 * rate_hz / (POINTS_PER_BIN as f64 * profile.slot.integrate as f64);
    let over = |k: usize| fixed_db[k].max(FLOOR) - float_db[k].max(FLOOR);
    let worst =
        (0..fixed_db.len()).max_by(|&a, &b| over(a).total_cmp(&over(b))).expect("frequencies");
    let band = |response: &[f64]| {
        let within = (0..response.len()).filter(|&k| (RESERVE[0]..=RESERVE[1]).contains(&hz(k)));
        20.0 * 0.005f64.log10() - within.map(|k| response[k]).fold(f64::NEG_INFINITY, f64::max)
    };
    Measured {
        rate_hz,
        excess: over(worst),
        excess_hz: hz(worst),
        constant: constant(&profile, &mut core, &fixed),
        reserve: band(&fixed_db),
        float_reserve: band(&float_db),
        bias: bias(&profile, &mut core, &fixed),
        profile,
    }
}

/// The sums of the first channel but for what they are of silence.
fn sums(
    profile: &Profile,
    core: &mut FixedSimulation,
    code: impl Fn(usize, usize) -> i32,
) -> Vec<Pair> {
    let channels = profile.channels();
    let codes: Vec<i32> = (0..profile.slot.integrate as usize * channels)
        .map(|k| code(k / channels, k % channels))
        .collect();
    core.sums(&codes)[..2 * (channels - 1)].chunks(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// The response to a constant of a third of full scale, in dB; none where not a bit of it is left.
fn constant(
    profile: &Profile,
    core: &mut FixedSimulation,
    windowed_carrier: &[Pair],
) -> Option<f64> {
    let code = profile.formats.adc.max_code() as i32 / 3;
    let silence = sums(profile, core, |_, _| 0)[0];
    let read = sums(profile, core, |_, _| code)[0];
    let left = (read[0] - silence[0]).hypot(read[1] - silence[1]) / f64::from(code);
    let carrier = amplitude(windowed_carrier, profile.carrier.periods as usize * POINTS_PER_BIN);
    (left > 0.0).then(|| 20.0 * (2.0 * left / carrier).log10())
}

/// What a code of one adds to the sums, by the sample where it is: an impulse in each channel at a
/// sample of its own.
fn windowed_carrier(profile: &Profile, core: &mut FixedSimulation) -> Vec<Pair> {
    let (samples, channels) = (profile.slot.integrate as usize, profile.channels() - 1);
    let impulse = 1i32 << (profile.formats.adc.width - 2);
    let silence = sums(profile, core, |_, _| 0)[0];
    let mut windowed_carrier = Vec::new();
    for first in (0..samples).step_by(channels) {
        let of = sums(profile, core, |n, channel| {
            if channel < channels && n == first + channel { impulse } else { 0 }
        });
        windowed_carrier.extend(
            of.iter()
                .map(|sum| [0, 1].map(|part| (sum[part] - silence[part]) / f64::from(impulse))),
        );
    }
    windowed_carrier.truncate(samples);
    windowed_carrier
}

/// The Hann window and the carrier, in floating point.
fn ideal(profile: &Profile) -> Vec<Pair> {
    let (samples, periods) = (profile.slot.integrate, profile.carrier.periods);
    let window = |m: u64| (PI * m as f64 / samples as f64).sin().powi(2);
    let phase =
        |m: u64| TAU * ((profile.slot.blanking() + m) * periods % samples) as f64 / samples as f64;
    (0..samples).map(|m| [window(m) * phase(m).cos(), window(m) * phase(m).sin()]).collect()
}

/// The response from zero to half the sample rate, in dB of that at `carrier`.
fn response(windowed_carrier: &[Pair], carrier: usize) -> Vec<f64> {
    let one = amplitude(windowed_carrier, carrier);
    let half = POINTS_PER_BIN * windowed_carrier.len() / 2;
    (0..=half).map(|k| 20.0 * (amplitude(windowed_carrier, k) / one).max(1e-15).log10()).collect()
}

/// |H(f)| + |H(−f)| at a frequency in parts of a bin.
fn amplitude(windowed_carrier: &[Pair], frequency: usize) -> f64 {
    let turn = POINTS_PER_BIN * windowed_carrier.len();
    let (step, mut of) = (TAU / turn as f64, [0.0; 4]);
    // Of both w_i and w_q the sums with cosine and sine; H(±f) are made of these four.
    for (n, [i, q]) in windowed_carrier.iter().enumerate() {
        let (sine, cosine) = (step * (frequency * n % turn) as f64).sin_cos();
        of = [of[0] + i * cosine, of[1] + i * sine, of[2] + q * cosine, of[3] + q * sine];
    }
    let [ic, is, qc, qs] = of;
    (ic + qs).hypot(is - qc) + (ic - qs).hypot(is + qc)
}

/// How far the amplitude of a tone on the carrier is off that is not dithered, rms over phases.
fn bias(profile: &Profile, core: &mut FixedSimulation, windowed_carrier: &[Pair]) -> f64 {
    let (first, channels) = (profile.slot.blanking(), profile.channels());
    let turn = profile.turns_per_sample();
    let wave =
        |n: usize, phase: f64| QUIET * (TAU * ((first + n as u64) as f64 * turn - phase)).cos();
    let silence = sums(profile, core, |_, _| 0)[0];
    let mut squares = 0.0;
    for block in 0..PHASES / (channels - 1) {
        let phase = |channel: usize| (block * (channels - 1) + channel) as f64 / PHASES as f64;
        let read = sums(profile, core, |n, channel| wave(n, phase(channel)).round() as i32);
        for (channel, sum) in read.iter().enumerate() {
            let exact = windowed_carrier.iter().enumerate().fold([0.0; 2], |sum, (n, window)| {
                [0, 1].map(|part| sum[part] + window[part] * wave(n, phase(channel)))
            });
            let amplitude = (sum[0] - silence[0]).hypot(sum[1] - silence[1]);
            squares += (amplitude / exact[0].hypot(exact[1]) - 1.0).powi(2);
        }
    }
    (squares / (PHASES / (channels - 1) * (channels - 1)) as f64).sqrt()
}

/// Any: the sums do not depend on it.
fn calibration(profile: &Profile) -> Calibration {
    let points: Vec<_> = (0..121)
        .map(|k| (f64::from(k % 11) - 5.0, f64::from(k / 11) - 5.0))
        .map(|(i, j)| Point { x: i * 80.0, y: j * 40.0, r_x: i / 6.0, r_y: j / 6.0, sheet: 0.0 })
        .collect();
    Calibration {
        position: PositionTable::fit(profile, &points).expect("a raster"),
        capacitance_gain: 796.0,
        force_gain: 1e-6,
        contact_capacitance: 0.0,
        force_table: ForceTable::default(),
    }
}

/// Text of docs/lock-in.md.
pub fn document(measured: &[Measured]) -> String {
    let mut text = String::from(
        "# The lock-in, measured\n\n\
         Generated by `cargo bench -p hapticore-model --bench lock_in > docs/lock-in.md`; a test keeps it fresh. It compares how\n\
         `fixed` and floating point with the same Hann window and carrier respond to tones off the carrier, found from impulses\n\
         at each sample of the window. Response: to a tone of the worst phase, relative to one on the carrier, at every 1/16 bin\n\
         (1/16 of the inverse window length) from 0 to half the sample rate. Reserve: amplitude of a tone relative to the carrier's\n\
         that changes the force by 1 %; the smallest value from 50 Hz to 20 kHz. Bias: error of the amplitude of a tone of 256\n\
         codes without dither, in the sums, RMS over phases.\n\n\
         | profile | carrier, kHz | largest excess of the response over floating point, above −110 dB | at, kHz | response to a constant | reserve | reserve in floating point | bias |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for m in measured {
        let carrier = m.profile.turns_per_sample() * m.rate_hz / 1e3;
        let constant = m.constant.map_or("nothing".into(), |db| format!("{db:.1} dB"));
        writeln!(
            text,
            "| {} | {carrier:.0} | {:.1} dB | {:.1} | {constant} | {:.1} dB | {:.1} dB | {:.4} % |",
            m.profile.name,
            m.excess,
            m.excess_hz / 1e3,
            m.reserve,
            m.float_reserve,
            100.0 * m.bias
        )
        .expect("a string grows");
    }
    text
}
