// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a run says on the terminal.

use std::path::PathBuf;

use hapticore_report::words::{off, speed, stability};
use hapticore_run::findings;
use hapticore_run::lab::Outcome;
use hapticore_run::lab::least_squares::Estimate;
pub use hapticore_run::number::number;
use hapticore_run::provenance::version;
use hapticore_run::record::{Criterion, Effect, Record, SignalError};

use crate::console::{self, Colour};
use crate::say;

/// A table as text: columns as wide as their widest cell, numbers to the right.
pub fn table(head: &[&str], rows: &[Vec<String>]) -> String {
    let cells = |row: usize, column: usize| match row {
        0 => head[column],
        _ => rows[row - 1].get(column).map_or("", String::as_str),
    };
    let width =
        |column| (0..=rows.len()).map(|row| cells(row, column).chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..head.len()).map(width).collect();
    let is_number = |text: &str| text.starts_with(|c: char| c.is_ascii_digit() || c == '-');
    let pad = |text: &str, width: usize| {
        let space = " ".repeat(width - text.chars().count());
        if is_number(text) { space + text } else { text.to_string() + &space }
    };
    let line = |row| {
        let line: Vec<_> =
            (0..head.len()).map(|column| pad(cells(row, column), widths[column])).collect();
        line.join("  ").trim_end().to_string() + "\n"
    };
    (0..=rows.len()).map(line).collect()
}

/// One line at the start: which effects are on, and at which level.
pub fn effects_line<'a>(effects: impl Iterator<Item = (&'static str, &'a str)>) -> String {
    let mut words: Vec<String> = Vec::new();
    for (name, level) in effects {
        let word = if level.is_empty() || level == "on" {
            name.to_string()
        } else {
            format!("{name} {level}")
        };
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
pub fn finish(record: &Record, files: &[PathBuf], verbose: bool) {
    if verbose {
        let of = &record.provenance;
        let seed = of.seed.map_or(String::new(), |seed| format!(" · seed {seed}"));
        say!("hapticore {}{seed} · {}", version(), record.date);
        if !record.effects.is_empty() {
            console::print(format_args!("\n{}", effects(&record.effects)));
        }
    }
    if !record.criteria.is_empty() {
        console::print(format_args!("\n{}", criteria(&record.criteria)));
        say!("{}", verdict(&record.criteria));
    }
    let findings = findings::lines(&record.findings).into_iter().chain(stability(record));
    let flags = record.findings.flagged.is_empty().then(|| "flags: no frame carries one".into());
    let findings: Vec<_> =
        flags.into_iter().chain(findings).map(|line: String| line + "\n").collect();
    console::print(format_args!("\n{}", findings.concat()));
    if !record.errors.is_empty() {
        console::print(format_args!("\n{}", errors(&record.errors)));
    }
    if let Some(residual) = &record.position_table {
        say!("\nposition table: {}", residual.text());
    }
    say!(
        "\n{} s of device time in {} s: {}",
        number(record.simulated_seconds),
        number(record.wall_seconds),
        speed(record)
    );
    files.iter().for_each(|file| say!("  {}", file.display()));
}

/// The effects with what each cost; their times are summed over all threads.
fn effects(effects: &[Effect]) -> String {
    let all: f64 = effects.iter().map(|effect| effect.seconds).sum();
    let row = |effect: &Effect| {
        let error =
            effect.finer.as_ref().map_or(String::new(), |(finer, percent)| off(*percent, finer));
        let share = format!("{} %", number(100.0 * effect.seconds / all));
        vec![effect.name.clone(), effect.level.clone(), error, number(effect.seconds), share]
    };
    let head = [
        "effect",
        "fidelity level",
        "difference from a finer level",
        "seconds, all threads",
        "share of all effects",
    ];
    table(&head, &effects.iter().map(row).collect::<Vec<_>>())
}

/// How many criteria hold.
fn verdict(criteria: &[Criterion]) -> String {
    let applicable = criteria.iter().filter(|criterion| criterion.applicable).count();
    let holding =
        criteria.iter().filter(|criterion| criterion.applicable && criterion.pass).count();
    let colour = if holding == applicable { Colour::Green } else { Colour::Red };
    console::coloured(&format!("{holding} of {applicable} criteria passed"), colour)
}

fn criteria(criteria: &[Criterion]) -> String {
    let row = |criterion: &Criterion| {
        let with_unit = |value| format!("{} {}", number(value), criterion.unit);
        let baseline = criterion
            .baseline
            .as_ref()
            .map_or(String::new(), |(name, value)| format!("{name}: {}", with_unit(*value)));
        let (measured, limit) = (with_unit(criterion.measured), with_unit(criterion.limit));
        match (criterion.applicable, criterion.pass) {
            (false, _) => {
                vec![criterion.name.clone(), String::new(), limit, "not applicable".into()]
            }
            (true, true) => vec![criterion.name.clone(), measured, limit, "pass".into(), baseline],
            (true, false) => vec![criterion.name.clone(), measured, limit, "FAIL".into(), baseline],
        }
    };
    let rows: Vec<_> = criteria.iter().map(row).collect();
    let text = table(&["criterion", "measured", "limit", "", "for comparison"], &rows);
    text.replace("  FAIL", &("  ".to_string() + &console::coloured("FAIL", Colour::Red)))
}

fn errors(errors: &[SignalError]) -> String {
    let row = |error: &SignalError| {
        vec![
            error.signal.clone(),
            error.format.clone(),
            number(error.max_error),
            number(error.max_codes),
        ]
    };
    table(
        &["signal", "format", "largest rounding error", "in codes (LSB)"],
        &errors.iter().map(row).collect::<Vec<_>>(),
    )
}

/// A calibration's results, one line each.
pub fn calibration_lines(outcome: &Outcome) -> Vec<String> {
    let raster = outcome
        .columns
        .map_or("scattered".into(), |columns| format!("{columns} × {}", outcome.places / columns));
    let mut lines = vec![
        format!(
            "{} places ({raster}), {} terminals, profile {}",
            outcome.places, outcome.terminals, outcome.profile
        ),
        format!("position table: {}", outcome.own_places.text()),
        format!("every other position held out of the table: {}", outcome.held_out.errors()),
    ];
    if let Some(force) = &outcome.force {
        let measurements = force.points.len();
        lines.push(format!(
            "force_k = {} N/(F·V)², {measurements} measurements with {} mN of noise",
            estimate(force.force_k),
            number(1e3 * force.noise_n)
        ));
        lines.extend(force.table_residual_n.map(force_table_line));
        lines.extend(force.mu.map(|mu| format!("mu = {}", estimate(mu))));
        lines.extend(
            force
                .current_scale
                .map(|scale| format!("current_full_scale_a times {}", estimate(scale))),
        );
    }
    lines
}

/// What force table and eq. 8 leave of the loads.
fn force_table_line([table, eq8]: [[f64; 2]; 2]) -> String {
    let millinewtons = |[largest, rms]: [f64; 2]| {
        format!("{} mN RMS, {} mN at most", number(1e3 * rms), number(1e3 * largest))
    };
    format!("force table: leaves {}; eq. 8: {}", millinewtons(table), millinewtons(eq8))
}

/// A number and its interval.
pub fn estimate(estimate: Estimate) -> String {
    let [low, high] = estimate.interval.map(number);
    format!("{} (95 %: {low} to {high})", number(estimate.value))
}
