// SPDX-License-Identifier: MIT OR Apache-2.0
//! Numbers of every operation against exact ones: what is meant happens, no word length does.

use super::*;
use crate::exact::{Exact, codes, least, pairs, power, short_formats};
use crate::format::BIT;
use crate::memory::Memory;
use crate::signal::{
    self, Assumed, Floor, HalfEven, Proved, Saturate, Wrap, bit, is_known, is_set,
};

fn real(of: Signal<i64>) -> Signal<Real> {
    Signal { value: Real(of.format.real(of.value)), format: of.format }
}

fn number(of: Signal<i64>) -> Exact {
    Exact::of_signal(of)
}

fn check(result: Signal<Real>, number: Exact, case: &str) {
    assert_eq!(result.value.0, number.real(), "{case}");
}

fn check_flag(result: Signal<Real>, set: bool, case: &str) {
    assert_eq!((result.value.0, result.format), (f64::from(u8::from(set)), BIT), "{case}");
}

#[test]
fn operations_on_two_numbers_are_those_of_the_numbers() {
    for (a, b) in pairs(&short_formats()) {
        let case = format!("{a:?}, {b:?}");
        let (x, y, p, q) = (number(a), number(b), real(a), real(b));
        check(p + q, x + y, &case);
        check(p - q, x - y, &case);
        check(p * q, x * y, &case);
        check_flag(p.less_than(q), x < y, &case);
        check_flag(p.equals(q), x == y, &case);
        check(bit(true).select(p, q), x, &case);
        check(bit(false).select(p, q), y, &case);
    }
}

#[test]
fn operations_on_one_number_are_those_of_the_number() {
    for format in short_formats() {
        for a in codes(format).into_iter().map(|value| Signal { value, format }) {
            let case = format!("{a:?}");
            check(-real(a), -number(a), &case);
            check(real(a).abs(), if a.value < 0 { -number(a) } else { number(a) }, &case);
            check(real(a).square(), number(a) * number(a), &case);
            check(real(a).scaled(3), number(a) * Exact::of(8, BIT), &case);
            assert_eq!(<Real as Value>::code(real(a)), a.value);
            assert_eq!(
                (Real::real(real(a)), Real::unrounded(real(a))),
                (real(a).value.0, real(a).value.0)
            );
        }
    }
}

/// Only a floor and a wrap change a number, and saturation of a negative one to an unsigned format.
#[test]
fn only_what_is_meant_narrows() {
    for (from, to) in ["s6.3", "u6.3", "s5.-1"]
        .into_iter()
        .flat_map(|from| short_formats().into_iter().map(move |to| (from, to)))
    {
        let format: Format = from.parse().expect("a format");
        for a in codes(format).into_iter().map(|value| Signal { value, format }) {
            let case = format!("{a:?} to {to}");
            let (x, floor) = (number(a), number(a).rounded(to, Floor));
            let floored = Exact::of(floor as i64, to);
            let zero = Exact::of(0, BIT);
            let clipped =
                |of: Exact| if format.signed && !to.signed && of < zero { zero } else { of };
            check(real(a).quantize(to, HalfEven, Saturate), clipped(x), &case);
            check(real(a).quantize(to, Floor, Saturate), clipped(floored), &case);
            check(real(a).quantize(to, HalfEven, Wrap), x.wrapped(to), &case);
            check(real(a).quantize(to, Floor, Wrap), floored.wrapped(to), &case);
            for overflow in [Proved, Assumed("a reason")] {
                check(real(a).quantize(to, HalfEven, overflow), x, &case);
                check(real(a).quantize(to, Floor, overflow), floored, &case);
            }
        }
    }
}

