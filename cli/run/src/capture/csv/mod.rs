// SPDX-License-Identifier: MIT OR Apache-2.0
//! Captures as CSV.
//!
//! ```csv
//! # sample_rate_hz = 1000000
//! # bits = 18
//! i1,i2,i3,i4,i5,i6,v_sense,v_haptic,pad
//! -12,4,55,3,0,-1,81920,17,0
//! ```
//!
//! Columns may come in any order, `pad` may be missing, and a column of times is checked. With
//! `# full_scale_v = 10` samples are not codes but volts at the ADC, 10 of them at the end of its
//! range. Every row ends with the end of a line, so that a file that was cut short is known for one.
//! UTF-8, and UTF-16 with its byte order mark.
//!
//! | module | does |
//! | --- | --- |
//! | [`dialect`] | what separates cells, which sign is the decimal point |
//! | [`head`] | the lines before the first row, as recorders write them |
//! | [`time`] | a column of times: jumps, another sample rate |
//! | [`write`] | a capture being written |

mod dialect;
mod head;
pub(super) mod time;
pub(super) mod write;

use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Read};

use anyhow::{Context, Result, anyhow, bail, ensure};
use encoding_rs_io::DecodeReaderBytesBuilder;

use super::columns::{self, Column, Columns, wanted};
use super::input::Input;
use super::stream::{Adc, Described, Sampled, Source};
use crate::digitiser::Digitiser;
use dialect::Dialect;
use head::{Head, Line};
use time::Times;

/// The most bits of a code.
const MOST_BITS: u8 = 32;

/// The longest line, bytes: it is held in memory, and what comes may have no end.
const LONGEST: usize = 1 << 20;

/// A CSV capture being read.
pub struct Reader {
    input: Input,
    adc: Adc,
    digitiser: Digitiser,
    columns: Option<Columns>,
    dialect: Dialect,
    /// Volts of one of each column's numbers.
    volts: Vec<Option<f64>>,
    times: Option<(usize, Times)>,
    /// A comment that names all channels.
    named_in_comment: Option<Line>,
    fractions: Vec<f64>,
    line: String,
    number: usize,
    /// Rows that were read with the head.
    pending: VecDeque<Line>,
    sample_rate_hz: Option<f64>,
    bits: Option<u8>,
    full_scale_v: Option<f64>,
    is_short_taken: bool,
    ended_short: bool,
    rounded: bool,
    clipped: bool,
}

/// What is wrong besides where a file ends within a line.
const CUT_SHORT: &str =
    "; the file ends within this line: it is cut short; --truncated takes what is there";

impl Reader {
    /// Opens a capture and reads its head.
    pub fn open(input: Input, adc: Adc, described: &Described) -> Result<Self> {
        let mut reader = Reader {
            input: decoded(input)?,
            adc,
            digitiser: Digitiser::new(adc.format),
            columns: None,
            dialect: Dialect::of(","),
            volts: Vec::new(),
            times: None,
            named_in_comment: None,
            fractions: Vec::new(),
            line: String::new(),
            number: 0,
            pending: VecDeque::new(),
            sample_rate_hz: None,
            bits: None,
            full_scale_v: None,
            is_short_taken: described.truncated,
            ended_short: false,
            rounded: false,
            clipped: false,
        };
        if !reader.advance()? {
            bail!(reader.error(format!("expected a header of {}, got an empty file", wanted(adc))));
        }
        reader.read_head(described)?;
        Ok(reader)
    }

    fn error(&self, message: impl std::fmt::Display) -> anyhow::Error {
        let (name, number) = (&self.input.name, self.number.max(1));
        let cut = if self.line.is_empty() || self.line.ends_with('\n') { "" } else { CUT_SHORT };
        anyhow!("{name}:{number}: {message}{cut}")
    }

    /// Goes to the next line that is neither empty nor a comment; whether there is one.
    fn advance(&mut self) -> Result<bool> {
        if let Some((number, line)) = self.pending.pop_front() {
            (self.number, self.line) = (number, line);
            return Ok(true);
        }
        loop {
            self.line.clear();
            self.number += 1;
            let mut bytes = (&mut self.input.bytes).take(LONGEST as u64);
            let read = bytes.read_line(&mut self.line).map_err(|error| self.error(error))?;
            if read == 0 {
                return Ok(false);
            }
            if read == LONGEST && !self.line.ends_with('\n') {
                bail!(self.error(format!("expected a line of at most {LONGEST} bytes")));
            }
            let text = self.line.trim_start_matches('\u{feff}').trim();
            match text.strip_prefix('#') {
                Some(comment) => {
                    let comment = comment.to_string();
                    self.read_comment(&comment)?;
                }
                None if text.is_empty() => (),
                None => return Ok(true),
            }
        }
    }

