// SPDX-License-Identifier: MIT OR Apache-2.0
//! Blocks that live on streams of samples, sums or words: what comes out is what the equations say, rounded so.

use crate::harness::{Bench, operations};
use crate::random::Random;
use hapticore_contract::frame::Field;
use hapticore_contract::profile::{Method, Profile, Window};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_model::blocks::currents::{self, Currents};
use hapticore_model::blocks::demodulator::{self, Demodulator};
use hapticore_model::blocks::frames::{self, Frames};
use hapticore_model::blocks::haptic_voltage::{self, HapticVoltage};
use hapticore_model::blocks::multiplexer::{self, Multiplexer};
use hapticore_model::blocks::oscillator::{self, Oscillator};
use hapticore_reference::rounded::{self, Exact, Sample};

const MILLION: u64 = 1_000_000;

#[test]
fn samples_are_counted_into_slots() {
    for (seed, profile) in (0..).zip(Profile::all()) {
        let (mut bench, mut random) = (Bench::new(Multiplexer::new(&profile)), Random::new(seed));
        for n in 0..operations(MILLION / 3) {
            bench.clock(multiplexer::Inputs { strobe: 1, clear: 0 });
            let sampled = bench.clock(multiplexer::Inputs { strobe: 0, clear: 0 });
            for _ in 0..random.below(3) {
                let waiting = bench.clock(multiplexer::Inputs { strobe: 0, clear: 0 });
                assert_eq!(waiting, multiplexer::Outputs { sample: 0, ..sampled }, "sample {n}");
            }
            let (slot, at) = (&profile.slot, n % profile.slot.samples());
            let expected = multiplexer::Outputs {
                sample: 1,
                restart: (at == 0).into(),
                integrate: (at >= slot.blanking()).into(),
                first: (at == slot.blanking()).into(),
                last: (at == slot.samples() - 1).into(),
                pad: (n / slot.samples() % profile.pads) as i64,
                closed: (at >= slot.open).into(),
            };
            assert_eq!(sampled, expected, "sample {n}");
        }
    }
}

#[test]
fn waves_are_those_of_the_table_at_the_phase() {
    for (seed, mut profile) in (0..).zip(Profile::all().into_iter().chain(Profile::all())) {
        profile.carrier.window = if seed < 3 { Window::Hann } else { Window::Rectangular };
        let reference = rounded::Oscillator::new(&profile);
        let (mut bench, mut random) = (Bench::new(Oscillator::new(&profile)), Random::new(seed));
        let format = profile.formats.oscillator;
        let (mut since_restart, mut since_first) = (0, 0);
        for sample in 0..operations(MILLION / 6) {
            let [restart, first] = [1500, 700].map(|one_in| sample == 0 || random.below(one_in) == 0);
            since_restart = if restart { 0 } else { since_restart + 1 };
            since_first = if first { 0 } else { since_first + 1 };
            bench.clock(oscillator::Inputs { sample: 1, restart: restart.into(), first: first.into() });
            let quiet = oscillator::Inputs { sample: 0, restart: 0, first: 0 };
            (0..4).map(|_| bench.clock(quiet)).find(|out| out.ready == 1).expect("ready after four clocks");
            let out = bench.clock(quiet);
            let Sample { cosine, sine, window } = reference.sample(since_restart, since_first);
            let [cosine, sine, window] = [cosine, sine, window].map(|wave| wave.code(format));
            let phase = if profile.carrier.method == Method::Polyphase { since_restart as i64 % 5 } else { 0 };
            let expected = oscillator::Outputs { ready: 0, cosine, sine, window, phase };
            assert_eq!(out, expected, "clock {}: sample {since_restart}, of the window {since_first}", bench.clock);
        }
    }
}

#[test]
fn sums_are_those_of_the_products() {
    for (seed, profile) in (0..).zip(Profile::all()) {
        let (mut bench, mut random) = (Bench::new(Demodulator::new(&profile)), Random::new(seed));
        let mut left = operations(MILLION / 3) as i64;
        while left > 0 {
            let samples = 1 + random.below(random.clone().below(profile.slot.integrate) + 1);
            // By phase, each sum has a sample at least.
            let samples = if profile.carrier.method == Method::Polyphase { samples.max(5) } else { samples };
            left -= samples as i64;
            check_window(&mut bench, &profile, samples, &mut random);
        }
    }
}

