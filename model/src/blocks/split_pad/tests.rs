// SPDX-License-Identifier: MIT OR Apache-2.0
//! Split pads: the rounded reference's, for random estimates, places, walls and drives; sensing that
//! fails within a wall; the clocks they take; the proof of ranges.

use super::{Inputs, Outputs, SplitPad};
use crate::support::never_skips::NeverSkips;
use crate::support::random::Random;
use crate::support::{Bench, MILLION, operations};
use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::{self, Profile};
use hapticore_hdl::block::Block;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::range::{Range, take_assumptions, take_violations, whole};
use hapticore_hdl::probe::sample;
use hapticore_hdl::signal::Signal;
use hapticore_reference::rounded::{Estimate, Exact, SplitPads, WallFrame};

/// Of a part: codes of capacitance and force, and whether it is invalid and whether it is lifted.
type PartCodes = (i64, i64, [bool; 2]);

/// The bundled profiles with two pads of two parts, of three, and of quadrants.
fn profiles() -> Vec<Profile> {
    let walls = [profile::Wall::A, profile::Wall::B, profile::Wall::QUADRANTS];
    let with = |wall: profile::Wall| {
        Profile::all().into_iter().map(move |profile| Profile {
            control: Some(Control::of(&profile, Law::Inverse)),
            wall: Some(wall),
            pads: 2 * wall.parts,
            ..profile
        })
    };
    walls.into_iter().flat_map(with).collect()
}

/// The block and its reference.
struct Pair {
    bench: Bench<SplitPad>,
    pads: [SplitPads; 2],
    formats: Inputs<Format>,
    parts: usize,
    quiet: Inputs<i64>,
}

impl Pair {
    fn new(profile: &Profile) -> Self {
        let block = SplitPad::try_new(profile).unwrap();
        let formats = block.inputs();
        let mut quiet = Inputs::of(0);
        quiet.wall.wall_stiffness = formats.wall.wall_stiffness.code_saturating(0.5);
        quiet.wall.wall_most = formats.wall.wall_most.code_saturating(1.0);
        let mut pair = Pair {
            parts: profile.wall.unwrap().parts as usize,
            pads: [0, 1].map(|_| SplitPads::new(profile)),
            bench: Bench::new(block),
            formats,
            quiet,
        };
        pair.walls();
        pair
    }

    /// Walls on the left of 0 mm.
    fn walls(&mut self) {
        for pad in 0..2 {
            (0..self.axes()).for_each(|axis| self.surface(pad, axis, 0, false));
        }
    }

    /// The number by which a pad's wall along x is known, or that along y.
    fn number(&self, pad: usize, axis: usize) -> i64 {
        (self.parts * (pad + 1) - 1 - axis) as i64
    }

    fn axes(&self) -> usize {
        self.pads[0].axes.len()
    }

    fn surface(&mut self, pad: usize, axis: usize, code: i64, right: bool) {
        let mut write = self.quiet;
        (write.wall.wall_write, write.wall.wall_pad) = (1, self.number(pad, axis));
        (write.wall.wall_surface, write.wall.wall_right) = (code, right.into());
        self.bench.clock(write);
        let surface = Exact::of(code, self.formats.wall.wall_surface);
        self.pads[pad].axes[axis].surface = Some((surface, right));
    }

    fn place(&mut self, pad: usize, axis: usize, code: i64) {
        let placed_pad = self.number(pad, axis);
        self.bench.clock(Inputs { placed: 1, placed_pad, place: code, ..self.quiet });
        self.pads[pad].place[axis] = Some(Exact::of(code, self.formats.place));
    }

    /// The same place along both axes.
    fn place_on_all(&mut self, pad: usize, code: i64) {
        (0..2).for_each(|axis| self.place(pad, axis, code));
    }

