// SPDX-License-Identifier: MIT OR Apache-2.0
//! Currents: amplitudes and their sums, rounded; the clocks they take.

use super::{Currents, Inputs, Outputs};
use crate::support::random::Random;
use crate::support::{Bench, MILLION, check_rest, operations};
use hapticore_contract::profile::Profile;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::{Format, MAX_WIDTH};
use hapticore_hdl::signal::Signal;
use hapticore_reference::rounded::{self, Exact};

#[test]
fn currents_are_amplitudes_and_their_sums() {
    for (seed, profile) in (0..).zip(Profile::of_distinct_words()) {
        let (mut bench, mut random) =
            (Bench::new(Currents::try_new(&profile).unwrap()), Random::new(seed));
        for _ in 0..operations(MILLION / 20) {
            let sum = bench.block.inputs().sum;
            let smaller = random.below(u64::from(sum.width) / 2);
            let count = 2 * profile.demodulated();
            let codes = (0..count).map(|_| random.word(sum) >> smaller).collect();
            check_currents(&mut bench, &profile, codes);
        }
    }
}

/// The terminals of one side at full scale, the others without current: sums as large as there are.
#[test]
fn currents_of_one_side_alone_are_their_sums() {
    for profile in Profile::of_distinct_words() {
        let mut bench = Bench::new(Currents::try_new(&profile).unwrap());
        let full = bench.block.inputs().sum.max_code() as i64;
        for (signs, side) in [(&profile.terminals.x, 1), (&profile.terminals.y, -1)] {
            let of = |channel: usize| match signs.get(channel) {
                Some(sign) if *sign != side => 0,
                _ => full,
            };
            let codes =
                (0..profile.demodulated() as usize).flat_map(|channel| [of(channel); 2]).collect();
            check_currents(&mut bench, &profile, codes);
        }
    }
}

/// Full scale of the terminals without a sensing voltage, and the other way round.
#[test]
fn currents_without_a_voltage_and_a_voltage_alone_are_their_sums() {
    for profile in Profile::of_distinct_words() {
        let mut bench = Bench::new(Currents::try_new(&profile).unwrap());
        let full = bench.block.inputs().sum.max_code() as i64;
        let sums = 2 * profile.demodulated() as usize;
        for of_terminals in [true, false] {
            let of = |sum| if (sum < sums - 2) == of_terminals { full } else { 0 };
            check_currents(&mut bench, &profile, (0..sums).map(of).collect());
        }
    }
}

/// Whatever their number, and whichever of them have a sign in which ratio.
#[test]
fn currents_of_any_terminals_are_their_sums() {
    for name in ["small", "standard"] {
        for terminals in 3..=16 {
            let profile = with_terminals(name, terminals);
            let mut bench = Bench::new(Currents::try_new(&profile).unwrap());
            let (sum, mut random) = (bench.block.inputs().sum, Random::new(terminals as u64));
            for smaller in [0, 2, 9] {
                let count = 2 * profile.demodulated();
                let codes = (0..count).map(|_| random.word(sum) >> smaller).collect();
                check_currents(&mut bench, &profile, codes);
            }
        }
    }
}

/// No bit is missing, and none is never used.
#[test]
fn words_of_currents_have_the_bits_that_all_terminals_need() {
    for name in ["small", "standard"] {
        for terminals in 3..=16 {
            let profile = with_terminals(name, terminals);
            let block = Currents::try_new(&profile).unwrap();
            // Signed by all terminals alike, each with as much as an amplitude can be.
            let needed = (terminals as i128) << block.least().width;
            check_narrowest(needed, block.sums().0);
            check_narrowest(needed, block.sums().1);
            if profile.formats.block_shift > 0 {
                check_narrowest((terminals as i128) << (profile.formats.iq.width - 1), block.total);
            }
            // In-phase and quadrature of the terminals and the sensing voltage.
            let places = 2 * (terminals + 1);
            assert!((places..2 * places).contains(&block.words.words), "{terminals} terminals");
        }
    }
}

/// Holds that a code fits into a format, and not into one that is a bit narrower.
fn check_narrowest(needed: i128, format: Format) {
    assert!(needed <= format.max_code(), "{needed} is beyond {format}");
    assert!(needed > format.max_code() / 2, "{needed} has room in less than {format}");
}

fn with_terminals(name: &str, terminals: usize) -> Profile {
    let mut profile = Profile::bundled(name).expect("bundled");
    let signs = |signs: [i8; 5]| signs.into_iter().cycle().take(terminals).collect();
    profile.terminals.x = signs([1, 0, -1, 0, 1]);
    profile.terminals.y = signs([0, 1, 1, 0, -1]);
    profile
}

