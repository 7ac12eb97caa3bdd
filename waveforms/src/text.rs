// SPDX-License-Identifier: MIT OR Apache-2.0
//! Waveforms as text, for tests.
//!
//! ```text
//! clock            0   1   2   3   4
//! core.start       ▁▁▁▁▔▔▔▔▁▁▁▁▁▁▁▁▁▁▁▁
//! core.state       |IDLE   |RUN
//! core.i           |0.5|-0.25  |0.5
//! ```
//!
//! One column a clock, wide enough that every value fits where it holds. Codes are shown as the
//! numbers they stand for, with as many decimals as tell neighbouring codes apart.

use std::ops::Range;

use hapticore_hdl::format::Format;
use hapticore_hdl::probe::Probe;

use crate::declarations::{Encoding, Signal};
use crate::pattern::fits;

/// The codes of a simulation at every clock, kept.
#[derive(Debug, Clone)]
pub struct History {
    signals: Vec<Signal>,
    codes: Vec<i64>,
}

impl History {
    /// An empty history of the variables of `probe`.
    pub fn of(probe: &impl Probe) -> Self {
        History {
            signals: probe.variables().into_iter().map(Signal::of).collect(),
            codes: Vec::new(),
        }
    }

    /// Keeps the codes after one clock.
    pub fn clock(&mut self, probe: &impl Probe) {
        probe.sample(&mut self.codes);
    }

    /// Number of clocks kept.
    pub fn clocks(&self) -> usize {
        self.codes.len() / self.signals.len().max(1)
    }

    fn code(&self, signal: usize, clock: usize) -> i64 {
        self.codes[clock * self.signals.len() + signal]
    }

    /// The signals that fit each pattern, in the order of the patterns.
    fn find(&self, patterns: &[&str]) -> Vec<usize> {
        let fitting = |pattern: &&str| {
            let found: Vec<_> = (0..self.signals.len())
                .filter(|&i| fits(pattern, &self.signals[i].path()))
                .collect();
            assert!(!found.is_empty(), "no signal fits \"{pattern}\"");
            found
        };
        patterns.iter().flat_map(fitting).collect()
    }
}

/// The waveforms of the signals that fit `patterns`, over the clocks of `range` that were kept.
///
/// # Panics
/// No signal fits one of the patterns.
pub fn render(history: &History, patterns: &[&str], range: Range<usize>) -> String {
    let clocks = range.start..range.end.min(history.clocks());
    let rows: Vec<_> = history
        .find(patterns)
        .into_iter()
        .map(|signal| Row::new(history, signal, &clocks))
        .collect();
    let last = clocks.end.saturating_sub(1).to_string().len() + 1;
    let column = rows.iter().map(Row::column).chain([last]).max().unwrap_or(last);
    let label =
        rows.iter().map(|row| row.label.chars().count()).max().unwrap_or(0).max("clock".len());
    let ruler = clocks.map(|clock| format!("{clock:<column$}")).collect();
    let lines = rows.iter().map(|row| (row.label.as_str(), row.draw(column)));
    std::iter::once(("clock", ruler))
        .chain(lines)
        .map(|(name, wave): (_, String)| line(name, label, &wave))
        .collect()
}

/// Asserts that the waveforms are those of `expected`; indentation and blank lines around it do not
/// matter.
///
/// # Panics
/// They differ; the message shows both.
#[track_caller]
pub fn check(history: &History, patterns: &[&str], range: Range<usize>, expected: &str) {
    let got = render(history, patterns, range);
    assert!(
        flush_left(&got) == flush_left(expected),
        "waveforms differ\nexpected:\n{expected}\ngot:\n{got}"
    );
}

fn line(name: &str, label: usize, wave: &str) -> String {
    format!("{name:<label$}  {}\n", wave.trim_end())
}

fn flush_left(text: &str) -> Vec<&str> {
    text.lines().map(str::trim).filter(|line| !line.is_empty()).collect()
}

/// One signal: its values and for how many clocks each holds.
struct Row {
    label: String,
    bit: bool,
    runs: Vec<(String, usize)>,
}

impl Row {
    fn new(history: &History, signal: usize, clocks: &Range<usize>) -> Self {
        let Signal { encoding, .. } = &history.signals[signal];
        let codes: Vec<_> = clocks.clone().map(|clock| history.code(signal, clock)).collect();
        let runs =
            codes.chunk_by(|a, b| a == b).map(|run| (value(encoding, run[0]), run.len())).collect();
        Row { label: history.signals[signal].path(), bit: encoding.width() == Some(1), runs }
    }

    /// The narrowest column in which every value and its edge fit. A bit takes any.
    fn column(&self) -> usize {
        let needs =
            |(value, clocks): &(String, usize)| (value.chars().count() + 1).div_ceil(*clocks);
        self.runs.iter().filter(|_| !self.bit).map(needs).max().unwrap_or(1)
    }

    fn draw(&self, column: usize) -> String {
        let draw = |(value, clocks): &(String, usize)| {
            let width = clocks * column;
            match (self.bit, value.as_str()) {
                (false, value) => format!("|{value:<0$}", width - 1),
                (true, "0") => "▁".repeat(width),
                (true, _) => "▔".repeat(width),
            }
        };
        self.runs.iter().map(draw).collect()
    }
}

fn value(encoding: &Encoding, code: i64) -> String {
    match encoding {
        Encoding::State(format, states) => match states.get(code as usize) {
            Some(name) => name.to_string(),
            None => number(*format, code),
        },
        Encoding::Code(format) => number(*format, code),
        Encoding::Real(_) => unreachable!("a probe has codes"),
    }
}

/// The number that `code` stands for, rounded to decimals that still tell neighbouring codes apart.
pub fn number(format: Format, code: i64) -> String {
    let decimals = (f64::from(format.frac) * 2f64.log10()).ceil() as usize;
    let text = match format.frac {
        ..=0 => return (i128::from(code) << format.frac.unsigned_abs().min(63)).to_string(),
        1..=62 => fixed_point(code, format.frac as u32, decimals),
        63.. => format!("{:.decimals$}", format.real(code)),
    };
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}

/// `code · 2^-frac` to `decimals` decimals, in integers: an `f64` has not the bits of the widest
/// codes.
fn fixed_point(code: i64, frac: u32, decimals: usize) -> String {
    let one = 10u128.pow(decimals as u32);
    let scaled = (u128::from(code.unsigned_abs()) * one + (1 << (frac - 1))) >> frac;
    format!("{}{}.{:0decimals$}", if code < 0 { "-" } else { "" }, scaled / one, scaled % one)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_tell_neighbouring_codes_apart() {
        let s = Format::signed(18, 17);
        assert_eq!(number(s, 1 << 16), "0.5");
        assert_eq!(
            (number(s, -1), number(s, -2), number(s, 0)),
            ("-0.000008".into(), "-0.000015".into(), "0".into())
        );
        assert_eq!(number(Format::signed(24, -3), -5), "-40");
        assert_eq!(number(Format::unsigned(18, 38), 1), "0.000000000004");
        let s = Format::signed(63, 40);
        assert_eq!(number(s, (1 << 61) + 1), "2097152.0000000000009");
        assert_eq!(number(s, i64::MIN >> 1), "-4194304");
        assert_eq!(number(Format::signed(63, 62), i64::MIN >> 1), "-1");
        assert_eq!(number(Format::unsigned(63, 0), i64::MAX), i64::MAX.to_string());
    }
}
