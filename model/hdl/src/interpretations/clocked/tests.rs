// SPDX-License-Identifier: MIT OR Apache-2.0
//! Codes of every operation against exact numbers: all codes of short words, the limits of long ones.

use super::*;
use crate::exact::{self, codes, greatest, least, limited, long_formats, pairs, short_formats};
use crate::format::BIT;
use crate::signal::{
    Assumed, Exact, Floor, HalfEven, Proved, Saturate, Wrap, bit, code, decides, is_known, is_set,
};

type Number = exact::Exact;

fn signal(value: i64, format: Format) -> Signal<i64> {
    Signal { value, format }
}

/// Holds that a signal is this number, and that its format has the code.
fn check(result: Signal<i64>, number: Number, case: &str) {
    assert_eq!(Number::of_signal(result), number, "{case}: got {result:?}");
    let within = least(result.format)..=greatest(result.format);
    assert!(within.contains(&result.value.into()), "{case}: {result:?} is no code of its format");
}

fn check_flag(result: Signal<i64>, set: bool, case: &str) {
    assert_eq!((result.value, result.format), (set.into(), BIT), "{case}");
}

fn check_pairs(formats: &[Format]) {
    for (a, b) in pairs(formats) {
        let case = format!("{a:?}, {b:?}");
        let (x, y) = (Number::of_signal(a), Number::of_signal(b));
        check(a + b, x + y, &case);
        check(a - b, x - y, &case);
        check(a * b, x * y, &case);
        check_flag(a.less_than(b), x < y, &case);
        check_flag(a.at_least(b), x >= y, &case);
        check_flag(a.equals(b), x == y, &case);
        check(bit(true).select(a, b), x, &case);
        check(bit(false).select(a, b), y, &case);
    }
}

#[test]
fn operations_on_two_short_words_are_exact() {
    check_pairs(&short_formats());
}

#[test]
fn operations_on_two_long_words_are_exact() {
    check_pairs(&long_formats());
}

#[test]
fn sums_and_differences_fill_the_widest_word() {
    for format in [Format::signed(62, 0), Format::unsigned(62, 7)] {
        for (a, b) in pairs(&[format]) {
            let (x, y) = (Number::of_signal(a), Number::of_signal(b));
            check(a + b, x + y, "sum");
            check(a - b, x - y, "difference");
        }
    }
}

#[test]
fn operations_on_one_word_are_exact() {
    for format in [short_formats(), long_formats()].concat() {
        for a in codes(format).into_iter().map(|value| signal(value, format)) {
            let (x, case) = (Number::of_signal(a), format!("{a:?}"));
            check(-a, -x, &case);
            // A sign at least, and one bit more for the most negative code.
            let width = 1 + if format.signed { format.width.max(2) } else { format.width };
            assert_eq!((-a).format, Format::signed(width, format.frac), "{case}");
            check(a.abs(), if a.value < 0 { -x } else { x }, &case);
            check(a.square(), x * x, &case);
            check(a.scaled(3), x * Number::of(8, BIT), &case);
            check(a.integer(), Number::of(a.value, Format::signed(63, 0)), &case);
            check_flag(
                a.msb(),
                if format.signed {
                    a.value < 0
                } else {
                    i128::from(a.value) > greatest(format) / 2
                },
                &case,
            );
        }
    }
}

/// Every rounding with every overflow, from every code of a word to every short format.
#[test]
fn narrowings_are_the_nearest_or_lower_code_saturated_or_wrapped() {
    let from =
        ["s6.3", "u6.3", "s5.-1", "u4.6", "s8.0"].map(|text| text.parse().expect("a format"));
    for (from, to) in from
        .into_iter()
        .flat_map(|from: Format| short_formats().into_iter().map(move |to| (from, to)))
    {
        for a in codes(from).into_iter().map(|value| signal(value, from)) {
            for (rounding, overflow) in
                [(HalfEven, Saturate), (HalfEven, Wrap), (Floor, Saturate), (Floor, Wrap)]
            {
                let result = a.quantize(to, rounding, overflow);
                let expected = limited(Number::of_signal(a).rounded(to, rounding), to, overflow);
                assert_eq!(
                    i128::from(result.value),
                    expected,
                    "{a:?} to {to}, {rounding:?}, {overflow:?}"
                );
            }
        }
    }
}

#[test]
fn long_words_narrow_as_short_ones() {
    for from in long_formats() {
        for a in codes(from).into_iter().map(|value| signal(value, from)) {
            for to in ["s18.10", "u9.4", "s25.17", "u40.10"]
                .map(|text| text.parse::<Format>().expect("a format"))
            {
                for (rounding, overflow) in
                    [(HalfEven, Saturate), (HalfEven, Wrap), (Floor, Saturate), (Floor, Wrap)]
                {
                    let result = a.quantize(to, rounding, overflow);
                    let expected =
                        limited(Number::of_signal(a).rounded(to, rounding), to, overflow);
                    assert_eq!(
                        i128::from(result.value),
                        expected,
                        "{a:?} to {to}, {rounding:?}, {overflow:?}"
                    );
                }
            }
        }
    }
}

/// The largest code of 63 bits is that of an `i64`.
#[test]
fn the_widest_word_saturates_at_its_largest_code() {
    let [unsigned, signed] = [Format::unsigned(63, 0), Format::signed(63, 0)];
    for (format, largest) in [(unsigned, i64::MAX), (signed, i64::MAX >> 1)] {
        assert_eq!(signal(largest, format).resize(format, Saturate).value, largest, "{format}");
    }
    assert_eq!(signal(i64::MAX, unsigned).resize(signed, Saturate).value, i64::MAX >> 1);
    assert_eq!(signal(-1, signed).resize(unsigned, Saturate).value, 0);
}

