// SPDX-License-Identifier: MIT OR Apache-2.0
//! The formats of waveform files.

use std::path::Path;

use crate::Error;
use crate::fst_file::FstFile;
use crate::vcd_file::VcdFile;
use crate::wave::Wave;

/// The file formats.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Value change dump: text that every viewer reads.
    Vcd,
    /// GTKWave's own: compressed, some tens of times smaller.
    Fst,
}

impl Kind {
    /// A file of this format that will be called `path`.
    ///
    /// # Errors
    /// The folder cannot be written to.
    pub fn create(self, path: &Path) -> Result<Box<dyn Wave>, Error> {
        Ok(match self {
            Kind::Vcd => Box::new(VcdFile::create(path)?),
            Kind::Fst => Box::new(FstFile::create(path)?),
        })
    }

    /// The usual ending of a file name, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Kind::Vcd => "vcd",
            Kind::Fst => "fst",
        }
    }
}
