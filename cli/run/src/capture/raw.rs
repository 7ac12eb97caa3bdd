// SPDX-License-Identifier: MIT OR Apache-2.0
//! Samples as bytes, a sample instant after the other: what WAV and SigMF files are behind their
//! heads.
//!
//! Any sample becomes a fraction of full scale, and that a code of the ADC, rounded half to even
//! where the ADC has fewer bits.

use std::io::{ErrorKind, Read};

use anyhow::{Context, Result, bail, ensure};

use super::columns::{self, Column, Columns};
use super::input::Input;
use super::stream::{Adc, Sampled, Source};
use crate::digitiser::Digitiser;

/// How a sample stands in its bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// A signed integer: its code is the sample moved right by `shift`, and has `bits`.
    Integer {
        /// Bits of the code.
        bits: u32,
        /// Bits below it, which are zero.
        shift: u32,
    },
    /// A float, full scale at ±1 or at a voltage.
    Float,
}

/// How samples stand in a file.
#[derive(Debug, Clone, Copy)]
pub struct Layout {
    /// Bytes of a sample.
    pub bytes: usize,
    /// Whether the most significant byte comes first.
    pub big_endian: bool,
    /// How a sample is encoded.
    pub encoding: Encoding,
    /// What ±1 of a fraction is in the file's numbers.
    pub full_scale: f64,
}

impl Layout {
    /// Integers of `bytes` bytes. The codes are in the low bits where `described` states their
    /// number, else they are of `bits` bits, in the high bits.
    ///
    /// # Errors
    /// More bits than the bytes have.
    pub fn integer(
        bytes: usize,
        bits: u32,
        described: Option<u8>,
        big_endian: bool,
    ) -> Result<Self> {
        let container = 8 * bytes as u32;
        let (bits, shift) = match described {
            Some(bits) => (u32::from(bits), 0),
            None => (bits, container.saturating_sub(bits)),
        };
        ensure!(
            (2..=container).contains(&bits),
            "expected codes of 2 to {container} bits in {bytes} bytes, got {bits}"
        );
        let full_scale = f64::from(bits - 1).exp2();
        Ok(Layout { bytes, big_endian, encoding: Encoding::Integer { bits, shift }, full_scale })
    }

    /// Floats of `bytes` bytes.
    pub fn float(bytes: usize, full_scale_v: Option<f64>, big_endian: bool) -> Self {
        Layout {
            bytes,
            big_endian,
            encoding: Encoding::Float,
            full_scale: full_scale_v.unwrap_or(1.0),
        }
    }

    /// The number that a sample's bytes are.
    fn number(&self, bytes: &[u8]) -> Result<f64> {
        let mut whole = [0; 8];
        for (to, from) in whole.iter_mut().zip(0..bytes.len()) {
            *to = bytes[if self.big_endian { bytes.len() - 1 - from } else { from }];
        }
        let word = u64::from_le_bytes(whole);
        match self.encoding {
            Encoding::Float if self.bytes == 4 => finite(f64::from(f32::from_bits(word as u32))),
            Encoding::Float => finite(f64::from_bits(word)),
            Encoding::Integer { bits, shift } => {
                let unused = 64 - 8 * self.bytes as u32;
                let sample = ((word << unused) as i64) >> unused;
                ensure!(
                    sample.trailing_zeros() >= shift || sample == 0,
                    "expected codes of {bits} bits at the top of {} bytes and zeros below, got {sample}; codes at the \
                     bottom need --bits {bits}",
                    self.bytes
                );
                let (code, end) = (sample >> shift, 1i64 << (bits - 1));
                ensure!((-end..end).contains(&code), "expected a code of {bits} bits, got {code}");
                Ok(code as f64)
            }
        }
    }
}

fn finite(number: f64) -> Result<f64> {
    ensure!(number.is_finite(), "expected a number, got {number}");
    Ok(number)
}

/// A file of such samples, being read.
pub struct Reader {
    input: Input,
    layout: Layout,
    columns: Columns,
    digitiser: Digitiser,
    sample_rate_hz: f64,
    /// Sample instants in the file, where its head says so.
    instants: Option<u64>,
    /// What is there is taken where the bytes end before the samples that the head names.
    is_short_taken: bool,
    ended_short: bool,
    instant: u64,
    buffer: Vec<u8>,
    rounded: bool,
    clipped: bool,
    adc_bits: u8,
}

