// SPDX-License-Identifier: MIT OR Apache-2.0
//! Errors of single operations against their derivatives, and of roundings, tables and memories
//! against the table at the module's head.

mod golden;
mod sources;

use super::*;
use crate::signal::{Floor, HalfEven, Proved, Saturate, bit, code, constant};

const FORMAT: Format = Format::signed(12, 4);

fn moments(mean: f64, variance: f64, bound: f64) -> Moments {
    Moments { mean, variance, bound }
}

/// A signal whose error has mean 0.5, variance 1 and bound 2.
fn input(recording: &Recording, real: f64) -> Signal<Noise> {
    input_of(recording, real, FORMAT)
}

fn input_of(recording: &Recording, real: f64, format: Format) -> Signal<Noise> {
    let code = format.code(real).expect("a code");
    recording.input("input", Shadow { code, real }, format, moments(0.5, 1.0, 2.0))
}

/// Holds that two errors are alike to a billionth of their size.
fn check(recording: &Recording, of: Signal<Noise>, expected: Moments, case: &str) {
    let got = recording.errors(of.value).total;
    for (got, expected) in
        [(got.mean, expected.mean), (got.variance, expected.variance), (got.bound, expected.bound)]
    {
        assert!(
            (got - expected).abs() <= 1e-6 * (1e-3 + expected.abs()),
            "{case}: {got} for {expected}"
        );
    }
}

#[test]
fn what_two_signals_have_in_common_counts_once() {
    let recording = Recording::begin();
    let [x, y] = [3.0, -5.0].map(|real| input(&recording, real));
    let variance = |of: Signal<Noise>| recording.errors(of.value).total.variance;
    assert_eq!(variance(x + y), 2.0);
    assert_eq!(variance(x + x), 4.0);
    assert_eq!(variance(x - x), 0.0);
    assert_eq!(variance(x * y), 34.0, "5²+3²");
    assert_eq!(variance((x - x) * y), 0.0);
}

#[test]
fn errors_have_the_gain_of_the_derivative() {
    let recording = Recording::begin();
    let [x, y] = [3.0, -5.0].map(|real| input(&recording, real));
    let exact: Signal<Noise> = code(32, FORMAT);
    let of = |gain: f64| moments(0.5, 1.0, 2.0).times(gain);
    check(&recording, x + y, of(1.0).plus(of(1.0)), "sum");
    check(&recording, x - y, of(1.0).plus(of(-1.0)), "difference");
    check(&recording, x * y, of(-5.0).plus(of(3.0)), "product");
    check(&recording, x * exact, of(2.0), "product with an exact factor");
    check(&recording, exact - x, of(-1.0), "difference from an exact number");
    check(&recording, x.abs(), of(1.0), "magnitude of a positive number");
    check(&recording, y.abs(), of(-1.0), "magnitude of a negative number");
    check(&recording, input(&recording, 0.0).abs(), of(1.0), "magnitude of zero");
    check(&recording, x.scaled(3), of(8.0), "eight times");
    check(&recording, x.scaled(-2), of(0.25), "a quarter");
    check(&recording, bit(true).select(x, y * y), of(1.0), "choice");
    check(&recording, bit(false).select(x * x, y), of(1.0), "the other choice");
    for of in [
        exact + exact,
        exact * exact,
        x * code(0, FORMAT),
        x.bits(0, 3),
        x.bits(0, 2).concat(y.bits(0, 2)),
        x.less_than(y),
        x.equals(y),
    ] {
        assert_eq!(of.value.entry, EXACT, "what is exact or decides has no error");
    }
}

/// Values are those of the shadow interpretation, and so are decisions.
#[test]
fn values_are_those_of_the_shadow() {
    let recording = Recording::begin();
    let [x, y] = [3.0, -5.0].map(|real| input(&recording, real));
    let (s, t) = (shadow(x), shadow(y));
    let same = |noise: Signal<Noise>, of: Signal<Shadow>| {
        assert_eq!((noise.value.shadow, noise.format), (of.value, of.format))
    };
    same(x + y, s + t);
    same(x - y, s - t);
    same(x * y, s * t);
    same(y.abs(), t.abs());
    same(x.scaled(2), s.scaled(2));
    same(x.bits(4, 2).concat(y.bits(4, 3)), s.bits(4, 2).concat(t.bits(4, 3)));
    same(x.less_than(y), s.less_than(t));
    same(x.equals(x), s.equals(s));
    same(
        x.quantize(Format::signed(3, -1), HalfEven, Saturate),
        s.quantize(Format::signed(3, -1), HalfEven, Saturate),
    );
    same(bit(true).select(x, y), bit(true).select(s, t));
    same(bit(false).select(x, y), bit(false).select(s, t));
    let fine = y.resize(Format::signed(14, 6), Proved);
    same(fine, t.resize(Format::signed(14, 6), Proved));
    same(bit(true).select(x, fine), bit(true).select(s, shadow(fine)));
    for (a, b) in [(false, false), (false, true), (true, false), (true, true)] {
        let [p, q] = [a, b].map(bit::<Noise>);
        same(p & q, bit(a && b));
        same(p | q, bit(a || b));
        same(!p, bit(!a));
        assert_eq!(
            (crate::signal::is_set(p), p.can_skip(), <Noise as Value>::code(p)),
            (a, !a, a.into())
        );
    }
}

