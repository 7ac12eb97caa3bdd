// SPDX-License-Identifier: MIT OR Apache-2.0
//! Captures: ADC samples in files, one row per sample instant.
//!
//! | kind | read | written |
//! | --- | --- | --- |
//! | CSV: integer codes, or volts | yes, from standard input too | yes |
//! | WAV: integers of 16 to 32 bits, floats; RIFF, RF64 | yes, from standard input too | yes, RF64 beyond 4 GiB |
//! | SigMF: real integers and floats | yes | no |

mod columns;
mod csv;
mod input;
mod raw;
mod sigmf;
mod wav;

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use hapticore_files::AtomicFile;
use hapticore_model::format::Format;

/// A capture being read, sample instant by sample instant.
pub trait Source {
    /// Reads the next row of codes, one a channel in the order of the ADC, appended to `codes`. `None` at the end.
    ///
    /// # Errors
    /// The file is no capture; the message names file, line or sample, and what was expected.
    fn row(&mut self, codes: &mut Vec<i32>) -> Result<Option<Sampled>>;

    /// The sample rate, where the file names one. A CSV file does so before its first row.
    fn sample_rate_hz(&self) -> Option<f64>;

    /// Where the last row was, for messages.
    fn place(&self) -> String;

    /// What was done to the samples that were read.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }
}

/// What a row says beside its codes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sampled {
    /// The pad that was served.
    pub pad: Option<usize>,
}

/// A capture being written.
pub trait Recorder {
    /// Writes the samples of a slot: codes of all channels, a sample after the other.
    ///
    /// # Errors
    /// The file cannot be written.
    fn slot(&mut self, pad: usize, codes: &[i32]) -> Result<()>;

    /// Completes the file and gives it its name.
    ///
    /// # Errors
    /// The file cannot be written.
    fn keep(self: Box<Self>) -> Result<()>;
}

/// What the ADC is like.
#[derive(Debug, Clone, Copy)]
pub struct Adc {
    /// Current sensors; the sensing and the haptic voltage follow.
    pub terminals: usize,
    /// Codes.
    pub format: Format,
}

impl Adc {
    /// Names of the channels: `i1 … iN, v_sense, v_haptic`.
    pub fn channels(&self) -> Vec<String> {
        let terminals = (1..=self.terminals).map(|terminal| format!("i{terminal}"));
        terminals.chain(["v_sense".into(), "v_haptic".into()]).collect()
    }
}

/// What a capture does not say of itself.
#[derive(Debug, Clone, Default)]
pub struct Described {
    /// What each column or channel of the file is, in its order; as the file says where none.
    pub channels: Option<Vec<String>>,
    /// Bits of integer codes, which are then at the bottom of their samples.
    pub bits: Option<u8>,
    /// Samples are volts, and this many are the end of the ADC's range.
    pub full_scale_v: Option<f64>,
}

#[derive(Clone, Copy)]
enum Kind {
    Csv,
    Wav,
    Sigmf,
}

fn kind(path: &Path) -> Result<Kind> {
    match path.extension().map(|extension| extension.to_string_lossy().to_lowercase()).as_deref() {
        Some("csv") => Ok(Kind::Csv),
        Some("wav" | "rf64") => Ok(Kind::Wav),
        Some("sigmf-meta" | "sigmf-data") => Ok(Kind::Sigmf),
        Some("sigmf") => {
            bail!(
                "{}: expected NAME.sigmf-meta and NAME.sigmf-data, got an archive: unpack it with tar",
                path.display()
            )
        }
        _ => bail!("{}: expected a capture whose name ends in .csv or .wav (or .sigmf-meta)", path.display()),
    }
}

/// Opens a capture; `-` is standard input.
///
/// # Errors
/// It is not there, or its head is not that of a capture.
pub fn open(path: &Path, adc: Adc, described: &Described) -> Result<Box<dyn Source>> {
    let (kind, input) = if path == Path::new("-") {
        let input = input::standard()?;
        (if input.is_wav() { Kind::Wav } else { Kind::Csv }, input)
    } else {
        let kind = kind(path)?;
        if let Kind::Sigmf = kind {
            return Ok(Box::new(sigmf::open(path, adc, described)?));
        }
        (kind, input::file(path)?)
    };
    Ok(match kind {
        Kind::Csv => Box::new(csv::Reader::open(input, adc, described)?),
        _ => Box::new(wav::read::open(input, adc, described)?),
    })
}

/// Creates a capture, to be called `path`.
///
/// # Errors
/// The folder cannot be written to, or there is a folder of this name.
pub fn create(path: &Path, adc: Adc, sample_rate_hz: f64) -> Result<Box<dyn Recorder + Send>> {
    Ok(match kind(path)? {
        Kind::Csv => Box::new(csv::Writer::create(path, adc, sample_rate_hz)?),
        Kind::Wav => Box::new(wav::write::Writer::create(path, adc, sample_rate_hz)?),
        Kind::Sigmf => bail!("{}: expected a capture whose name ends in .csv or .wav", path.display()),
    })
}

/// Where the calibration of a capture is looked for: `hockey.wav.calibration.toml`.
pub fn calibration_path(capture: &Path) -> PathBuf {
    let mut name = capture.as_os_str().to_owned();
    name.push(".calibration.toml");
    name.into()
}

/// A file in the making, and what writes into it.
struct Aside {
    file: BufWriter<File>,
    atomic: AtomicFile,
}

impl Aside {
    fn create(path: &Path) -> Result<Self> {
        let within = || path.display().to_string();
        let atomic = AtomicFile::create(path).with_context(within)?;
        let file = BufWriter::with_capacity(1 << 18, atomic.reopen().with_context(within)?);
        Ok(Aside { file, atomic })
    }

    fn path(&self) -> &Path {
        self.atomic.path()
    }

    /// Completes the file and gives it its name.
    fn keep(mut self) -> Result<()> {
        let path = self.path().display().to_string();
        self.file.flush().and_then(|()| self.atomic.persist()).context(path)
    }
}

/// Writes a small text file atomically.
///
/// # Errors
/// It cannot be written.
pub fn write_text(path: &Path, text: &str) -> Result<()> {
    hapticore_files::write(path, text).with_context(|| path.display().to_string())
}
