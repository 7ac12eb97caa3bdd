// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tables: criteria, effects, rounding errors, the run itself.

use super::number;
use super::page::escape;
use super::words;
use hapticore_run::findings;
use hapticore_run::record::{Criterion, Effect, Record, SignalError};

/// The criteria, below a sentence that says how many passed.
pub fn criteria(criteria: &[Criterion]) -> String {
    if criteria.is_empty() {
        return String::new();
    }
    let rows = criteria.iter().map(criterion).collect::<String>();
    verdict(criteria)
        + &table(
            "Criteria",
            &["criterion", "", "#measured", "#limit (at most)", "for comparison"],
            &rows,
        )
}

fn verdict(criteria: &[Criterion]) -> String {
    let holding = criteria.iter().filter(|c| c.pass && c.applicable).count();
    let applicable = criteria.iter().filter(|c| c.applicable).count();
    let class = if holding == applicable { "pass" } else { "fail" };
    let others = match criteria.len() - applicable {
        0 => String::new(),
        others => format!(" {others} not applicable: no slot meets the condition."),
    };
    format!(
        "<p class=\"verdict {class}\">{} {holding} of {applicable} criteria passed.{others}</p>\n",
        sign(class == "pass"),
    )
}

fn sign(pass: bool) -> &'static str {
    if pass { "✓" } else { "✗" }
}

fn criterion(criterion: &Criterion) -> String {
    let (class, word) = match (criterion.applicable, criterion.pass) {
        (false, _) => ("", "– not applicable"),
        (true, true) => ("pass", "✓ pass"),
        (true, false) => ("fail", "✗ fail"),
    };
    let in_unit = |number: String| number::with_unit(&number, &criterion.unit);
    let baseline = criterion.baseline.as_ref().map_or_else(String::new, |(what, value)| {
        format!("{}: {}", escape(what), escape(&in_unit(number::short(*value))))
    });
    row(&[
        ("", &escape(&criterion.name)),
        (class, word),
        ("number", &escape(&in_unit(number::short(criterion.measured)))),
        ("number", &escape(&in_unit(number::chosen(criterion.limit)))),
        ("", &baseline),
    ])
}

/// The effects, what each cost, and which share of the run that was.
pub fn effects(effects: &[Effect], wall_seconds: f64) -> String {
    if effects.is_empty() {
        return String::new();
    }
    let rows = effects.iter().map(|e| effect(e, wall_seconds)).collect::<String>();
    table(
        "Effects",
        &[
            "effect",
            "fidelity level",
            "difference from a finer level",
            "#wall time",
            "#share of the run",
        ],
        &rows,
    )
}

fn effect(effect: &Effect, wall_seconds: f64) -> String {
    row(&[
        ("", &escape(&effect.name)),
        ("", &escape(&effect.level)),
        (
            "",
            &effect
                .finer
                .as_ref()
                .map_or(String::new(), |(finer, percent)| escape(&words::off(*percent, finer))),
        ),
        ("number", &number::seconds(effect.seconds)),
        ("number", &share(effect.seconds / wall_seconds)),
    ])
}

fn share(share: f64) -> String {
    if !share.is_finite() {
        return number::NONE.into();
    }
    let percent = 100.0 * share;
    let width = number::fixed(percent.clamp(0.0, 100.0), 1);
    let text =
        if percent > 0.0 && percent < 0.1 { "< 0.1".into() } else { number::fixed(percent, 1) };
    format!("{} %<span class=\"bar\"><span style=\"width:{width}%\"></span></span>", escape(&text))
}

/// The largest rounding error of each signal.
pub fn errors(errors: &[SignalError]) -> String {
    if errors.is_empty() {
        return String::new();
    }
    let rows = errors.iter().map(signal).collect::<String>();
    table(
        "Rounding errors",
        &["signal", "format", "#largest rounding error", "#in codes (LSB)"],
        &rows,
    )
}

fn signal(error: &SignalError) -> String {
    row(&[
        ("code", &escape(&error.signal)),
        ("code", &escape(&error.format)),
        ("number", &number::short(error.max_error)),
        ("number", &number::short(error.max_codes)),
    ])
}

/// Flagged frames by kind and pad, tracking and stability of force loops; nothing where there is none.
pub fn findings(record: &Record) -> String {
    let lines = findings::lines(&record.findings).into_iter().chain(words::stability(record));
    let items: String = lines.map(|line| format!("<li>{}</li>\n", escape(&line))).collect();
    if items.is_empty() { items } else { format!("<ul class=\"findings\">\n{items}</ul>\n") }
}

/// How long the run took and what it left.
pub fn run(record: &Record) -> String {
    let ratio = record.wall_seconds / record.simulated_seconds;
    let facts = [
        ("device time", number::seconds(record.simulated_seconds)),
        ("wall time", number::seconds(record.wall_seconds)),
        ("wall time per second of device time", number::seconds(ratio)),
        ("finished slots", record.rows.len().to_string()),
        (
            "slots with a flag set",
            record.rows.iter().filter(|r| !r.flags.is_empty()).count().to_string(),
        ),
        ("number of pads", record.pads.len().to_string()),
        ("number of cases", record.cases.len().to_string()),
    ];
    let rows = facts
        .iter()
        .map(|(name, value)| row(&[("", *name), ("number", value)]))
        .collect::<String>();
    table("Run", &["", "#"], &rows)
}

/// A table in a container that scrolls on its own; a `#` before a head puts its column to the
/// right.
pub fn table(label: &str, heads: &[&str], rows: &str) -> String {
    let head = |head: &&str| match head.strip_prefix('#') {
        Some(text) => format!("<th class=\"number\" scope=\"col\">{text}</th>"),
        None => format!("<th scope=\"col\">{head}</th>"),
    };
    let named = heads.iter().any(|h| h.len() > 1);
    let heads: String = heads.iter().map(head).collect();
    let heads = if named { format!("<thead><tr>{heads}</tr></thead>\n") } else { String::new() };
    let open =
        format!("<div class=\"scroll\" role=\"region\" aria-label=\"{label}\" tabindex=\"0\">");
    format!("{open}<table>\n{heads}<tbody>\n{rows}</tbody>\n</table></div>\n")
}

/// A table of texts; columns whose head begins with `#` hold numbers, to the right.
pub fn texts(label: &str, heads: &[&str], rows: &[Vec<String>]) -> String {
    let class = |head: &&str| if head.starts_with('#') { "number" } else { "" };
    let html = |cells: &Vec<String>| {
        let cells: Vec<_> = cells.iter().map(|cell| escape(cell)).collect();
        let cells = heads.iter().map(class).zip(cells.iter().map(|cell| &**cell));
        row(&cells.collect::<Vec<_>>())
    };
    table(label, heads, &rows.iter().map(html).collect::<String>())
}

/// A row; the cells are HTML, each with its class.
pub fn row(cells: &[(&str, &str)]) -> String {
    let cell = |(class, html): &(&str, &str)| match *class {
        "" => format!("<td>{html}</td>"),
        class => format!("<td class=\"{class}\">{html}</td>"),
    };
    format!("<tr>{}</tr>\n", cells.iter().map(cell).collect::<String>())
}
