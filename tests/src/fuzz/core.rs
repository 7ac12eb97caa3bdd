// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core of a random legal profile, on random codes: `clock` = `fixed` = rounded reference.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use arbitrary::{Result, Unstructured};
use fastrand::Rng;
use hapticore_contract::calibration::{Calibration, ForceTable, Point, PositionTable};
use hapticore_contract::format::Format;
use hapticore_contract::frame::Frame;
use hapticore_contract::profile::{ForceLaw, Method, Profile, Window};
use hapticore_model::fidelity::clock::ClockSimulation;
use hapticore_model::fidelity::fixed::FixedSimulation;
use hapticore_reference::rounded::Slots;

use super::{Planted, planted};
use crate::stimulus::corner;

static BUNDLED: LazyLock<Vec<Profile>> = LazyLock::new(Profile::of_distinct_words);

pub(super) fn check(data: &[u8]) -> bool {
    let mut choices = Unstructured::new(data);
    let Ok(Some(profile)) = profile(&mut choices) else { return false };
    let Ok(Some(calibration)) = calibration(&profile, &mut choices) else { return false };
    let slots = choices.int_in_range(1..=3).unwrap_or(1);
    let mut reference = Slots::new(&profile, &calibration);
    let mut fixed: FixedSimulation = FixedSimulation::new(&profile, &calibration);
    let mut clock = ClockSimulation::new(&profile, &calibration);
    for slot in 0..slots {
        let Ok(codes) = codes(&profile, &mut choices) else { return false };
        let pad = slot % profile.pads as usize;
        let window = &codes[profile.slot.blanking() as usize * profile.channels()..];
        let expected = reference.slot(pad, window);
        assert_eq!(fixed.slot(pad, window), expected, "fixed, reference: {profile:?}");
        clock.samples(&codes);
        let frame = clock.finish_slot().map(misrounded);
        assert_eq!(frame, Some(expected), "clock, reference: {profile:?}");
    }
    true
}

/// A bundled profile with other words, counts and terminals, of a slot as short as can be; none
/// where no core can be built of it.
fn profile(choices: &mut Unstructured) -> Result<Option<Profile>> {
    let mut profile = choices.choose(&BUNDLED)?.clone();
    terminals(&mut profile, choices)?;
    words(&mut profile, choices)?;
    profile.pads = choices.int_in_range(1..=3)?;
    profile.position.steps = choices.int_in_range(1..=4)?;
    profile.haptic.windows = 1 << choices.int_in_range(0..=2)?;
    profile.capacitance.sheet_correction = choices.ratio(3, 4)?;
    profile.carrier.window = *choices.choose(&[Window::Hann, Window::Rectangular])?;
    if choices.ratio(1, 3)? {
        profile.force.law = ForceLaw::Table;
    }
    profile.slot.open = choices.int_in_range(1..=3)?;
    let unit = if profile.carrier.method == Method::Polyphase { 5 } else { 4 };
    let samples = unit * choices.int_in_range(2..=8)?;
    profile = profile.with_window(samples);
    if profile.carrier.method == Method::Products {
        profile.carrier.periods = profile.carrier.periods.clamp(2, samples / 3);
    }
    Ok(shortest(profile))
}

fn terminals(profile: &mut Profile, choices: &mut Unstructured) -> Result<()> {
    if choices.ratio(1, 2)? {
        let count = choices.int_in_range(3..=8)?;
        let mut signs = || (0..count).map(|_| choices.int_in_range(-1..=1)).collect::<Result<_>>();
        let (mut x, mut y): (Vec<i8>, Vec<i8>) = (signs()?, signs()?);
        // Both signs in both, and not the same ones: what a profile asks for.
        x[..2].copy_from_slice(&[1, -1]);
        y[1..3].copy_from_slice(&[1, -1]);
        (profile.terminals.x, profile.terminals.y) = (x, y);
    }
    let least = profile.least_clocks_per_sample();
    profile.clocks_per_sample = least + choices.int_in_range(0..=4)?;
    Ok(())
}

/// Longer or shorter words.
fn words(profile: &mut Profile, choices: &mut Unstructured) -> Result<()> {
    let f = &mut profile.formats;
    let mut by = |formats: &mut [&mut Format], least: i8, most: i8| -> Result<()> {
        let change = if choices.ratio(1, 8)? { choices.int_in_range(least..=most)? } else { 0 };
        for format in formats {
            format.frac = format.frac.saturating_add(change);
            format.width = format.width.saturating_add_signed(change);
        }
        Ok(())
    };
    if profile.carrier.method == Method::Products {
        by(&mut [&mut f.adc], -8, 4)?;
    }
    by(&mut [&mut f.oscillator], -6, 4)?;
    by(&mut [&mut f.ratio], -5, 4)?;
    by(&mut [&mut f.table, &mut f.position], -4, 2)?;
    by(&mut [&mut f.position], 0, 6)?;
    by(&mut [&mut f.admittance], -8, 6)?;
    by(&mut [&mut f.capacitance], -8, 6)?;
    by(&mut [&mut f.mean_square], -8, 6)?;
    by(&mut [&mut f.square], -8, 6)?;
    by(&mut [&mut f.force], -8, 6)?;
    by(&mut [&mut f.capacitance_gain], -6, 6)?;
    by(&mut [&mut f.force_gain], -6, 6)?;
    by(&mut [&mut f.iq, &mut f.total], -6, 4)?;
    // Of a multiple of four no word of carrier or window lies half way between two codes at 60°.
    profile.carrier.amplitude = f.oscillator.max_code() as u64 & !3;
    Ok(())
}

