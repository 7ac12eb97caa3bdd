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
//! Columns may come in any order, `pad` may be missing. Every row ends with the end of a line, so that a file that was cut
//! short is known for one.

use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail, ensure};

use super::{Adc, Aside, Recorder, Sampled, Source};

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Column {
    Channel(usize),
    Pad,
}

/// A CSV capture being read.
pub struct Reader {
    file: BufReader<File>,
    path: PathBuf,
    adc: Adc,
    names: Vec<String>,
    columns: Vec<Column>,
    line: String,
    number: usize,
    sample_rate_hz: Option<f64>,
    bits: u8,
    /// Codes of the file are moved left by this.
    shift: u8,
}

impl Reader {
    /// Opens a capture and reads its head.
    pub fn open(path: &Path, adc: Adc) -> Result<Self> {
        let file = File::open(path).with_context(|| path.display().to_string())?;
        let bits = adc.format.width;
        let mut reader = Reader {
            file: BufReader::with_capacity(1 << 18, file),
            path: path.to_owned(),
            adc,
            names: Vec::new(),
            columns: Vec::new(),
            line: String::new(),
            number: 0,
            sample_rate_hz: None,
            bits,
            shift: 0,
        };
        ensure!(
            reader.advance()?,
            "{}",
            reader.error(format!("expected a header of {}, got an empty file", reader.wanted()))
        );
        reader.read_header()?;
        Ok(reader)
    }

    fn wanted(&self) -> String {
        format!("columns {} (and perhaps pad)", self.adc.channels().join(", "))
    }

    fn error(&self, message: impl std::fmt::Display) -> anyhow::Error {
        anyhow!("{}:{}: {message}", self.path.display(), self.number.max(1))
    }

    /// Goes to the next line that is neither empty nor a comment; whether there is one.
    fn advance(&mut self) -> Result<bool> {
        loop {
            self.line.clear();
            self.number += 1;
            let read = self.file.read_line(&mut self.line).map_err(|error| self.error(error))?;
            if read == 0 {
                return Ok(false);
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
        let value = value.trim();
        match key.trim() {
            "sample_rate_hz" => {
                let rate = value.parse().ok().filter(|rate: &f64| rate.is_finite() && *rate > 0.0);
                let expected = || self.error(format!("sample_rate_hz: expected a number above 0, got \"{value}\""));
                self.sample_rate_hz = Some(rate.ok_or_else(expected)?);
            }
            "bits" => {
                let adc = self.adc.format.width;
                let bits = value.parse().ok().filter(|bits| (2..=adc).contains(bits));
                let expected =
                    || self.error(format!("bits: expected 2 to {adc}, as the profile's ADC has, got \"{value}\""));
                self.bits = bits.ok_or_else(expected)?;
                self.shift = adc - self.bits;
            }
            _ => (),
        }
        Ok(())
    }

    fn read_header(&mut self) -> Result<()> {
        let channels = self.adc.channels();
        let line = self.line.trim_start_matches('\u{feff}').trim().to_string();
        for name in line.split(',').map(|name| name.trim().trim_matches('"')) {
            let known = channels.iter().position(|channel| channel == name).map(Column::Channel);
            let column = known.or((name == "pad").then_some(Column::Pad));
            let column = column.ok_or_else(|| self.error(format!("expected {}, got \"{name}\"", self.wanted())))?;
            ensure!(!self.columns.contains(&column), "{}", self.error(format!("column {name} comes twice")));
            self.columns.push(column);
            self.names.push(name.to_string());
        }
        match (0..channels.len()).find(|channel| !self.columns.contains(&Column::Channel(*channel))) {
            Some(missing) => {
                Err(self.error(format!("column {} is missing: expected {}", channels[missing], self.wanted())))
            }
            None => Ok(()),
        }
    }

    fn code(&self, column: usize, field: &str) -> Result<i32> {
        let most = 1i32 << (self.bits - 1);
        let code = field.parse().ok().filter(|code| (-most..most).contains(code));
        let (name, last) = (&self.names[column], most - 1);
        let message =
            || format!("{name}: expected an integer code from -{most} to {last} ({} bits), got \"{field}\"", self.bits);
        Ok(code.ok_or_else(|| self.error(message()))? << self.shift)
    }
}

impl Source for Reader {
    fn row(&mut self, codes: &mut Vec<i32>) -> Result<Option<Sampled>> {
        if !self.advance()? {
            return Ok(None);
        }
        let start = codes.len();
        codes.resize(start + self.columns.len() - usize::from(self.columns.contains(&Column::Pad)), 0);
        let (mut fields, mut pad) = (0, None);
        for field in self.line.trim().split(',').map(str::trim) {
            match self.columns.get(fields) {
                Some(Column::Channel(channel)) => codes[start + channel] = self.code(fields, field)?,
                Some(Column::Pad) => {
                    let expected = || self.error(format!("pad: expected the number of a pad, got \"{field}\""));
                    pad = Some(field.parse().map_err(|_| expected())?);
                }
                None => (),
            }
            fields += 1;
        }
        let expected = self.columns.len();
        if fields != expected {
            bail!(self.error(format!("expected {expected} columns, got {fields}")));
        }
        if !self.line.ends_with('\n') {
            bail!(self.error("expected the end of the line, got the end of the file: it is cut short"));
        }
        Ok(Some(Sampled { pad }))
    }

    fn sample_rate_hz(&self) -> Option<f64> {
        self.sample_rate_hz
    }

    fn place(&self) -> String {
        format!("{}:{}", self.path.display(), self.number)
    }
}

/// A CSV capture being written.
pub struct Writer {
    aside: Aside,
    channels: usize,
}

impl Writer {
    /// Creates a capture.
    pub fn create(path: &Path, adc: Adc, sample_rate_hz: f64) -> Result<Self> {
        let mut aside = Aside::create(path)?;
        let channels = adc.channels();
        write!(aside.file, "# sample_rate_hz = {sample_rate_hz}\n# bits = {}\n", adc.format.width)?;
        writeln!(aside.file, "{},pad", channels.join(","))?;
        Ok(Writer { aside, channels: channels.len() })
    }
}

impl Recorder for Writer {
    fn slot(&mut self, pad: usize, codes: &[i32]) -> Result<()> {
        let file = &mut self.aside.file;
        for row in codes.chunks_exact(self.channels) {
            row.iter().try_for_each(|code| write!(file, "{code},"))?;
            writeln!(file, "{pad}")?;
        }
        Ok(())
    }

    fn keep(mut self: Box<Self>) -> Result<()> {
        self.aside.file.flush()?;
        super::persist(self.aside.temporary, &self.aside.path)
    }
}
