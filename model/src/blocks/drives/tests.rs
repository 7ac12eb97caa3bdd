// SPDX-License-Identifier: MIT OR Apache-2.0
//! Drives: which words of a frame are places, what is taken with the estimate, signs of life.

use super::{Drives, Inputs};
use crate::blocks::core::{self, Core};
use crate::blocks::estimator::FramePort;
use crate::support::Bench;
use crate::support::never_skips::NeverSkips;
use crate::support::random::Random;
use hapticore_contract::control::{Control, Law};
use hapticore_contract::frame::Field;
use hapticore_contract::profile::{self, Profile, Release};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::Signal;

const WALLS: [Option<profile::Wall>; 4] =
    [None, Some(profile::Wall::A), Some(profile::Wall::B), Some(profile::Wall::QUADRANTS)];

/// Two pads in the words of `standard`, whole or split.
fn profile(law: Law, wall: Option<profile::Wall>) -> Profile {
    let mut profile = Profile::bundled("standard").expect("bundled");
    profile.control = Some(Control::of(&profile, law));
    (profile.wall, profile.pads) = (wall, 2 * parts(wall));
    profile
}

fn parts(wall: Option<profile::Wall>) -> u64 {
    wall.map_or(1, |of| of.parts)
}

/// The drives of a profile, and the formats of the core before them.
fn with_core(profile: &Profile) -> (Drives, core::Outputs<Format>) {
    let formats = Core::try_new(profile).unwrap().outputs();
    (Drives::try_new(profile, formats.prompt).unwrap(), formats)
}

#[test]
fn a_pad_has_a_drive_word_after_its_last_part() {
    for wall in WALLS {
        let (block, _) = with_core(&profile(Law::Inverse, wall));
        let parts = parts(wall) as usize;
        for pad in 0..2 * parts {
            assert_eq!(block.is_last(pad), pad % parts == parts - 1, "part {pad} of {parts}");
        }
        assert_eq!(block.has_walls_along_y(), parts == 4, "{parts} parts");
    }
}

#[test]
fn targets_have_a_word_for_every_number_of_a_pad() {
    for pads in 2..=9 {
        let profile = Profile { pads, ..profile(Law::Open, None) };
        let words = (pads as usize).next_power_of_two();
        assert_eq!(with_core(&profile).0.targets.words, words, "{pads} pads");
    }
}

/// x of every valid frame; of quadrants x and y of the last one's, y by the number before it.
#[test]
fn places_are_x_and_of_quadrants_y_of_valid_frames() {
    for wall in WALLS {
        let profile = profile(Law::Inverse, wall);
        let (block, formats) = with_core(&profile);
        let quadrants = parts(wall) == 4;
        for (index, field) in (0..).zip(Field::ALL) {
            for case in 0..4 * profile.pads as i64 {
                let (pad, valid, invalid) = (case / 4, case % 2, case / 2 % 2);
                let frame = FramePort { pad, valid, invalid, index, frame: 5, ..FramePort::of(0) };
                let frame = FramePort::zip(frame, formats.frames);
                let frame = FramePort::map(frame, |(value, format)| Signal { value, format });
                let (placed, number, place) = block.place(&frame);
                let along = matches!(field, Field::X) || quadrants && matches!(field, Field::Y);
                let counts = along && (!quadrants || pad % 4 == 3) && wall.is_some();
                let expected = counts && valid == 1 && invalid == 0;
                assert_eq!(placed.value, i64::from(expected), "{field:?} of pad {pad}, {case}");
                if expected {
                    let of_y = i64::from(matches!(field, Field::Y));
                    assert_eq!((number.value, place.value), (pad - of_y, 5), "{field:?}");
                }
            }
        }
    }
}