impl Reader {
    /// A reader of what follows a head.
    pub fn new(
        input: Input,
        adc: Adc,
        layout: Layout,
        columns: Columns,
        rate: f64,
        instants: Option<u64>,
    ) -> Self {
        let buffer = vec![0; layout.bytes * columns.columns.len()];
        Reader {
            input,
            layout,
            columns,
            digitiser: Digitiser::new(adc.format),
            sample_rate_hz: rate,
            instants,
            is_short_taken: false,
            ended_short: false,
            instant: 0,
            buffer,
            rounded: false,
            clipped: false,
            adc_bits: adc.format.width,
        }
    }

    /// The same reader, which takes what is there where the bytes end early.
    pub fn taking_short(self, is_short_taken: bool) -> Self {
        Reader { is_short_taken, ..self }
    }

    /// Fills the buffer with the next instant; whether there is one.
    fn advance(&mut self) -> Result<bool> {
        if self.instants == Some(self.instant) || self.ended_short {
            return Ok(false);
        }
        let (file, at) = (&self.input.name, self.instant);
        let mut filled = 0;
        while filled < self.buffer.len() {
            match self.input.bytes.read(&mut self.buffer[filled..]) {
                Ok(0) if self.is_short_taken => {
                    self.ended_short = self.instants.is_some() || filled > 0;
                    return Ok(false);
                }
                Ok(0) => match self.instants {
                    Some(all) => {
                        bail!(
                            "{file}: sample {at}: expected {all} samples, the file is cut short; --truncated takes what is there"
                        )
                    }
                    None if filled == 0 => return Ok(false),
                    None => bail!(
                        "{file}: sample {at}: the file is cut short; --truncated takes what is there"
                    ),
                },
                Ok(read) => filled += read,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error).context(format!("{file}: sample {at}")),
            }
        }
        Ok(true)
    }

    fn code(&mut self, number: f64) -> i32 {
        let fraction = number / self.layout.full_scale;
        let (code, exact) = self.digitiser.code(fraction);
        self.clipped |= !(-1.0..=1.0).contains(&fraction);
        self.rounded |= !exact;
        code
    }
}

impl Source for Reader {
    fn row(&mut self, codes: &mut Vec<i32>) -> Result<Option<Sampled>> {
        if !self.advance()? {
            return Ok(None);
        }
        let start = codes.len();
        codes.resize(start + self.columns.channels, 0);
        let mut pad = None;
        for index in 0..self.columns.columns.len() {
            let column = self.columns.columns[index];
            if matches!(column, Column::LeftOut | Column::Time) {
                continue;
            }
            let bytes = &self.buffer[index * self.layout.bytes..][..self.layout.bytes];
            let place = || {
                format!(
                    "{}: sample {}: {}",
                    self.input.name, self.instant, self.columns.names[index]
                )
            };
            let number = self.layout.number(bytes).with_context(place)?;
            match column {
                Column::Channel(channel) => codes[start + channel] = self.code(number),
                _ => {
                    let expected = || format!("expected the number of a pad, got {number}");
                    pad = Some(columns::pad(number).with_context(expected).with_context(place)?);
                }
            }
        }
        self.instant += 1;
        Ok(Some(Sampled { pad, lost: 0 }))
    }

    fn sample_rate_hz(&self) -> Option<f64> {
        Some(self.sample_rate_hz)
    }

    fn place(&self) -> String {
        format!("{}: sample {}", self.input.name, self.instant.saturating_sub(1))
    }

    fn notes(&self) -> Vec<String> {
        let adc = self.adc_bits;
        let finer = match self.layout.encoding {
            Encoding::Integer { bits, .. } => format!("codes of {bits} bits"),
            Encoding::Float => "floats".into(),
        };
        let notes = [
            (self.rounded, format!("{finer} were rounded to the {adc} bits of the profile's ADC")),
            (self.clipped, "samples beyond full scale were clipped".to_string()),
            (
                self.instants.is_none(),
                "the file names no length: it was read to its end".to_string(),
            ),
            (
                self.ended_short,
                format!(
                    "it ends after {} samples{}: what is there was taken",
                    self.instant,
                    self.instants.map_or_else(
                        || ", within the next".to_string(),
                        |all| format!(", its head names {all}")
                    )
                ),
            ),
        ];
        notes
            .into_iter()
            .filter(|(is, _)| *is)
            .map(|(_, note)| format!("{}: {note}", self.input.name))
            .collect()
    }
}
