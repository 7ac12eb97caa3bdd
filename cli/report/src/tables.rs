// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tables: criteria, effects, rounding errors, the run itself.

use super::number;
use super::page::escape;
use super::words;
use hapticore_run::findings::{Flagged, Tracking};
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
            &["criterion", "result", "#measured", "#limit (at most)", "for comparison"],
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

/// The effects, what each cost, and which share of all effects that was: their times are summed over all threads, so that
/// they may be more than the run's wall time.
pub fn effects(effects: &[Effect]) -> String {
    if effects.is_empty() {
        return String::new();
    }
    let all: f64 = effects.iter().map(|effect| effect.seconds).sum();
    let rows = effects.iter().map(|e| effect(e, all)).collect::<String>();
    let heads = [
        "effect",
        "fidelity level",
        "difference from a finer level",
        "#computing time, all threads",
        "#share of all effects",
    ];
    table("Effects", &heads, &rows)
}

fn effect(effect: &Effect, all_seconds: f64) -> String {
    let finer = |(finer, percent): &(String, f64)| escape(&words::off(*percent, finer));
    row(&[
        ("", &escape(&effect.name)),
        ("", &escape(&effect.level)),
        ("", &effect.finer.as_ref().map_or(String::new(), finer)),
        ("number", &number::seconds(effect.seconds)),
        ("number", &share(effect.seconds / all_seconds)),
    ])
}

