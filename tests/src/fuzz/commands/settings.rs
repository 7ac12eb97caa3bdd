// SPDX-License-Identifier: MIT OR Apache-2.0
//! Values of a scene's keys: at the limits that their reader names, near the scene's own, of other types.

use fastrand::Rng;

use super::keys::{self, Key};

/// Numbers at limits, and texts that are none.
pub const NUMBERS: &str = "0 -0.0 1 -1 2 4 16 256 0.5 0.1 1e-6 5e-324 1e-320 1e-20 1e20 1e300 1.7976931348623157e308 1e400 \
    nan inf -inf -1e300 4294967296 9223372036854775807 -9223372036854775808 18446744073709551616";

/// Values of other types, and of forms; `#` stands for a number.
const TOML: [&str; 18] = [
    "true",
    "false",
    "[]",
    "{}",
    "\"\"",
    "[0, 0]",
    "[nan, 0]",
    "[[0, 1], [0, 1]]",
    "\"auto\"",
    "1979-05-27",
    "[#, #]",
    "{ sweep = [0, #] }",
    "{ sweep = { from = #, to = #, points = 3 } }",
    "{ timeline = [[0, #], [#, #]] }",
    "{ sine = { mean = 50, amplitude = #, frequency_hz = #, phase_turns = # } }",
    "{ line = { from_mm = [0, 0], to_mm = [#, 0], period_s = # } }",
    "{ circle = { radius_mm = #, period_s = #, phase_turns = # } }",
    "{ lissajous = { amplitude_mm = [10, #], frequency_hz = [#, 1], phase_turns = [0, #] } }",
];

/// Keys that make a run as long as their value says. They have small values.
const LENGTHS: &str = "duration_s dwell_slots nx ny points dwell_s";
const SHORT: &str = "0 1 2 0.001 0.01 -1 1e-320 nan";

/// A value of a key, from what its reader expects.
pub fn setting(rng: &mut Rng, key: &Key) -> String {
    let last = key.name.rsplit('.').next().unwrap_or_default();
    if LENGTHS.split(' ').any(|length| length == last) {
        return one_of(rng, SHORT);
    }
    let words = keys::words(&key.expected);
    let numbers = numbers(&key.expected);
    match rng.u8(..12) {
        0 | 1 => form(rng),
        2 => one_of(rng, NUMBERS),
        _ if !words.is_empty() => format!("\"{}\"", one(rng, &words)),
        _ if key.expected.starts_with("true") => one(rng, &["true", "false"]),
        3 | 4 if !numbers.is_empty() => at_limit(rng, &numbers),
        _ => match &key.own {
            Some(own) => near(rng, own),
            None => plausible(rng),
        },
    }
}

/// The numbers of a text.
fn numbers(text: &str) -> Vec<f64> {
    let words = text.split(|c: char| c.is_whitespace() || ",()[]".contains(c));
    words.filter_map(|word| word.trim_end_matches('.').parse().ok()).collect()
}

/// A limit, or beside it.
fn at_limit(rng: &mut Rng, limits: &[f64]) -> String {
    let limit = *rng.choice(limits).expect("a limit");
    let beside = [limit, limit.next_up(), limit.next_down(), limit + 1.0, limit - 1.0, limit / 2.0];
    toml_number(*rng.choice(&beside).expect("a number"))
}

/// A scene's own value with its first number changed.
pub fn near(rng: &mut Rng, own: &str) -> String {
    let factor =
        *rng.choice(&[0.1, 0.5, 1.0, 1.1, 2.0, 10.0, -1.0, 0.0, 1e-300, 1e300]).expect("a factor");
    let digits = |c: char| c.is_ascii_digit();
    let Some(start) = own.find(digits) else { return own.into() };
    let end = own[start..]
        .find(|c: char| !(digits(c) || ".e".contains(c)))
        .map_or(own.len(), |n| start + n);
    match own[start..end].parse::<f64>() {
        Ok(number) => format!("{}{}{}", &own[..start], toml_number(number * factor), &own[end..]),
        Err(_) => own.into(),
    }
}

/// A number of any size.
fn plausible(rng: &mut Rng) -> String {
    let number = rng.f64() * 10_f64.powi(rng.i32(-6..7));
    let whole = number.round() as i64;
    if rng.bool() { whole.to_string() } else { toml_number(number) }
}

/// A number as TOML has it: whole ones without a point.
fn toml_number(number: f64) -> String {
    match number.fract() == 0.0 && number.abs() < 1e15 {
        true => (number as i64).to_string(),
        false => format!("{number:e}"),
    }
}

/// A value of another type, or a form with numbers of any size.
fn form(rng: &mut Rng) -> String {
    let form = one(rng, &TOML);
    let (head, rest) = form.split_once('#').unwrap_or((&form, ""));
    let mut text = head.to_string();
    if form.contains('#') {
        for part in rest.split('#') {
            text += &one_of(rng, NUMBERS);
            text += part;
        }
    }
    text
}

/// One of a list.
pub fn one<T: ToString>(rng: &mut Rng, list: &[T]) -> String {
    rng.choice(list).expect("a list of some").to_string()
}

/// One of the words of a text.
pub fn one_of(rng: &mut Rng, words: &str) -> String {
    one(rng, &words.split_whitespace().collect::<Vec<_>>())
}