    /// The estimates of a pad's parts, capacitance, force and whether they are invalid: the block's outputs for the pad
    /// equal the reference's to the bit. `rests` says whether the pad's drive word is then zero.
    fn frame(&mut self, pad: usize, parts: &[PartCodes], rests: bool) -> Outputs<i64> {
        let mut got = None;
        for (part, &(capacitance, measured, [invalid, lifted])) in (0..).zip(parts) {
            let pad = (self.parts * pad) as i64 + part;
            let [invalid, lifted] = [invalid, lifted].map(i64::from);
            let flags = Inputs { invalid, lifted, ..self.quiet };
            let estimate = Inputs { estimate: 1, pad, capacitance, measured, ..flags };
            self.bench.clock(estimate);
            for clock in 1..=self.bench.block.latency() {
                let out = self.bench.clock(self.quiet);
                if out.done == 1 {
                    assert_eq!(clock, self.bench.block.latency(), "clocks measured, latency()");
                    got = Some(out);
                }
            }
        }
        let got = got.expect("the last part gives the pad");
        let f = &self.formats;
        let of = |&(c, force, [invalid, lifted]): &PartCodes| Estimate {
            capacitance: Exact::of(c, f.capacitance),
            force: Exact::of(force, f.measured),
            invalid,
            lifted,
        };
        let port = WallFrame {
            restart: self.quiet.wall.wall_restart == 1,
            parts: [Exact::ZERO; 2],
            x: Exact::ZERO,
            along: Exact::ZERO,
            other_free: false,
            at_zero: false,
            stiffness: Exact::of(self.quiet.wall.wall_stiffness, f.wall.wall_stiffness),
            most: Exact::of(self.quiet.wall.wall_most, f.wall.wall_most),
            factory: Exact::of(self.quiet.wall.wall_factory, f.wall.wall_factory),
        };
        let expected = self.pads[pad].estimates(&parts.iter().map(of).collect::<Vec<_>>(), &port);
        let expected = Outputs {
            done: 1,
            capacitance: expected.brake.capacitance.code(f.capacitance),
            measured: expected.brake.force.code(f.measured),
            invalid: expected.brake.invalid.into(),
            lifted: expected.brake.lifted.into(),
            target: expected.wall.target.code(f.measured),
            free: expected.wall.free.into(),
            reads: expected.wall.valid.into(),
        };
        assert_eq!(got, expected, "clock {}: pad {pad}, {parts:?}", self.bench.clock);
        self.bench.clock(Inputs { driven: 1, rests: rests.into(), ..self.quiet });
        self.pads[pad].rests = rests;
        got
    }
}

/// Two pads, whose walls are on either side and move, with estimates that are near each other or
/// anywhere, places that go to and fro or jump.
#[test]
fn pads_are_those_of_the_reference() {
    for (seed, profile) in (0..).zip(profiles()) {
        let (mut pair, mut random) = (Pair::new(&profile), Random::new(seed));
        let (formats, parts) = (pair.formats, pair.parts);
        let (mut freed, mut forced) = (0, 0);
        let mut places = [[0i64; 2]; 2];
        // As many as walls let pads go in.
        let frames = if cfg!(optimised) { 1500 } else { operations(MILLION / 1000) };
        for n in 0..frames {
            let pad = (n % 2) as usize;
            for (axis, place) in places[pad].iter_mut().enumerate() {
                if axis < pair.axes() && random.below(50) == 0 {
                    let near = random.between(-200.0, 200.0) as i64;
                    let word = random.word(formats.wall.wall_surface);
                    let code = if random.below(4) == 0 { word } else { near };
                    pair.surface(pad, axis, code, (pad == 1) ^ (axis == 1));
                }
                if random.below(4) != 0 {
                    let near = *place + random.below(9) as i64 - 4;
                    let word = random.word(formats.place);
                    *place = if random.below(200) == 0 { word } else { near };
                    *place = (*place).clamp(-(1 << 12), 1 << 12);
                    pair.place(pad, axis, *place);
                }
            }
            let middle = random.word(formats.capacitance) / 2;
            let estimates: Vec<_> = (0..parts)
                .map(|_| {
                    let near = (middle as f64 * random.between(0.98, 1.0)) as i64;
                    let any = random.word(formats.capacitance);
                    let capacitance = if random.below(20) == 0 { any } else { near };
                    let flags = [(); 2].map(|()| random.below(50) == 0);
                    (capacitance, random.word(formats.measured), flags)
                })
                .collect();
            pair.quiet.wall.wall_restart = i64::from(random.below(300) == 0);
            let out = pair.frame(pad, &estimates, random.below(20) != 0);
            freed += out.free;
            forced += i64::from(out.target > 0);
        }
        if cfg!(optimised) {
            assert!(freed > 50 && forced > 50, "{}: {freed}, {forced}", profile.name);
        }
    }
}

