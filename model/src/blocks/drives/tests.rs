// SPDX-License-Identifier: MIT OR Apache-2.0
//! Drives: which words of a frame are places, what is taken with the estimate, signs of life.

use super::{Drives, Inputs};
use crate::blocks::core::{self, Core};
use crate::blocks::estimator::{FramePort, PromptPort};
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

/// y by the number before the part's.
#[test]
fn places_are_x_and_y_of_valid_frames_of_a_pad_s_last_part() {
    for wall in WALLS {
        let profile = profile(Law::Inverse, wall);
        let (block, formats) = with_core(&profile);
        for (index, field) in (0..).zip(Field::ALL) {
            for case in 0..8 * profile.pads as i64 {
                let (pad, [valid, invalid, lifted]) = (case / 8, [1, 2, 4].map(|of| case / of % 2));
                let flags = FramePort { invalid, lifted, ..FramePort::of(0) };
                let frame = FramePort { pad, valid, index, frame: 5, ..flags };
                let frame = FramePort::zip(frame, formats.frames);
                let frame = FramePort::map(frame, |(value, format)| Signal { value, format });
                let (placed, number, place) = block.place(&frame);
                let of_place = matches!(field, Field::X | Field::Y);
                let is_last = pad % parts(wall) as i64 == parts(wall) as i64 - 1;
                let counts = of_place && is_last && wall.is_some();
                let expected = counts && valid == 1 && invalid == 0 && lifted == 0;
                assert_eq!(placed.value, i64::from(expected), "{field:?} of pad {pad}, {case}");
                if expected {
                    let of_y = i64::from(matches!(field, Field::Y));
                    assert_eq!((number.value, place.value), (pad - of_y, 5), "{field:?}");
                }
            }
        }
    }
}

