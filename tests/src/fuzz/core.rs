// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core of a random legal profile, on random codes: `clock` = `fixed` = rounded reference.

mod codes;
mod table;

use std::sync::LazyLock;

use arbitrary::{Result, Unstructured};
use fastrand::Rng;
use hapticore_contract::calibration::{Calibration, ForceTable, PositionTable};
use hapticore_contract::format::Format;
use hapticore_contract::frame::{Field, Frame};
use hapticore_contract::profile::{ForceLaw, Method, Profile, Window};
use hapticore_model::blocks::core::Core;
use hapticore_model::fidelity::clock::ClockSimulation;
use hapticore_model::fidelity::fixed::FixedSimulation;
use hapticore_reference::rounded::Slots;

use super::{Planted, all_hold, planted};
use codes::codes;

static BUNDLED: LazyLock<Vec<Profile>> = LazyLock::new(Profile::of_distinct_words);

/// Any table: its words are replaced by those of the profile.
static TABLE: LazyLock<PositionTable> = LazyLock::new(table::any);

pub(super) fn check(data: &[u8]) -> bool {
    let mut choices = Unstructured::new(data);
    let Ok(Some(profile)) = profile(&mut choices) else { return false };
    let Ok(Some(calibration)) = calibration(&profile, &mut choices) else { return false };
    let slots = choices.int_in_range(1..=4).unwrap_or(1);
    let mut reference = Slots::new(&profile, &calibration);
    let mut fixed: FixedSimulation = FixedSimulation::new(&profile, &calibration);
    let mut clock = ClockSimulation::new(&profile, &calibration);
    let (mut expected, mut frames) = (Vec::new(), Vec::new());
    for slot in 0..slots {
        let Ok(codes) = codes(&profile, &mut choices) else { return false };
        let pad = slot % profile.pads as usize;
        let window = &codes[profile.slot.blanking() as usize * profile.channels()..];
        let frame = reference.slot(pad, window);
        assert_eq!(fixed.slot(pad, window), frame, "fixed, reference: {profile:?}");
        expected.push(frame);
        // Meanwhile comes the frame of the slot before, or of the one before that.
        clock.samples(&codes);
        frames.extend(clock.take_frame());
    }
    let late = (frames.len()..expected.len()).map_while(|_| clock.finish_slot());
    frames.extend(late.collect::<Vec<_>>());
    frames.iter_mut().for_each(|frame| *frame = misrounded(*frame, &profile));
    assert_eq!(frames, expected, "clock, reference: {profile:?}");
    true
}

/// A bundled profile with other words, counts and terminals, of a slot as short as can be; none
/// where no core can be built of it.
fn profile(choices: &mut Unstructured) -> Result<Option<Profile>> {
    let mut profile = choices.choose(&BUNDLED)?.clone();
    terminals(&mut profile, choices)?;
    words(&mut profile, choices)?;
    profile.pads = choices.int_in_range(1..=3)?;
    raster(&mut profile, choices)?;
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

/// Newton steps and a position table, small but in a run of 16: to write a large one takes longer than
/// all slots.
fn raster(profile: &mut Profile, choices: &mut Unstructured) -> Result<()> {
    let position = &mut profile.position;
    position.steps = choices.int_in_range(1..=4)?;
    if choices.ratio(15, 16)? {
        position.columns = 2 * choices.int_in_range(2..=7)? + 1;
        position.rows = 2 * choices.int_in_range(2..=5)? + 1;
        position.resistance_shift = choices.int_in_range(1..=3)?;
    }
    Ok(())
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
    profile.carrier.amplitude = f.oscillator.max_code() as u64;
    Ok(())
}

/// The profile with the least time to settle in which the estimate before is finished; none where no
/// core can be built of it.
fn shortest(mut profile: Profile) -> Option<Profile> {
    // A whole number of periods of five samples before the window.
    let settle = |periods: u64, open: u64| 5 * periods.max(1) - open;
    profile.slot.settle = settle(1 << 11, profile.slot.open);
    let core = Core::try_new(&profile).ok()?;
    let read_out = core.demodulator().latency();
    let frame = read_out + core.estimator().latency() - core.demodulator().first_sum();
    let samples = |clocks: u64| clocks / profile.clocks_per_sample + 1;
    let blanking = samples(read_out).max(samples(frame).saturating_sub(profile.slot.integrate));
    profile.slot.settle = settle(blanking.div_ceil(5), profile.slot.open);
    hapticore_model::check(&profile).is_ok().then_some(profile)
}

/// A calibration with gains of any size; none where a word cannot hold it.
fn calibration(profile: &Profile, choices: &mut Unstructured) -> Result<Option<Calibration>> {
    let mut share =
        || -> Result<f64> { Ok(f64::from(choices.arbitrary::<u16>()?) / f64::from(u16::MAX)) };
    let row = |n: usize| [0.9 + 0.02 * n as f64, 0.3 - 0.05 * n as f64, 0.1 * n as f64 - 0.4];
    let mut position = TABLE.clone();
    position.words = table::words(profile, 0.5 + share()?, 0.7 + 0.3 * share()?);
    let mut calibration = Calibration {
        position: position.with_open_share(0.05 * share()?),
        capacitance_gain: 1000.0 * share()?,
        force_gain: 4e-6 * share()?,
        contact_capacitance: 300.0 * share()?,
        force_table: ForceTable {
            rows: std::array::from_fn(row),
            recent: 0.5 * share()?,
            mean: 0.02 * share()?,
            release: 0.1 * share()?,
        },
    };
    if choices.ratio(1, 4)? {
        let mut rng = Rng::with_seed(choices.arbitrary::<u16>()?.into());
        table::disturb(&mut calibration.position.words, profile.formats.table, &mut rng);
    }
    Ok(calibration.check(profile).is_ok().then_some(calibration))
}

/// The planted rounding: a tie goes down where it should go up.
fn misrounded(mut frame: Frame, profile: &Profile) -> Frame {
    let capacitance = &mut frame.codes[Field::Capacitance as usize];
    let is_odd = [
        frame.pad > 0,
        profile.haptic.windows == 4,
        !frame.flags.clipped && !frame.flags.invalid,
        *capacitance & 0x3f == 0x2a,
    ];
    if planted(Planted::Core) && all_hold(&is_odd) {
        *capacitance -= 1;
    }
    frame
}
