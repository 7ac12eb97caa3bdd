// SPDX-License-Identifier: MIT OR Apache-2.0
//! Walls: the rounded reference's, frame by frame of hands that enter, press and leave, and of
//! random words; the clocks they take; hostile frames; the proof of ranges.

use super::{Inputs, Outputs, Wall};
use crate::support::never_skips::NeverSkips;
use crate::support::random::Random;
use crate::support::{Bench, MILLION, operations};
use hapticore_contract::profile::{self, Profile, Release};
use hapticore_hdl::block::Block;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::range::{Range, take_assumptions, take_violations, whole};
use hapticore_hdl::probe::sample;
use hapticore_hdl::signal::Signal;
use hapticore_reference::rounded::{self, Exact, WallFrame, WallResult};

/// The bundled profiles by rule A, which is taken where they name none, and by rule B.
fn profiles() -> Vec<Profile> {
    let with = |wall| Profile::all().into_iter().map(move |p| Profile { wall, ..p });
    with(None).chain(with(Some(profile::Wall::B))).collect()
}

/// Those, and `small` by the rules of the paper.
fn of_all_rules() -> Vec<Profile> {
    let of = |rule| Profile {
        wall: Some(profile::Wall { rule, ..profile::Wall::A }),
        ..Profile::bundled("small").unwrap()
    };
    let quadrants =
        Profile { wall: Some(profile::Wall::QUADRANTS), ..Profile::bundled("fast").unwrap() };
    let of_paper = [Release::Never, Release::Direct].map(of);
    profiles().into_iter().chain(of_paper).chain([quadrants]).collect()
}

/// The block and its reference, pad by pad.
struct Pair {
    bench: Bench<Wall>,
    walls: Vec<rounded::Wall>,
    formats: Inputs<Format>,
    force: Format,
}

impl Pair {
    fn new(profile: &Profile) -> Self {
        let block = Wall::try_new(profile).unwrap();
        let walls = (0..profile.pads).map(|_| rounded::Wall::new(profile)).collect();
        let (formats, force) = (block.inputs(), profile.formats.force);
        Pair { bench: Bench::new(block), walls, formats, force }
    }

    /// A frame of both: the same to the bit.
    fn frame(&mut self, inputs: Inputs<i64>) -> Outputs<i64> {
        let (got, clocks) = self.bench.operate(inputs);
        assert_eq!(clocks, self.bench.block.latency(), "clocks measured, latency()");
        let f = &self.formats;
        let frame = WallFrame {
            restart: inputs.restart == 1,
            parts: [inputs.c_left, inputs.c_right].map(|code| Exact::of(code, f.c_left)),
            x: Exact::of(inputs.x, f.x),
            along: Exact::of(inputs.along, f.along),
            other_free: inputs.other_free == 1,
            at_zero: inputs.at_zero == 1,
            stiffness: Exact::of(inputs.stiffness, f.stiffness),
            most: Exact::of(inputs.most, f.most),
            factory: Exact::of(inputs.factory, f.factory),
        };
        let WallResult { target, free, valid } = self.walls[inputs.pad as usize].frame(&frame);
        let target = target.code(self.force);
        let expected = Outputs { done: 1, target, free: free.into(), valid: valid.into() };
        assert_eq!(got, expected, "clock {}: {inputs:?}", self.bench.clock);
        got
    }

    /// Codes of a frame in units: pF, mm.
    fn given(&self, pad: i64, [left, right]: [f64; 2], x_mm: f64, at_zero: bool) -> Inputs<i64> {
        let f = &self.formats;
        Inputs {
            start: 0,
            pad,
            restart: 0,
            c_left: f.c_left.code_saturating(left),
            c_right: f.c_right.code_saturating(right),
            x: f.x.code_saturating(x_mm),
            along: 0,
            other_free: 0,
            at_zero: at_zero.into(),
            stiffness: f.stiffness.code_saturating(0.5),
            most: f.most.code_saturating(1.0),
            factory: 0,
        }
    }
}

