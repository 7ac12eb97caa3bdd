// SPDX-License-Identifier: MIT OR Apache-2.0
//! What has changed since the last clock, and only that, into a waveform file.

use hapticore_hdl::probe::Probe;

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

/// The codes of the probe: signals `0 ..` of the declarations.
pub(crate) struct Codes {
    widths: Vec<u8>,
    now: Vec<i64>,
    /// Empty before the first clock traced.
    last: Vec<i64>,
}

impl Codes {
    pub(crate) fn new(widths: Vec<u8>) -> Self {
        let signals = widths.len();
        Codes { widths, now: Vec::with_capacity(signals), last: Vec::with_capacity(signals) }
    }

    pub(crate) fn signals(&self) -> usize {
        self.widths.len()
    }

    /// Samples `probe` and writes what has changed since the last sample.
    pub(crate) fn trace<W: Wave>(
        &mut self,
        probe: &impl Probe,
        wave: &mut Timed<W>,
    ) -> Result<(), Error> {
        self.now.clear();
        probe.sample(&mut self.now);
        assert_eq!(
            self.now.len(),
            self.widths.len(),
            "a probe samples as many codes as it declares variables"
        );
        if self.last.is_empty() {
            // Other than any code, so that every first value is a change.
            self.last.extend(self.now.iter().map(|code| !code));
        }
        for (signal, (&now, &last)) in self.now.iter().zip(&self.last).enumerate() {
            if now != last {
                wave.bits(signal, masked(now, self.widths[signal]))?;
            }
        }
        std::mem::swap(&mut self.now, &mut self.last);
        Ok(())
    }
}

/// The physical truth: the signals that follow those of the probe. NaN, the value before any is
/// set, is not written.
pub(crate) struct Truth {
    first: usize,
    now: Vec<f64>,
    last: Vec<f64>,
}

impl Truth {
    pub(crate) fn new(first: usize, signals: usize) -> Self {
        Truth { first, now: vec![f64::NAN; signals], last: vec![f64::NAN; signals] }
    }

    pub(crate) fn set(&mut self, index: usize, value: f64) {
        self.now[index] = value;
    }

    /// Writes what has changed since the last call.
    pub(crate) fn trace<W: Wave>(&mut self, wave: &mut Timed<W>) -> Result<(), Error> {
        for (index, (now, last)) in self.now.iter().zip(&mut self.last).enumerate() {
            if now.to_bits() != last.to_bits() {
                wave.real(self.first + index, *now)?;
                *last = *now;
            }
        }
        Ok(())
    }
}