/// Two pads that are dragged to and fro over their walls' surfaces, the one's on the left, the other's on the
/// right, not driven outside. What the direction reads without a push is not what the factory says.
#[test]
fn pads_are_those_of_the_reference_where_a_hand_drags_them() {
    let small = |of: &Profile| of.name == "small";
    for (seed, profile) in (0..).zip(profiles().into_iter().filter(small)) {
        let (mut pair, mut random) = (Pair::new(&profile), Random::new(seed));
        let f = pair.formats;
        pair.quiet.wall.wall_factory = f.wall.wall_factory.code_saturating(0.015);
        (0..2).for_each(|pad| pair.surface(pad, 0, 0, pad == 1));
        let (mut freed, mut forced) = ([0; 2], [0; 2]);
        for n in 0..800 {
            for pad in 0..2 {
                let side = [1.0, -1.0][pad];
                let (sin, cos) = (std::f64::consts::TAU * f64::from(n) / 400.0).sin_cos();
                let x_mm = 1.5 * cos + 0.002 * random.between(-1.0, 1.0);
                pair.place(pad, 0, f.place.code_saturating(side * x_mm));
                pair.place(pad, 1, f.place.code_saturating(1.0));
                let u = side * (0.02 - 0.015 * sin);
                let part = |part: usize| {
                    // Of quadrants the first two are on the left.
                    let right = if pair.parts == 4 { part >= 2 } else { part == 1 };
                    let share = if right { 1.0 + u } else { 1.0 - u };
                    (f.capacitance.code_saturating(170.0 * share), 0, [false; 2])
                };
                let parts: Vec<_> = (0..pair.parts).map(part).collect();
                let out = pair.frame(pad, &parts, x_mm > 0.0);
                freed[pad] += out.free;
                forced[pad] += i64::from(out.target > 0);
            }
        }
        let met = freed.iter().chain(&forced).all(|&frames| frames > 20);
        assert!(met, "{} parts: {freed:?} free, {forced:?} forces", pair.parts);
    }
}

/// A pad that goes to and fro between two walls has the nearer one: its side and place change in the middle, far from
/// both. Each holds the pad that is pushed into it and lets go, and the block equals the reference to the bit.
#[test]
fn a_wall_that_changes_sides_holds_and_lets_go_on_either() {
    const FRAMES: u32 = 600;
    let small = |of: &Profile| of.name == "small";
    for (seed, profile) in (0..).zip(profiles().into_iter().filter(small)) {
        let (mut pair, mut random) = (Pair::new(&profile), Random::new(seed));
        let f = pair.formats;
        let surface = |mm: f64| f.wall.wall_surface.code_saturating(mm);
        pair.surface(0, 0, surface(-10.0), false);
        (1..pair.axes()).for_each(|axis| pair.surface(0, axis, surface(-100.0), false));
        let mut right = false;
        let (mut freed, mut forced) = ([0; 2], [0; 2]);
        for n in 0..6 * FRAMES {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(n) / f64::from(FRAMES)).sin_cos();
            let x_mm = 11.5 * sin + 0.002 * random.between(-1.0, 1.0);
            if x_mm * if right { -1.0 } else { 1.0 } > 1.0 {
                right = !right;
                pair.surface(0, 0, surface(if right { 10.0 } else { -10.0 }), right);
            }
            pair.place(0, 0, f.place.code_saturating(x_mm));
            pair.place(0, 1, f.place.code_saturating(if pair.axes() == 2 { x_mm } else { 0.0 }));
            // A hand pushes the way it goes: inwards, a pad on the right has more on its right.
            let u = 0.004 + 0.02 * cos.signum();
            let part = |part: usize| {
                let on_right = if pair.parts == 4 { part >= 2 } else { part == 1 };
                let share = if on_right { 1.0 + u } else { 1.0 - u };
                (f.capacitance.code_saturating(170.0 * share), 0, [false; 2])
            };
            let parts: Vec<_> = (0..pair.parts).map(part).collect();
            let out = pair.frame(0, &parts, x_mm.abs() < 10.0);
            if n > FRAMES && x_mm.abs() > 10.0 {
                let (side, inwards) = (usize::from(x_mm > 0.0), cos * x_mm > 0.0);
                forced[side] += usize::from(inwards && out.target > 0);
                freed[side] += usize::from(!inwards && out.free == 1);
            }
        }
        let met = forced.iter().chain(&freed).all(|&frames| frames > 100);
        assert!(met, "{} parts: {forced:?} forces, {freed:?} free", pair.parts);
    }
}

