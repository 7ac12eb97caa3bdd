// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sums: those of the products; the clocks they take.

use super::{Demodulator, Inputs};
use crate::support::random::Random;
use crate::support::{Bench, MILLION, operations};
use hapticore_contract::profile::{Method, Profile};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_reference::rounded::{self, Exact, Sample};

#[test]
fn sums_are_those_of_the_products() {
    for (seed, profile) in (0..).zip(Profile::all()) {
        let (mut bench, mut random) =
            (Bench::new(Demodulator::try_new(&profile).unwrap()), Random::new(seed));
        let mut left = operations(MILLION / 3) as i64;
        while left > 0 {
            let samples = 1 + random.below(random.clone().below(profile.slot.integrate) + 1);
            // By phase, each sum has a sample at least.
            let samples =
                if profile.carrier.method == Method::Polyphase { samples.max(5) } else { samples };
            left -= samples as i64;
            check_window(&mut bench, &profile, samples, &mut random);
        }
    }
}

fn check_window(
    bench: &mut Bench<Demodulator>,
    profile: &Profile,
    samples: u64,
    random: &mut Random,
) {
    let (adc, lo) = (profile.formats.adc, profile.formats.oscillator);
    let sum = bench.block.sum();
    let (mut all_codes, mut carrier, mut channel, mut sums) =
        (Vec::new(), Vec::new(), 0, Vec::new());
    let mut clipped = 0;
    for m in 0..samples {
        let codes: Vec<i64> = (0..profile.channels()).map(|_| random.word(adc)).collect();
        let [cosine, sine] = [random.word(lo), random.word(lo)];
        let window = random.word(Format { signed: false, width: lo.width - 1, ..lo });
        // By phase, sums have room for the mean of the window.
        let polyphase = profile.carrier.method == Method::Polyphase;
        let (window, phase) = if polyphase { (window / 2, m as i64 % 5) } else { (window, 0) };
        let [first, last] = [m == 0, m == samples - 1].map(i64::from);
        for clock in 0..bench.block.least_clocks_per_sample() + random.below(3) {
            let (start, code) = (i64::from(clock == 0), codes[channel as usize]);
            let out = bench.clock(Inputs {
                start,
                first,
                last,
                pad: 0,
                code,
                cosine,
                sine,
                window,
                phase,
            });
            (channel, clipped) = (out.channel, out.clipped);
            if out.valid == 1 {
                assert_eq!(
                    out.index,
                    sums.len() as i64,
                    "clock {}: sums in their order",
                    bench.clock
                );
                sums.push(out.sum);
            }
        }
        all_codes.extend(codes.iter().map(|&code| code as i32));
        let [cosine, sine, window] = [cosine, sine, window].map(|code| Exact::of(code, lo));
        carrier.push(Sample { cosine, sine, window });
    }
    let quiet = Inputs::map(bench.block.inputs(), |_| 0);
    for _ in 0..bench.block.latency() {
        let out = bench.clock(quiet);
        if out.valid == 1 {
            assert_eq!(out.index, sums.len() as i64, "clock {}: sums in their order", bench.clock);
            sums.push(out.sum);
        }
    }
    let expected = rounded::demodulate(profile, &carrier, &all_codes);
    let parts = expected.phases.iter().flatten().chain([&expected.square]);
    let reference: Vec<i64> = parts.map(|part| part.code(sum)).collect();
    assert_eq!(
        sums, reference,
        "clock {}: {samples} samples {all_codes:?} with {carrier:?}",
        bench.clock
    );
    assert_eq!(clipped != 0, expected.clipped, "clock {}: clipped, of {all_codes:?}", bench.clock);
}

#[test]
fn latency_is_the_clocks_measured() {
    for profile in Profile::all() {
        let mut bench = Bench::new(Demodulator::try_new(&profile).unwrap());
        let quiet = Inputs::map(bench.block.inputs(), |_| 0);
        bench.clock(Inputs { start: 1, first: 1, last: 1, ..quiet });
        let last = (1..2000).filter(|_| bench.clock(quiet).valid == 1).last();
        assert_eq!(last, Some(bench.block.latency()), "clocks from start to the last sum");
    }
}
