// SPDX-License-Identifier: MIT OR Apache-2.0
//! Exact numbers, and how a word departs from them: to the nearest code, ties to even, saturated.
//!
//! An `f64` would do up to 2^53; squares of the widest words have 62 bits. So numbers are `mantissa
//! · 2^exponent` with an `i128`, which holds every sum and product of the core exactly.

use hapticore_contract::format::Format;
use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

/// An exact number: `mantissa · 2^exponent`.
///
/// ```
/// use hapticore_contract::format::Format;
/// use hapticore_reference::rounded::{Exact, round};
///
/// let (x, word) = (Format::signed(16, 15), Format::signed(18, 17));
/// let product = Exact::of(-32768, x) * Exact::of(98303, word);
/// assert_eq!(product.real(), -98303.0 / 131072.0);
/// assert_eq!(product.code(word), -98303, "-1 times it is a number of the format still");
///
/// let narrow = Format::signed(4, 1);
/// assert_eq!(round(Exact::new(3, -2), narrow).value.code(narrow), 2, "0.75 lies half way, and goes to the even code");
/// assert!(round(Exact::new(4, 0), narrow).held, "3.5 is the largest");
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Exact {
    mantissa: i128,
    exponent: i32,
}

/// A number as a format holds it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rounded {
    /// The number of the code.
    pub value: Exact,
    /// Whether it is saturated.
    pub held: bool,
}

impl Exact {
    /// The number 0.
    pub const ZERO: Exact = Exact { mantissa: 0, exponent: 0 };

    /// An integer times a power of two.
    pub fn new(mantissa: i128, exponent: i32) -> Self {
        Exact { mantissa, exponent }
    }

    /// What a code stands for.
    pub fn of(code: i64, format: Format) -> Self {
        Exact::new(code.into(), -i32::from(format.frac))
    }

    /// The code of a number that a format holds as it is.
    ///
    /// # Panics
    /// Where the format does not.
    pub fn code(self, format: Format) -> i64 {
        let rounded = round(self, format);
        assert!(rounded.value == self, "{format} does not hold {self:?}");
        i64::try_from(rounded.value.over(-i32::from(format.frac)))
            .expect("a code has at most 63 bits")
    }

    /// The number times `2^by`.
    pub fn scaled(self, by: i8) -> Self {
        Exact { exponent: self.exponent + i32::from(by), ..self }
    }

    /// Absolute value.
    pub fn magnitude(self) -> Self {
        Exact { mantissa: self.mantissa.abs(), ..self }
    }

    /// The largest integer that is no more.
    pub fn floor(self) -> i128 {
        if self.exponent >= 0 { self.over(0) } else { self.mantissa >> -self.exponent }
    }

    /// The nearest `f64`.
    pub fn real(self) -> f64 {
        self.mantissa as f64 * 2f64.powi(self.exponent)
    }

    /// The mantissa over a smaller exponent.
    fn over(self, exponent: i32) -> i128 {
        if self.mantissa == 0 { 0 } else { self.mantissa << (self.exponent - exponent) }
    }

    fn both(self, other: Exact) -> (i128, i128, i32) {
        let exponent = self.exponent.min(other.exponent);
        (self.over(exponent), other.over(exponent), exponent)
    }
}

impl Add for Exact {
    type Output = Exact;
    fn add(self, other: Exact) -> Exact {
        let (a, b, exponent) = self.both(other);
        Exact::new(a + b, exponent)
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
        Exact::new(self.mantissa * other.mantissa, self.exponent + other.exponent)
    }
}

impl Neg for Exact {
    type Output = Exact;
    fn neg(self) -> Exact {
        Exact::new(-self.mantissa, self.exponent)
    }
}

impl PartialEq for Exact {
    fn eq(&self, other: &Exact) -> bool {
        self.partial_cmp(other) == Some(Ordering::Equal)
    }
}

impl PartialOrd for Exact {
    fn partial_cmp(&self, other: &Exact) -> Option<Ordering> {
        let (a, b, _) = self.both(*other);
        Some(a.cmp(&b))
    }
}