#[test]
fn rounding_is_a_source_where_a_number_has_an_error() {
    let recording = Recording::begin();
    let x = input(&recording, 3.0625);
    let (own, to) = (moments(0.5, 1.0, 2.0), Format::signed(12, 1));
    let added = Moments::of_rounding(HalfEven, 3, to.lsb());
    check(&recording, x.quantize(to, HalfEven, Saturate), own.plus(added), "three bits less");
    check(&recording, x.quantize(FORMAT, HalfEven, Saturate), own, "as many bits");
    check(&recording, x.quantize(Format::signed(14, 6), HalfEven, Saturate), own, "more bits");
    check(&recording, x.resize(Format::signed(14, 6), Proved), own, "exact");
    let zero = input(&recording, 0.0);
    check(
        &recording,
        zero.quantize(to, HalfEven, Saturate),
        own,
        "of nothing nothing is rounded away",
    );
    let exact: Signal<Noise> = code(49, FORMAT);
    assert_eq!(exact.quantize(to, HalfEven, Saturate).value.entry, EXACT);
    let (near, code) = (Shadow { code: 0, real: 0.01 }, Shadow { code: 1, real: 0.0 });
    for of in [near, code].map(|shadow| recording.input("input", shadow, FORMAT, own)) {
        check(
            &recording,
            of.quantize(to, HalfEven, Saturate),
            own.plus(added),
            "a number or a code alone",
        );
    }
    check(&recording, x.quantize(to, Floor, Saturate), Moments::default(), "a floor decides");
}

#[test]
fn constants_and_words_have_their_known_errors() {
    let recording = Recording::begin();
    let of = constant::<Noise>(0.3, FORMAT);
    check(&recording, of, Moments::known(0.3125 - 0.3), "five sixteenths for 0.3");
    assert_eq!(constant::<Noise>(0.25, FORMAT).value.entry, EXACT);
    let memory = Memory::table("table", FORMAT, vec![0.3, 0.25]);
    let mut words = Noise::words(&memory);
    let mut read = |memory: &Memory, word: i64, write: Option<(bool, i64, Signal<Noise>)>| {
        let address = |word| code(word, memory.address());
        let write = write.map(|(enable, at, data)| Write {
            enable: bit(enable),
            address: address(at),
            data,
        });
        Noise::access(memory, &mut words, address(word), write);
        memory.data::<Noise>(&mut words)
    };
    check(&recording, read(&memory, 0, None), Moments::known(0.3125 - 0.3), "a word of a table");
    assert_eq!(read(&memory, 1, None).value.entry, EXACT);
    let x = input(&recording, 1.0);
    assert_eq!(read(&memory, 1, Some((false, 1, x))).value.entry, EXACT);
    assert_eq!(read(&memory, 1, Some((true, 1, x))).value.entry, EXACT, "it reads as it was");
    let written = read(&memory, 1, None);
    assert_eq!((written.value.entry, written.value.shadow), (x.value.entry, x.value.shadow));
    let zeros = Noise::words(&Memory::new("zeros", 3, FORMAT));
    assert_eq!((zeros.entries, zeros.data), (vec![EXACT; 3], EXACT));
}

#[test]
fn moments_add_and_scale() {
    let (a, b) = (moments(3.0, 16.0, 5.0), moments(-1.0, 2.0, 3.0));
    assert_eq!(a.times(-2.0), moments(-6.0, 64.0, 10.0));
    assert_eq!(a.plus(b), moments(2.0, 18.0, 8.0));
    assert_eq!((a.rms(), Moments::known(-0.5)), (5.0, moments(-0.5, 0.0, 0.5)));
    assert_eq!(Moments::of_result(2.0), moments(0.0, 4.0 / 12.0, 1.0));
}