/// The bit that says so, and the limited number, over every sign of both formats.
#[test]
fn saturate_tells_what_it_limits() {
    let from = ["s6.3", "u6.3", "s4.1", "u3.0", "s1.0", "u1.0"]
        .map(|text| text.parse().expect("a format"));
    let to = short_formats().into_iter().chain([Format::unsigned(7, 3), Format::signed(8, 3)]);
    let to: Vec<Format> = to.collect();
    for (from, &to) in from.into_iter().flat_map(|from: Format| to.iter().map(move |to| (from, to)))
    {
        for a in codes(from).into_iter().map(|value| signal(value, from)) {
            for rounding in [HalfEven, Floor] {
                let rounded = Number::of_signal(a).rounded(to, rounding);
                let (limited, saturated) = a.saturate(to, rounding);
                let expected = exact::limited(rounded, to, Saturate);
                let case = format!("{a:?} to {to}, {rounding:?}");
                assert_eq!(i128::from(limited.value), expected, "{case}");
                check_flag(saturated, rounded != expected, &case);
            }
        }
    }
}

#[test]
fn bits_are_cut_and_joined() {
    for format in ["u6.2", "s6.2"].map(|text| text.parse::<Format>().expect("a format")) {
        for a in codes(format).into_iter().map(|value| signal(value, format)) {
            let pattern = i128::from(a.value).rem_euclid(64);
            for (low, width) in (0..6).flat_map(|low| (1..=6 - low).map(move |width| (low, width)))
            {
                let expected = pattern.div_euclid(1 << low).rem_euclid(1 << width);
                let cut = a.bits(low, width);
                assert_eq!(
                    (i128::from(cut.value), cut.format),
                    (expected, Format::unsigned(width, 0))
                );
            }
            let joined = a.bits(4, 2).concat(a.bits(1, 3)).concat(a.bits(0, 1));
            assert_eq!(i128::from(joined.value), pattern);
            assert_eq!(joined.format, Format::unsigned(6, 0));
        }
    }
}

#[test]
fn bits_are_combined() {
    for (a, b) in [(false, false), (false, true), (true, false), (true, true)] {
        let [x, y] = [a, b].map(bit::<i64>);
        check_flag(x & y, a && b, "and");
        check_flag(x | y, a || b, "or");
        check_flag(!x, !a, "not");
        assert_eq!((is_set(x), is_known(&x), decides(&x), x.can_skip()), (a, true, true, !a));
    }
}

#[test]
fn the_lesser_of_two_is_taken() {
    let format = Format::signed(3, 1);
    for (a, b) in pairs(&[format]) {
        let least = a.at_most(b);
        assert_eq!((least.value, least.format), (a.value.min(b.value), format));
    }
}

/// In a word of 3 bits: the code after the last is zero, or the most negative.
#[test]
fn a_count_returns_to_its_beginning() {
    for (format, after) in [(Format::unsigned(3, 0), 0), (Format::signed(3, 0), -4)] {
        for value in codes(format) {
            let next = signal(value, format).increment();
            let expected = if i128::from(value) == greatest(format) { after } else { value + 1 };
            assert_eq!((next.value, next.format), (expected, format));
        }
    }
}

#[test]
fn integers_are_read_as_codes() {
    let (word, to) = (Format::signed(6, 0), Format::signed(4, 3));
    for value in codes(word) {
        let read = signal(value, word).as_code(to);
        assert_eq!((i128::from(read.value), read.format), (limited(value.into(), to, Wrap), to));
    }
}

#[test]
fn a_point_is_aligned_without_a_change_of_the_number() {
    let aligned = signal(-3, Format::signed(3, 1)).align_point(Format::signed(7, 4));
    assert_eq!((aligned.value, aligned.format), (-24, Format::signed(7, 4)));
}

#[test]
fn the_limits_of_a_format_fit_where_it_is_said_that_they_do() {
    for to in short_formats() {
        for code in [least(to), greatest(to)] {
            let wide = signal(code as i64, Format::signed(8, to.frac));
            for overflow in [Proved, Assumed("a reason")] {
                assert_eq!(i128::from(wide.resize(to, overflow).value), code, "{to}");
            }
        }
    }
}

/// One above and one below, in builds with debug assertions.
#[test]
#[cfg(debug_assertions)]
fn what_was_said_to_fit_and_does_not_is_noticed() {
    for to in short_formats() {
        for code in [least(to) - 1, greatest(to) + 1] {
            for overflow in [Proved, Assumed("a reason")] {
                let narrow =
                    || signal(code as i64, Format::signed(8, to.frac)).resize(to, overflow);
                assert!(std::panic::catch_unwind(narrow).is_err(), "{code} in {to}");
            }
        }
    }
}

#[test]
#[should_panic(expected = "s8.3 → s8.2 is not exact")]
#[cfg(debug_assertions)]
fn bits_are_not_dropped_unnamed() {
    let _ = signal(8, Format::signed(8, 3)).resize(Format::signed(8, 2), Wrap);
}

/// Only formats are asked: more fractional bits are exact, whatever is below.
#[test]
fn an_exact_narrowing_may_refine() {
    assert_eq!(
        signal(-3, Format::signed(3, 1)).quantize(Format::signed(7, 4), Exact, Saturate).value,
        -24
    );
}

#[test]
fn constants_are_the_nearest_codes() {
    let format = Format::signed(4, 1);
    let of = |real| crate::signal::constant::<i64>(real, format).value;
    assert_eq!([0.25, 0.75, -9.0, 9.0].map(of), [0, 2, -8, 7]);
    assert_eq!((i64::raw(-5, format), i64::code(code(-5, format))), (-5, -5));
    assert_eq!((i64::real(code(-5, format)), i64::unrounded(code(-5, format))), (-2.5, -2.5));
}
