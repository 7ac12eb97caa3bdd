// SPDX-License-Identifier: MIT OR Apache-2.0
//! The codes that a core receives in a slot.

use std::f64::consts::TAU;

use arbitrary::{Result, Unstructured};
use fastrand::Rng;
use hapticore_contract::profile::Profile;

use crate::stimulus::corner;

/// The codes of a slot, a sample after the other. In half of the slots those of a pad that is touched, as
/// else few frames are valid: the terminals' tones in step, the sensing voltage a quarter of a turn behind.
pub(super) fn codes(profile: &Profile, choices: &mut Unstructured) -> Result<Vec<i32>> {
    let (samples, sense) = (profile.slot.samples(), profile.terminals.x.len());
    let touched = choices.ratio(1, 2)?;
    let phase = f64::from(choices.arbitrary::<u8>()?) / 256.0;
    let scale = 0.5_f64.powi(choices.int_in_range(0..=6)?);
    let mut channels = Vec::new();
    for channel in 0..profile.channels() {
        channels.push(if touched && channel <= sense {
            let level = f64::from(choices.arbitrary::<u8>()?) / 256.0;
            match channel == sense {
                true => tone(profile, level, phase),
                false => tone(profile, scale * level, phase + 0.25),
            }
        } else {
            anything(profile, choices)?
        });
    }
    let sample = |n: u64| channels.iter().map(move |channel| channel[n as usize] as i32);
    Ok((0..samples).flat_map(sample).collect())
}

/// The codes of a channel: nothing, corners, a constant, what the input says, or a tone, which may clip.
fn anything(profile: &Profile, choices: &mut Unstructured) -> Result<Vec<i64>> {
    let (adc, samples) = (profile.formats.adc, profile.slot.samples());
    let level = f64::from(choices.arbitrary::<u8>()?) / 128.0;
    let mut rng = Rng::with_seed(choices.arbitrary::<u16>()?.into());
    Ok(match choices.int_in_range(0..=7)? {
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
        _ => tone(profile, level, rng.f64()),
    })
}

/// A tone of the carrier's frequency.
fn tone(profile: &Profile, level: f64, phase: f64) -> Vec<i64> {
    let turns = |n: u64| n as f64 * profile.turns_per_sample() + phase;
    let code = |n: u64| profile.formats.adc.code_saturating(level * (TAU * turns(n)).cos());
    (0..profile.slot.samples()).map(code).collect()
}
