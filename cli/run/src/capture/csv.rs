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
//! Columns may come in any order, `pad` may be missing. With `# full_scale_v = 10` samples are not
//! codes but volts at the ADC, 10 of them at the end of its range. Every row ends with the end of a
//! line, so that a file that was cut short is known for one.

use std::io::{BufRead, Read, Write};
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail};

use super::columns::{self, Column, Columns, wanted};
use super::input::Input;
use super::partial_file::PartialFile;
use super::stream::{Adc, Described, Recorder, Sampled, Source};
use crate::digitiser::Digitiser;

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
    fractions: Vec<f64>,
    line: String,
    number: usize,
    /// The line is a row that is still to be read: a file without a header begins with it.
    pending: bool,
    sample_rate_hz: Option<f64>,
    bits: u8,
    full_scale_v: Option<f64>,
    rounded: bool,
    clipped: bool,
}

impl Reader {
    /// Opens a capture and reads its head.
    pub fn open(input: Input, adc: Adc, described: &Described) -> Result<Self> {
        let mut reader = Reader {
            input,
            adc,
            digitiser: Digitiser::new(adc.format),
            columns: None,
            fractions: Vec::new(),
            line: String::new(),
            number: 0,
            pending: false,
            sample_rate_hz: None,
            bits: adc.format.width,
            full_scale_v: None,
            rounded: false,
            clipped: false,
        };
        if !reader.advance()? {
            bail!(reader.error(format!("expected a header of {}, got an empty file", wanted(adc))));
        }
        reader.bits = described.bits.unwrap_or(reader.bits);
        reader.full_scale_v = described.full_scale_v.or(reader.full_scale_v);
        reader.read_header(described.channels.as_deref())?;
        Ok(reader)
    }

    fn error(&self, message: impl std::fmt::Display) -> anyhow::Error {
        anyhow!("{}:{}: {message}", self.input.name, self.number.max(1))
    }

    /// Goes to the next line that is neither empty nor a comment; whether there is one.
    fn advance(&mut self) -> Result<bool> {
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
        let Some((key, value)) = comment.split_once('=') else { return Ok(()) };
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
                self.bits = bits.ok_or_else(|| expected(&format!("2 to {MOST_BITS}")))?;
            }
        }
        Ok(())
    }

    fn read_header(&mut self, described: Option<&[String]>) -> Result<()> {
        let line = self.line.trim_start_matches('\u{feff}').trim().to_string();
        let fields: Vec<String> =
            line.split(',').map(|name| name.trim().trim_matches('"').to_string()).collect();
        let columns = match described {
            Some(_) => Columns::counted(fields.len(), described, self.adc),
            None => Columns::named(&fields, self.adc),
        };
        self.columns = Some(columns.map_err(|error| self.error(format!("{error:#}")))?);
        self.pending =
            described.is_some() && fields.iter().all(|field| field.parse::<f64>().is_ok());
        Ok(())
    }

    /// The fraction of full scale that a field is.
    fn fraction(&self, name: &str, field: &str) -> Result<f64> {
        if let Some(full_scale_v) = self.full_scale_v {
            let volts = field.parse().ok().filter(|volts: &f64| volts.is_finite());
            let message = || self.error(format!("{name}: expected volts, got \"{field}\""));
            return Ok(volts.ok_or_else(message)? / full_scale_v);
        }
        let (bits, most) = (self.bits, 1i64 << (self.bits - 1));
        let code = field.parse::<i64>().ok().filter(|code| (-most..most).contains(code));
        let message = || {
            let volts = field.contains('.') && field.parse::<f64>().is_ok();
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

    fn row_of(&self, columns: &Columns, fractions: &mut [f64]) -> Result<Option<usize>> {
        let (mut fields, mut pad) = (0, None);
        for field in self.line.trim().split(',').map(str::trim) {
            match columns.columns.get(fields) {
                Some(Column::Channel(channel)) => {
                    fractions[*channel] = self.fraction(&columns.names[fields], field)?
                }
                Some(Column::Pad) => {
                    let expected = || {
                        self.error(format!("pad: expected the number of a pad, got \"{field}\""))
                    };
                    pad = Some(field.parse().ok().and_then(columns::pad).with_context(expected)?);
                }
                _ => (),
            }
            fields += 1;
        }
        let expected = columns.columns.len();
        if fields != expected {
            bail!(self.error(format!("expected {expected} columns, got {fields}")));
        }
        if !self.line.ends_with('\n') {
            bail!(
                self.error(
                    "expected the end of the line, got the end of the file: it is cut short"
                )
            );
        }
        Ok(pad)
    }
}

impl Source for Reader {
    fn row(&mut self, codes: &mut Vec<i32>) -> Result<Option<Sampled>> {
        if !std::mem::take(&mut self.pending) && !self.advance()? {
            return Ok(None);
        }
        let columns = self.columns.take().expect("the header has been read");
        self.fractions.clear();
        self.fractions.resize(columns.channels, 0.0);
        let mut fractions = std::mem::take(&mut self.fractions);
        let pad = self.row_of(&columns, &mut fractions);
        for fraction in &fractions {
            let (code, exact) = self.digitiser.code(*fraction);
            self.rounded |= !exact;
            self.clipped |= !(-1.0..=1.0).contains(fraction);
            codes.push(code);
        }
        (self.columns, self.fractions) = (Some(columns), fractions);
        Ok(Some(Sampled { pad: pad? }))
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
            format!("codes of {} bits", self.bits)
        };
        let notes = [
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

/// A CSV capture being written.
pub struct Writer {
    partial: PartialFile,
    channels: usize,
}

impl Writer {
    /// Creates a capture.
    pub fn create(path: &Path, adc: Adc, sample_rate_hz: f64) -> Result<Self> {
        let mut partial = PartialFile::create(path)?;
        let channels = adc.channels();
        let header = format!(
            "# sample_rate_hz = {sample_rate_hz}\n# bits = {}\n{},pad\n",
            adc.format.width,
            channels.join(",")
        );
        partial.file.write_all(header.as_bytes()).with_context(|| path.display().to_string())?;
        Ok(Writer { partial, channels: channels.len() })
    }

    fn write(&mut self, pad: usize, codes: &[i32]) -> std::io::Result<()> {
        let file = &mut self.partial.file;
        for row in codes.chunks_exact(self.channels) {
            row.iter().try_for_each(|code| write!(file, "{code},"))?;
            writeln!(file, "{pad}")?;
        }
        Ok(())
    }
}

impl Recorder for Writer {
    fn slot(&mut self, pad: usize, codes: &[i32]) -> Result<()> {
        self.write(pad, codes).with_context(|| self.partial.path().display().to_string())
    }

    fn keep(self: Box<Self>) -> Result<()> {
        self.partial.keep()
    }
}
