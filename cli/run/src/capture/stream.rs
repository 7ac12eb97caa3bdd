// SPDX-License-Identifier: MIT OR Apache-2.0
//! What all kinds of captures have in common: rows that are read, slots that are written, and the
//! ADC that they are of.

use anyhow::Result;
use hapticore_hdl::format::Format;

/// A capture being read, sample instant by sample instant.
pub trait Source {
    /// Reads the next row of codes, one a channel in the order of the ADC, appended to `codes`.
    /// `None` at the end.
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
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Sampled {
    /// The selected pad.
    pub pad: Option<usize>,
    /// Samples that are missing before this one, by a column of times.
    pub lost: u64,
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
    /// Format of the codes.
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
    /// The sample rate that a column of times must have.
    pub sample_rate_hz: Option<f64>,
    /// What is there of a file that is cut short is taken.
    pub truncated: bool,
}
