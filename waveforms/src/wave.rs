// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a waveform file can do.

use crate::Error;
use crate::declarations::Declarations;

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
