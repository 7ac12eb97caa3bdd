// SPDX-License-Identifier: MIT OR Apache-2.0
//! Drive words: those of each law, rounded; faults; the clocks they take.

use super::{Controller, Inputs};
use crate::support::random::Random;
use crate::support::{Bench, MILLION, check_latency_of, operations};
use hapticore_contract::control::{Control, Law, Tuning};
use hapticore_contract::profile::Profile;
use hapticore_hdl::format::Format;
use hapticore_reference::rounded::{self, Exact, Request};

const LAWS: [Law; 4] = [Law::Open, Law::Proportional, Law::Integral, Law::Inverse];

/// Every bundled profile with a controller of every law.
fn profiles() -> impl Iterator<Item = (u64, Profile)> {
    let with = |profile: Profile| {
        LAWS.map(|law| Profile { control: Some(Control::of(&profile, law)), ..profile.clone() })
    };
    (0..).zip(Profile::all().into_iter().flat_map(with))
}

/// A controller beside its reference.
struct Pair {
    bench: Bench<Controller>,
    reference: rounded::Controller,
    inputs: Inputs<i64>,
    profile: Profile,
}

impl Pair {
    /// Both, with a tuning drawn at random, its words corners or anything.
    fn tuned(profile: &Profile, random: &mut Random) -> Self {
        let mut bench = Bench::new(Controller::try_new(profile).unwrap());
        let formats = bench.block.inputs();
        let control = profile.control.as_ref().unwrap();
        let mut inputs = Inputs::of(0);
        let mut word = |format| random.word(format);
        let (mut t, f) = (inputs.tuning, formats.tuning);
        t.full_drive = word(f.full_drive);
        t.proportional = word(f.proportional);
        t.correction = word(f.correction);
        t.rail = word(f.rail);
        t.slew = word(f.slew);
        t.force_cap = word(f.force_cap);
        t.enable = 1;
        inputs.tuning = t;
        let curve: Vec<i64> = (0..=control.cells).map(|_| word(f.curve_word)).collect();
        for (address, &curve_word) in (0..).zip(&curve) {
            let mut write = inputs;
            (write.tuning.curve_write, write.tuning.curve_address) = (1, address);
            write.tuning.curve_word = curve_word;
            bench.clock(write);
        }
        let tuning = Tuning {
            curve: curve.iter().map(|&code| control.drive.real(code)).collect(),
            full_drive: control.gain.real(t.full_drive),
            proportional: control.gain.real(t.proportional),
            correction: control.gain.real(t.correction),
            rail: control.drive.real(t.rail),
            slew: control.drive.real(t.slew),
            force_cap: profile.formats.force.real(t.force_cap),
            walls: None,
        };
        let mut reference = rounded::Controller::new(profile, &tuning);
        bench.clock(Inputs { tick: 1, alive: 1, ..inputs });
        reference.tick();
        reference.hear();
        Pair { bench, reference, inputs, profile: profile.clone() }
    }

    /// Holds that a drive word and the faults are the reference's.
    fn check(&mut self, random: &mut Random) {
        let f = self.bench.block.inputs();
        let rarely = |random: &mut Random, one_in: u64| i64::from(random.below(one_in) == 0);
        let i = Inputs {
            pad: random.below(self.profile.pads) as i64,
            target: random.word(f.target),
            capacitance: random.word(f.capacitance),
            measured: random.word(f.measured),
            force_gain: random.word(f.force_gain),
            invalid: rarely(random, 3),
            lifted: rarely(random, 8),
            alive: rarely(random, 30),
            tick: rarely(random, 2),
            clear: rarely(random, 40),
            clear_faults: rarely(random, 20),
            ..self.inputs
        };
        let enable = 1 - rarely(random, 10);
        self.tell(&i);
        let mut inputs = Inputs { alive: 0, tick: 0, clear: 0, clear_faults: 0, ..i };
        inputs.tuning.enable = enable;
        let expected = self.expected(&inputs);
        let (out, _) = self.bench.operate(inputs);
        let got = (out.drive, out.low, out.high, out.faults);
        assert_eq!(got, expected, "{:?} {:?}, {inputs:?}", self.profile.name, self.profile.control);
        self.bench.check_registers();
    }