/// A pad that is dragged to and fro over the wall's surface, pushing the way it goes: what it reads
/// and where it is in frame n.
pub(in crate::blocks) fn dragged(random: &mut Random, n: u64) -> ([f64; 2], f64) {
    let turns = n as f64 / 700.0;
    let x_mm = 2.0 * (std::f64::consts::TAU * turns).cos() + 0.005 * random.between(-1.0, 1.0);
    let push = -0.02 * (std::f64::consts::TAU * turns).sin() + 0.004;
    let noise = 0.01 * random.between(-1.0, 1.0);
    ([170.0 * (1.0 - push - noise), 170.0 * (1.0 + push)], x_mm)
}

#[test]
fn walls_are_those_of_the_reference_where_a_hand_drags_the_pad() {
    for (seed, profile) in (0..).zip(of_all_rules()) {
        let (mut pair, mut random) = (Pair::new(&profile), Random::new(seed));
        let (mut frees, mut targets) = (0, 0);
        // One turn of the drag at least: less would not meet the wall.
        for n in 0..operations(MILLION / 500).max(700) {
            for pad in 0..2 {
                let (parts, x_mm) = dragged(&mut random, n + 300 * pad);
                let mut inputs = pair.given(pad as i64, parts, x_mm, x_mm > 0.0);
                inputs.restart = i64::from(random.below(3000) == 0);
                // It slides along the surface, too, for half of each turn.
                let slides_mm = ((n + 300 * pad) % 700).saturating_sub(350) as f64 * 0.01;
                inputs.along = pair.formats.along.code_saturating(slides_mm);
                inputs.other_free = i64::from(n / 40 % 3 == 0);
                let out = pair.frame(inputs);
                frees += out.free;
                targets += i64::from(out.target > 0);
            }
        }
        let rule = profile.wall.unwrap_or_default().rule;
        assert!(rule != Release::Never || frees == 0, "{frees} free");
        if cfg!(optimised) && rule != Release::Never {
            assert!(
                frees > 200 && targets > 200,
                "{}: {frees} free, {targets} forces",
                profile.name
            );
        }
    }
}

/// A hand that does as it likes: it goes somewhere, inside or outside, at some speed, pushing some way.
struct Hand {
    x_mm: f64,
    to_mm: f64,
    step_mm: f64,
    /// Place along the surface, and how far it goes there in a frame.
    along_mm: f64,
    slide_mm: f64,
    push: f64,
    driven: bool,
    /// Frames that are left with a part open.
    open: u64,
}

impl Hand {
    /// A hand that puts the pad on, somewhere.
    fn puts_on(random: &mut Random) -> Self {
        let x_mm = random.between(-0.5, 1.5);
        let open = if random.below(3) == 0 { 15 } else { 0 };
        Hand {
            x_mm,
            to_mm: x_mm,
            step_mm: 0.0,
            along_mm: 0.0,
            slide_mm: 0.0,
            push: 0.0,
            driven: false,
            open,
        }
    }

    /// What the parts read and where the pad is in the next frame.
    fn goes_on(&mut self, random: &mut Random, u: f64, noise: f64) -> ([f64; 2], f64) {
        if (self.to_mm - self.x_mm).abs() <= self.step_mm {
            self.to_mm = random.between(-1.2, 1.2);
            self.step_mm = random.between(0.004, 0.04);
            let along = 0.02 * (self.to_mm - self.x_mm).signum();
            let any = random.between(-0.03, 0.03);
            self.push = if random.below(2) == 0 { along } else { any };
            self.driven = random.below(4) == 0;
            // It does not slide, or slides at some angle to the surface.
            let slides = random.below(3) == 0;
            self.slide_mm = if slides { random.between(-0.06, 0.06) } else { 0.0 };
        }
        self.x_mm += self.step_mm * (self.to_mm - self.x_mm).signum();
        self.along_mm += self.slide_mm;
        let u = u + self.push + noise * random.between(-1.0, 1.0);
        let right = if self.open > 0 { 0.0 } else { 170.0 * (1.0 + u) };
        self.open = self.open.saturating_sub(1);
        ([170.0 * (1.0 - u), right], self.x_mm)
    }
}

