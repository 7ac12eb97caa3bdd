// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sums: those of the products; the clocks they take.

use super::{Demodulator, Inputs};
use crate::support::random::Random;
use crate::support::{Bench, MILLION, operations};
use hapticore_contract::profile::{Method, Profile, Window};
use hapticore_hdl::block::Block;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::shadow::Shadow;
use hapticore_hdl::signal::{Signal, bit, code, zero};
use hapticore_reference::rounded::{self, Exact, Sample};
use std::f64::consts::TAU;

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
    let pad = random.below(profile.pads) as i64;
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
                pad: if clock == 0 { pad } else { random.below(profile.pads) as i64 },
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
                assert_eq!(out.pad, pad, "clock {}: that of the window", bench.clock);
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
            assert_eq!(out.pad, pad, "clock {}: that of the window", bench.clock);
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
fn without_a_start_there_is_no_sum() {
    for (seed, profile) in (0..).zip(Profile::all()) {
        let mut bench = Bench::new(Demodulator::try_new(&profile).unwrap());
        let (formats, mut random) = (bench.block.inputs(), Random::new(seed));
        for _ in 0..500 {
            let any = Inputs::map(formats, |format| random.word(format));
            let out = bench.clock(Inputs { start: 0, ..any });
            let results = [out.valid, out.index, out.sum, out.pad, out.clipped];
            assert_eq!(results, [0; 5], "clock {}", bench.clock);
        }
    }
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

/// By phase, a result of the read-out takes 40 clocks: four a product, of five phases' two halves.
#[test]
fn the_first_sum_takes_the_clocks_that_it_says() {
    for profile in Profile::all() {
        let mut bench = Bench::new(Demodulator::try_new(&profile).unwrap());
        let quiet = Inputs::map(bench.block.inputs(), |_| 0);
        bench.clock(Inputs { start: 1, first: 1, last: 1, ..quiet });
        let first = (1..2000).find(|_| bench.clock(quiet).valid == 1);
        let reading = if profile.carrier.method == Method::Polyphase { 40 } else { 0 };
        assert_eq!(first, Some(bench.block.first_sum() + reading), "clocks from start");
    }
}

/// Sums are right, each has a word, and the registers that count have no bit that is never used.
#[test]
fn demodulators_have_as_many_terminals_as_a_profile_says() {
    for name in ["small", "standard"] {
        for terminals in 3..=16 {
            let mut profile = Profile::bundled(name).expect("bundled");
            profile.terminals.x = vec![1; terminals];
            profile.terminals.y = vec![1; terminals];
            let block = Demodulator::try_new(&profile).unwrap();
            if profile.carrier.method == Method::Products {
                assert!((block.sums()..2 * block.sums()).contains(&(block.sums.words as u64)));
            }
            let (mut bench, mut random) = (Bench::new(block), Random::new(terminals as u64));
            for _ in 0..2 {
                check_window(&mut bench, &profile, 7, &mut random);
            }
            check_steps(&mut bench);
        }
    }
}

/// Holds that the register of steps is as wide as the last step of a sample needs.
fn check_steps(bench: &mut Bench<Demodulator>) {
    let quiet = Inputs::map(bench.block.inputs(), |_| 0);
    bench.clock(Inputs { start: 1, first: 1, ..quiet });
    let steps = (0..bench.block.least_clocks_per_sample()).map(|_| {
        bench.clock(quiet);
        bench.registers().find(|(register, _)| register.name == "step").expect("there is one")
    });
    let (register, last) = steps.max_by_key(|&(_, step)| step).expect("a sample takes clocks");
    assert_eq!(register.format, Format::counter(last as u64), "step {last} is the last");
}

/// As narrow as the largest products let it be. By phase, two products more are counted; a tapered window's first word
/// is zero.
#[test]
fn sums_have_the_bits_that_the_largest_products_need() {
    for profile in Profile::all() {
        for window in [Window::Hann, Window::Rectangular] {
            for integrate in [60, 61, 62, 63, 64, 65, 126, 127, 128, 129] {
                let mut profile = profile.clone();
                (profile.carrier.window, profile.slot.integrate) = (window, integrate);
                let f = &profile.formats;
                let (largest, more) = match profile.carrier.method {
                    Method::Polyphase => (1 << 32, 2),
                    Method::Products => {
                        let frac = f.adc.frac.max(f.oscillator.frac);
                        (1i128 << (2 * frac), 0)
                    }
                };
                let products = integrate + more - u64::from(window == Window::Hann);
                let sum = Demodulator::try_new(&profile).unwrap().sum();
                let needed = largest * i128::from(products);
                assert!(needed <= sum.max_code(), "{integrate} samples: {sum}");
                assert!(needed > sum.max_code() / 2, "{integrate} samples: {sum}");
            }
        }
    }
}

/// A sample whose waves and codes are numbers: a word each, and a part of its step.
struct Unrounded {
    codes: Vec<Signal<Shadow>>,
    cosine: Signal<Shadow>,
    sine: Signal<Shadow>,
    window: Signal<Shadow>,
}

impl Unrounded {
    fn draw(profile: &Profile, random: &mut Random) -> Self {
        let mut number = |format: Format, shrunk: i64| {
            let code = random.word(format) / shrunk;
            let real = format.real(code) + format.lsb() * (random.below(100) as f64 / 200.0);
            Signal { value: Shadow { code, real }, format }
        };
        let (adc, wave) = (profile.formats.adc, profile.formats.oscillator);
        let window = number(Format { signed: false, width: wave.width - 1, ..wave }, 2);
        Unrounded {
            codes: (0..profile.channels()).map(|_| number(adc, 1)).collect(),
            cosine: number(wave, 1),
            sine: number(wave, 1),
            window: Signal { format: wave, ..window },
        }
    }

    /// What the sample, the m-th of its window, adds to each sum.
    fn products(&self, profile: &Profile, shift: i8, m: usize) -> Vec<f64> {
        let (square, channels) = self.codes.split_last().expect("the haptic channel is the last");
        let [window, h] = [self.window, *square].map(|number| number.value.real);
        let turn = TAU * m as f64 / 5.0;
        let (waves, raised) = match profile.carrier.method {
            Method::Products => ([self.cosine, self.sine].map(|wave| wave.value.real), 0.0),
            Method::Polyphase => {
                let tap = |wave: f64| (57230.0 * wave).round() / 65536.0 / f64::from(shift).exp2();
                ([turn.cos(), turn.sin()].map(tap), 1.0)
            }
        };
        let of =
            |code: &Signal<Shadow>| waves.map(|wave| window * wave * (code.value.real + raised));
        channels.iter().flat_map(of).chain([window * h * h]).collect()
    }
}

/// By phase, a result may be off by two steps of its own.
#[test]
fn numbers_that_are_not_rounded_are_the_sums_of_the_products() {
    for (seed, profile) in (0..).zip(Profile::all()) {
        let block = Demodulator::try_new(&profile).unwrap();
        let mut random = Random::new(seed);
        let samples: Vec<_> = (0..40).map(|_| Unrounded::draw(&profile, &mut random)).collect();
        let mut expected = vec![0.0; block.sums() as usize];
        for (m, sample) in samples.iter().enumerate() {
            let products = sample.products(&profile, block.shift(), m);
            expected.iter_mut().zip(products).for_each(|(sum, product)| *sum += product);
        }
        let allowed = match profile.carrier.method {
            Method::Products => 1e-9,
            Method::Polyphase => 2.0 * block.sum().lsb(),
        };
        let sums = ideal_sums(&block, &samples);
        assert_eq!(sums.len(), expected.len(), "{}", profile.name);
        for (k, (sum, expected)) in sums.into_iter().zip(expected).enumerate() {
            let off = (sum - expected).abs();
            assert!(off < allowed, "{}, sum {k}: {sum}, expected {expected}", profile.name);
        }
    }
}

/// The sums of samples, without their rounding.
fn ideal_sums(block: &Demodulator, samples: &[Unrounded]) -> Vec<f64> {
    let (mut state, mut sums, mut channel) = (block.reset::<Shadow>(), Vec::new(), 0);
    let mut clock = |inputs: Inputs<Signal<Shadow>>| {
        let out = block.clock(&mut state, inputs);
        sums.extend((out.valid.value.code == 1).then_some(out.sum.value.real));
        out.channel.value.code as usize
    };
    let quiet = Inputs::map(block.inputs(), zero);
    for (m, sample) in samples.iter().enumerate() {
        let by_phase = || code(m as i64 % 5, quiet.phase.format);
        let phase = block.polyphase().map_or(quiet.phase, |_| by_phase());
        for clocks in 0..block.least_clocks_per_sample() {
            channel = clock(Inputs {
                start: bit(clocks == 0),
                first: bit(m == 0),
                last: bit(m + 1 == samples.len()),
                code: sample.codes[channel],
                phase,
                cosine: sample.cosine,
                sine: sample.sine,
                window: sample.window,
                ..quiet
            });
        }
    }
    (0..block.latency()).for_each(|_| _ = clock(quiet));
    sums
}
