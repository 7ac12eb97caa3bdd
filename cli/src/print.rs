// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a run says on the terminal.

use std::path::PathBuf;

use crate::console;
use crate::record::{Criterion, Effect, Record, SignalError};
use crate::say;

/// A table as text: columns as wide as their widest cell, numbers to the right.
pub fn table(head: &[&str], rows: &[Vec<String>]) -> String {
    let cells = |row: usize, column: usize| match row {
        0 => head[column],
        _ => rows[row - 1].get(column).map_or("", String::as_str),
    };
    let width = |column| (0..=rows.len()).map(|row| cells(row, column).chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..head.len()).map(width).collect();
    let is_number = |text: &str| text.starts_with(|c: char| c.is_ascii_digit() || c == '-');
    let pad = |text: &str, width: usize| {
        let space = " ".repeat(width - text.chars().count());
        if is_number(text) { space + text } else { text.to_string() + &space }
    };
    let line = |row| {
        let line: Vec<_> = (0..head.len()).map(|column| pad(cells(row, column), widths[column])).collect();
        line.join("  ").trim_end().to_string() + "\n"
    };
    (0..=rows.len()).map(line).collect()
}

/// A number with as many digits as matter.
pub fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if !(1e-4..1e6).contains(&size) => format!("{value:.3e}"),
        size => format!("{value:.*}", (3.0 - size.log10().floor()).clamp(0.0, 7.0) as usize),
    }
}

/// One line at the start: which effects are on, and at which rung.
pub fn effects_line<'a>(effects: impl Iterator<Item = (&'static str, &'a str)>) -> String {
    let mut words: Vec<String> = Vec::new();
    for (name, rung) in effects {
        let word = if rung.is_empty() || rung == "on" { name.to_string() } else { format!("{name} {rung}") };
        if !words.contains(&word) {
            words.push(word);
        }
    }
    words.join(" · ")
}

/// What the user must know before using the results, on standard error.
pub fn warnings(record: &Record) {
    record.warnings.iter().for_each(|warning| console::warn(warning));
}

/// The tables at the end of a run.
pub fn finish(record: &Record, files: &[PathBuf]) {
    if !record.effects.is_empty() {
        console::print(format_args!("\n{}", effects(&record.effects, record.wall_seconds)));
    }
    if !record.criteria.is_empty() {
        console::print(format_args!("\n{}", criteria(&record.criteria)));
    }
    if !record.errors.is_empty() {
        console::print(format_args!("\n{}", errors(&record.errors)));
    }
    let speed = record.wall_seconds / record.simulated_seconds;
    say!(
        "\n{} s simulated in {} s ({} s a second)",
        number(record.simulated_seconds),
        number(record.wall_seconds),
        number(speed)
    );
    files.iter().for_each(|file| say!("  {}", file.display()));
}

fn effects(effects: &[Effect], wall_seconds: f64) -> String {
    let row = |effect: &Effect| {
        let error = effect.finer.as_ref().map_or(String::new(), |(finer, percent)| off(*percent, finer));
        let share = format!("{} %", number(100.0 * effect.seconds / wall_seconds));
        vec![effect.name.clone(), effect.rung.clone(), error, number(effect.seconds), share]
    };
    table(&["effect", "rung", "error", "seconds", "of the run"], &effects.iter().map(row).collect::<Vec<_>>())
}

/// How far a rung is off the next finer one.
pub fn off(percent: f64, finer: &str) -> String {
    format!("{} % off {finer}", number(percent))
}

fn criteria(criteria: &[Criterion]) -> String {
    let row = |criterion: &Criterion| {
        let with_unit = |value| format!("{} {}", number(value), criterion.unit);
        let beside =
            criterion.beside.as_ref().map_or(String::new(), |(name, value)| format!("{name}: {}", with_unit(*value)));
        let (measured, limit) = (with_unit(criterion.measured), with_unit(criterion.limit));
        match (criterion.applicable, criterion.pass) {
            (false, _) => vec![criterion.name.clone(), String::new(), limit, "not applicable".into()],
            (true, true) => vec![criterion.name.clone(), measured, limit, "holds".into(), beside],
            (true, false) => vec![criterion.name.clone(), measured, limit, "FAILS".into(), beside],
        }
    };
    table(&["criterion", "measured", "limit", "", "beside"], &criteria.iter().map(row).collect::<Vec<_>>())
}

fn errors(errors: &[SignalError]) -> String {
    let row = |error: &SignalError| {
        vec![error.signal.clone(), error.format.clone(), number(error.max_error), number(error.max_codes)]
    };
    table(&["signal", "format", "largest error", "in codes"], &errors.iter().map(row).collect::<Vec<_>>())
}