fn share(share: f64) -> String {
    if !share.is_finite() {
        return number::NONE.into();
    }
    let percent = 100.0 * share;
    let width = number::fixed(percent, 1);
    let text = if percent > 0.0 && percent < 0.1 { "< 0.1" } else { width.as_str() };
    format!("{} %<span class=\"bar\"><span style=\"width:{width}%\"></span></span>", escape(text))
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

/// Flagged frames by kind, case and pad.
pub fn flags(flagged: &[Flagged], slots: usize) -> String {
    if flagged.is_empty() {
        let none = if slots > 0 { "<p>No frame carries a flag.</p>\n" } else { "" };
        return none.into();
    }
    let row = |of: &Flagged| {
        let force = of.force_percent.map_or(String::new(), |percent| signed(percent) + " %");
        let counts = [of.frames, of.of].map(|count| count.to_string());
        [vec![of.flag.clone(), of.case.clone(), of.pad.clone()], counts.to_vec(), vec![force]]
            .concat()
    };
    let heads = ["flag", "case", "pad", "#frames", "#of", "#force read in them, off the true one"];
    texts("Flags", &heads, &flagged.iter().map(row).collect::<Vec<_>>())
}

fn signed(value: f64) -> String {
    let sign = if value > 0.0 { "+" } else { "" };
    sign.to_string() + &number::short(value)
}

/// How controlled pads follow their targets.
pub fn tracking(tracking: &[Tracking]) -> String {
    if tracking.is_empty() {
        return String::new();
    }
    let newtons = |value: f64| number::with_unit(&number::short(value), "N");
    let row = |of: &Tracking| {
        let settled = of.settled.map_or(String::new(), |at| {
            let [target, read, truth] = [at.target_n, at.read_n, at.true_n].map(number::short);
            format!("{target} N: reads {read} N, true {truth} N")
        });
        let forces = [of.target_n, of.rms_n, of.overshoot_n].map(newtons);
        let ends = [of.sticking_n.map_or(String::new(), newtons), of.faults.to_string(), settled];
        [vec![of.case.clone(), of.pad.clone()], forces.to_vec(), ends.to_vec()].concat()
    };
    let heads = [
        "case",
        "pad",
        "#target up to",
        "#off target, RMS",
        "#overshoot",
        "#mean sticking force",
        "#drives off by a fault",
        "where the target stays",
    ];
    texts("Tracking", &heads, &tracking.iter().map(row).collect::<Vec<_>>())
}

/// Gains and margins of force loops; nothing where there is none.
pub fn loops(record: &Record) -> String {
    let items: String =
        words::stability(record).map(|line| format!("<li>{}</li>\n", escape(&line))).collect();
    if items.is_empty() { items } else { format!("<ul class=\"findings\">\n{items}</ul>\n") }
}

/// How long the run took and what it left.
pub fn run(record: &Record) -> String {
    let facts = [
        ("device time", number::seconds(record.simulated_seconds)),
        ("wall time", number::seconds(record.wall_seconds)),
        ("speed", words::speed(record)),
        ("finished slots", record.rows.len().to_string()),
        (
            "slots with a flag set",
            record.rows.iter().filter(|r| !r.flags.is_empty()).count().to_string(),
        ),
        ("number of pads", record.pads.len().to_string()),
        ("number of cases", record.cases.len().to_string()),
    ];
    texts("Run", &["", "#"], &facts.map(|(name, value)| vec![name.to_string(), value]))
}

/// Where the run comes from: enough to repeat it.
pub fn provenance(record: &Record) -> String {
    let of = &record.provenance;
    let facts = [
        ("date", record.date.clone()),
        ("version", of.version.clone()),
        ("commit", of.commit.clone().unwrap_or_default()),
        ("command", of.command.join(" ")),
        ("seed", of.seed.map_or(String::new(), |seed| seed.to_string())),
        (
            "calibration",
            of.calibration.as_ref().map_or(String::new(), |at| at.display().to_string()),
        ),
    ];
    let set = of.set.iter().map(|(key, value)| ("--set", format!("{key}={value}")));
    let known = facts.into_iter().chain(set).filter(|(_, value)| !value.is_empty());
    let rows: Vec<_> = known.map(|(name, value)| vec![name.to_string(), value]).collect();
    if rows.is_empty() { String::new() } else { texts("Provenance", &["", "="], &rows) }
}

/// The files beside the report.
pub fn files(files: &[String]) -> String {
    let link = |name: &String| {
        let href = name.replace('%', "%25").replace('#', "%23").replace('?', "%3F");
        format!("<li><a href=\"{}\">{}</a></li>\n", escape(&href), escape(name))
    };
    let links: String = files.iter().map(link).collect();
    if links.is_empty() { links } else { format!("<ul class=\"files\">\n{links}</ul>\n") }
}

/// A table in a container that scrolls on its own; a `#` before a head puts its column to the
/// right.
pub fn table(label: &str, heads: &[&str], rows: &str) -> String {
    let head = |head: &&str| match head.strip_prefix('#') {
        Some(text) => format!("<th class=\"number\" scope=\"col\">{text}</th>"),
        None => format!("<th scope=\"col\">{head}</th>"),
    };
    let named = heads.iter().any(|h| h.len() > 1);
    let rows = labelled(heads, rows);
    let heads: String = heads.iter().map(head).collect();
    let heads = if named { format!("<thead><tr>{heads}</tr></thead>\n") } else { String::new() };
    let open =
        format!("<div class=\"scroll\" role=\"region\" aria-label=\"{label}\" tabindex=\"0\">");
    format!("{open}<table>\n{heads}<tbody>\n{rows}</tbody>\n</table></div>\n")
}

/// Rows whose cells carry their column's head: a phone shows a row as a list, so that it cuts no number.
fn labelled(heads: &[&str], rows: &str) -> String {
    let row = |row: &str| {
        let mut cells = row.split("<td");
        let start = cells.next().unwrap_or_default().to_string();
        let heads = heads
            .iter()
            .map(|head| head.trim_start_matches(['#', '=']))
            .chain(std::iter::repeat(""));
        let cell = |(cell, head): (&str, &str)| match head {
            "" => format!("<td{cell}"),
            head => format!("<td data-head=\"{head}\"{cell}"),
        };
        start + &cells.zip(heads).map(cell).collect::<String>()
    };
    rows.split_inclusive("</tr>").map(row).collect()
}

/// A table of texts; columns whose head begins with `#` hold numbers, to the right, those with `=` what a terminal shows.
pub fn texts(label: &str, heads: &[&str], rows: &[Vec<String>]) -> String {
    let class = |head: &&str| match head.as_bytes().first() {
        Some(b'#') => "number",
        Some(b'=') => "code",
        _ => "",
    };
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
