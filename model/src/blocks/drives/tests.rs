// SPDX-License-Identifier: MIT OR Apache-2.0
//! Drives: which words of a frame are places, what is taken with the estimate, signs of life.

use super::{DrivePort, Drives, Inputs, Outputs};
use crate::blocks::core::{self, Core};
use crate::blocks::estimator::{FramePort, PromptPort};
use crate::support::never_skips::NeverSkips;
use crate::support::random::Random;
use crate::support::{Bench, MILLION, operations};
use hapticore_contract::control::{Control, Law};
use hapticore_contract::frame::Field;
use hapticore_contract::profile::{self, Profile, Release};
use hapticore_hdl::block::Block;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::range::{Range, take_assumptions, take_violations, whole};
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

/// The same, with controller and walls on one arithmetic unit.
fn folded(mut profile: Profile) -> Profile {
    profile.control.iter_mut().for_each(|control| control.folded = true);
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
        for (wall, is_folded) in walls.into_iter().flat_map(|wall| [(wall, false), (wall, true)]) {
            let profile = profile(law, wall);
            let profile = if is_folded { folded(profile) } else { profile };
            let (block, _) = with_core(&profile);
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
    let both = |wall| {
        let profile = profile(Law::Inverse, wall);
        [profile.clone(), folded(profile)]
    };
    for (seed, profile) in (0..).zip(WALLS.into_iter().flat_map(both)) {
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

/// Every word anywhere in its format: the programs of a unit go their one way through it.
#[test]
fn no_signal_of_folded_drives_can_overflow() {
    for (law, wall) in Law::ALL.into_iter().zip(WALLS) {
        for name in ["small", "standard"] {
            let mut profile = Profile::bundled(name).unwrap();
            profile.control = Some(Control { folded: true, ..Control::of(&profile, law) });
            (profile.wall, profile.pads) = (wall, 2 * parts(wall));
            let (block, _) = with_core(&profile);
            let mut state = block.reset::<Range>();
            let point = |code| Range::point(code);
            let (parts, apart) = (parts(wall), block.latency() + 5);
            take_violations();
            take_assumptions();
            for clock in 0..2 * parts * apart {
                let mut any = <Inputs as Bundle>::map(block.inputs(), |format| Signal {
                    value: if format.is_none() { point(0) } else { whole(format) },
                    format,
                });
                any.estimate.prompt.value = point((clock % apart == 0).into());
                any.estimate.prompt_pad.value = point((clock / apart % (2 * parts)).into());
                block.clock(&mut state, any);
            }
            assert_eq!(take_violations(), [], "{name}, {law:?}, {wall:?}");
            assert_eq!(take_assumptions(), Vec::<&str>::new());
        }
    }
}

/// Drives of either kind with the same curve, targets and places.
struct Kinds([Bench<Drives>; 2]);

impl Kinds {
    fn new(profile: &Profile) -> Self {
        let of = |profile: Profile| Bench::new(with_core(&profile).0);
        Kinds([of(profile.clone()), of(folded(profile.clone()))])
    }

    fn both(&mut self, inputs: Inputs<i64>) {
        self.0.iter_mut().for_each(|bench| _ = bench.clock(inputs));
    }

    /// The drive words that follow an estimate, each after its latency, and faults and extremes then.
    fn estimate(&mut self, inputs: Inputs<i64>) -> [Vec<Outputs<i64>>; 2] {
        let quiet = Inputs { estimate: PromptPort { prompt: 0, ..inputs.estimate }, ..inputs };
        self.0.each_mut().map(|bench| {
            let latency = bench.block.latency();
            bench.clock(inputs);
            let mut given = Vec::new();
            for clock in 1..=latency + 2 {
                let out = bench.clock(quiet);
                assert!(
                    out.drive.drive_valid == 0 || clock == latency,
                    "clock {clock} of {latency}"
                );
                let valid = out.drive.drive_valid;
                if valid == 1 || clock == latency + 2 {
                    // Without a drive word the target may be the one before, or the next.
                    let drive_target = valid * out.drive.drive_target;
                    let drive = DrivePort { drive_valid: 0, drive_target, ..out.drive };
                    given.push(Outputs { drive, ..out });
                }
            }
            given
        })
    }
}

/// To the bit, with anything as inputs: every law, pads whole and split, words of 15 to 24 bits.
#[test]
fn folded_drives_give_what_others_give() {
    let profiles = ["small", "standard"].map(|name| Profile::bundled(name).unwrap());
    let rules = WALLS.into_iter().flat_map(|wall| {
        let with = |rule| wall.map(|wall| profile::Wall { rule, ..wall });
        [wall, with(Release::Direct)]
    });
    for (seed, wall) in (0..).zip(rules) {
        for (law, of) in
            Law::ALL.into_iter().flat_map(|law| profiles.each_ref().map(|of| (law, of)))
        {
            let mut profile = of.clone();
            let control = Control { invalid_frames: 3, ..Control::of(of, law) };
            profile.control = Some(Control { silent_frames: 40, ..control });
            (profile.wall, profile.pads) = (wall, 2 * parts(wall));
            let driven = give_the_same(&profile, seed, operations(MILLION / 25_000).max(24));
            assert!(driven > 3, "{law:?}, {wall:?}: {driven} words that are not zero");
        }
    }
}

/// In words of any profile that can be: where a folded one cannot, it says so.
#[test]
fn folded_drives_in_words_at_random_give_what_others_give() {
    let (mut random, mut compared) = (Random::new(77), 0);
    for n in 0..operations(MILLION / 5000).max(100) {
        let name = ["small", "standard"][random.below(2) as usize];
        let mut profile = Profile::bundled(name).unwrap();
        let law = Law::ALL[random.below(4) as usize];
        let wall = WALLS[random.below(4) as usize];
        let mut control = Control::of(&profile, law);
        let mut words = |least: u64, most: u64, integer: u64| {
            let width = least + random.below(most - least + 1);
            Format::unsigned(width as u8, (width - integer.min(width)) as i8)
        };
        control.drive = words(8, 20, 0);
        control.target = words(8, 20, 1 + n % 4);
        control.gain = words(8, 20, 1 + n % 8);
        let f = &mut profile.formats;
        for format in [&mut f.capacitance, &mut f.force, &mut f.square, &mut f.force_gain] {
            let more = random.below(9) as i8 - 4;
            (format.width, format.frac) =
                (format.width.saturating_add_signed(more), format.frac + more);
        }
        control.cells = 4 << random.below(5);
        profile.control = Some(control);
        (profile.wall, profile.pads) = (wall, 2 * parts(wall));
        let Ok(_) = crate::check(&profile) else { continue };
        match crate::check(&folded(profile.clone())) {
            Ok(()) => _ = give_the_same(&profile, n, 6),
            Err(error) => {
                let text = error.to_string();
                assert!(text.starts_with("control.folded") || text.starts_with("slot."), "{text}");
                continue;
            }
        }
        compared += 1;
    }
    assert!(compared > 20, "{compared} profiles");
}

/// How many drive words of both kinds of drives are not zero; all are the same.
fn give_the_same(profile: &Profile, seed: u64, frames: u64) -> usize {
    let (mut kinds, mut random) = (Kinds::new(profile), Random::new(seed));
    let formats = kinds.0[0].block.inputs();
    let parts = parts(profile.wall);
    for address in 0..kinds.0[0].block.words_of_curve() as i64 {
        let mut write = Inputs::of(0);
        (write.tuning.curve_write, write.tuning.curve_address) = (1, address);
        write.tuning.curve_word = random.word(formats.tuning.curve_word);
        kinds.both(write);
    }
    let mut driven = 0;
    for n in 0..frames {
        let mut told = Inputs::of(0);
        let pad = random.below(2);
        let last = ((pad + 1) * parts - 1) as i64;
        (told.target.target_write, told.target.target_pad) = (i64::from(n % 8 != 0), last);
        told.target.target_word = random.word(formats.target.target_word) >> random.below(8);
        told.target.clear_faults = i64::from(random.below(4) == 0);
        told.extremes_read = i64::from(random.below(4) == 0);
        (told.placed, told.placed_pad) = (i64::from(random.below(4) != 0), last);
        if parts > 1 {
            told.place = -(random.below(2000) as i64) + 500;
            told.wall.wall_write = i64::from(random.below(8) == 0);
            told.wall.wall_pad = last;
            told.wall.wall_right = random.below(2) as i64;
        } else {
            told.placed = 0;
        }
        kinds.both(told);
        let mut quiet = Inputs::of(0);
        quiet.estimate.prompt_gain = random.word(formats.estimate.prompt_gain);
        let inputs = settings(&formats, &mut random, quiet);
        for part in 0..parts {
            let mut estimate = inputs;
            let words = &mut estimate.estimate;
            (words.prompt, words.prompt_pad) = (1, (pad * parts + part) as i64);
            words.prompt_capacitance =
                random.word(formats.estimate.prompt_capacitance) >> random.below(3);
            words.prompt_force = random.word(formats.estimate.prompt_force) >> random.below(16);
            words.prompt_invalid = i64::from(random.below(5) == 0);
            let [own, on_unit] = kinds.estimate(estimate);
            assert_eq!(own, on_unit, "{}, {:?}, frame {n}", profile.name, profile.control);
            driven += usize::from(own.iter().any(|out| out.drive.drive > 0));
        }
    }
    driven
}

/// A program that is longer, or words that are wider, would give the same: this holds what folding costs.
#[test]
fn folded_drives_cost_so_many_instructions_bits_and_clocks() {
    let costs = |name: &str, law, wall: Option<profile::Wall>| {
        let mut profile = Profile::bundled(name).expect("bundled");
        profile.control = Some(Control::of(&profile, law));
        (profile.wall, profile.pads) = (wall, 2 * parts(wall));
        let (block, _) = with_core(&folded(profile));
        block.unit.expect("folded").costs()
    };
    for (name, law, wall, expected) in [
        ("small", Law::Inverse, Some(profile::Wall::B), (1159, [32, 32, 16, 16], vec![1229, 1167])),
        ("small", Law::Inverse, Some(profile::Wall::A), (1010, [32, 32, 16, 16], vec![1229, 985])),
        ("small", Law::Integral, None, (332, [31, 31, 15, 15], vec![980])),
        ("small", Law::Proportional, None, (309, [31, 31, 16, 15], vec![731])),
        (
            "standard",
            Law::Inverse,
            Some(profile::Wall::B),
            (1343, [49, 36, 24, 24], vec![1584, 1250]),
        ),
        (
            "standard",
            Law::Open,
            Some(profile::Wall::QUADRANTS),
            (1118, [35, 34, 20, 17], vec![645, 1250]),
        ),
        ("standard", Law::Integral, None, (353, [41, 41, 20, 20], vec![1342])),
        ("fine", Law::Inverse, None, (522, [57, 36, 28, 28], vec![1647])),
    ] {
        assert_eq!(costs(name, law, wall), expected, "{name}, {law:?}, {wall:?}");
    }
}

#[test]
fn folded_drives_stop_where_the_host_is_silent_as_others_do() {
    const MOST: i64 = 3;
    let mut profile = profile(Law::Inverse, None);
    profile.control.iter_mut().for_each(|control| control.silent_frames = MOST as u64);
    let mut kinds = Kinds::new(&profile);
    let mut told = Inputs::of(0);
    let mut estimate = Inputs::of(0);
    (estimate.estimate.prompt, estimate.tuning.enable) = (1, 1);
    (told.target.alive, told.target.clear_faults) = (1, 1);
    for round in 0..3 {
        kinds.both(told);
        for silent in 1..=2 * MOST {
            let [own, on_unit] = kinds.estimate(estimate);
            assert_eq!(own, on_unit, "round {round}, {silent} frames without a sign of life");
            let faults = own.last().expect("a drive word's").faults;
            assert_eq!(faults.silence_fault, i64::from(silent > MOST - 1), "{silent} frames");
        }
    }
}

/// A fault that is cleared while the host is still silent is there again with the next drive word, not before.
#[test]
fn a_silence_that_is_cleared_is_found_again_with_the_next_drive_word() {
    let mut profile = profile(Law::Inverse, None);
    profile.control.iter_mut().for_each(|control| control.silent_frames = 2);
    let mut kinds = Kinds::new(&profile);
    let mut estimate = Inputs::of(0);
    (estimate.estimate.prompt, estimate.tuning.enable) = (1, 1);
    let silence = |given: [Vec<Outputs<i64>>; 2]| {
        given.map(|given| given.last().expect("a drive word's").faults.silence_fault)
    };
    assert_eq!([(); 2].map(|()| silence(kinds.estimate(estimate))), [[0, 0], [1, 1]]);
    let mut clears = Inputs::of(0);
    clears.target.clear_faults = 1;
    kinds.both(clears);
    for clock in 0..20 {
        for bench in &mut kinds.0 {
            assert_eq!(bench.clock(Inputs::of(0)).faults.silence_fault, 0, "clock {clock}");
        }
    }
    assert_eq!(silence(kinds.estimate(estimate)), [1, 1]);
}

/// What is carried on the way is within a word of the model, too.
#[test]
fn sums_of_a_unit_have_at_most_60_bits() {
    assert_eq!(super::folded::sums_fit(60), Ok(()));
    let refused = super::folded::sums_fit(61).expect_err("too wide").to_string();
    assert_eq!(refused, "control.folded: expected sums of at most 60 bits, got 61");
}