/// The words of the terminals fit, their total does not.
#[test]
fn a_total_that_does_not_fit_is_saturated() {
    let mut profile = Profile::bundled("standard").expect("bundled");
    profile.formats.total = profile.formats.iq;
    let mut bench = Bench::new(Currents::try_new(&profile).unwrap());
    let eighth = bench.block.inputs().sum.max_code() as i64 / 8;
    let codes = vec![eighth; 2 * profile.demodulated() as usize];
    let out = check_currents(&mut bench, &profile, codes);
    assert_eq!(out.saturated, 1);
}

/// A half step of an I/Q word has as many bits as the model has, and then one more.
#[test]
fn words_that_cannot_be_rounded_are_refused() {
    for name in ["standard", "fine", "fast"] {
        let mut profile = Profile::bundled(name).expect("bundled");
        let sum = Currents::try_new(&profile).unwrap().sum;
        let scaled = sum.frac + profile.sum_shift();
        profile.formats.iq.frac = scaled - MAX_WIDTH as i8;
        assert!(Currents::try_new(&profile).is_ok(), "{name}: half a step is a word");
        profile.formats.iq.frac -= 1;
        let refused = Currents::try_new(&profile).expect_err("half a step is no word");
        assert!(refused.to_string().contains("a sum over the window"), "{refused}");
    }
}

#[test]
fn currents_that_are_run_on_are_the_same() {
    for (seed, profile) in (0..).zip(Profile::of_distinct_words()) {
        let block = || Currents::try_new(&profile).unwrap();
        let mut hurried = block();
        hurried.hurry();
        let ([mut clocked, mut hurried], mut random) =
            ([block(), hurried].map(Bench::new), Random::new(seed));
        let (sum, last) = (clocked.block.inputs().sum, 2 * profile.demodulated() as i64);
        for _ in 0..20 {
            let mut inputs = Inputs { valid: 1, index: 0, sum: 0 };
            for index in 0..=last {
                inputs = Inputs { valid: 1, index, sum: random.word(sum) >> random.below(20) };
                clocked.clock(inputs);
                hurried.clock(inputs);
            }
            let with_formats = Inputs::zip(inputs, hurried.block.inputs());
            let signals = Inputs::map(with_formats, |(value, format)| Signal { value, format });
            hurried.block.run_on(&mut hurried.state, signals);
            let quiet = Inputs { valid: 0, ..inputs };
            let at_once = hurried.clock(quiet);
            let expected = (0..10_000).map(|_| clocked.clock(quiet)).find(|out| out.done == 1);
            assert_eq!(Some(at_once), expected, "at once, clock by clock");
        }
    }
}

/// Holds the results to the reference, and gives them.
fn check_currents(bench: &mut Bench<Currents>, profile: &Profile, codes: Vec<i64>) -> Outputs<i64> {
    let (sum, amplitude, sums) =
        (bench.block.inputs().sum, bench.block.amplitude(), bench.block.sums());
    let count = codes.len();
    for (index, &sum) in (0..).zip(&codes) {
        bench.clock(Inputs { valid: 1, index, sum });
    }
    bench.clock(Inputs { valid: 1, index: count as i64, sum: 0 });
    let quiet = Inputs { valid: 0, index: 0, sum: 0 };
    let out =
        (0..10_000).map(|_| bench.clock(quiet)).find(|out| out.done == 1).expect("currents finish");
    let words: Vec<[Exact; 2]> =
        codes.chunks(2).map(|iq| [0, 1].map(|part| Exact::of(iq[part], sum))).collect();
    let expected = rounded::currents(profile, &words);
    let reference = Outputs {
        done: 1,
        total: expected.total.code(amplitude),
        sense: expected.sense.code(amplitude),
        x: expected.x.code(sums.0),
        y: expected.y.code(sums.0),
        corners: expected.corners.code(sums.1),
        least: expected.least.code(bench.block.least()),
        saturated: expected.saturated.into(),
    };
    assert_eq!(out, reference, "clock {}: got, reference of sums {codes:?}", bench.clock);
    out
}

#[test]
fn latency_is_the_clocks_measured() {
    for profile in Profile::all() {
        let mut bench = Bench::new(Currents::try_new(&profile).unwrap());
        for index in 0..=2 * profile.demodulated() as i64 {
            bench.clock(Inputs { valid: 1, index, sum: 1000 * index });
        }
        let quiet = Inputs { valid: 0, index: 0, sum: 0 };
        let measured = (1..10_000).find(|_| bench.clock(quiet).done == 1);
        assert_eq!(
            measured,
            Some(bench.block.latency()),
            "clocks from the last sum (the mean square's) to done"
        );
    }
}

#[test]
fn without_sums_there_are_no_currents() {
    for profile in Profile::of_distinct_words() {
        check_rest(Currents::try_new(&profile).unwrap(), &["valid"]);
    }
}