/// States are entered and left inside of the wall too, and the direction is learnt: of a quiet pad and of a
/// noisy one, whose factory has told something else.
#[test]
fn walls_are_those_of_the_reference_where_a_hand_does_as_it_likes() {
    for (seed, wall) in (0..).zip([profile::Wall::A, profile::Wall::B]) {
        let wall = Some(profile::Wall { zero_frames: 4, ramp_frames: 13, ..wall });
        let profile = Profile { wall, ..Profile::bundled("small").unwrap() };
        let (mut pair, mut random) = (Pair::new(&profile), Random::new(seed));
        let mut hands = [0, 1].map(|_| Hand::puts_on(&mut random));
        let factories = [0.4, -0.3].map(|u| pair.formats.factory.code_saturating(u));
        let mut states = [0; 4];
        for _ in 0..3000 {
            for (pad, hand) in hands.iter_mut().enumerate() {
                let restarts = random.below(600) == 0;
                if restarts {
                    *hand = Hand::puts_on(&mut random);
                }
                let (u, noise) = [(0.41, 0.002), (-0.28, 0.04)][pad];
                let (parts, x_mm) = hand.goes_on(&mut random, u, noise);
                let mut inputs = pair.given(pad as i64, parts, x_mm, x_mm > 0.0 && !hand.driven);
                (inputs.restart, inputs.factory) = (restarts.into(), factories[pad]);
                inputs.along = pair.formats.along.code_saturating(hand.along_mm);
                let out = pair.frame(inputs);
                if x_mm < 0.0 {
                    states[2 * pad + out.free as usize] += 1;
                }
            }
        }
        assert!(states.iter().all(|&frames| frames > 100), "{states:?}");
    }
}

/// A pad that was put on with a part open: from the first direction on that it reads it is quiet, for nothing
/// has changed since the factory. Were it noisy, what it reads would count half.
#[test]
fn a_part_that_was_open_at_first_makes_no_noise() {
    let mut pair = Pair::new(&Profile::bundled("small").unwrap());
    let u = 0.47;
    let reads = |push: f64| [170.0 * (1.0 - u - push), 170.0 * (1.0 + u + push)];
    let factory = pair.formats.factory.code_saturating(u);
    let mut frame = |parts: [f64; 2], x_mm: f64, at_zero: bool| {
        let inputs = pair.given(0, parts, x_mm, at_zero);
        pair.frame(Inputs { factory, ..inputs })
    };
    let x_mm = |n: u64| 0.6 - 0.015 * n as f64;
    for n in 0..16 {
        frame([170.0, 0.0], x_mm(n), true);
    }
    for n in 16..18 {
        frame(reads(0.0), x_mm(n), true);
    }
    for _ in 0..40 {
        assert_eq!(frame(reads(0.0), -0.3, false).free, 0);
    }
    let pulled = (0..40).position(|_| frame(reads(0.004), -0.3, false).free == 1);
    assert!(pulled.is_some_and(|frames| frames < 8), "it lets go in frame {pulled:?}");
}

#[test]
fn what_is_kept_has_a_power_of_two_of_words_for_every_number_of_a_pad() {
    for wall in [None, Some(profile::Wall::B)] {
        for pads in 2..=9 {
            let profile = Profile { pads, wall, ..Profile::bundled("small").unwrap() };
            let words = 32 * (pads as usize).next_power_of_two();
            assert_eq!(Wall::try_new(&profile).unwrap().kept.words, words, "{pads} pads");
        }
    }
}

/// The speed has seven bits more than the position, and its filter eight more than those; the product of depth
/// and stiffness has sixteen more.
#[test]
fn a_position_is_refused_where_its_words_cannot_be_held() {
    for width in 16..=60 {
        let mut profile = Profile::bundled("small").unwrap();
        profile.formats.position = Format::signed(width, width as i8 - 12);
        let refused = Wall::try_new(&profile).err().map(|error| error.to_string());
        let field = refused.as_ref().and_then(|text| text.split(':').next());
        let expected = match width {
            _ if width + 7 + 8 > 63 => Some("formats.position"),
            _ if width + 16 > 63 => Some("formats.force"),
            _ => None,
        };
        assert_eq!(field, expected, "{width} bits: {refused:?}");
    }
}

