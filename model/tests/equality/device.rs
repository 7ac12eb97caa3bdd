// SPDX-License-Identifier: MIT OR Apache-2.0
//! A device to calibrate with, and what its ADC could see.

use super::random::Random;
use hapticore_contract::calibration::{Calibration, ForceTable, Point, PositionTable};
use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::{ForceLaw, Method, Profile};
use std::f64::consts::TAU;

/// Bundled profiles of all words, their slots cut to a few samples so that slots pass quickly.
pub fn short_profiles() -> Vec<Profile> {
    Profile::of_distinct_words().into_iter().map(shortened).collect()
}

/// The same with a force table.
pub fn short_table_profiles() -> Vec<Profile> {
    let with_table = |mut profile: Profile| {
        profile.force.law = ForceLaw::Table;
        shortened(profile)
    };
    Profile::of_distinct_words().into_iter().map(with_table).collect()
}

fn shortened(mut profile: Profile) -> Profile {
    // The program's loop is the same, however often it is run through.
    profile.position.steps = 4;
    profile.slot.open = 2;
    let samples = 4 * profile.samples_per_period().round() as u64;
    let with_settle = |settle: u64| {
        let mut profile = profile.clone();
        profile.slot.settle = settle;
        let profile = profile.with_window(samples);
        hapticore_model::check(&profile).is_ok().then_some(profile)
    };
    (0..1000)
        .find_map(|periods| with_settle(98 + 5 * periods))
        .expect("a slot longer than the estimator takes")
}

/// The short profiles with windows as long as an estimate takes to finish, to a few samples, before the next sums come.
/// The estimate begins while the next slot is blanked and ends within its window.
pub fn overlapping_profiles() -> Vec<Profile> {
    let overlapping = |profile: Profile| {
        let unit = if profile.carrier.method == Method::Polyphase { 5 } else { 4 };
        // Of the same point in a period of five samples; longer than the read-out and a drive word.
        let settle = 98 + unit * 4;
        let with_window = |units: u64| {
            let mut profile = profile.clone();
            profile.slot.settle = settle;
            let profile = profile.with_window(unit * units);
            hapticore_model::check(&profile).is_ok().then_some(profile)
        };
        let profile = (10..1000).find_map(with_window).expect("a slot longer than the estimate");
        assert!(profile.slot.integrate > 50, "{}: the estimate ends within a window", profile.name);
        profile
    };
    let laws = [None, Some(Law::Inverse)];
    let both = short_profiles().into_iter().chain(short_table_profiles());
    let with = |profile: Profile| {
        laws.map(|law| Profile {
            control: law.map(|law| Control::of(&profile, law)),
            ..profile.clone()
        })
    };
    both.flat_map(with).map(overlapping).collect()
}

/// A calibration such as a sheet has: ratios that saturate towards its edges.
pub fn calibration(profile: &Profile) -> Calibration {
    let (columns, rows) = (41, 25);
    let point = |k: usize| {
        let (u, v) = ((k % columns) as f64 / 20.0 - 1.0, (k / columns) as f64 / 12.0 - 1.0);
        let r_x = 0.78 * (1.3 * u).sin() / 1.3f64.sin() * (1.0 - 0.15 * v * v);
        let r_y = 0.7 * (1.2 * v).sin() / 1.2f64.sin() * (1.0 - 0.3 * u * u);
        Point { x: 400.0 * u, y: 220.0 * v, r_x, r_y, sheet: 0.05 + 0.02 * u * u + 0.01 * v }
    };
    let points: Vec<Point> = (0..columns * rows).map(point).collect();
    let calibration = Calibration {
        position: PositionTable::fit(profile, &points).expect("a raster").with_open_share(0.01),
        capacitance_gain: 800.0,
        force_gain: 2e-6,
        contact_capacitance: 100.0,
        force_table: force_table(),
    };
    calibration.check(profile).expect("a calibration within its formats");
    calibration
}

