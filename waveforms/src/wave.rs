// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a waveform file can do.

use std::path::Path;

use crate::Error;
use crate::declarations::Declarations;
use crate::fst_file::FstFile;
use crate::vcd_file::VcdFile;

/// How much of a file is gathered before it goes to the file system.
pub(crate) const BUFFER_BYTES: usize = 1 << 18;

/// A waveform file being written. Signals are named by their index in the declarations.
///
/// Calls come as: one `begin`; then times in rising order, each followed by its changes; then one
/// `finish`. A file dropped before `finish` leaves nothing behind.
pub trait Wave {
    /// Writes the scopes and variables.
    ///
    /// # Errors
    /// The file cannot be written, as for all methods here.
    fn begin(&mut self, declarations: &Declarations) -> Result<(), Error>;

    /// What follows happens at `ticks`.
    fn time(&mut self, ticks: u64) -> Result<(), Error>;

    /// The signal takes the value `bits`, already masked to its width.
    fn bits(&mut self, signal: usize, bits: u64) -> Result<(), Error>;

    /// The real signal takes this value.
    fn real(&mut self, signal: usize, value: f64) -> Result<(), Error>;

    /// Completes the file and gives it its name.
    fn finish(&mut self) -> Result<(), Error>;
}

impl<W: Wave + ?Sized> Wave for Box<W> {
    fn begin(&mut self, declarations: &Declarations) -> Result<(), Error> {
        (**self).begin(declarations)
    }

    fn time(&mut self, ticks: u64) -> Result<(), Error> {
        (**self).time(ticks)
    }

    fn bits(&mut self, signal: usize, bits: u64) -> Result<(), Error> {
        (**self).bits(signal, bits)
    }

    fn real(&mut self, signal: usize, value: f64) -> Result<(), Error> {
        (**self).real(signal, value)
    }

    fn finish(&mut self) -> Result<(), Error> {
        (**self).finish()
    }
}

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
