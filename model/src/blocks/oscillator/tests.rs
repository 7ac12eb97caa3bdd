// SPDX-License-Identifier: MIT OR Apache-2.0
//! Waves: those of the table at the phase; the clocks they take.

use super::{Inputs, Oscillator, Outputs};
use crate::support::random::Random;
use crate::support::{Bench, MILLION, operations};
use hapticore_contract::profile::{Method, Profile, Window};
use hapticore_hdl::block::Block;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::interpretations::shadow::Shadow;
use hapticore_hdl::signal::code;
use hapticore_reference::rounded::{self, Sample};
use std::f64::consts::TAU;

#[test]
fn waves_are_those_of_the_table_at_the_phase() {
    let with = |window| Profile::all().into_iter().map(move |profile| (window, profile));
    let all = [Window::Hann, Window::Rectangular].into_iter().flat_map(with);
    for (seed, (window, mut profile)) in (0..).zip(all) {
        profile.carrier.window = window;
        check_waves(&profile, seed, operations(MILLION / 6));
    }
}

/// At a twelfth of a turn and at a sixth of a window a word is ½, ¼ or ¾ of the amplitude. That is
/// half way between two codes where the amplitude is no multiple of four.
#[test]
fn waves_half_way_between_two_codes_are_the_even_ones() {
    for (seed, (name, samples)) in (0..).zip([("standard", 24), ("small", 60), ("small", 120)]) {
        for less in 0..4 {
            let mut profile = Profile::bundled(name).expect("bundled");
            profile.slot.integrate = samples;
            profile.carrier.amplitude -= less;
            if profile.carrier.method == Method::Products {
                profile.carrier.periods = 2;
            }
            check_waves(&profile, seed, 400);
        }
    }
    let mut profile = Profile::bundled("standard").expect("bundled");
    (profile.slot.integrate, profile.carrier.amplitude) = (24, 5);
    let table = Oscillator::new(&profile).quarter.codes();
    assert_eq!(table, [0, 1, 2, 4, 4, 5, 5], "5·sin 30° is 2.5, its even neighbour 2");
}

/// A word's step is a million times as large as what is allowed here.
#[test]
fn windows_that_are_not_rounded_are_those_of_the_formula() {
    for profile in Profile::all() {
        let block = Oscillator::new(&profile);
        let mut state = block.reset::<Shadow>();
        let bit = |set: bool| code(i64::from(set), BIT);
        for m in 0..profile.slot.integrate {
            let mut real = 0.0;
            for clock in 0..=block.latency() + 1 {
                let sample = bit(clock == 0);
                let inputs = Inputs { sample, restart: bit(m == 0), first: bit(m == 0) };
                real = block.clock(&mut state, inputs).window.value.real;
            }
            let turn = TAU * m as f64 / profile.slot.integrate as f64;
            let expected = match profile.carrier.window {
                Window::Hann => profile.amplitude() * (1.0 - turn.cos()) / 2.0,
                Window::Rectangular => profile.amplitude(),
            };
            assert!((real - expected).abs() < 1e-11, "{}, sample {m}: {real}", profile.name);
        }
    }
}

/// Also what halving the window leaves, which would be carried from one window to the next.
#[test]
fn a_window_that_begins_anew_depends_on_no_window_before() {
    for profile in Profile::all() {
        let mut waves = Waves::new(&profile);
        for samples in 1..40 {
            (0..samples).for_each(|n| waves.check_sample([false, n == 0]));
        }
    }
}

#[test]
fn waves_begin_with_phase_and_window_at_zero_after_a_reset() {
    for profile in Profile::all() {
        let mut waves = Waves::at_reset(&profile);
        (0..20).for_each(|_| waves.check_sample([false, false]));
    }
}

/// Compares `samples` samples, begun anew at random, with the reference.
fn check_waves(profile: &Profile, seed: u64, samples: u64) {
    let (mut waves, mut random) = (Waves::new(profile), Random::new(seed));
    for sample in 0..samples {
        let begins = [1500, 700].map(|one_in| sample == 0 || random.below(one_in) == 0);
        waves.check_sample(begins);
    }
}

/// An oscillator beside the reference.
struct Waves<'a> {
    profile: &'a Profile,
    bench: Bench<Oscillator>,
    reference: rounded::Oscillator,
    since_restart: u64,
    since_first: u64,
}

impl<'a> Waves<'a> {
    /// Both at reset: waves are zero, and the first sample is that after a restart.
    fn new(profile: &'a Profile) -> Self {
        let mut waves = Waves::at_reset(profile);
        waves.check_sample([true, true]);
        waves
    }

