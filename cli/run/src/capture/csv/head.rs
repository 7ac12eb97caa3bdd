// SPDX-License-Identifier: MIT OR Apache-2.0
//! The lines before the first row of numbers, as recorders write them.
//!
//! | recorder | head | source |
//! | --- | --- | --- |
//! | this command | `# key = value`, then the names of the columns | |
//! | Tektronix MSO, MDO, DPO | `Model,…`, `Sample Interval,1e-06`, …, then `TIME,CH1,…` | its saved files |
//! | PicoScope | `Time,Channel A,…`, then `(us),(mV),…`, then an empty line | PicoScope 6 User's Guide, "Text formats" |
//! | Rigol DS1000Z | `X,CH1,…,Start,Increment,`, then `Sequence,Volt,…,-6e-02,1e-06`; rows end with a comma | its saved files |
//! | LeCroy | `LECROY…,Waveform`, `Segments,1,SegmentSize,…`, `Segment,TrigTime,…`, `#1,…`, then `Time,Ampl` | its saved files |
//! | numpy `savetxt` | `# ` and the names of the columns, separated by blanks | numpy manual |

use anyhow::{Result, bail};

use super::super::columns::{Column, Columns};
use super::super::stream::Adc;
use super::dialect::Dialect;
use super::time::{self, Times};

/// Lines of a head at most.
pub const LONGEST: usize = 100;

/// Known heads: what a line of them begins with, and whose it is.
const RECORDERS: [(&str, &str); 6] = [
    ("model,", "a Tektronix file"),
    ("record length,", "a Tektronix TDS file, which holds one channel"),
    ("time,channel a", "a PicoScope file"),
    ("x,ch", "a Rigol file"),
    ("time(s),ch", "a Rigol file"),
    ("lecroy", "a LeCroy file"),
];

/// A line and its number in the file.
pub type Line = (usize, String);

/// What the head of a file says.
pub struct Head {
    /// What each column is.
    pub columns: Columns,
    /// How cells stand in a row.
    pub dialect: Dialect,
    /// Volts of one of each column's numbers, where it names a unit.
    pub volts: Vec<Option<f64>>,
    /// The column of times, where there is one.
    pub times: Option<(usize, Times)>,
    /// From a sample to the next, s, where the head says so.
    pub step_s: Option<f64>,
    /// The first rows, which were read with it.
    pub rows: Vec<Line>,
}

/// Whether a line is one of names of all channels.
pub fn is_header(line: &str, adc: Adc) -> bool {
    Columns::named(&names(line), adc).is_ok()
}

/// Whether a line has cells, but nothing in them.
pub fn is_empty(line: &str) -> bool {
    Dialect::of(line).cells(line).all(str::is_empty)
}

/// The names in a header, each without its unit.
fn names(line: &str) -> Vec<String> {
    let mut names: Vec<String> =
        Dialect::of(line).cells(line).map(|cell| split(cell).0.to_string()).collect();
    names.pop_if(|name| name.is_empty());
    names
}

/// A name and the unit behind it: `CH1 (mV)`. That of a time stays with it.
fn split(cell: &str) -> (&str, Option<&str>) {
    let (name, unit) = match cell.split_once(['(', '[']) {
        Some((name, unit)) if !name.trim().is_empty() => (name.trim(), Some(unit)),
        _ => (cell, None),
    };
    if time::named(cell).is_some() { (cell, unit) } else { (name, unit) }
}

fn volts_of(unit: &str) -> Result<Option<f64>> {
    Ok(Some(match unit.trim_matches(['(', ')', '[', ']', ' ']) {
        "V" | "Volt" | "Volts" | "volts" => 1.0,
        "mV" => 1e-3,
        "uV" | "µV" | "μV" => 1e-6,
        "kV" => 1e3,
        unit @ ("A" | "mA" | "uA" | "µA" | "μA") => {
            bail!(
                "expected volts at the ADC, got {unit}: set the probe's factor to 1 V/V, or convert the column"
            )
        }
        _ => return Ok(None),
    }))
}

