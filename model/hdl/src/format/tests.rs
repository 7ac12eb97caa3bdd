// SPDX-License-Identifier: MIT OR Apache-2.0
//! Formats: their limits, and the formats of results, by looking at every code.

use super::*;
use crate::exact::{Exact, codes, format_pairs, greatest, least, short_formats};

#[test]
fn formats_read_and_print() {
    for text in ["s18.17", "u32.32", "u18.38", "s24.-3", "u63.0", "s1.0"] {
        assert_eq!(text.parse::<Format>().unwrap().to_string(), text);
        assert_eq!(format!("{:?}", text.parse::<Format>().unwrap()), text);
    }
    for text in ["", "x8.7", "s0.0", "s64.0", "s18", "u1.x", "é8.1"] {
        assert!(text.parse::<Format>().is_err(), "{text}");
    }
}

#[test]
fn formats_are_kept_as_text() {
    let format = Format::signed(18, 17);
    let as_text = serde::de::value::StrDeserializer::<serde::de::value::Error>::new("s18.17");
    assert_eq!(serde::Deserialize::deserialize(as_text), Ok(format));
    let wrong = serde::de::value::StrDeserializer::<serde::de::value::Error>::new("s18");
    let refused = <Format as serde::Deserialize>::deserialize(wrong).unwrap_err().to_string();
    assert!(refused.contains(r#"got "s18""#), "{refused}");
    struct Text(String);
    impl fmt::Display for Text {
        fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            serde::Serialize::serialize(&self.0.parse::<Format>().expect("a format"), f)
        }
    }
    assert_eq!(Text("s18.17".into()).to_string(), "s18.17", "a formatter takes texts");
}

/// The number of codes and their limits, up to the widest word and in one of 127 bits.
#[test]
fn limits_are_powers_of_two() {
    for (signed, width) in [false, true].into_iter().flat_map(|s| (1..=63).map(move |w| (s, w))) {
        let format = Format { signed, width, frac: 5 };
        assert_eq!((format.min_code(), format.max_code()), (least(format), greatest(format)));
        assert!(!format.is_none());
    }
    assert!(Format::NONE.is_none() && Format::NONE.max_code() == 0 && Format::NONE.min_code() == 0);
}

#[test]
fn joined_with_no_bits_a_format_stays() {
    for (width, frac) in (1..=63).flat_map(|width| (-63..=63).map(move |frac| (width, frac))) {
        for signed in [false, true] {
            let format = Format { signed, width, frac };
            assert_eq!(format.join(Format::NONE), format);
            assert_eq!(Format::NONE.join(format), format);
        }
    }
    assert_eq!(Format::NONE.join(Format::NONE), Format::NONE);
}

#[test]
fn a_counter_holds_its_most_and_no_bit_more() {
    assert_eq!(Format::counter(0), Format::unsigned(1, 0));
    for width in 1..=63u8 {
        let most = greatest(Format::unsigned(width, 0)) as u64;
        assert_eq!(Format::counter(most), Format::unsigned(width, 0));
        assert_eq!(Format::counter(most + 1), Format::unsigned(width + 1, 0));
    }
}

#[test]
fn a_point_is_moved() {
    let format = Format::signed(9, 4);
    assert_eq!(format.scaled(3), Format::signed(9, 1));
    assert_eq!(format.scaled(-3), Format::signed(9, 7));
    assert_eq!((format.integer(), format.assume_frac(4)), (Format::signed(9, 0), format));
    assert_eq!(Format::unsigned(5, 0).as_uint(), Format::unsigned(5, 0));
    assert_eq!((format.where_present(true), format.where_present(false)), (format, Format::NONE));
}

#[test]
#[should_panic(expected = "!self.signed && self.frac == 0")]
#[cfg(debug_assertions)]
fn a_signed_integer_is_no_count() {
    let _ = Format::signed(5, 0).as_uint();
}

#[test]
#[should_panic(expected = "!self.signed && self.frac == 0")]
#[cfg(debug_assertions)]
fn a_fraction_is_no_count() {
    let _ = Format::unsigned(5, 1).as_uint();
}

#[test]
#[should_panic(expected = "self.frac == frac")]
#[cfg(debug_assertions)]
fn a_point_is_where_it_is_assumed() {
    let _ = Format::unsigned(5, 1).assume_frac(2);
}

/// Whether every number of `of` is a code of `format`.
fn represents(format: Format, of: Format) -> bool {
    codes(of).into_iter().all(|code| is_code(format, Exact::of(code, of)))
}

fn is_code(format: Format, number: Exact) -> bool {
    let code = number.rounded(format, crate::signal::Floor);
    (least(format)..=greatest(format)).contains(&code) && Exact::of(code as i64, format) == number
}

#[test]
fn a_format_holds_another_where_it_has_its_numbers() {
    for (a, b) in format_pairs() {
        // That of a format with one code too few for its exponents: zero alone, of a signed bit.
        if b.width > u8::from(b.signed) {
            assert_eq!(a.holds(b), represents(a, b), "{a} holds {b}");
        }
    }
}

/// Holds that each result of two codes is a code of the format of results.
fn check_results(result: fn(Format, Format) -> Format, of: fn(Exact, Exact) -> Exact) {
    for (a, b) in format_pairs() {
        let to = result(a, b);
        for (x, y) in codes(a).into_iter().flat_map(|x| codes(b).into_iter().map(move |y| (x, y))) {
            let number = of(Exact::of(x, a), Exact::of(y, b));
            assert!(is_code(to, number), "{a}, {b}: {to}");
        }
    }
}

#[test]
fn exact_results_have_formats_that_hold_them() {
    check_results(Format::sum, |x, y| x + y);
    check_results(Format::difference, |x, y| x - y);
    check_results(Format::product, |x, y| x * y);
}

#[test]
fn the_format_of_both_is_the_narrowest() {
    check_results(Format::join, |x, _| x);
    check_results(Format::join, |_, y| y);
    for (a, b) in format_pairs() {
        let (join, wide) = (a.join(b), |of: Format| of.width > u8::from(of.signed));
        let less = Format { width: join.width - 1, ..join };
        let lacks = less.is_none() || !represents(less, a) || !represents(less, b);
        assert!(lacks || !wide(a) || !wide(b), "{a}, {b}: {join} is too wide");
        assert_eq!(join.frac, a.frac.max(b.frac));
        assert_eq!((join, join.signed), (b.join(a), a.signed || b.signed));
        assert_eq!((a.join(Format::NONE), Format::NONE.join(a)), (a, a));
    }
}

/// One bit more than both for a sum, the bits of both for a product.
#[test]
fn widths_of_results() {
    for (a, b) in format_pairs() {
        let join = a.join(b);
        assert_eq!(a.sum(b), Format { width: join.width + 1, ..join });
        assert_eq!(a.difference(b), Format { signed: true, width: join.width + 1, ..join });
        let (signed, width, frac) = (a.signed || b.signed, a.width + b.width, a.frac + b.frac);
        assert_eq!(a.product(b), Format { signed, width, frac });
    }
}

/// Rounded to its steps, every number is a code, before and after the step that rounding may add.
#[test]
fn rounding_has_room_for_the_next_code() {
    for (a, to) in format_pairs() {
        let rounded = a.rounded(to);
        assert_eq!((rounded.frac, rounded.signed), (to.frac, a.signed));
        let bits = i32::from(a.width) - i32::from(a.frac) + i32::from(to.frac) + 1;
        assert_eq!(i32::from(rounded.width), bits.max(to.width.into()), "{a} to {to}");
        let steps = i32::from(a.frac) - i32::from(to.frac);
        let widest = i32::from(rounded.width).max(a.width.into()).max(steps);
        assert_eq!(i32::from(a.rounding_width(to)), widest, "{a} to {to}");
        for code in codes(a) {
            let nearest = Exact::of(code, a).rounded(to, crate::signal::HalfEven);
            assert!((least(rounded)..=greatest(rounded)).contains(&nearest), "{a} to {to}");
        }
    }
    let far = Format::signed(4, 20);
    assert_eq!(
        far.rounding_width(Format::signed(3, 1)),
        19,
        "the half step is wider than the word"
    );
}

#[test]
fn arithmetic_formats_hold_their_corners() {
    let (s, u) = (Format::signed(4, 2), Format::unsigned(3, 1));
    assert_eq!(s.product(u), Format::signed(7, 3));
    assert_eq!(s.join(u), Format::signed(5, 2));
    assert_eq!(s.sum(u), Format::signed(6, 2));
    assert_eq!(u.difference(u), Format::signed(4, 1));
    assert_eq!(
        s.min_code() * s.min_code(),
        64,
        "the square of the most negative code needs the whole product"
    );
    assert!(s.product(s).max_code() >= 64);
    assert_eq!((s.integer_bits(), u.integer_bits(), u.scaled(4).integer_bits()), (1, 2, 6));
}

#[test]
fn full_scale_and_ties() {
    let s = Format::signed(4, 0);
    assert_eq!(
        s.code(7.5),
        None,
        "half way to the code above the largest rounds to even, out of the format"
    );
    assert_eq!(s.code_saturating(9.0), 7);
    assert_eq!(s.code_saturating(f64::NAN), 0);
    assert_eq!(s.code(2.5), Some(2));
}

/// A code's number is that of the definition, and back; beyond the limits there is none.
#[test]
fn numbers_have_codes_within_the_limits() {
    for format in
        [short_formats(), vec![Format::signed(18, 38), Format::unsigned(12, -30)]].concat()
    {
        assert_eq!(format.lsb(), 2f64.powi(-i32::from(format.frac)));
        for code in codes(format) {
            let real = code as f64 * 2f64.powi(-i32::from(format.frac));
            assert_eq!(format.real(code), real);
            assert_eq!((format.code(real), format.code_saturating(real)), (Some(code), code));
        }
        let (low, high) = (least(format) as i64, greatest(format) as i64);
        let beyond = [format.real(low - 1), format.real(high + 1)];
        assert_eq!(beyond.map(|real| format.code(real)), [None, None]);
        assert_eq!(beyond.map(|real| format.code_saturating(real)), [low, high]);
    }
}