/// The profile with the least time to settle in which the estimate before is finished.
fn shortest(profile: Profile) -> Option<Profile> {
    let with_settle = |periods: u64| {
        let mut profile = profile.clone();
        // A whole number of periods of five samples before the window.
        profile.slot.settle = 5 * periods - profile.slot.open;
        hapticore_model::check(&profile).is_ok().then_some(profile)
    };
    let longest =
        (1..=11).map(|power| 1 << power).find(|periods| with_settle(*periods).is_some())?;
    let (mut low, mut high) = (longest / 2, longest);
    while high - low > 1 {
        let middle = (low + high) / 2;
        if with_settle(middle).is_some() { high = middle } else { low = middle }
    }
    with_settle(high)
}

/// A calibration such as a sheet has, with gains of any size; none where a word cannot hold it.
fn calibration(profile: &Profile, choices: &mut Unstructured) -> Result<Option<Calibration>> {
    let mut share =
        || -> Result<f64> { Ok(f64::from(choices.arbitrary::<u16>()?) / f64::from(u16::MAX)) };
    let bend = 0.5 + share()?;
    let point = |k: usize| {
        let (u, v) = ((k % 9) as f64 / 4.0 - 1.0, (k / 9) as f64 / 2.0 - 1.0);
        let r_x = 0.78 * (bend * u).sin() / bend.sin() * (1.0 - 0.15 * v * v);
        Point {
            x: 400.0 * u,
            y: 220.0 * v,
            r_x,
            r_y: 0.7 * v * (1.0 - 0.3 * u * u),
            sheet: 0.05 + 0.02 * u * u,
        }
    };
    let points: Vec<_> = (0..45).map(point).collect();
    let Ok(position) = PositionTable::fit(profile, &points) else { return Ok(None) };
    let row = |n: usize| [0.9 + 0.02 * n as f64, 0.3 - 0.05 * n as f64, 0.1 * n as f64 - 0.4];
    let calibration = Calibration {
        position: position.with_open_share(0.05 * share()?),
        capacitance_gain: 1000.0 * share()?,
        force_gain: 4e-6 * share()?,
        force_table: ForceTable {
            rows: std::array::from_fn(row),
            recent: 0.5 * share()?,
            mean: 0.02 * share()?,
            release: 0.1 * share()?,
        },
    };
    Ok(calibration.check(profile).is_ok().then_some(calibration))
}

/// The codes of a slot, a sample after the other: of each channel nothing, a tone, corners, a
/// constant, or what the input says.
fn codes(profile: &Profile, choices: &mut Unstructured) -> Result<Vec<i32>> {
    let (adc, samples) = (profile.formats.adc, profile.slot.samples());
    let mut channels = Vec::new();
    for _ in 0..profile.channels() {
        let level = f64::from(choices.arbitrary::<u8>()?) / 128.0;
        let mut rng = Rng::with_seed(choices.arbitrary::<u16>()?.into());
        let turns = |n: u64| n as f64 * profile.turns_per_sample();
        let channel: Vec<i64> = match choices.int_in_range(0..=7)? {
            0 => vec![0; samples as usize],
            1 => (0..samples).map(|_| corner(&mut rng, adc)).collect(),
            2 => vec![adc.code_saturating(level - 1.0); samples as usize],
            3 => {
                let given = choices.bytes(16.min(choices.len()))?;
                let fraction = |n: u64| match given {
                    [] => 0.0,
                    given => f64::from(given[n as usize % given.len()] as i8) / 128.0,
                };
                (0..samples).map(|n| adc.code_saturating(fraction(n))).collect()
            }
            _ => {
                let phase = rng.f64();
                (0..samples)
                    .map(|n| adc.code_saturating(level * (TAU * (turns(n) + phase)).cos()))
                    .collect()
            }
        };
        channels.push(channel);
    }
    let sample = |n: u64| channels.iter().map(move |channel| channel[n as usize] as i32);
    Ok((0..samples).flat_map(sample).collect())
}

/// The planted rounding: a result that ends in these bits is one less.
fn misrounded(mut frame: Frame) -> Frame {
    let capacitance = &mut frame.codes[5];
    if planted(Planted::Core) && *capacitance & 0x3f == 0x2a && !frame.flags.clipped {
        *capacitance -= 1;
    }
    frame
}