fn check_window(bench: &mut Bench<Demodulator>, profile: &Profile, samples: u64, random: &mut Random) {
    let (adc, lo) = (profile.formats.adc, profile.formats.oscillator);
    let sum = bench.block.sum();
    let (mut all_codes, mut carrier, mut channel, mut sums) = (Vec::new(), Vec::new(), 0, Vec::new());
    let mut clipped = 0;
    for m in 0..samples {
        let codes: Vec<i64> = (0..profile.channels()).map(|_| random.word(adc)).collect();
        let [cosine, sine] = [random.word(lo), random.word(lo)];
        let window = random.word(Format { signed: false, width: lo.width - 1, ..lo });
        // By phase, sums have room for what a window weighs in the mean.
        let polyphase = profile.carrier.method == Method::Polyphase;
        let (window, phase) = if polyphase { (window / 2, m as i64 % 5) } else { (window, 0) };
        let [first, last] = [m == 0, m == samples - 1].map(i64::from);
        for clock in 0..bench.block.least_clocks_per_sample() + random.below(3) {
            let (start, code) = (i64::from(clock == 0), codes[channel as usize]);
            let out =
                bench.clock(demodulator::Inputs { start, first, last, pad: 0, code, cosine, sine, window, phase });
            (channel, clipped) = (out.channel, out.clipped);
            if out.valid == 1 {
                assert_eq!(out.index, sums.len() as i64, "clock {}: sums in their order", bench.clock);
                sums.push(out.sum);
            }
        }
        all_codes.extend(codes.iter().map(|&code| code as i32));
        let [cosine, sine, window] = [cosine, sine, window].map(|code| Exact::of(code, lo));
        carrier.push(Sample { cosine, sine, window });
    }
    let quiet = demodulator::Inputs::map(bench.block.inputs(), |_| 0);
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
    assert_eq!(sums, reference, "clock {}: {samples} samples {all_codes:?} with {carrier:?}", bench.clock);
    assert_eq!(clipped != 0, expected.clipped, "clock {}: clipped, of {all_codes:?}", bench.clock);
}

#[test]
fn currents_are_amplitudes_and_their_sums() {
    for (seed, profile) in (0..).zip(Profile::all()) {
        let (mut bench, mut random) = (Bench::new(Currents::new(&profile)), Random::new(seed));
        for _ in 0..operations(MILLION / 20) {
            check_currents(&mut bench, &profile, &mut random);
        }
    }
}