#[test]
fn what_is_kept_has_a_word_for_every_number_of_a_part() {
    for profile in profiles() {
        let parts = profile.wall.unwrap().parts;
        for pads in 1..=4 {
            let block =
                SplitPad::try_new(&Profile { pads: pads * parts, ..profile.clone() }).unwrap();
            let words = ((pads * parts) as usize).next_power_of_two();
            let kept = [&block.places, &block.surfaces].map(|of| of.words);
            assert_eq!((block.parts(), kept), (parts, [words; 2]), "{pads} pads");
        }
    }
}

/// A wall on the left that a pad has been pushed into by a millimetre.
fn pushed(profile: &Profile) -> (Pair, Vec<PartCodes>, i64) {
    let mut pair = Pair::new(profile);
    let f = pair.formats;
    let half_n = f.wall.wall_most.code_saturating(0.5);
    let estimate = (f.capacitance.code_saturating(180.0), 0, [false; 2]);
    let parts = vec![estimate; pair.parts];
    pair.place_on_all(0, f.place.code_saturating(0.5));
    pair.frame(0, &parts, true);
    pair.place(0, 0, f.place.code_saturating(-1.0));
    for _ in 0..50 {
        assert_eq!(pair.frame(0, &parts, false).free, 0);
    }
    assert_eq!(pair.frame(0, &parts, false).target, half_n, "0.5 N/mm, 1 mm deep");
    (pair, parts, half_n)
}

#[test]
fn a_sensing_part_that_is_invalid_or_lifted_lets_go_in_mid_wall_and_the_wall_is_back_after_it() {
    for profile in profiles() {
        let sensing = if profile.wall.unwrap().parts == 4 { 4 } else { 2 };
        for (dead, flag) in (0..sensing).flat_map(|part| [(part, 0), (part, 1)]) {
            let (mut pair, parts, half_n) = pushed(&profile);
            let mut broken = parts.clone();
            broken[dead].2[flag] = true;
            let out = pair.frame(0, &broken, false);
            assert_eq!((out.target, out.reads), (0, 0), "part {dead}: the safe side");
            assert_eq!(pair.frame(0, &parts, false).target, half_n, "part {dead} is back");
        }
    }
}

/// Of a pad whose last part brakes alone the others say nothing of that.
#[test]
fn a_pad_is_lifted_where_a_part_that_brakes_is() {
    for profile in profiles() {
        let (mut pair, parts, _) = pushed(&profile);
        let brakes = |part: usize| parts.len() != 3 || part == 2;
        for part in 0..parts.len() {
            let mut lifted = parts.clone();
            lifted[part].2[1] = true;
            let out = pair.frame(0, &lifted, false);
            assert_eq!(out.lifted, i64::from(brakes(part)), "part {part} of {}", parts.len());
            assert_eq!(pair.frame(0, &parts, false).lifted, 0, "part {part} is back");
        }
    }
}

/// The larger of both walls' forces counts, and either may let go.
#[test]
fn a_quadrant_pad_meets_both_walls() {
    for profile in profiles().into_iter().filter(|of| of.wall.unwrap().axes() == 2) {
        let (mut pair, parts, _) = pushed(&profile);
        let f = pair.formats;
        for (y_mm, newtons) in [(-0.5, 0.5), (-1.5, 0.75), (-9.0, 1.0), (0.25, 0.5)] {
            pair.place(0, 1, f.place.code_saturating(y_mm));
            // It has been put there, and has not slid.
            pair.quiet.wall.wall_restart = 1;
            pair.frame(0, &parts, false);
            pair.quiet.wall.wall_restart = 0;
            let out = (0..50).map(|_| pair.frame(0, &parts, false)).last().expect("frames");
            let expected = f.wall.wall_most.code_saturating(newtons);
            assert_eq!(out.target, expected, "{y_mm} mm");
        }
        let right = pair.formats.wall.wall_surface.code_saturating(0.0);
        pair.surface(0, 0, right, true);
        assert_eq!(pair.frame(0, &parts, false).target, 0, "of neither inside");
    }
}