#[test]
fn bits_are_those_of_the_floor() {
    for format in ["u6.2", "s6.2"].map(|text| text.parse::<Format>().expect("a format")) {
        for a in codes(format).into_iter().map(|value| Signal { value, format }) {
            let pattern = i128::from(a.value) - least(format);
            let pattern = if format.signed { (pattern + 32) % 64 } else { pattern };
            // Half a step more is the same code.
            let above = Signal { value: Real(real(a).value.0 + 0.125), format };
            for (low, width) in [(0, 6), (0, 3), (2, 3), (5, 1)] {
                let expected = pattern.div_euclid(power(low)).rem_euclid(power(width));
                let cut = above.bits(low as u8, width as u8);
                assert_eq!(
                    (cut.value.0, cut.format),
                    (expected as f64, Format::unsigned(width as u8, 0))
                );
            }
            let joined = above.bits(4, 2).concat(above.bits(0, 4));
            assert_eq!(joined.value.0, pattern as f64);
        }
    }
}

#[test]
fn bits_are_combined() {
    for (a, b) in [(false, false), (false, true), (true, false), (true, true)] {
        let [x, y] = [a, b].map(bit::<Real>);
        check_flag(x & y, a && b, "and");
        check_flag(x | y, a || b, "or");
        check_flag(!x, !a, "not");
        assert_eq!((is_set(x), is_known(&x), x.can_skip()), (a, true, false));
    }
}

#[test]
fn constants_are_not_rounded() {
    let format = Format::signed(4, 1);
    assert_eq!(signal::constant::<Real>(0.3, format).value, Real(0.3));
    assert_eq!(signal::code::<Real>(-3, format).value, Real(-1.5));
    let a = signal::zero(format);
    assert_eq!(Real::with_unrounded(a, 0.7), Real(0.7));
    assert_eq!(<Real as Value>::code(Signal { value: Real(9.0), format }), 7);
}

#[test]
fn a_golden_model_takes_the_place_of_a_result() {
    let [a, b, c] =
        [3.0, 5.0, 0.5].map(|real| Signal { value: Real(real), format: Format::signed(8, 1) });
    let golden = a.golden(&[b, c, a], |of| of[0] / of[1] + of[2] * of.len() as f64);
    assert_eq!(golden.value, Real(19.0));
}

#[test]
fn words_are_numbers_that_no_format_rounds() {
    let memory =
        Memory { words: 3, ..Memory::table("table", Format::signed(4, 1), vec![0.3, 99.0]) };
    let mut words = Real::words(&memory);
    let address = |word: f64| Signal { value: Real(word), format: memory.address() };
    let mut read = |word: f64, write: Option<(bool, f64, f64)>| {
        let write = write.map(|(enable, at, data)| Write {
            enable: bit(enable),
            address: address(at),
            data: Signal { value: Real(data), format: memory.format },
        });
        Real::access(&memory, &mut words, address(word), write);
        memory.data::<Real>(&mut words).value.0
    };
    assert_eq!([0.0, 1.0, 2.0, 3.0].map(|word| read(word, None)), [0.3, 99.0, 0.0, 0.0]);
    assert_eq!(read(0.0, Some((true, 0.0, 0.7))), 0.3, "a word that is written reads as it was");
    assert_eq!(read(0.0, Some((false, 0.0, 0.1))), 0.7);
    assert_eq!(read(0.0, Some((true, 2.0, 0.2))), 0.7, "what is not enabled is not written");
    assert_eq!(read(2.0, None), 0.2);
}

/// Without word lengths nothing saturates but a negative number that becomes unsigned.
#[test]
fn only_a_lost_sign_saturates() {
    let of = |value| real(Signal { value, format: Format::signed(6, 2) });
    for (to, code, expected) in [
        (Format::unsigned(2, 0), -3, (0.0, 1.0)),
        (Format::unsigned(2, 0), 31, (7.75, 0.0)),
        (Format::signed(2, 0), -32, (-8.0, 0.0)),
    ] {
        let (limited, saturated) = of(code).saturate(to, HalfEven);
        assert_eq!((limited.value.0, saturated.value.0), expected, "{code} to {to}");
    }
}