/// The integer nearest to `n / d`, ties to even.
fn nearest(n: i128, d: i128) -> i128 {
    let (floor, rest) = (n.div_euclid(d), n.rem_euclid(d));
    let up = match (2 * rest).cmp(&d) {
        Ordering::Less => false,
        Ordering::Equal => floor % 2 != 0,
        Ordering::Greater => true,
    };
    floor + i128::from(up)
}

/// A code, saturated to a format.
fn hold(code: i128, to: Format) -> Rounded {
    let bits = u32::from(to.width) - u32::from(to.signed);
    let (low, high) = (if to.signed { -(1i128 << bits) } else { 0 }, (1i128 << bits) - 1);
    let within = code.max(low).min(high);
    Rounded { value: Exact::new(within, -i32::from(to.frac)), held: within != code }
}

/// The number in a format.
pub fn round(x: Exact, to: Format) -> Rounded {
    let scaled = x.exponent + i32::from(to.frac);
    hold(if scaled >= 0 { x.mantissa << scaled } else { nearest(x.mantissa, 1 << -scaled) }, to)
}

/// The largest integer that is no more than `n / d`, of a positive `d`.
pub fn floor_quotient(n: Exact, d: Exact) -> i128 {
    let (n, d, _) = n.both(d);
    n.div_euclid(d)
}

/// `n / d` in a format, `n` and `d` not negative; by zero it saturates at the largest code.
pub fn round_quotient(n: Exact, d: Exact, to: Format) -> Rounded {
    let (n, d, _) = n.scaled(to.frac).both(d);
    if d == 0 { hold(i128::MAX, to) } else { hold(nearest(n, d), to) }
}

/// `√x` with `frac` fractional bits, `x` having at most twice as many. `f64::sqrt` would round
/// twice; here the integers decide: `√x` is past `n + ½` where `x` is past `n² + n`.
///
/// ```
/// use hapticore_reference::rounded::{Exact, round_sqrt};
///
/// assert_eq!(round_sqrt(Exact::new(2, 0), 10).real(), 1448.0 / 1024.0);
/// ```
pub fn round_sqrt(x: Exact, frac: i8) -> Exact {
    let x = x.over(-2 * i32::from(frac));
    let n = x.isqrt();
    Exact::new(n + i128::from(x > n * n + n), -i32::from(frac))
}

/// A real number (an entry of a table, a constant) in a format.
pub fn round_real(x: f64, to: Format) -> Exact {
    let x = x * 2f64.powi(to.frac.into());
    let (floor, rest) = (x.floor(), x - x.floor());
    let up = rest > 0.5 || (rest == 0.5 && floor % 2.0 != 0.0);
    hold(floor as i128 + i128::from(up), to).value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ties_go_to_even_and_words_saturate() {
        let to = Format::signed(4, 0);
        let halves = |halves: i128| round(Exact::new(halves, -1), to).value.real();
        assert_eq!(
            [-5, -3, -1, 1, 3, 5, 100, -100].map(halves),
            [-2.0, -2.0, 0.0, 0.0, 2.0, 2.0, 7.0, -8.0]
        );
        assert_eq!(round_real(2.5, to).real(), 2.0);
        assert_eq!(round_real(-0.75, to).real(), -1.0);
        assert!(round(Exact::new(15, -1), to).held, "7.5 rounds to 8");
    }

    #[test]
    fn square_roots_and_quotients_are_nearest() {
        assert_eq!(
            [0, 1, 2, 3, 6, 7, 12, 13].map(|x| round_sqrt(Exact::new(x, 0), 0).real() as i128),
            [0, 1, 1, 2, 2, 3, 3, 4]
        );
        let to = Format::unsigned(4, 0);
        let quotient = |n, d| round_quotient(Exact::new(n, 0), Exact::new(d, 0), to).value.real();
        assert_eq!(
            [quotient(3, 2), quotient(5, 2), quotient(7, 3), quotient(1, 0)],
            [2.0, 2.0, 2.0, 15.0]
        );
    }
}
