// SPDX-License-Identifier: MIT OR Apache-2.0
//! Changes of format: the rounded number is made in as many bits as it can have, then the overflow
//! is applied to it.

use super::bits::{extend, literal, width as bits};
use crate::format::Format;
use crate::signal::{Overflow, Rounding};

/// A rounded number, not yet narrowed.
pub struct Rounded {
    /// Its code as a term of `width` bits, signed.
    pub term: String,
    /// Enough bits for every code that it can have, and one more.
    pub width: u32,
}

/// The code of a term of the format `from`, rounded to the steps of `to`.
pub fn round(term: &str, from: Format, to: Format, rounding: Rounding) -> Rounded {
    let drop = i32::from(from.frac) - i32::from(to.frac);
    let width = u32::from(from.width.max(to.width)) + drop.unsigned_abs() + 3;
    let wide = extend(term, from, width);
    let number = |code: i128| literal(code, width);
    let term = match (drop, rounding) {
        (0, _) => wide,
        (..0, _) => format!("(bvshl {wide} {})", number(i128::from(-drop))),
        (_, Rounding::HalfEven) => {
            // As the model does: just under a half, and one more where the result would be odd.
            let odd = format!("(bvand (bvashr {wide} {0}) {1})", number(drop.into()), number(1));
            let half = number((1 << (drop - 1)) - 1);
            format!("(bvashr (bvadd {wide} {half} {odd}) {})", number(drop.into()))
        }
        _ => format!("(bvashr {wide} {})", number(drop.into())),
    };
    Rounded { term, width }
}

impl Rounded {
    /// The low bits of the rounded number; the nearest code where it saturates.
    pub fn narrow(&self, to: Format, overflow: Overflow) -> String {
        let Rounded { term, width } = self;
        let low = |term: &str| format!("((_ extract {} 0) {term})", bits(to) - 1);
        if overflow != Overflow::Saturate {
            return low(term);
        }
        let [least, most] = [to.min_code(), to.max_code()].map(|code| literal(code, *width));
        let limited = format!(
            "(let ((r {term})) (ite (bvslt r {least}) {least} (ite (bvslt {most} r) {most} r)))"
        );
        low(&limited)
    }

    /// Whether the rounded number is one of the format, as a Boolean term.
    pub fn is_in(&self, to: Format) -> String {
        let Rounded { term, width } = self;
        let [least, most] = [to.min_code(), to.max_code()].map(|code| literal(code, *width));
        format!("(let ((r {term})) (and (bvsle {least} r) (bvsle r {most})))")
    }
}