    /// Both at reset: waves are zero. Polyphase counts before a sample, else after it.
    fn at_reset(profile: &'a Profile) -> Self {
        let bench = Bench::new(Oscillator::new(profile));
        let reference = rounded::Oscillator::new(profile);
        let products = profile.carrier.method == Method::Products;
        let since = if products { u64::MAX } else { 0 };
        let mut waves =
            Waves { profile, bench, reference, since_restart: since, since_first: since };
        let none = <Outputs as Bundle>::map(waves.bench.block.outputs(), |_| 0);
        let quiet = Inputs { sample: 0, restart: 0, first: 0 };
        if products {
            assert_eq!(waves.bench.clock(quiet), none, "at reset");
        }
        waves
    }

    /// Holds a sample to the reference.
    fn check_sample(&mut self, [restart, first]: [bool; 2]) {
        let since = |begins: bool, before: u64| if begins { 0 } else { before.wrapping_add(1) };
        self.since_restart = since(restart, self.since_restart);
        self.since_first = since(first, self.since_first);
        let bench = &mut self.bench;
        bench.clock(Inputs { sample: 1, restart: restart.into(), first: first.into() });
        let quiet = Inputs { sample: 0, restart: 0, first: 0 };
        (0..4)
            .map(|_| bench.clock(quiet))
            .find(|out| out.ready == 1)
            .expect("ready after four clocks");
        let out = bench.clock(quiet);
        let Sample { cosine, sine, window } =
            self.reference.sample(self.since_restart, self.since_first);
        let format = self.profile.formats.oscillator;
        let [cosine, sine, window] = [cosine, sine, window].map(|wave| wave.code(format));
        let phase = match self.profile.carrier.method {
            Method::Polyphase => self.since_restart as i64 % 5,
            Method::Products => 0,
        };
        let expected = Outputs { ready: 0, cosine, sine, window, phase };
        assert_eq!(
            out, expected,
            "clock {}: sample {}, of the window {}",
            bench.clock, self.since_restart, self.since_first
        );
    }
}

#[test]
fn latency_is_the_clocks_measured() {
    for profile in Profile::all() {
        let mut bench = Bench::new(Oscillator::new(&profile));
        bench.clock(Inputs { sample: 1, restart: 1, first: 1 });
        let quiet = Inputs { sample: 0, restart: 0, first: 0 };
        let measured = (1..100).find(|_| bench.clock(quiet).ready == 1);
        assert_eq!(measured, Some(bench.block.latency()), "clocks from sample to ready");
    }
}

/// A quarter of a turn in steps of a window's part, or half a window: both ends are among them.
#[test]
fn tables_have_no_word_twice() {
    for profile in Profile::all() {
        let parts = match profile.carrier.method {
            Method::Products => 4,
            Method::Polyphase => 2,
        };
        let words = profile.slot.integrate / parts + 1;
        assert_eq!(Oscillator::new(&profile).quarter.words as u64, words);
    }
}

/// As wide as the largest phase that there is, where one more would need another bit.
#[test]
fn phases_have_the_bits_that_they_need() {
    for (name, samples) in [("small", 64), ("small", 128), ("standard", 64), ("standard", 256)] {
        let mut profile = Profile::bundled(name).expect("bundled");
        (profile.slot.integrate, profile.carrier.periods) = (samples, 3);
        let mut bench = Bench::new(Oscillator::new(&profile));
        let counted = match profile.carrier.method {
            Method::Products => vec!["phase", "window_phase"],
            Method::Polyphase => vec!["window_phase"],
        };
        let mut most = vec![0; counted.len()];
        for clock in 0..24 * samples {
            let first = i64::from(clock == 0);
            let sample = i64::from(clock % 24 == 0);
            bench.clock(Inputs { sample, restart: first, first });
            for (most, name) in most.iter_mut().zip(&counted) {
                *most = register(&bench, name).1.max(*most);
            }
        }
        for (most, name) in most.into_iter().zip(counted) {
            let (format, _) = register(&bench, name);
            assert_eq!(format, Format::counter(most as u64), "{name} comes to {most}");
        }
    }
}

/// The format of a register, and what it holds.
fn register(bench: &Bench<Oscillator>, name: &str) -> (Format, i64) {
    let mut registers = bench.registers();
    let (variable, code) =
        registers.find(|(register, _)| register.name == name).expect("a register has this name");
    (variable.format, code)
}
