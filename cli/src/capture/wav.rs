// SPDX-License-Identifier: MIT OR Apache-2.0
//! Captures as WAV: integer samples of 16, 24 or 32 bits, a channel each for the currents, the sensing voltage and the haptic
//! voltage, and perhaps one for the pad.
//!
//! As in any WAV file a sample's rails are the ADC's: codes of 18 bits are at the top of samples of 24 bits. Samples with
//! more bits than the ADC are taken where the bits below are zero.

use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail, ensure};
use hound::{SampleFormat, WavIntoSamples, WavReader, WavSpec, WavWriter};
use tempfile::NamedTempFile;

use super::{Adc, Aside, Recorder, Sampled, Source};

/// A WAV capture being read.
pub struct Reader {
    samples: WavIntoSamples<BufReader<File>, i32>,
    path: PathBuf,
    names: Vec<String>,
    channels: usize,
    spec: WavSpec,
    adc_bits: u16,
    rows: u64,
    instant: u64,
}

impl Reader {
    /// Opens a capture and reads its head.
    pub fn open(path: &Path, adc: Adc) -> Result<Self> {
        let file = path.display();
        let opened = File::open(path).with_context(|| file.to_string())?;
        ensure!(opened.metadata()?.len() > 0, "{file}: expected a WAV file, got an empty file");
        let reader = WavReader::new(BufReader::with_capacity(1 << 18, opened));
        let reader = reader.map_err(|error| anyhow!("{file}: expected a WAV file: {error}"))?;
        let (spec, names) = (reader.spec(), adc.channels());
        let channels = usize::from(spec.channels);
        ensure!(
            channels == names.len() || channels == names.len() + 1,
            "{file}: expected {} channels ({}, and perhaps pad), got {channels}",
            names.len(),
            names.join(", ")
        );
        ensure!(
            spec.sample_format == SampleFormat::Int && matches!(spec.bits_per_sample, 16 | 24 | 32),
            "{file}: expected integer samples of 16, 24 or 32 bits, got {:?} samples of {} bits",
            spec.sample_format,
            spec.bits_per_sample
        );
        let rows = u64::from(reader.duration());
        let (path, adc_bits) = (path.to_owned(), u16::from(adc.format.width));
        Ok(Reader { samples: reader.into_samples(), path, names, channels, spec, adc_bits, rows, instant: 0 })
    }

    /// The next sample; `None` at the end of the file.
    fn sample(&mut self) -> Result<Option<i32>> {
        let (file, at, rows) = (self.path.display(), self.instant, self.rows);
        match self.samples.next() {
            None => Ok(None),
            Some(Ok(sample)) => Ok(Some(sample)),
            Some(Err(error)) => bail!("{file}: sample {at}: expected {rows} samples, the file is cut short: {error}"),
        }
    }

    /// The ADC's code of a sample.
    fn code(&self, channel: usize, sample: i32) -> Result<i32> {
        let (have, want) = (self.spec.bits_per_sample, self.adc_bits);
        if have <= want {
            return Ok(sample << (want - have));
        }
        let code = sample >> (have - want);
        ensure!(
            code << (have - want) == sample,
            "{}: sample {}: {}: expected codes of at most {want} bits, as the profile's ADC has, got {have} bits",
            self.path.display(),
            self.instant,
            self.names[channel]
        );
        Ok(code)
    }
}

impl Source for Reader {
    fn row(&mut self, codes: &mut Vec<i32>) -> Result<Option<Sampled>> {
        let mut pad = None;
        for channel in 0..self.channels {
            match self.sample()? {
                None if channel == 0 => return Ok(None),
                None => bail!("{}: sample {}: the file is cut short", self.path.display(), self.instant),
                Some(sample) if channel < self.names.len() => codes.push(self.code(channel, sample)?),
                Some(sample) => pad = usize::try_from(sample).ok(),
            }
        }
        self.instant += 1;
        Ok(Some(Sampled { pad }))
    }

    fn sample_rate_hz(&self) -> Option<f64> {
        Some(f64::from(self.spec.sample_rate))
    }

    fn place(&self) -> String {
        format!("{}: sample {}", self.path.display(), self.instant.saturating_sub(1))
    }
}

/// A WAV capture being written.
pub struct Writer {
    wav: WavWriter<BufWriter<File>>,
    temporary: NamedTempFile,
    path: PathBuf,
    shift: u16,
}

impl Writer {
    /// Creates a capture.
    pub fn create(path: &Path, adc: Adc, sample_rate_hz: f64) -> Result<Self> {
        let file = path.display();
        let bits = u16::from(adc.format.width).next_multiple_of(8).max(16);
        let rate = sample_rate_hz as u32;
        ensure!(
            f64::from(rate) == sample_rate_hz,
            "{file}: expected a whole sample rate for WAV, got {sample_rate_hz} Hz"
        );
        let spec = WavSpec {
            channels: adc.channels().len() as u16,
            sample_rate: rate,
            bits_per_sample: bits,
            sample_format: SampleFormat::Int,
        };
        let Aside { file: buffer, temporary, path } = Aside::create(path)?;
        let wav = WavWriter::new(buffer, spec).with_context(|| path.display().to_string())?;
        Ok(Writer { wav, temporary, path, shift: bits - u16::from(adc.format.width) })
    }
}

impl Recorder for Writer {
    fn slot(&mut self, _pad: usize, codes: &[i32]) -> Result<()> {
        let write = |code: &i32| self.wav.write_sample(code << self.shift);
        codes.iter().try_for_each(write).with_context(|| self.path.display().to_string())
    }

    fn keep(self: Box<Self>) -> Result<()> {
        self.wav.finalize().with_context(|| self.path.display().to_string())?;
        super::persist(self.temporary, &self.path)
    }
}