fn check_currents(bench: &mut Bench<Currents>, profile: &Profile, random: &mut Random) {
    let (sum, amplitude, sums) = (bench.block.inputs().sum, bench.block.amplitude(), bench.block.sums());
    let count = 2 * profile.demodulated();
    let smaller = random.below(u64::from(sum.width) / 2);
    let codes: Vec<i64> = (0..count).map(|_| random.word(sum) >> smaller).collect();
    for (index, &sum) in (0..).zip(&codes) {
        bench.clock(currents::Inputs { valid: 1, index, sum });
    }
    bench.clock(currents::Inputs { valid: 1, index: count as i64, sum: 0 });
    let quiet = currents::Inputs { valid: 0, index: 0, sum: 0 };
    let out = (0..10_000).map(|_| bench.clock(quiet)).find(|out| out.done == 1).expect("currents finish");
    let words: Vec<[Exact; 2]> = codes.chunks(2).map(|iq| [0, 1].map(|part| Exact::of(iq[part], sum))).collect();
    let expected = rounded::currents(profile, &words);
    let reference = currents::Outputs {
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
fn mean_squares_are_the_last_sum() {
    for (seed, profile) in (0..).zip(Profile::all()) {
        let (mut bench, mut random) = (Bench::new(HapticVoltage::new(&profile)), Random::new(seed));
        let (format, last) = (bench.block.inputs().sum, 2 * profile.demodulated() as i64);
        let mut reference = haptic_voltage::Outputs { mean_square: 0, saturated: 0 };
        for _ in 0..operations(MILLION / 3) {
            let (valid, index) = (random.below(2) as i64, last - random.below(2) as i64);
            let sum = random.word(format) >> random.below(20);
            let out = bench.clock(haptic_voltage::Inputs { clear: 0, pad: 0, valid, index, sum });
            assert_eq!(out, reference, "clock {}", bench.clock);
            if valid == 1 && index == last {
                let expected = rounded::mean_square(&profile, Exact::of(sum, format));
                let mean_square = expected.value.code(profile.formats.mean_square);
                reference = haptic_voltage::Outputs { mean_square, saturated: expected.held.into() };
            }
        }
    }
}

#[test]
fn mean_squares_of_several_windows_are_the_mean_of_the_pads_last() {
    for (seed, windows) in (0..).zip([2, 4, 64]) {
        let mut profile = Profile::bundled("small").expect("bundled");
        profile.haptic.windows = windows;
        let block = HapticVoltage::new(&profile);
        let (format, last, latency) = (block.inputs().sum, 2 * profile.demodulated() as i64, block.latency());
        let (mut bench, mut random) = (Bench::new(block), Random::new(seed));
        let mut reference = rounded::Squares::new(&profile);
        for round in 0..20 * windows {
            let clear = i64::from(round > 0 && random.below(4 * windows) == 0);
            if clear == 1 {
                bench.clock(haptic_voltage::Inputs { clear, pad: 0, valid: 0, index: 0, sum: 0 });
                reference = rounded::Squares::new(&profile);
            }
            for pad in 0..profile.pads as i64 {
                let sum = (random.word(format) >> random.below(20)).abs();
                let mut inputs = haptic_voltage::Inputs { clear: 0, pad, valid: 1, index: last, sum };
                (0..latency).for_each(|_| {
                    bench.clock(inputs);
                    inputs.valid = 0;
                });
                let newest = rounded::mean_square(&profile, Exact::of(sum, format));
                let expected = reference.mean(&profile, pad as usize, newest);
                let mean_square = expected.value.code(profile.formats.mean_square);
                let expected = haptic_voltage::Outputs { mean_square, saturated: expected.held.into() };
                assert_eq!(bench.clock(inputs), expected, "{windows} windows, round {round}, pad {pad}");
            }
        }
    }
}

#[test]
fn frames_hold_what_was_last_valid_of_their_pad() {
    for (seed, profile) in (0..).zip(Profile::all()) {
        let (mut bench, mut random) = (Bench::new(Frames::new(&profile)), Random::new(seed));
        let mut reference = rounded::Frames::new(&profile);
        let formats = bench.block.inputs();
        for _ in 0..operations(MILLION / 3) {
            let codes = Field::ALL.map(|field| random.word(field.format(&profile)));
            let [r_x, r_y, x, y, sheet, capacitance, force, mean_square] = codes;
            let (pad, invalid) = (random.word(formats.pad) % profile.pads as i64, random.below(2) as i64);
            let quiet = frames::Inputs {
                start: 0,
                pad,
                invalid,
                r_x,
                r_y,
                x,
                y,
                sheet,
                capacitance,
                haptic_force: force,
                mean_square,
            };
            bench.clock(frames::Inputs { start: 1, ..quiet });
            let mut words = [0; Field::ALL.len()];
            let take = |out: &frames::Outputs<i64>| {
                if out.valid == 1 {
                    words[out.index as usize] = out.word;
                }
                out.done == 1
            };
            (0..100).map(|_| bench.clock(quiet)).find(take).expect("a frame finishes");
            let values: [Exact; 8] = std::array::from_fn(|k| Exact::of(codes[k], Field::ALL[k].format(&profile)));
            let expected = reference.words(pad as usize, values, invalid == 1);
            assert_eq!(words, expected, "clock {}: got, reference of {codes:?}, invalid {invalid}", bench.clock);
        }
    }
}