/// A force table such as a device has: the factor rises with the capacitance, more where the voltage
/// has been there for long.
fn force_table() -> ForceTable {
    let row = |row: usize| {
        let row = row as f64;
        [0.9 + 0.02 * row * row, 0.3 - 0.05 * row, 0.1 * row - 0.4]
    };
    ForceTable { rows: std::array::from_fn(row), recent: 0.5, mean: 0.011, release: 0.05 }
}

/// The tones of a slot: amplitudes and phases (turns) of the terminals and the sensing voltage, and
/// the haptic amplitude.
#[derive(Debug, Clone)]
pub struct Tones {
    pub phasors: Vec<(f64, f64)>,
    pub haptic: f64,
}

/// What the ADC may see.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sight {
    /// Nothing at all.
    Silence,
    /// Uniformly distributed codes.
    Noise,
    /// A few codes about zero.
    Whisper,
    /// Codes at full scale.
    FullScale,
    /// Tones as a pad on the sheet causes them.
    Tones,
    /// A pad, one terminal's wire broken.
    Broken,
    /// Currents, but no sensing voltage.
    NoVoltage,
    /// A pad that does not touch: a hundredth to a tenth of its currents.
    Lifted,
}

impl Sight {
    pub const ALL: [Sight; 8] = [
        Sight::Tones,
        Sight::Silence,
        Sight::Noise,
        Sight::Broken,
        Sight::NoVoltage,
        Sight::Whisper,
        Sight::FullScale,
        Sight::Lifted,
    ];
}

/// A pad somewhere on the sheet.
pub fn tones(profile: &Profile, random: &mut Random) -> Tones {
    let terminals = profile.terminals.x.len();
    let phase = random.unit();
    let current =
        |random: &mut Random| (random.between(0.04, 0.14), phase + random.between(-0.02, 0.02));
    let mut phasors: Vec<_> = (0..terminals).map(|_| current(random)).collect();
    phasors.push((random.between(0.7, 0.9), random.unit()));
    Tones { phasors, haptic: random.between(0.1, 0.9) }
}

/// The codes of a sample with these tones; `n` counts from the first of the slot.
pub fn tone_codes(profile: &Profile, tones: &Tones, n: u64) -> Vec<i32> {
    let full = f64::from(1 << (profile.formats.adc.width - 1));
    let turns = n as f64 * profile.turns_per_sample();
    let code = |&(amplitude, phase): &(f64, f64)| full * amplitude * (TAU * (turns - phase)).cos();
    let haptic = full * tones.haptic * (TAU * n as f64 / 5000.0).cos();
    tones.phasors.iter().map(code).chain([haptic]).map(|x| x.round() as i32).collect()
}

/// The codes of a whole slot, a sample after the other.
pub fn codes(profile: &Profile, sight: Sight, random: &mut Random) -> Vec<i32> {
    let adc = profile.formats.adc;
    let half = 1i32 << (adc.width - 1);
    let channels = profile.channels();
    let mut tones = tones(profile, random);
    match sight {
        Sight::Broken => {
            tones.phasors[random.below(profile.terminals.x.len() as u64) as usize].0 = 0.0
        }
        Sight::NoVoltage => tones.phasors.last_mut().expect("there are channels").0 = 0.0,
        Sight::Lifted => {
            let share = random.between(0.01, 0.1);
            let (_, terminals) = tones.phasors.split_last_mut().expect("there are channels");
            terminals.iter_mut().for_each(|(amplitude, _)| *amplitude *= share);
        }
        _ => (),
    }
    let sample = |n: u64| match sight {
        Sight::Silence => vec![0; channels],
        Sight::Noise => (0..channels).map(|_| random.word(adc) as i32).collect(),
        Sight::Whisper => (0..channels).map(|_| random.below(5) as i32 - 2).collect(),
        Sight::FullScale => (0..channels)
            .map(|k| if (n + k as u64).is_multiple_of(3) { -half } else { half - 1 })
            .collect(),
        _ => tone_codes(profile, &tones, n),
    };
    (0..profile.slot.samples()).flat_map(sample).collect()
}