    /// A clock in which the host is heard or clears faults, time passes, pads begin anew.
    fn tell(&mut self, i: &Inputs<i64>) {
        let &Inputs { alive, tick, clear, clear_faults, .. } = i;
        let (alive, tick) = (alive, tick * (1 - alive));
        self.bench.clock(Inputs { alive, tick, clear, clear_faults, ..self.inputs });
        if alive == 1 {
            self.reference.hear();
        }
        if tick == 1 {
            self.reference.tick();
        }
        if clear == 1 {
            self.reference.clear();
        }
        if i.clear_faults == 1 {
            self.reference.clear_faults();
        }
    }

    fn expected(&mut self, i: &Inputs<i64>) -> (i64, i64, i64, super::Faults<i64>) {
        let (f, control) = (&self.profile.formats, self.profile.control.as_ref().unwrap());
        let drive = self.reference.drive(&Request {
            pad: i.pad as usize,
            target: Exact::of(i.target, control.target),
            capacitance: Exact::of(i.capacitance, f.capacitance),
            force: Exact::of(i.measured, f.force),
            force_gain: Exact::of(i.force_gain, f.force_gain),
            invalid: i.invalid == 1,
            lifted: i.lifted == 1,
            enable: i.tuning.enable == 1,
        });
        let [silence_fault, sensor_fault, force_fault] = self.reference.faults.map(i64::from);
        let faults = super::Faults { silence_fault, sensor_fault, force_fault };
        (drive.drive.code(control.drive), drive.low.into(), drive.high.into(), faults)
    }
}

#[test]
fn drive_words_are_those_of_the_law() {
    for (seed, profile) in profiles() {
        let mut random = Random::new(seed);
        for _ in 0..8 {
            let mut pair = Pair::tuned(&profile, &mut random);
            (0..operations(MILLION / 2500)).for_each(|_| pair.check(&mut random));
        }
    }
}

/// A controller of any law whose words are as long or short as its checks and those of a profile allow.
fn any_words(random: &mut Random) -> Profile {
    let mut profile = Profile::bundled("standard").expect("bundled");
    let mut within = |least: u64, most: u64| least + random.below(most - least + 1);
    let drive = within(8, 20) as u8;
    let mut word = |least: u64, integer: u64| {
        let width = within(least, 20) as u8;
        Format::unsigned(width, width as i8 - within(1, integer) as i8)
    };
    let (target, gain) = (word(8, 4), word(8, 8));
    let law = LAWS[within(0, 3) as usize];
    profile.formats.force = Format::unsigned(within(4, 28) as u8, within(0, 44) as i8 - 4);
    profile.multiplier = within(8, 19) as u8;
    profile.control = Some(Control {
        drive: Format::unsigned(drive, drive as i8),
        target,
        gain,
        cells: 1 << within(2, u64::from(drive - 4).min(10)),
        ..Control::of(&profile, law)
    });
    profile
}

/// None panics: what cannot be built is refused.
#[test]
fn drive_words_of_any_formats_are_those_of_the_law() {
    let (mut random, mut accepted, mut refused) = (Random::new(1), 0, 0);
    for _ in 0..operations(400).max(60) {
        let profile = any_words(&mut random);
        if Controller::try_new(&profile).is_err() {
            refused += 1;
            continue;
        }
        accepted += 1;
        let mut pair = Pair::tuned(&profile, &mut random);
        (0..25).for_each(|_| pair.check(&mut random));
    }
    println!("{accepted} controllers, {refused} refused");
    assert!(accepted > 3 * refused && refused > 0, "{accepted} accepted, {refused} refused");
}

#[test]
fn latency_is_the_clocks_measured() {
    for (_, profile) in profiles() {
        let block = Controller::try_new(&profile).unwrap();
        check_latency_of(block.clone(), block.latency(), |mut inputs| {
            inputs.tuning.curve_write = 0; // any address would do
            inputs
        });
    }
}

