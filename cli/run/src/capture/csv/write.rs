// SPDX-License-Identifier: MIT OR Apache-2.0
//! A CSV capture being written.

use std::io::Write;
use std::path::Path;

use anyhow::{Context, Result};

use super::super::partial_file::PartialFile;
use super::super::stream::{Adc, Recorder};

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