    fn read_comment(&mut self, comment: &str) -> Result<()> {
        let Some((key, value)) = comment.split_once('=') else {
            if self.columns.is_none() && head::is_header(comment, self.adc) {
                self.named_in_comment = Some((self.number, comment.to_string()));
            }
            return Ok(());
        };
        let (key, value) = (key.trim(), value.trim());
        if !["sample_rate_hz", "full_scale_v", "bits"].contains(&key) {
            return Ok(());
        }
        if self.columns.is_some() {
            bail!(
                self.error(format!(
                    "{key}: expected before the header, where it holds for all rows"
                ))
            );
        }
        let above_0 =
            || value.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
        let expected = |what: &str| self.error(format!("{key}: expected {what}, got \"{value}\""));
        match key {
            "sample_rate_hz" => {
                self.sample_rate_hz = Some(above_0().ok_or_else(|| expected("a number above 0"))?)
            }
            "full_scale_v" => {
                self.full_scale_v = Some(above_0().ok_or_else(|| expected("a number above 0"))?)
            }
            _ => {
                let bits = value.parse().ok().filter(|bits| (2..=MOST_BITS).contains(bits));
                self.bits = Some(bits.ok_or_else(|| expected(&format!("2 to {MOST_BITS}")))?);
            }
        }
        Ok(())
    }

    /// Reads lines up to the first row of numbers, or a header with all names and the line behind it.
    fn read_head(&mut self, described: &Described) -> Result<()> {
        let channels = described.channels.as_deref();
        let mut lines: Vec<Line> = Vec::new();
        loop {
            let line = self.line.trim_start_matches('\u{feff}').to_string();
            let is_row = Dialect::of(&line).numbers(&line).is_some();
            if !head::is_empty(&line) {
                lines.push((self.number, line));
            }
            let named = lines
                .iter()
                .rposition(|(_, line)| channels.is_none() && head::is_header(line, self.adc));
            let is_whole = is_row || named.is_some_and(|index| index + 2 == lines.len());
            if is_whole || lines.len() == head::LONGEST || !self.advance()? {
                break;
            }
        }
        let last = self.number;
        let named = self.named_in_comment.take();
        let head = Head::of(lines, named, channels, self.adc)
            .map_err(|(number, error)| anyhow!("{}:{number}: {error:#}", self.input.name))?;
        self.bits = described.bits.or(self.bits);
        self.full_scale_v = described.full_scale_v.or(self.full_scale_v);
        self.sample_rate_hz = self.sample_rate_hz.or(head.step_s.map(|step_s| 1.0 / step_s));
        head::check_volts(&head, self.full_scale_v).map_err(|error| self.error(error))?;
        let step_s = described.sample_rate_hz.map(|rate| 1.0 / rate);
        self.times = head.times.map(|(column, times)| (column, times.with_step(step_s)));
        (self.columns, self.dialect, self.volts) = (Some(head.columns), head.dialect, head.volts);
        (self.pending, self.number) = (head.rows.into(), last);
        Ok(())
    }

    /// The fraction of full scale that a cell is; `unit_v` are the volts of one of its numbers.
    fn fraction(&self, name: &str, field: &str, unit_v: Option<f64>) -> Result<f64> {
        if let Some(full_scale_v) = self.full_scale_v {
            let message = || {
                let cure = if field.contains('∞') {
                    ": the recorder's input was beyond its range; choose a larger one"
                } else {
                    ""
                };
                self.error(format!("{name}: expected volts, got \"{field}\"{cure}"))
            };
            let volts = Dialect::number(field).ok_or_else(message)? * unit_v.unwrap_or(1.0);
            return Ok(volts / full_scale_v);
        }
        let Some(bits) = self.bits else {
            bail!(self.error(format!(
                "{name}: expected \"# bits = N\" before the header, or --bits N: an integer code without its bits may be \
                 any part of full scale; for volts say how many are full scale: --full-scale-v 10"
            )))
        };
        let most = 1i64 << (bits - 1);
        let whole =
            || Dialect::number(field).filter(|code| code.fract() == 0.0).map(|code| code as i64);
        let code =
            field.parse::<i64>().ok().or_else(whole).filter(|code| (-most..most).contains(code));
        let message = || {
            let volts = field.contains(['.', ',']) && Dialect::number(field).is_some();
            let cure = if volts {
                "; for volts say how many are full scale: --full-scale-v 10"
            } else {
                ""
            };
            let last = most - 1;
            self.error(format!(
                "{name}: expected an integer code from -{most} to {last} ({bits} bits), got \"{field}\"{cure}"
            ))
        };
        Ok(code.ok_or_else(message)? as f64 / most as f64)
    }

