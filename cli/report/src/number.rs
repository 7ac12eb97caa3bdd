// SPDX-License-Identifier: MIT OR Apache-2.0
//! Numbers as text: three significant digits, a true minus sign, SI prefixes for times.

/// What stands where there is no number.
pub const NONE: &str = "–";

const SUPERSCRIPTS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// Three significant digits: `0.0421`, `318`, `−1.2 × 10⁻⁷`.
pub fn short(value: f64) -> String {
    if !value.is_finite() {
        return NONE.into();
    }
    if value == 0.0 {
        return "0".into();
    }
    let exponent = exponent(value);
    if (-4..6).contains(&exponent) {
        fixed(value, usize::try_from(2 - exponent).unwrap_or(0))
    } else {
        let mantissa = fixed(value / 10f64.powi(exponent), 2);
        format!("{mantissa} × 10{}", superscript(exponent))
    }
}

/// The same without zeros at the end: `0.5`, for numbers that somebody chose.
pub fn chosen(value: f64) -> String {
    let text = short(value);
    if !text.contains('.') || text.contains('×') {
        return text;
    }
    text.trim_end_matches('0').trim_end_matches('.').into()
}

/// With a given number of decimals.
pub fn fixed(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return NONE.into();
    }
    let text = format!("{value:.decimals$}");
    let zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    if zero { text.trim_start_matches('-').into() } else { text.replace('-', "−") }
}

/// A number and its unit; a bare `1` is no unit.
pub fn with_unit(number: &str, unit: &str) -> String {
    if unit.is_empty() || unit == "1" || number == NONE {
        number.into()
    } else {
        format!("{number} {unit}")
    }
}

/// A duration with an SI prefix: `12.3 ms`.
pub fn seconds(value: f64) -> String {
    let (factor, unit) = match value.abs() {
        v if v == 0.0 || v >= 1.0 => (1.0, "s"),
        v if v >= 1e-3 => (1e3, "ms"),
        v if v >= 1e-6 => (1e6, "µs"),
        _ => (1e9, "ns"),
    };
    with_unit(&short(value * factor), unit)
}

/// The decimal exponent after rounding to three digits.
fn exponent(value: f64) -> i32 {
    let text = format!("{value:.2e}");
    text.split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0)
}

fn superscript(exponent: i32) -> String {
    let digits = exponent.unsigned_abs().to_string();
    let raised = digits.bytes().map(|b| SUPERSCRIPTS[usize::from(b - b'0')]);
    let sign = if exponent < 0 { "⁻" } else { "" };
    sign.chars().chain(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_whatever_the_size() {
        let texts = [0.0, 0.04213, 317.96, -0.5, 999_999.0, -1.23e-7, f64::NAN].map(short);
        assert_eq!(texts, ["0", "0.0421", "318", "−0.500", "1.00 × 10⁶", "−1.23 × 10⁻⁷", NONE]);
    }

    #[test]
    fn times_take_a_prefix() {
        assert_eq!(
            [0.0, 2.5, 0.0123, 4.5e-6, 3e-9].map(seconds),
            ["0 s", "2.50 s", "12.3 ms", "4.50 µs", "3.00 ns"]
        );
    }

    #[test]
    fn chosen_numbers_end_where_they_end() {
        assert_eq!([0.5, 1.0, 100.0, 0.0].map(chosen), ["0.5", "1", "100", "0"]);
    }

    #[test]
    fn no_negative_zero() {
        assert_eq!(fixed(-0.001, 1), "0.0");
    }
}
