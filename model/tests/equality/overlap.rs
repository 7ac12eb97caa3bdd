// SPDX-License-Identifier: MIT OR Apache-2.0
//! Slots so short that an estimate runs on within the next window: frames and drive words of
//! fidelities `fixed` and `clock` are those of the reference, and slots that are shorter are refused.

use crate::device::{self, Sight, calibration, overlapping_profiles};
use crate::harness::operations;
use crate::random::Random;
use hapticore_contract::control::{Drive, Law, Surface, Tuning, Walls};
use hapticore_contract::frame::Frame;
use hapticore_contract::profile::{Profile, ProfileError, Wall};
use hapticore_model::blocks::core::Core;
use hapticore_model::fidelity::clock::ClockSimulation;
use hapticore_model::fidelity::force_loop::{ClockLoop, FixedLoop};
use hapticore_reference::rounded::Slots;

/// Pads in turn, or the only one, and the codes of `count` slots.
pub fn slots(
    profile: &Profile,
    count: usize,
    seed: u64,
) -> impl Iterator<Item = (usize, Vec<i32>)> {
    let mut random = Random::new(seed);
    (0..count).map(move |slot| {
        let sight = Sight::ALL[(slot + slot / Sight::ALL.len()) % Sight::ALL.len()];
        (slot % profile.pads as usize, device::codes(profile, sight, &mut random))
    })
}

pub fn window<'a>(profile: &Profile, codes: &'a [i32]) -> &'a [i32] {
    &codes[profile.slot.blanking() as usize * profile.channels()..]
}

/// Both numbers of pads of each profile.
fn profiles() -> impl Iterator<Item = Profile> {
    overlapping_profiles()
        .into_iter()
        .flat_map(|profile| [1, 4].map(|pads| Profile { pads, ..profile.clone() }))
}

#[test]
fn frames_come_within_the_next_window_and_are_the_reference() {
    for (seed, profile) in (0..).zip(profiles()) {
        let calibration = calibration(&profile);
        let mut reference = Slots::new(&profile, &calibration);
        let mut clock = ClockSimulation::new(&profile, &calibration);
        let mut expected: Option<Frame> = None;
        for (slot, (pad, codes)) in slots(&profile, operations(150) as usize, seed).enumerate() {
            clock.samples(&codes);
            let case = format!("{}, {} pads, slot {slot}", profile.name, profile.pads);
            assert_eq!(clock.take_frame(), expected, "{case}: of the slot before");
            expected = Some(reference.slot(pad, window(&profile, &codes)));
        }
        assert_eq!(clock.finish_slot(), expected, "{}: the last", profile.name);
    }
}

/// A tuning that drives as the targets and the measured forces say.
pub fn tuning(profile: &Profile) -> Tuning {
    let cells = profile.control.as_ref().expect("a controller").cells;
    Tuning {
        curve: (0..=cells).map(|cell| 0.9 * cell as f64 / cells as f64).collect(),
        full_drive: 0.8,
        proportional: 0.1,
        correction: 0.2,
        rail: 0.95,
        slew: 0.5,
        force_cap: 4.0,
        walls: profile.wall.map(|_| Walls {
            stiffness_n_per_mm: 0.5,
            most_n: 1.0,
            factory: 0.01,
            right: false,
        }),
    }
}

/// The profiles with a controller; those for one pad also with a wall and two, three or four parts of it.
pub fn controlled() -> impl Iterator<Item = Profile> {
    profiles().filter(|profile| profile.control.is_some()).flat_map(|profile| {
        let with_wall = |wall: Wall| {
            let pads = wall.parts * profile.pads.div_ceil(wall.parts);
            Profile { wall: Some(wall), pads, ..profile.clone() }
        };
        let walls = [Wall::A, Wall::B, Wall::QUADRANTS].map(with_wall);
        let one = if profile.pads == 1 { walls.to_vec() } else { Vec::new() };
        [profile].into_iter().chain(one).collect::<Vec<_>>()
    })
}

#[test]
fn drives_and_frames_of_a_loop_are_the_same_at_fixed_and_clock() {
    let mut driven_at_walls = false;
    for (seed, mut profile) in (10..).zip(controlled()) {
        let laws = Law::ALL;
        profile.control.as_mut().expect("a controller").law = laws[seed as usize % laws.len()];
        let (calibration, tuning) = (calibration(&profile), tuning(&profile));
        let mut reference = Slots::new(&profile, &calibration);
        let mut fixed = FixedLoop::new(&profile, &calibration, &tuning).unwrap();
        let mut clock = ClockLoop::new(&profile, &calibration, &tuning).unwrap();
        let (mut frames, mut expected) = (Vec::new(), Vec::new());
        let mut drives: Vec<Drive> = Vec::new();
        let count = operations(60) as usize;
        for (slot, (pad, codes)) in slots(&profile, count, seed).enumerate() {
            let target = 0.01 * (slot % 90) as f64;
            fixed.set_target(pad, target);
            clock.set_target(pad, target);
            if profile.wall.is_some() {
                let mm = 40.0 * (slot as f64 / 7.0).sin();
                let surface = Surface { mm, right: slot % 50 > 40 };
                fixed.set_surface(pad, surface);
                clock.set_surface(pad, surface);
            }
            let codes = window(&profile, &codes);
            let (frame, drive) = fixed.slot(|core| core.slot(pad, codes));
            let (finished, of_clock) = clock.slot(codes);
            let case = format!("{}, {} pads, slot {slot}", profile.name, profile.pads);
            assert_eq!(of_clock, drive, "{case}: the drive, at once");
            assert_eq!(frame, reference.slot(pad, codes), "{case}: fixed, reference");
            expected.push(frame);
            drives.extend(drive);
            frames.extend(finished);
        }
        assert_eq!(frames.len() + 1, expected.len(), "{}: a slot later", profile.name);
        frames.extend(clock.finish());
        assert_eq!(frames, expected, "{}", profile.name);
        let drives = drives.iter().any(|drive| drive.fraction > 0.0);
        assert!(drives || profile.wall.is_some(), "{}: it drives", profile.name);
        driven_at_walls |= drives && profile.wall.is_some();
    }
    assert!(driven_at_walls, "some of the pads with walls are driven");
}

#[test]
fn a_slot_is_longer_than_its_estimate_to_a_clock() {
    for profile in overlapping_profiles() {
        let core = Core::new(&profile);
        let (demodulator, estimator) = (core.demodulator(), core.estimator());
        let least = demodulator.latency() + estimator.latency() - demodulator.first_sum();
        // Other clocks of a sample, so that slots of nearly any number of clocks can be had.
        let samples = profile.slot.samples();
        let with = |clocks_per_sample| Profile { clocks_per_sample, ..profile.clone() };
        let most = least / samples;
        assert!(hapticore_model::check(&with(most + 1)).is_ok(), "{}", profile.name);
        if most < profile.least_clocks_per_sample() {
            continue;
        }
        match hapticore_model::check(&with(most)) {
            Err(ProfileError::Value { field, expected, got }) => {
                assert_eq!(field, "slot.settle");
                assert_eq!(expected, format!("slots of more than {least} clocks"));
                assert_eq!(got, (most * samples).to_string());
            }
            Ok(()) => panic!("{}: {} clocks are too few", profile.name, most * samples),
            Err(error) => panic!("{error}"),
        }
    }
}