/// Whether a line is one of units: `(us),(mV)`, `Sequence,Volt`.
fn is_units(line: &str) -> bool {
    let is_unit = |cell: &str| {
        cell.is_empty()
            || cell == "Sequence"
            || time::unit_s(cell).is_some()
            || !matches!(volts_of(cell), Ok(None))
            || Dialect::number(cell).is_some()
    };
    let cells: Vec<_> = Dialect::of(line).cells(line).collect();
    cells.iter().all(|cell| is_unit(cell))
        && cells.iter().any(|cell| !cell.is_empty() && Dialect::number(cell).is_none())
}

impl Head {
    /// The head that lines are; the last of them may be a row of numbers. `described` names the
    /// columns where the file does not.
    ///
    /// # Errors
    /// Lines that name no columns; with the number of the line.
    pub fn of(
        mut lines: Vec<Line>,
        in_comment: Option<Line>,
        described: Option<&[String]>,
        adc: Adc,
    ) -> Result<Head, (usize, anyhow::Error)> {
        let segments =
            |line: &str| Some(line.strip_prefix("Segments,")?.split(',').next()?.to_string());
        let several = |(number, line): &Line| Some((*number, segments(line).filter(|n| n != "1")?));
        if let Some((number, segments)) = lines.iter().find_map(several) {
            return Err((
                number,
                anyhow::anyhow!("expected one segment, got {segments}: cut the recording there"),
            ));
        }
        let numbers = |(_, line): &Line| Dialect::of(line).numbers(line);
        let data = lines.iter().position(|line| numbers(line).is_some());
        let count = data.and_then(|index| numbers(&lines[index]));
        let end = data.unwrap_or(lines.len());
        let is_named = |(_, line): &Line| described.is_none() && is_header(line, adc);
        let cells =
            |line: &str| Dialect::of(line).cells(line).filter(|cell| !cell.is_empty()).count();
        let named = lines[..end].iter().position(is_named);
        let (header, comment) = match named {
            Some(index) => (Some(index), None),
            None if described.is_none() && in_comment.is_some() => (None, in_comment),
            None => {
                let as_long = |line: &Line| {
                    !is_units(&line.1) && count.is_none_or(|count| cells(&line.1) >= count)
                };
                (lines[..end].iter().rposition(as_long), None)
            }
        };
        let at = comment.as_ref().map_or_else(
            || lines.get(header.unwrap_or(0)).map_or(1, |(number, _)| *number),
            |(number, _)| *number,
        );
        let fail = |error: anyhow::Error| (at, error);
        let mut text =
            comment.map(|(_, text)| text).or_else(|| header.map(|index| lines[index].1.clone()));
        if text.is_none() && described.is_none() {
            text = lines.first().map(|(_, line)| line.clone());
        }
        let file_names = text.as_deref().map(names).unwrap_or_default();
        let columns = match described {
            Some(_) => Columns::counted(count.unwrap_or(file_names.len()), described, adc),
            None => Columns::named(&file_names, adc),
        };
        let mut columns =
            columns.map_err(|error| fail(cured(error, &lines, count, described, adc)))?;
        let units_at = header.map_or(0, |index| index + 1);
        let has_units =
            lines.get(units_at).is_some_and(|(_, line)| units_at < end && is_units(line));
        let units = has_units.then(|| lines[units_at].1.clone());
        let rows_at = match (header, described) {
            (_, Some(_)) => end,
            (index, None) => index.map_or(0, |index| index + 1) + usize::from(has_units),
        };
        let rows = lines.split_off(rows_at.min(lines.len()));
        let step_s = step_s(&lines);
        let header_cells: Vec<String> = text
            .as_deref()
            .map(|line| Dialect::of(line).cells(line).map(str::to_string).collect())
            .unwrap_or_default();
        let unit_cells: Vec<String> = units
            .as_deref()
            .map(|line| Dialect::of(line).cells(line).map(str::to_string).collect())
            .unwrap_or_default();
        let unit = |index: usize| {
            let of_row = unit_cells.get(index).map(String::as_str);
            of_row.or_else(|| header_cells.get(index).and_then(|cell| split(cell).1))
        };
        let mut volts = Vec::new();
        for (index, column) in columns.columns.iter().enumerate() {
            volts.push(match (column, unit(index)) {
                (Column::Channel(_), Some(unit)) => volts_of(unit).map_err(fail)?,
                _ => None,
            });
        }
        let name = |index: usize| header_cells.get(index).map_or("", String::as_str);
        let unit_s = |index: usize| match unit(index).and_then(time::unit_s) {
            _ if unit(index) == Some("Sequence") => step_s,
            Some(unit_s) if time::named(name(index)).is_some() => Some(unit_s),
            _ => time::named(name(index)),
        };
        let unused =
            |index: &usize| matches!(columns.columns[*index], Column::LeftOut | Column::Time);
        let time = (0..columns.columns.len())
            .filter(unused)
            .find(|index| columns.columns[*index] == Column::Time || unit_s(*index).is_some());
        let times = time.map(|index| (index, Times::new(unit_s(index).unwrap_or(1.0), None)));
        if let Some(index) = time {
            columns.columns[index] = Column::Time;
        }
        let dialect = rows
            .first()
            .map_or(Dialect::of(text.as_deref().unwrap_or("")), |(_, line)| Dialect::of(line));
        Ok(Head { columns, dialect, volts, times, step_s, rows })
    }
}

