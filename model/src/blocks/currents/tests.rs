// SPDX-License-Identifier: MIT OR Apache-2.0
//! Currents: amplitudes and their sums, rounded; the clocks they take.

use super::{Currents, Inputs, Outputs};
use crate::support::random::Random;
use crate::support::{Bench, MILLION, operations};
use hapticore_contract::profile::Profile;
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

fn check_currents(bench: &mut Bench<Currents>, profile: &Profile, codes: Vec<i64>) {
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