#[test]
fn a_profile_without_a_controller_is_refused() {
    let profile = Profile::bundled("small").expect("bundled");
    let error = Controller::try_new(&profile).unwrap_err();
    assert_eq!(error.to_string(), "control: expected a table, got none");
}

/// A controller with this time for a silent host, and a clock of it.
fn watched(silent_ms: u64) -> impl FnMut(Inputs<i64>) -> i64 {
    let mut profile = Profile::bundled("standard").expect("bundled");
    profile.control = Some(Control { silent_ms, ..Control::of(&profile, Law::Open) });
    let mut bench = Bench::new(Controller::try_new(&profile).unwrap());
    move |inputs| {
        bench.clock(inputs);
        bench.clock(Inputs::of(0)).faults.silence_fault
    }
}

/// A tick, a sign of life, and a host that clears faults.
fn told() -> [Inputs<i64>; 3] {
    let nothing = Inputs::of(0);
    [
        Inputs { tick: 1, ..nothing },
        Inputs { alive: 1, ..nothing },
        Inputs { clear_faults: 1, ..nothing },
    ]
}

/// No drive word is asked for: the host is missed all the same.
#[test]
fn the_host_is_missed_after_as_many_ticks_as_the_profile_says() {
    let (mut clock, [tick, alive, clears]) = (watched(5), told());
    assert_eq!([tick; 6].map(&mut clock), [0, 0, 0, 0, 1, 1]);
    assert_eq!(clock(alive), 1, "it stays until it is cleared");
    assert_eq!(clock(clears), 0);
    assert_eq!([tick, tick, tick, tick, alive, tick].map(&mut clock), [0; 6]);
}

#[test]
fn a_silence_is_over_once_it_is_cleared_and_the_host_is_heard() {
    let (mut clock, [tick, _, clears]) = (watched(2), told());
    assert_eq!([tick, tick].map(&mut clock), [0, 1]);
    assert_eq!(clock(clears), 1, "it is silent still");
    assert_eq!(clock(Inputs { alive: 1, ..clears }), 0);
}

/// Roots and quotients computed within a clock change no drive word, only the clocks.
#[test]
fn a_hurried_controller_has_the_drive_words_of_the_law_earlier() {
    for (seed, profile) in profiles() {
        let mut random = Random::new(seed);
        let mut pair = Pair::tuned(&profile, &mut random);
        pair.bench.block.hurry();
        (0..operations(200).max(20)).for_each(|_| pair.check(&mut random));
        let (_, clocks) = pair.bench.operate(pair.inputs);
        let latency = pair.bench.block.latency();
        assert!(clocks < latency, "{}: {clocks} of {latency} clocks", profile.name);
    }
}

#[test]
fn what_is_kept_has_a_word_for_every_number_of_a_pad() {
    for pads in 2..=9 {
        let mut profile = Profile { pads, ..Profile::bundled("small").expect("bundled") };
        profile.control = Some(Control::of(&profile, Law::Integral));
        let block = Controller::try_new(&profile).unwrap();
        let words = (pads as usize).next_power_of_two();
        assert_eq!([block.pads.words, block.corrections.words], [words; 2], "{pads} pads");
    }
}

#[test]
fn only_laws_with_an_error_have_registers_of_a_correction() {
    for (_, profile) in profiles() {
        let bench = Bench::new(Controller::try_new(&profile).unwrap());
        let kept: Vec<String> = bench
            .registers()
            .filter(|(of, _)| !of.format.is_none() && of.scope.len() == 1)
            .map(|(of, _)| of.name)
            .collect();
        let law = bench.block.law;
        let has_error = law != Law::Open;
        for name in ["proportional", "correction"] {
            assert_eq!(kept.iter().any(|of| of == name), has_error, "{law:?}: {name} in {kept:?}");
        }
    }
}

