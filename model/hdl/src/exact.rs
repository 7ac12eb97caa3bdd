// SPDX-License-Identifier: MIT OR Apache-2.0
//! What tests compare the arithmetic with: numbers `n / 2^places`, rounded and limited by division
//! and powers of two. It shares no code with the interpretations, which shift and mask.

use crate::format::Format;
use crate::signal::{Overflow, Rounding, Signal};
use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

/// The number `n / 2^places`.
#[derive(Debug, Clone, Copy)]
pub struct Exact {
    n: i128,
    places: u32,
}

pub fn power(of: u32) -> i128 {
    2i128.pow(of)
}

/// The least code of a format.
pub fn least(format: Format) -> i128 {
    match format.signed {
        true => -power(u32::from(format.width)) / 2,
        false => 0,
    }
}

/// The greatest code of a format.
pub fn greatest(format: Format) -> i128 {
    least(format) + power(u32::from(format.width)) - 1
}

/// Codes of a format: all of a short word, the limits and the middle of a long one.
pub fn codes(format: Format) -> Vec<i64> {
    let (least, greatest) = (least(format), greatest(format));
    let mut codes: Vec<i128> = match format.width {
        ..=8 => (least..=greatest).collect(),
        _ => vec![
            least,
            least + 1,
            least / 3,
            -1,
            0,
            1,
            2,
            greatest / 3,
            greatest / 2,
            greatest - 1,
            greatest,
        ],
    };
    codes.retain(|code| (least..=greatest).contains(code));
    codes.dedup();
    codes.into_iter().map(|code| code as i64).collect()
}

/// Every format of 1 to 3 bits with its point within the word or beside it.
pub fn short_formats() -> Vec<Format> {
    let words =
        [false, true].into_iter().flat_map(|signed| (1..=3).map(move |width| (signed, width)));
    words
        .flat_map(|(signed, width)| (-1..=1).map(move |frac| Format { signed, width, frac }))
        .collect()
}

/// Every short format with every other.
pub fn format_pairs() -> impl Iterator<Item = (Format, Format)> {
    short_formats().into_iter().flat_map(|a| short_formats().into_iter().map(move |b| (a, b)))
}

/// Long formats; sums and products of any two fit a word of the model.
pub fn long_formats() -> Vec<Format> {
    ["s18.17", "u16.16", "s31.20", "u24.-3", "s30.25"]
        .map(|text| text.parse().expect("a format"))
        .to_vec()
}

/// Pairs of signals of any two formats of a list, each with every code.
pub fn pairs(formats: &[Format]) -> impl Iterator<Item = (Signal<i64>, Signal<i64>)> {
    let all: Vec<Signal<i64>> = formats
        .iter()
        .flat_map(|&format| codes(format).into_iter().map(move |value| Signal { value, format }))
        .collect();
    all.clone().into_iter().flat_map(move |a| all.clone().into_iter().map(move |b| (a, b)))
}

impl Exact {
    pub fn of(code: i64, format: Format) -> Self {
        match u32::try_from(format.frac) {
            Ok(places) => Exact { n: code.into(), places },
            Err(_) => Exact {
                n: i128::from(code) * power(u32::from(format.frac.unsigned_abs())),
                places: 0,
            },
        }
    }

    pub fn of_signal(signal: Signal<i64>) -> Self {
        Exact::of(signal.value, signal.format)
    }

    pub fn real(self) -> f64 {
        self.n as f64 / power(self.places) as f64
    }

    /// The numerators of both over the same power of two.
    fn with(self, other: Exact) -> (i128, i128, u32) {
        let places = self.places.max(other.places);
        let over = |of: Exact| of.n * power(places - of.places);
        (over(self), over(other), places)
    }

    /// The number in steps of a format: whole steps, the remainder, and its denominator.
    fn steps(self, format: Format) -> (i128, i128, i128) {
        let up = power(u32::try_from(format.frac).unwrap_or(0));
        let down = power(u32::try_from(-format.frac).unwrap_or(0));
        let (n, step) = (self.n * up, power(self.places) * down);
        (n.div_euclid(step), n.rem_euclid(step), step)
    }

    /// The number rounded to steps of a format, in those.
    pub fn rounded(self, to: Format, rounding: Rounding) -> i128 {
        let (whole, rest, step) = self.steps(to);
        match (rounding, (2 * rest).cmp(&step)) {
            (Rounding::Exact, _) => {
                assert_eq!(rest, 0, "nothing is rounded");
                whole
            }
            (Rounding::Floor, _) | (_, Ordering::Less) => whole,
            (_, Ordering::Greater) => whole + 1,
            (_, Ordering::Equal) => whole + whole.rem_euclid(2),
        }
    }

    /// The number modulo the span of a format, unrounded.
    pub fn wrapped(self, to: Format) -> Exact {
        let of = |code: i128| Exact::of(1, to) * Exact { n: code, places: 0 };
        let (from_low, span, places) = (self - of(least(to))).with(of(power(u32::from(to.width))));
        Exact { n: from_low.rem_euclid(span), places } + of(least(to))
    }
}

/// A code beyond a format, by what is asked for.
pub fn limited(code: i128, to: Format, overflow: Overflow) -> i128 {
    match overflow {
        Overflow::Saturate if code < least(to) => least(to),
        Overflow::Saturate if code > greatest(to) => greatest(to),
        Overflow::Wrap => least(to) + (code - least(to)).rem_euclid(power(u32::from(to.width))),
        _ => code,
    }
}

impl Add for Exact {
    type Output = Exact;
    fn add(self, other: Exact) -> Exact {
        let (a, b, places) = self.with(other);
        Exact { n: a + b, places }
    }
}

impl Neg for Exact {
    type Output = Exact;
    fn neg(self) -> Exact {
        Exact { n: -self.n, ..self }
    }
}

impl Sub for Exact {
    type Output = Exact;
    fn sub(self, other: Exact) -> Exact {
        self + -other
    }
}

impl Mul for Exact {
    type Output = Exact;
    fn mul(self, other: Exact) -> Exact {
        Exact { n: self.n * other.n, places: self.places + other.places }
    }
}

impl PartialEq for Exact {
    fn eq(&self, other: &Exact) -> bool {
        let (a, b, _) = self.with(*other);
        a == b
    }
}

impl PartialOrd for Exact {
    fn partial_cmp(&self, other: &Exact) -> Option<Ordering> {
        let (a, b, _) = self.with(*other);
        a.partial_cmp(&b)
    }
}
