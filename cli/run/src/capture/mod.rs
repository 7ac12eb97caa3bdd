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
mod partial_file;
mod raw;
mod sigmf;
mod stream;
mod wav;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

pub use stream::{Adc, Described, Recorder, Sampled, Source};

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
        _ => bail!(
            "{}: expected a capture whose name ends in .csv or .wav (or .sigmf-meta)",
            path.display()
        ),
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
        Kind::Sigmf => {
            bail!("{}: expected a capture whose name ends in .csv or .wav", path.display())
        }
    })
}

/// Where the calibration of a capture is looked for: `hockey.wav.calibration.toml`.
pub fn calibration_path(capture: &Path) -> PathBuf {
    let mut name = capture.as_os_str().to_owned();
    name.push(".calibration.toml");
    name.into()
}

/// Writes a small text file atomically.
///
/// # Errors
/// It cannot be written.
pub fn write_text(path: &Path, text: &str) -> Result<()> {
    hapticore_files::write(path, text).with_context(|| path.display().to_string())
}