#[test]
fn walls_are_those_of_the_reference_whatever_the_words() {
    for (seed, profile) in (0..).zip(of_all_rules()) {
        let (mut pair, mut random) = (Pair::new(&profile), Random::new(seed));
        let formats = pair.formats;
        let mut inputs = <Inputs as Bundle>::map(formats, |format| random.word(format));
        for _ in 0..operations(MILLION / 200) {
            let next = <Inputs as Bundle>::map(formats, |format| random.word(format));
            let restart = i64::from(random.below(40) == 0);
            // Runs of like positions and voltages, so that states are reached and left.
            let x =
                if random.below(3) == 0 { next.x } else { inputs.x + random.below(9) as i64 - 4 };
            let x = x.clamp(formats.x.min_code() as i64, formats.x.max_code() as i64);
            let along = match random.below(3) {
                0 => next.along,
                _ => inputs.along + random.below(17) as i64 - 8,
            };
            let along =
                along.clamp(formats.along.min_code() as i64, formats.along.max_code() as i64);
            let at_zero = i64::from(random.below(30) != 0);
            let (pad, start) = (next.pad.rem_euclid(2), 0);
            let other_free = next.other_free & i64::from(random.below(3) == 0);
            inputs = Inputs { start, restart, x, along, other_free, at_zero, pad, ..next };
            if random.below(2) == 0 {
                inputs.c_right = inputs.c_left + inputs.c_left / 64;
                inputs.c_right = inputs.c_right.min(formats.c_right.max_code() as i64);
            }
            pair.frame(inputs);
        }
    }
}

#[test]
fn a_lifted_pad_is_let_go_and_an_open_part_is_no_evidence() {
    for profile in profiles() {
        let mut pair = Pair::new(&profile);
        let within = |pair: &mut Pair, parts: [f64; 2]| {
            let inputs = pair.given(0, parts, -1.0, false);
            (0..200).map(|_| pair.frame(inputs)).last().unwrap()
        };
        pair.frame(pair.given(0, [170.0; 2], 1.0, true));
        let pressed = within(&mut pair, [170.0; 2]);
        assert_eq!((pressed.free, pressed.valid), (0, 1));
        let half_n = pair.force.code_saturating(0.5);
        assert_eq!(pressed.target, half_n, "0.5 N/mm, 1 mm deep");
        let lifted = within(&mut pair, [0.0; 2]);
        assert_eq!((lifted.target, lifted.free, lifted.valid), (0, 0, 0), "all parts lifted");
        for dead in [[170.0, 0.0], [0.0, 170.0]] {
            let open = within(&mut pair, dead);
            assert_eq!((open.target, open.free, open.valid), (half_n, 0, 1), "{dead:?}: as before");
        }
        let out = pair.given(0, [170.0, 0.0], -0.7, false);
        let last = (0..40).map(|_| pair.frame(out)).last().unwrap();
        assert_eq!((last.target, last.free), (0, 1), "play releases it");
    }
}

#[test]
fn at_the_surface_there_is_no_force_and_no_push_is_no_release() {
    for profile in profiles() {
        let mut pair = Pair::new(&profile);
        let surface = pair.given(0, [170.0; 2], 0.0, false);
        for _ in 0..100 {
            let out = pair.frame(surface);
            assert_eq!((out.target, out.free), (0, 0), "x_c = 0");
        }
        let still = pair.given(0, [170.0; 2], -0.5, false);
        // With rule A friction's asymmetry advances letting go by less than the test's drift.
        for _ in 0..2000 {
            assert_eq!(pair.frame(still).free, 0, "Δx = 0");
        }
        let rail = Inputs { x: pair.formats.x.min_code() as i64, ..still };
        let last = (0..100).map(|_| pair.frame(rail)).last().unwrap();
        assert_eq!(last.target, still.most, "at the rail the largest force holds it");
    }
}