/// Settings that are anything, but let drives follow; the target's and the curve's ports are quiet.
fn settings(formats: &Inputs<Format>, random: &mut Random, quiet: Inputs<i64>) -> Inputs<i64> {
    let any = <Inputs as Bundle>::map(*formats, |format| match format.is_none() {
        true => 0,
        false => random.word(format),
    });
    let mut inputs = quiet;
    inputs.tuning = any.tuning;
    (inputs.tuning.curve_write, inputs.tuning.enable) = (0, i64::from(random.below(4) != 0));
    inputs.wall.wall_stiffness = any.wall.wall_stiffness;
    inputs.wall.wall_most = any.wall.wall_most;
    inputs.wall.wall_factory = any.wall.wall_factory;
    inputs
}

/// Two drives with the same curve and targets.
struct Twins([Bench<Drives>; 2]);

impl Twins {
    fn new(block: Drives, random: &mut Random) -> Self {
        let mut twins = Twins([block.clone(), block].map(Bench::new));
        let formats = twins.0[0].block.inputs();
        for address in 0..twins.0[0].block.words_of_curve() as i64 {
            let mut write = Inputs::of(0);
            (write.tuning.curve_write, write.tuning.curve_address) = (1, address);
            write.tuning.curve_word = random.word(formats.tuning.curve_word);
            twins.both(write);
        }
        twins
    }

    fn both(&mut self, inputs: Inputs<i64>) {
        for bench in &mut self.0 {
            bench.clock(inputs);
        }
    }

    /// The estimates of a pad's parts. After the last one the second has other settings in every clock:
    /// the first one's drive word and its force, and whether the second's differ.
    fn frame(&mut self, pad: u64, parts: u64, random: &mut Random) -> ((i64, i64), bool) {
        let formats = self.0[0].block.inputs();
        let mut quiet = Inputs::of(0);
        quiet.estimate.prompt_capacitance = random.word(formats.estimate.prompt_capacitance) / 2;
        // Small forces among them, at which no law lets go.
        quiet.estimate.prompt_force =
            random.word(formats.estimate.prompt_force) >> random.below(16);
        quiet.estimate.prompt_gain = random.word(formats.estimate.prompt_gain);
        let inputs = settings(&formats, random, quiet);
        for part in 0..parts {
            let mut estimate = inputs;
            estimate.estimate.prompt = 1;
            estimate.estimate.prompt_pad = (pad * parts + part) as i64;
            self.both(estimate);
            let latency = if part + 1 == parts { 0 } else { 20 };
            (0..latency).for_each(|_| self.both(inputs));
        }
        for _ in 0..self.0[0].block.latency() + 2 {
            let others = settings(&formats, random, inputs);
            let [held, changed] = &mut self.0;
            let (held, changed) = (held.clock(inputs), changed.clock(others));
            if held.drive.drive_valid == 1 || held != changed {
                return ((held.drive.drive, held.drive.drive_target), held != changed);
            }
        }
        panic!("no drive word");
    }
}

/// Gains, limits, and what walls are made of, are those of the clock in which the estimate is given.
#[test]
fn settings_after_the_estimate_change_no_drive_word() {
    let direct = |wall: profile::Wall| Some(profile::Wall { rule: Release::Direct, ..wall });
    let walls = [None, direct(profile::Wall::B), direct(profile::Wall::QUADRANTS)];
    for (seed, law) in (0..).zip(Law::ALL) {
        for wall in walls {
            let (block, _) = with_core(&profile(law, wall));
            let (mut random, mut driven) = (Random::new(seed), 0);
            let formats = block.inputs();
            let mut twins = Twins::new(block, &mut random);
            for n in 0..60 {
                let pad = n % 2;
                let mut told = Inputs::of(0);
                let last = ((pad + 1) * parts(wall) - 1) as i64;
                (told.target.target_write, told.target.target_pad) = (1, last);
                let target = random.word(formats.target.target_word);
                told.target.target_word = if random.below(2) == 0 { target } else { 0 };
                (told.target.clear_faults, told.placed, told.placed_pad) = (1, 1, last);
                told.place = if wall.is_some() { -(random.below(2000) as i64) } else { 0 };
                twins.both(told);
                let ((drive, force), differ) = twins.frame(pad, parts(wall), &mut random);
                assert!(!differ, "{law:?}, {} parts, frame {n}", parts(wall));
                driven += i64::from(drive > 0) + i64::from(force > 0);
            }
            assert!(driven > 5, "{law:?}, {} parts: {driven}", parts(wall));
        }
    }
}