/// The step that a head names: `Sample Interval,1e-06`, or `Increment` above its number.
fn step_s(lines: &[Line]) -> Option<f64> {
    let cells =
        |line: &str| -> Vec<String> { Dialect::of(line).cells(line).map(str::to_string).collect() };
    let number =
        |cell: Option<&String>| cell.and_then(|cell| Dialect::number(cell)).filter(|s| *s > 0.0);
    lines.iter().enumerate().find_map(|(index, (_, line))| {
        let cells_here = cells(line);
        if cells_here[0].eq_ignore_ascii_case("sample interval") {
            return number(cells_here.get(1));
        }
        let column = cells_here.iter().position(|cell| cell == "Increment")?;
        number(cells(&lines.get(index + 1)?.1).get(column))
    })
}

/// An error of the columns' names with its cure: a recorder that is known, and how its columns are named.
fn cured(
    error: anyhow::Error,
    lines: &[Line],
    count: Option<usize>,
    described: Option<&[String]>,
    adc: Adc,
) -> anyhow::Error {
    let begins = |words: &str| lines.iter().any(|(_, line)| line.to_lowercase().starts_with(words));
    let recorder = RECORDERS.into_iter().find(|(words, _)| begins(words)).map(|(_, name)| name);
    let channels = adc.channels();
    let it = recorder.map_or(String::new(), |name| format!("; it is {name}"));
    match count {
        Some(count) if count < channels.len() => anyhow::anyhow!(
            "{error:#}{it}; put the columns of a recorder's files, one for each channel, side by side"
        ),
        Some(count) if described.is_none() => {
            let others = count - channels.len();
            let names = std::iter::repeat_n("_", others).map(String::from).chain(channels);
            let names: Vec<_> = names.collect();
            anyhow::anyhow!(
                "{error:#}{it}; its {count} columns are named so: --channels {}",
                names.join(",")
            )
        }
        Some(count) if described.is_some_and(|names| count > names.len()) => {
            anyhow::anyhow!("{error:#}{it}; decimal commas need another separator, or quotes")
        }
        _ => anyhow::anyhow!("{error:#}{it}"),
    }
}

/// Checks that volts are named where columns are volts.
///
/// # Errors
/// A unit of volts without a full scale.
pub fn check_volts(head: &Head, full_scale_v: Option<f64>) -> Result<()> {
    let named = head.volts.iter().position(Option::is_some);
    if let (Some(index), None) = (named, full_scale_v) {
        let name = &head.columns.names[index];
        bail!("{name}: its unit is volts: say how many are full scale: --full-scale-v 10");
    }
    Ok(())
}
