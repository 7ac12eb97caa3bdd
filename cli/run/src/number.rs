// SPDX-License-Identifier: MIT OR Apache-2.0
//! Numbers in messages.

/// A number with as many digits as matter.
pub fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if !(1e-4..1e6).contains(&size) => format!("{value:.3e}"),
        size => format!("{value:.*}", (3.0 - size.log10().floor()).clamp(0.0, 7.0) as usize),
    }
}