#[test]
fn a_host_that_writes_targets_is_alive() {
    let mut profile = profile(Law::Open, None);
    profile.control = Some(Control { silent_frames: 3, ..profile.control.unwrap() });
    let silent = |alive: i64, target_write: i64| {
        let mut bench = Bench::new(with_core(&profile).0);
        let mut faults = 0;
        for _ in 0..5 {
            let mut inputs = Inputs::of(0);
            (inputs.target.alive, inputs.target.target_write) = (alive, target_write);
            bench.clock(inputs);
            inputs = Inputs::of(0);
            inputs.estimate.prompt = 1;
            bench.clock(inputs);
            for _ in 0..bench.block.latency() + 2 {
                faults |= bench.clock(Inputs::of(0)).faults.silence_fault;
            }
        }
        faults
    };
    assert_eq!([silent(0, 0), silent(0, 1), silent(1, 0), silent(1, 1)], [1, 0, 0, 0]);
}

#[test]
fn skipping_changes_no_bit_on_any_clock() {
    for (seed, wall) in (0..).zip(WALLS) {
        let profile = profile(Law::Inverse, wall);
        let (block, _) = with_core(&profile);
        let (formats, apart) = (block.inputs(), block.latency() + 30);
        let words = block.words_of_curve() as i64;
        let mut skips = Bench::new(block.clone());
        let mut never = Bench::<_, NeverSkips>::read(block);
        let mut random = Random::new(seed);
        let mut estimate = Inputs::of(0).estimate;
        for clock in 0..8 * apart {
            let mut inputs = <Inputs as Bundle>::map(formats, |format| match format.width {
                0 => 0,
                1 => i64::from(random.below(40) == 0),
                _ => random.word(format),
            });
            inputs.tuning.curve_address %= words;
            for pad in [
                &mut inputs.estimate.prompt_pad,
                &mut inputs.placed_pad,
                &mut inputs.target.target_pad,
                &mut inputs.wall.wall_pad,
            ] {
                *pad %= profile.pads as i64;
            }
            inputs.estimate.prompt = i64::from(clock % apart == 20);
            if inputs.estimate.prompt == 1 {
                estimate = inputs.estimate;
            }
            inputs.estimate.prompt_capacitance = estimate.prompt_capacitance;
            inputs.estimate.prompt_force = estimate.prompt_force;
            assert_eq!(skips.clock(inputs), never.clock(inputs), "clock {clock}");
            let differ: Vec<_> = skips
                .registers()
                .zip(never.registers())
                .filter(|((_, a), (_, b))| *a != b.0)
                .map(|((of, _), _)| of.name)
                .collect();
            assert_eq!(differ, Vec::<String>::new(), "clock {clock}");
        }
    }
}

/// A fault that is cleared while the host is still silent is there again with the next drive word, not before.
#[test]
fn a_silence_that_is_cleared_is_found_again_with_the_next_drive_word() {
    let mut profile = profile(Law::Inverse, None);
    profile.control.iter_mut().for_each(|control| control.silent_frames = 2);
    let mut bench = Bench::new(with_core(&profile).0);
    let mut estimate = Inputs::of(0);
    (estimate.estimate.prompt, estimate.tuning.enable) = (1, 1);
    let mut silence = |inputs: Inputs<i64>| {
        bench.clock(inputs);
        let clocks = bench.block.latency() + 2;
        (0..clocks).map(|_| bench.clock(Inputs::of(0)).faults.silence_fault).last().expect("clocks")
    };
    assert_eq!([silence(estimate), silence(estimate)], [0, 1]);
    let mut clears = Inputs::of(0);
    clears.target.clear_faults = 1;
    assert_eq!(silence(clears), 0);
    assert_eq!(silence(estimate), 1);
}