    fn row_of(&self, columns: &Columns, fractions: &mut [f64]) -> Result<(Sampled, Option<Times>)> {
        let (mut fields, mut sampled, mut after) = (0, Sampled::default(), None);
        for field in self.dialect.cells(&self.line) {
            match columns.columns.get(fields) {
                Some(Column::Channel(channel)) => {
                    let name = &columns.names[fields];
                    fractions[*channel] = self.fraction(name, field, self.volts[fields])?
                }
                Some(Column::Pad) => {
                    let expected = || {
                        self.error(format!("pad: expected the number of a pad, got \"{field}\""))
                    };
                    let pad = Dialect::number(field).and_then(columns::pad);
                    sampled.pad = Some(pad.with_context(expected)?);
                }
                Some(Column::Time) => {
                    let Some((_, times)) =
                        self.times.as_ref().filter(|(column, _)| *column == fields)
                    else {
                        fields += 1;
                        continue;
                    };
                    let name = &columns.names[fields];
                    let number = Dialect::number(field).with_context(|| {
                        self.error(format!("{name}: expected a time, got \"{field}\""))
                    })?;
                    let mut times = times.clone();
                    sampled.lost = times
                        .row(field, number)
                        .map_err(|error| self.error(format!("time: {error}")))?;
                    after = Some(times);
                }
                // A line that ends with a separator has no column behind it.
                None if field.is_empty() && fields == columns.columns.len() => continue,
                _ => (),
            }
            fields += 1;
        }
        let expected = columns.columns.len();
        if fields != expected {
            let cure = if fields > expected && self.line.contains(',') && fields.is_multiple_of(2) {
                "; decimal commas need another separator, or quotes"
            } else {
                ""
            };
            bail!(self.error(format!("expected {expected} columns, got {fields}{cure}")));
        }
        let is_whole = self.line.ends_with('\n');
        ensure!(is_whole, self.error("expected the end of the line, got the end of the file"));
        Ok((sampled, after))
    }

    /// Whether the row is a last line without its end, and such a line is left out.
    fn is_left_out(&mut self) -> bool {
        self.ended_short = self.is_short_taken && !self.line.ends_with('\n');
        self.ended_short
    }
}

/// The text of a file, UTF-16 made UTF-8.
fn decoded(mut input: Input) -> Result<Input> {
    let start = input.bytes.fill_buf().map_err(|error| anyhow!("{}:1: {error}", input.name))?;
    let is_marked = start.starts_with(&[0xff, 0xfe]) || start.starts_with(&[0xfe, 0xff]);
    if !is_marked
        && start.len() > 3
        && (start[0] == 0) != (start[1] == 0)
        && (start[2] == 0) != (start[3] == 0)
    {
        bail!(
            "{}:1: expected text, got UTF-16 without a byte order mark: save it as UTF-8",
            input.name
        );
    }
    if !is_marked {
        return Ok(input);
    }
    let text = DecodeReaderBytesBuilder::new().build(input.bytes);
    Ok(Input { bytes: BufReader::new(Box::new(text)), ..input })
}

impl Source for Reader {
    fn row(&mut self, codes: &mut Vec<i32>) -> Result<Option<Sampled>> {
        if self.ended_short || !self.advance()? || self.is_left_out() {
            return Ok(None);
        }
        let columns = self.columns.take().expect("the header has been read");
        self.fractions.clear();
        self.fractions.resize(columns.channels, 0.0);
        let mut fractions = std::mem::take(&mut self.fractions);
        let sampled = self.row_of(&columns, &mut fractions);
        for fraction in &fractions {
            let (code, exact) = self.digitiser.code(*fraction);
            self.rounded |= !exact;
            self.clipped |= !(-1.0..=1.0).contains(fraction);
            codes.push(code);
        }
        (self.columns, self.fractions) = (Some(columns), fractions);
        let (sampled, times) = sampled?;
        if let (Some(known), Some(times)) = (&mut self.times, times) {
            known.1 = times;
        }
        Ok(Some(sampled))
    }

    fn sample_rate_hz(&self) -> Option<f64> {
        self.sample_rate_hz
    }

    fn place(&self) -> String {
        format!("{}:{}", self.input.name, self.number)
    }

    fn notes(&self) -> Vec<String> {
        let adc = self.adc.format.width;
        let finer = if self.full_scale_v.is_some() {
            "volts".into()
        } else {
            format!("codes of {} bits", self.bits.unwrap_or(adc))
        };
        let notes = [
            (self.ended_short, "its last line is cut short and was left out".to_string()),
            (self.rounded, format!("{finer} were rounded to the {adc} bits of the profile's ADC")),
            (self.clipped, "samples beyond full scale were clipped".to_string()),
        ];
        notes
            .into_iter()
            .filter(|(is, _)| *is)
            .map(|(_, note)| format!("{}: {note}", self.input.name))
            .collect()
    }
}