/// Braking a pad that slides along the surface is drag, and holds it off nothing.
#[test]
fn a_pad_that_slides_along_the_surface_is_not_braked_until_it_goes_inwards() {
    for profile in profiles() {
        let mut pair = Pair::new(&profile);
        let force = pair.force;
        let mut place_mm = [0.5, 0.0];
        let mut goes = |across: f64, along: f64, frames: u32| -> Vec<f64> {
            let mut frame = || {
                (place_mm[0], place_mm[1]) = (place_mm[0] + across, place_mm[1] + along);
                let mut inputs = pair.given(0, [170.0; 2], place_mm[0], false);
                inputs.along = pair.formats.along.code_saturating(place_mm[1]);
                force.real(pair.frame(inputs).target)
            };
            (0..frames).map(|_| frame()).collect()
        };
        let last = |forces: &[f64]| *forces.last().expect("frames");
        let is_near = |force_n: f64, expected_n: f64| (force_n - expected_n).abs() < 0.01;
        // As into a corner.
        assert!(is_near(last(&goes(-0.02, 0.02, 75)), 0.5), "{}: 1 mm deep", profile.name);
        assert!(is_near(last(&goes(0.0, 0.0, 100)), 0.5), "it stands still");
        // Within half of the play it need not slide.
        assert!(is_near(last(&goes(0.0, 0.005, 4)), 0.5), "0.02 mm along the surface");
        let slides = goes(0.0, -0.05, 20);
        assert_eq!(last(&slides), 0.0, "{slides:?}");
        assert_eq!(last(&goes(0.0, 0.0, 200)), 0.0, "it stands still, where it has slid to");
        assert_eq!(last(&goes(-0.01, 0.03, 80)), 0.0, "at 18° to the surface");
        let inwards = goes(-0.005, 0.0, 100);
        assert!(is_near(last(&inwards), 1.0), "{inwards:?}");
    }
}

/// In a corner this wall would hold back what leaves the other.
#[test]
fn where_the_user_leaves_the_other_wall_only_a_pad_that_goes_inwards_is_braked() {
    let profile =
        Profile { wall: Some(profile::Wall::QUADRANTS), ..Profile::bundled("fast").unwrap() };
    let mut pair = Pair::new(&profile);
    let force = pair.force;
    let mut place_mm = [0.5, 0.0];
    let mut goes = |across: f64, along: f64, other_free: bool, frames: u32| -> f64 {
        let mut last = 0.0;
        for _ in 0..frames {
            (place_mm[0], place_mm[1]) = (place_mm[0] + across, place_mm[1] + along);
            let mut inputs = pair.given(0, [170.0; 2], place_mm[0], false);
            inputs.along = pair.formats.along.code_saturating(place_mm[1]);
            inputs.other_free = other_free.into();
            last = force.real(pair.frame(inputs).target);
        }
        last
    };
    let into_the_corner = goes(-0.02, -0.02, false, 50);
    assert!((into_the_corner - 0.25).abs() < 0.02, "{into_the_corner} N, 0.5 mm deep");
    assert_eq!(goes(0.0, 0.0, true, 1), 0.0, "the user leaves the other wall");
    assert_eq!(goes(-0.02, 0.02, true, 20), 0.0, "drawn out of the corner, and into this wall");
    assert_eq!(goes(-0.02, 0.02, false, 10), 0.0, "the same, out of the other wall");
    assert!(goes(-0.02, 0.0, false, 80) > 0.9, "it goes into this wall");
}

/// A pad on a wall by rule B that is pressed in to some depth, mm.
fn pressed_by_rule_b(depth_mm: f64) -> Pair {
    let profile = Profile { wall: Some(profile::Wall::B), ..Profile::bundled("small").unwrap() };
    let mut pair = Pair::new(&profile);
    for n in 0..=200 {
        let inputs = pair.given(0, reads(-0.03), 0.5 - (depth_mm + 0.5) * n as f64 / 200.0, false);
        pair.frame(inputs);
    }
    pair
}

/// What parts read under a push.
fn reads(push: f64) -> [f64; 2] {
    [170.0 * (1.0 - push), 170.0 * (1.0 + push)]
}

