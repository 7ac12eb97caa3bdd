// SPDX-License-Identifier: MIT OR Apache-2.0
//! What has changed since the last clock, and only that, into a waveform file.

use crate::Error;
use crate::bits::masked;
use crate::wave::Wave;

/// A file that receives the time only when something changes.
pub(crate) struct Timed<W> {
    wave: W,
    now: u64,
    written: Option<u64>,
}

impl<W: Wave> Timed<W> {
    pub(crate) fn new(wave: W) -> Self {
        Timed { wave, now: 0, written: None }
    }

    /// What follows happens at `ticks`.
    pub(crate) fn at(&mut self, ticks: u64) {
        self.now = ticks;
    }

    /// Completes the file, which lasts until `ticks`.
    pub(crate) fn finish(&mut self, ticks: u64) -> Result<(), Error> {
        self.wave.time(ticks)?;
        self.wave.finish()
    }

    fn stamp(&mut self) -> Result<(), Error> {
        if self.written == Some(self.now) {
            return Ok(());
        }
        self.written = Some(self.now);
        self.wave.time(self.now)
    }

    pub(crate) fn bits(&mut self, signal: usize, bits: u64) -> Result<(), Error> {
        self.stamp()?;
        self.wave.bits(signal, bits)
    }

    pub(crate) fn real(&mut self, signal: usize, value: f64) -> Result<(), Error> {
        self.stamp()?;
        self.wave.real(signal, value)
    }
}

/// Codes of a probe, some of which are signals of the file.
pub(crate) struct Codes {
    /// Of each code, its signal and its width.
    signals: Vec<Option<(usize, u8)>>,
    /// Empty before the first clock traced.
    last: Vec<i64>,
}

impl Codes {
    pub(crate) fn new(signals: Vec<Option<(usize, u8)>>) -> Self {
        Codes { last: Vec::with_capacity(signals.len()), signals }
    }

    /// Writes what has changed since the last call.
    pub(crate) fn trace<W: Wave>(&mut self, now: &[i64], wave: &mut Timed<W>) -> Result<(), Error> {
        assert_eq!(now.len(), self.signals.len(), "a probe samples as many codes as it declares");
        if self.last.is_empty() {
            // Other than any code, so that every first value is a change.
            self.last.extend(now.iter().map(|code| !code));
        }
        for ((signal, &now), last) in self.signals.iter().zip(now).zip(&mut self.last) {
            if let Some((signal, width)) = signal
                && now != *last
            {
                wave.bits(*signal, masked(now, *width))?;
            }
            *last = now;
        }
        Ok(())
    }
}

/// The physical truth: the signals that follow those of the probe. NaN, the value before any is
/// set, is not written.
pub(crate) struct Truth {
    first: usize,
    now: Vec<f64>,
    held: Vec<f64>,
    last: Vec<f64>,
}

impl Truth {
    pub(crate) fn new(first: usize, signals: usize) -> Self {
        let none = vec![f64::NAN; signals];
        Truth { first, now: none.clone(), held: none.clone(), last: none }
    }

    pub(crate) fn set(&mut self, index: usize, value: f64) {
        self.now[index] = value;
    }

    /// Keeps what is true now, to be written by [`Truth::trace`].
    pub(crate) fn hold(&mut self) {
        self.held.copy_from_slice(&self.now);
    }

    /// Writes what is held and has changed since the last call.
    pub(crate) fn trace<W: Wave>(&mut self, wave: &mut Timed<W>) -> Result<(), Error> {
        for (index, (now, last)) in self.held.iter().zip(&mut self.last).enumerate() {
            if now.to_bits() != last.to_bits() {
                wave.real(self.first + index, *now)?;
                *last = *now;
            }
        }
        Ok(())
    }
}