/// Settings that are anything, with drives on; the target's and the curve's ports are quiet.
fn settings(formats: &Inputs<Format>, random: &mut Random, quiet: Inputs<i64>) -> Inputs<i64> {
    let any = <Inputs as Bundle>::map(*formats, |format| match format.is_none() {
        true => 0,
        false => random.word(format),
    });
    let mut inputs = quiet;
    inputs.tuning = any.tuning;
    (inputs.tuning.curve_write, inputs.tuning.enable) = (0, 1);
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
        twins.both(Inputs { tick: 1, ..Inputs::of(0) });
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

/// Gains, limits, and what walls are made of, are those of the clock in which the estimate comes.
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
                if wall.is_some() {
                    twins.both(Inputs { placed: 1, placed_pad: last - 1, ..Inputs::of(0) });
                }
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
    profile.control = Some(Control { silent_ms: 3, ..profile.control.unwrap() });
    let silent = |alive: i64, target_write: i64| {
        let mut bench = Bench::new(with_core(&profile).0);
        let mut faults = 0;
        for _ in 0..5 {
            let mut inputs = Inputs::of(0);
            (inputs.target.alive, inputs.target.target_write) = (alive, target_write);
            bench.clock(inputs);
            for tick in [1, 0] {
                faults |= bench.clock(Inputs { tick, ..Inputs::of(0) }).faults.silence_fault;
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
        let begins = words as u64;
        for clock in 0..begins + 8 * apart {
            let mut inputs = <Inputs as Bundle>::map(formats, |format| match format.width {
                0 => 0,
                1 => i64::from(random.below(40) == 0),
                _ => random.word(format),
            });
            inputs.tuning.curve_address %= words;
            if clock < begins {
                (inputs.tuning.curve_write, inputs.tuning.curve_address) = (1, clock as i64);
            }
            inputs.tuning.enable = i64::from(random.below(400) != 0);
            inputs.clear &= i64::from(random.below(10) == 0);
            inputs.drives_clear &= i64::from(random.below(10) == 0);
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

/// Drives of two pads whose curve is 0.9 everywhere but at zero, tuned and on, time begun, and words of 1 N as targets.
struct Driven {
    bench: Bench<Drives>,
    on: Inputs<i64>,
    parts: u64,
}

impl Driven {
    fn new(wall: Option<profile::Wall>) -> Self {
        let profile = profile(Law::Open, wall);
        let bench = Bench::new(with_core(&profile).0);
        let mut driven = Driven { bench, on: Inputs::of(0), parts: parts(wall) };
        driven.begin();
        driven
    }

    /// What a host does after a reset, but for the targets.
    fn begin(&mut self) {
        let formats = self.bench.block.inputs().tuning;
        let mut on = Inputs::of(0);
        on.tuning.enable = 1;
        (on.tuning.rail, on.tuning.slew) =
            (formats.rail.max_code() as i64, formats.slew.max_code() as i64);
        on.tuning.force_cap = formats.force_cap.max_code() as i64;
        for address in 0..self.bench.block.words_of_curve() as i64 {
            let mut write = on;
            (write.tuning.curve_write, write.tuning.curve_address) = (1, address);
            let word = formats.curve_word.code_saturating(0.9);
            write.tuning.curve_word = if address == 0 { 0 } else { word };
            self.bench.clock(write);
        }
        self.bench.clock(Inputs { tick: 1, ..on });
        self.on = on;
    }

    fn target(&mut self, pad: u64, clear: i64) {
        let format = self.bench.block.inputs().target.target_word;
        let mut told = Inputs { clear, ..self.on };
        let last = (pad + 1) * self.parts - 1;
        (told.target.target_write, told.target.target_pad) = (1, last as i64);
        told.target.target_word = format.code_saturating(1.0);
        self.bench.clock(told);
    }

    /// The drive word after a pad's estimates; `late` has the inputs of each clock from the last one on.
    fn frame_with(&mut self, pad: u64, late: impl Fn(u64) -> Inputs<i64>) -> i64 {
        let mut drive = None;
        for part in 0..self.parts {
            let mut estimate = self.on;
            estimate.estimate.prompt = 1;
            estimate.estimate.prompt_pad = (pad * self.parts + part) as i64;
            self.bench.clock(estimate);
            let last = part + 1 == self.parts;
            for clock in 1..=self.bench.block.latency() {
                let mut inputs = if last { late(clock) } else { self.on };
                inputs.estimate = PromptPort { prompt: 0, ..estimate.estimate };
                let out = self.bench.clock(inputs);
                drive = drive.or((out.drive.drive_valid == 1).then_some(out.drive.drive));
            }
        }
        drive.expect("a drive word")
    }

    fn frame(&mut self, pad: u64) -> i64 {
        let on = self.on;
        self.frame_with(pad, |_| on)
    }

    fn both(&mut self) -> [bool; 2] {
        [0, 1].map(|pad| self.frame(pad) > 0)
    }
}

/// A pad without a target of now is at zero, whatever the memory holds.
#[test]
fn targets_are_forgotten_with_a_reset_and_with_clear() {
    for wall in WALLS {
        let mut driven = Driven::new(wall);
        assert_eq!(driven.both(), [false; 2], "none is written");
        (0..2).for_each(|pad| driven.target(pad, 0));
        assert_eq!(driven.both(), [true; 2], "both are");
        driven.bench.press_reset();
        driven.begin();
        driven.target(1, 0);
        assert_eq!(driven.both(), [false, true], "after a reset one is");
        driven.bench.clock(Inputs { clear: 1, ..driven.on });
        assert_eq!(driven.both(), [false; 2], "after a clear none is");
        // As the host of a board does: it writes while nothing is enabled.
        driven.bench.clock(Inputs { clear: 1, ..driven.on });
        driven.target(0, 1);
        driven.bench.clock(Inputs { clear: 1, ..driven.on });
        assert_eq!(driven.both(), [true, false], "what is written while it is cleared counts");
    }
}

/// What stops drives: a name, and the inputs that do.
type Stop = (&'static str, fn(&mut Inputs<i64>));

#[test]
fn what_stops_drives_acts_in_any_clock_of_a_drive_word() {
    let stops: [Stop; 3] = [
        ("clear", |inputs| inputs.clear = 1),
        ("drives_clear", |inputs| inputs.drives_clear = 1),
        ("disabled", |inputs| inputs.tuning.enable = 0),
    ];
    for wall in [None, Some(profile::Wall::B)] {
        let mut driven = Driven::new(wall);
        let latency = driven.bench.block.latency();
        // With walls the drive word is begun later.
        for at in (latency - driven.bench.block.controller.latency() + 1..=latency).step_by(7) {
            for (name, stop) in stops {
                driven.target(0, 0);
                driven.on.tuning.slew = driven.bench.block.inputs().tuning.slew.max_code() as i64;
                assert!(driven.frame(0) > 0, "{name}, clock {at}: driven before");
                driven.on.tuning.slew = 0;
                let on = driven.on;
                let pulse = |clock: u64| {
                    let mut inputs = on;
                    if clock == at {
                        stop(&mut inputs);
                    }
                    inputs
                };
                assert_eq!(driven.frame_with(0, pulse), 0, "{name} in clock {at}");
                driven.target(0, 0);
                assert_eq!(driven.frame(0), 0, "{name} in clock {at}: from zero, with no slew");
            }
        }
    }
}

/// What stales takes the drive, not what the host has asked for: the drive comes back by itself, from zero.
#[test]
fn targets_outlive_drives_clear() {
    let mut driven = Driven::new(None);
    driven.target(0, 0);
    assert!(driven.frame(0) > 0);
    driven.on.tuning.slew = 100;
    driven.bench.clock(Inputs { drives_clear: 1, ..driven.on });
    assert_eq!([0; 3].map(|pad| driven.frame(pad)), [100, 200, 300]);
}