/// Roots of drive words of 8 bits tell 16 bits of a radicand apart: two of them move a target of two
/// integer bits below one, 14 are left.
#[test]
fn a_target_of_more_bits_than_roots_tell_apart_is_refused() {
    let built = |target: Format| {
        let mut profile = Profile::bundled("standard").expect("bundled");
        let drive = Format::unsigned(8, 8);
        let control = Control { drive, target, cells: 16, ..Control::of(&profile, Law::Open) };
        profile.control = Some(control);
        Controller::try_new(&profile).map_err(|error| error.to_string())
    };
    assert!(built(Format::unsigned(16, 14)).is_ok());
    let error = built(Format::unsigned(17, 15)).unwrap_err();
    assert!(error.starts_with("control.target: expected 14 fractional bits at most"), "{error}");
}

/// The product of a squared capacitance and a gain is as wide as a word of the model at most.
#[test]
fn a_product_that_is_no_word_of_the_model_is_refused_by_name() {
    let mut profile = Profile::bundled("standard").expect("bundled");
    profile.control = Some(Control::of(&profile, Law::Inverse));
    let square = profile.formats.square.width;
    let mut refusals = Vec::new();
    for width in 8..=63 {
        profile.formats.force_gain = Format::unsigned(width, width as i8);
        match Controller::try_new(&profile) {
            Ok(block) => {
                let _: Controller = block;
                assert!(refusals.is_empty() && square + width <= 63, "{width} bits");
            }
            Err(error) => {
                assert!(square + width > 63, "{width} bits: {error}");
                refusals.push(error.to_string());
            }
        }
    }
    let named = refusals.iter().all(|text| text.contains("the product of square and gain"));
    assert!(!refusals.is_empty() && named, "{refusals:?}");
}

/// An operand is as wide as the widest word that is multiplied, a radicand as the longest of which a
/// root is taken.
#[test]
fn words_are_as_wide_as_what_they_hold() {
    let (mut random, mut seen) = (Random::new(7), [0; 2]);
    for _ in 0..2000 {
        let profile = any_words(&mut random);
        let Ok(block) = Controller::try_new(&profile) else { continue };
        let control = profile.control.as_ref().unwrap();
        let (target, shift, fine) = (control.target, control.target_shift(), block.fine);
        let quotient = block.divider.outputs().quotient;
        let bits = quotient.frac.max(target.frac + shift).max(fine.frac);
        assert_eq!(block.radicand, Format::unsigned(bits as u8, bits), "{control:?}");
        if ![Law::Proportional, Law::Integral].contains(&control.law) {
            continue;
        }
        // Of a force below 4^h that is a bit finer, the root is no other.
        let told_apart = fine.frac - shift - 1;
        let frac = profile.formats.force.frac.max(0).min(told_apart);
        assert_eq!(block.measured_format(), Format::unsigned((frac + shift) as u8, frac));
        let finer = (frac - target.frac).max(0);
        let error = target.width + finer as u8;
        let part = fine.width - control.cells.trailing_zeros() as u8;
        let operands = [
            Format::signed(fine.width.max(error) + 1, 0),
            Format::unsigned(part.max(control.gain.width), 0),
        ];
        assert_eq!([block.left, block.right], operands, "{control:?}");
        if control.law == Law::Proportional {
            assert_eq!(block.error_format(), Format::signed(error + 1, target.frac + finer));
        }
        seen[0] += u64::from(error > fine.width);
        seen[1] += u64::from(part > control.gain.width);
    }
    assert!(seen.iter().all(|&count| count > 20), "{seen:?}");
}

/// Steps of a force of a newton and more.
#[test]
fn drive_words_of_coarse_forces_are_those_of_the_law() {
    for (seed, frac) in (0..).zip(-4..=1) {
        for law in [Law::Proportional, Law::Integral] {
            let mut profile = Profile::bundled("standard").expect("bundled");
            profile.formats.force = Format::unsigned(8, frac);
            profile.control = Some(Control::of(&profile, law));
            let mut random = Random::new(seed);
            let mut pair = Pair::tuned(&profile, &mut random);
            (0..25).for_each(|_| pair.check(&mut random));
        }
    }
}