/// A push of 0.6 N that becomes weaker, and is not to be told from one that has ended: the force falls, and
/// is back within a dozen frames of slipping.
#[test]
fn the_force_of_a_push_that_becomes_weaker_falls_until_the_pad_slips() {
    let mut pair = pressed_by_rule_b(1.2);
    let force = pair.force;
    let mut frame = |push: f64, x_mm: f64| {
        let out = pair.frame(pair.given(0, reads(push), x_mm, false));
        assert_eq!(out.free, 0);
        force.real(out.target)
    };
    let steady: Vec<f64> = (0..200).map(|_| frame(-0.03, -1.2)).collect();
    assert!(
        steady.iter().all(|force_n| (force_n - 0.6).abs() < 0.01),
        "the push goes on: {steady:?}"
    );
    let weaker: Vec<f64> = (0..60).map(|_| frame(-0.01, -1.2)).collect();
    assert_eq!(weaker.last(), Some(&0.0), "{weaker:?}");
    let slips: Vec<f64> = (1..=20).map(|n| frame(-0.01, -1.2 - 0.01 * f64::from(n))).collect();
    assert!(slips[12] > 0.6, "{slips:?}");
}

/// Beyond 0.75 N patches are taken to have been pulled in: what they read does not let go. The force falls
/// first.
#[test]
fn a_large_force_lets_go_later_than_a_small_one() {
    let frames_to_free = |depth_mm: f64| {
        let mut pair = pressed_by_rule_b(depth_mm);
        let inputs = pair.given(0, reads(0.03), -depth_mm, false);
        (0..300).position(|_| pair.frame(inputs).free == 1)
    };
    let [small, large] = [1.4, 1.6].map(frames_to_free);
    assert!(small.is_some_and(|frames| frames < 5), "0.7 N: frame {small:?}");
    assert!(large.is_some_and(|frames| (20..130).contains(&frames)), "0.8 N: frame {large:?}");
}

#[test]
fn skipping_changes_no_bit_on_any_clock() {
    for profile in of_all_rules() {
        let block = Wall::try_new(&profile).unwrap();
        let (formats, clocks) = (block.inputs(), block.latency() + 6);
        let mut skips = Bench::new(block.clone());
        let mut never = Bench::<_, NeverSkips>::read(block);
        let mut random = Random::new(3);
        for _ in 0..operations(300) {
            let held = <Inputs as Bundle>::map(formats, |format| random.word(format));
            for clock in 0..clocks {
                let inputs = Inputs { start: i64::from(clock == 0), ..held };
                assert_eq!(skips.clock(inputs), never.clock(inputs), "clock {}", skips.clock);
                let same = |((name, a), (_, b)): ((_, i64), (_, NeverSkips))| -> Option<_> {
                    let _: &hapticore_hdl::probe::Variable = &name;
                    (a != b.0).then_some(name.name)
                };
                let differ: Vec<_> =
                    skips.registers().zip(never.registers()).filter_map(same).collect();
                assert_eq!(differ, Vec::<String>::new(), "clock {}", skips.clock);
            }
        }
    }
}

/// Every word anywhere in its format, in the memory too, until nothing new can come.
#[test]
fn no_signal_can_overflow() {
    for profile in of_all_rules() {
        let block = Wall::try_new(&profile).unwrap();
        let any = <Inputs as Bundle>::map(block.inputs(), |format: Format| Signal {
            value: whole(format),
            format,
        });
        let mut state = block.reset::<Range>();
        let mut seen: Vec<Range> = Vec::new();
        take_violations();
        take_assumptions();
        for clock in 0.. {
            assert!(clock < 20_000, "does not close");
            block.call("wall", &mut state, any);
            let mut now = Vec::new();
            sample(&block, &state, &mut now);
            let joined: Vec<_> = match seen.is_empty() {
                true => now,
                false => seen.iter().zip(&now).map(|(a, b)| a.join(*b)).collect(),
            };
            if joined == seen && clock > 300 {
                break;
            }
            seen = joined;
        }
        assert_eq!(take_violations(), [], "{}", profile.name);
        let assumed = take_assumptions();
        let known = ["remainder of a division", "a mean of old and new value"];
        let is_known = |text: &&str| known.iter().any(|known| text.contains(known));
        assert!(assumed.iter().all(is_known), "{assumed:?}");
    }
}
