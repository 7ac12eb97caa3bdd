// SPDX-License-Identifier: MIT OR Apache-2.0
//! Captures: ADC samples in files, one row per sample instant.
//!
//! | kind | read | written |
//! | --- | --- | --- |
//! | CSV: integer codes, or volts; as recorders write it, too | yes, from standard input too | yes |
//! | WAV: integers of 16 to 32 bits, floats; RIFF, RF64 | yes, from standard input too | yes, RF64 beyond 4 GiB |
//! | SigMF: real integers and floats | yes | no |

mod columns;
mod csv;
mod input;
mod partial_file;
mod raw;
mod sigmf;
mod slots;
mod stream;
mod switched;
mod wav;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

pub use input::Input;
pub use slots::{BROKEN, Cut, Shape, Slots};
pub use stream::{Adc, Described, Recorder, Sampled, Source};
pub use switched::Switched;

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
        _ => {
            let file = path.display();
            let scene = match path.extension().is_none_or(|extension| extension == "toml") {
                true => format!("; for a scene: hapticore simulate {file}"),
                false => String::new(),
            };
            bail!(
                "{file}: expected a capture whose name ends in .csv or .wav (or .sigmf-meta){scene}"
            )
        }
    }
}

/// Whether a file has the name of a capture.
pub fn is_named_as_one(path: &Path) -> bool {
    kind(path).is_ok()
}

/// The content of a capture's files, by kind.
pub enum Content {
    /// CSV.
    Csv(Input),
    /// WAV.
    Wav(Input),
    /// SigMF.
    Sigmf {
        /// What the meta data are called in messages.
        file: String,
        /// The text of the meta data.
        meta: String,
        /// The samples.
        data: Input,
    },
}

/// Opens a capture; `-` is standard input.
///
/// # Errors
/// It is not there, or its head is not that of a capture.
pub fn open(path: &Path, adc: Adc, described: &Described) -> Result<Box<dyn Source>> {
    let content = if path == Path::new("-") {
        let input = input::standard()?;
        if input.is_wav() { Content::Wav(input) } else { Content::Csv(input) }
    } else {
        match kind(path)? {
            Kind::Csv => Content::Csv(input::file(path)?),
            Kind::Wav => Content::Wav(input::file(path)?),
            Kind::Sigmf => sigmf::files(path)?,
        }
    };
    read(content, adc, described)
}

/// Opens a capture whose files have been opened.
///
/// # Errors
/// Its head is not that of a capture.
pub fn read(content: Content, adc: Adc, described: &Described) -> Result<Box<dyn Source>> {
    Ok(match content {
        Content::Csv(input) => Box::new(csv::Reader::open(input, adc, described)?),
        Content::Wav(input) => Box::new(wav::read::open(input, adc, described)?),
        Content::Sigmf { file, meta, data } => {
            Box::new(sigmf::open(&file, &meta, data, adc, described)?)
        }
    })
}

/// Creates a capture, to be called `path`.
///
/// # Errors
/// The folder cannot be written to, or there is a folder of this name.
pub fn create(path: &Path, adc: Adc, sample_rate_hz: f64) -> Result<Box<dyn Recorder + Send>> {
    Ok(match kind(path)? {
        Kind::Csv => Box::new(csv::write::Writer::create(path, adc, sample_rate_hz)?),
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
