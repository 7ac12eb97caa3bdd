// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bit vectors in SMT-LIB 2: widths, constants, extensions.

use crate::format::Format;

/// The bits of a format in a solver, which knows no vector of none.
pub fn width(format: Format) -> u32 {
    u32::from(format.width.max(1))
}

/// A constant by its code.
pub fn literal(code: i128, width: u32) -> String {
    let mask = if width >= 128 { u128::MAX } else { (1 << width) - 1 };
    format!("(_ bv{} {width})", code as u128 & mask)
}

/// A term with its sign, or zeros, in front.
pub fn extend(term: &str, format: Format, to: u32) -> String {
    match to - width(format) {
        0 => term.into(),
        more if format.signed => format!("((_ sign_extend {more}) {term})"),
        more => format!("((_ zero_extend {more}) {term})"),
    }
}

/// Whether any of these Boolean terms is true.
pub fn any(terms: &[String]) -> String {
    match terms {
        [] => "false".into(),
        [one] => one.clone(),
        all => format!("(or {})", all.join(" ")),
    }
}