#[test]
fn a_pad_that_has_no_place_yet_meets_no_wall() {
    for profile in profiles() {
        let mut pair = Pair::new(&profile);
        let far = pair.formats.wall.wall_surface.max_code() as i64;
        (0..pair.axes()).for_each(|axis| pair.surface(0, axis, far, false));
        let parts =
            vec![(pair.formats.capacitance.code_saturating(180.0), 0, [false; 2]); pair.parts];
        for _ in 0..20 {
            let out = pair.frame(0, &parts, true);
            assert_eq!((out.target, out.reads), (0, 0));
        }
        // Its first place begins where it is: it does not come there from somewhere else.
        pair.place_on_all(0, far - 64);
        let first = pair.frame(0, &parts, true);
        assert_eq!((first.reads, first.free), (1, 0), "with its first place it does");
        for frame in 0..20 {
            assert_eq!(pair.frame(0, &parts, true).free, 0, "frame {frame}");
        }
    }
}

/// Memories hold place and surface all the while.
#[test]
fn a_wall_is_forgotten_with_a_reset_and_its_place_with_every_clear() {
    for profile in profiles() {
        let acts = |pair: &mut Pair, parts: &[PartCodes]| pair.frame(0, parts, false).target > 0;
        let forget = |pair: &mut Pair, surfaces: bool| {
            pair.pads[0].place = [None; 2];
            pair.pads[0].free = [false; 2];
            for axis in &mut pair.pads[0].axes {
                axis.surface = axis.surface.filter(|_| !surfaces);
            }
            pair.pads[0].rests = false;
        };
        let (mut pair, parts, _) = pushed(&profile);
        let deep = pair.formats.place.code_saturating(-1.0);
        pair.bench.press_reset();
        forget(&mut pair, true);
        assert!(!acts(&mut pair, &parts), "reset: neither place nor wall");
        pair.place_on_all(0, deep);
        assert!(!acts(&mut pair, &parts), "a place, but no wall");
        pair.walls();
        assert!(acts(&mut pair, &parts), "both");
        pair.bench.clock(Inputs { clear: 1, ..pair.quiet });
        forget(&mut pair, false);
        assert!(!acts(&mut pair, &parts), "cleared: no place");
        pair.place_on_all(0, deep);
        assert!(acts(&mut pair, &parts), "the wall is as it was");
        pair.bench.clock(Inputs { clear: 1, begins_anew: 1, ..pair.quiet });
        forget(&mut pair, true);
        pair.place_on_all(0, deep);
        assert!(!acts(&mut pair, &parts), "the wall is gone");
    }
}

fn rarely(random: &mut Random) -> i64 {
    i64::from(random.below(200) == 0)
}

#[test]
fn skipping_changes_no_bit_on_any_clock() {
    for profile in profiles() {
        let block = SplitPad::try_new(&profile).unwrap();
        let (formats, block_latency) = (block.inputs(), block.latency());
        let mut skips = Bench::new(block.clone());
        let mut never = Bench::<_, NeverSkips>::read(block);
        let (mut random, apart) = (Random::new(5), block_latency + 30);
        for clock in 0..operations(20_000) {
            let mut inputs = <Inputs as Bundle>::map(formats, |format| random.word(format));
            inputs.pad %= profile.pads as i64;
            inputs.placed_pad %= profile.pads as i64;
            inputs.wall.wall_pad %= profile.pads as i64;
            inputs.estimate = i64::from(clock % apart == 0);
            (inputs.clear, inputs.begins_anew) = (rarely(&mut random), rarely(&mut random));
            assert_eq!(skips.clock(inputs), never.clock(inputs), "clock {}", skips.clock);
        }
    }
}

/// Every word anywhere in its format, in the memories too, until nothing new can come.
#[test]
fn no_signal_can_overflow() {
    for profile in profiles() {
        let block = SplitPad::try_new(&profile).unwrap();
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
            block.call("split_pad", &mut state, any);
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
