// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a board adds to a profile: its clock, its serial port, its ADC's pins.

use super::drive_output::{Converter, Wave};
use super::framing::word_bytes;
use super::uart::BitClocks;
use hapticore_contract::profile::Profile;
use hapticore_protocol::Output;
use hapticore_protocol::drive::Kind;

/// A board's own numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Parameters {
    /// The core's clock.
    pub clock_hz: u64,
    /// Bits a second of the serial port.
    pub baud: u64,
    /// Clocks from `sclk_run` to the pulse at the pin: those of the output primitive.
    pub sclk_latency: u64,
    /// What drives the pads; there is one exactly if the profile has a controller.
    pub drive: Option<Drive>,
}

/// What drives the pads of a board.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Drive {
    /// The wave.
    pub wave: Wave,
    /// The converter.
    pub converter: Converter,
    /// The voltage of a drive word of full scale, V: the board reports it, nothing else depends on it.
    pub full_scale_v: u16,
}

/// With the full scale that is usual.
impl From<(Wave, Converter)> for Drive {
    fn from((wave, converter): (Wave, Converter)) -> Self {
        Drive { wave, converter, full_scale_v: Output::FULL_SCALE_V }
    }
}

impl Drive {
    /// What heartbeats report of it at a clock of `clock_hz` hertz.
    pub fn output(&self, clock_hz: u64) -> Output {
        let Drive { wave, converter, full_scale_v } = *self;
        Output { dac: converter.dac(), wave, full_scale_v, clock_hz }
    }
}

/// A board that cannot be.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{field}: expected {expected}, got {got}")]
pub struct ParametersError {
    /// Name of the parameter.
    pub field: &'static str,
    /// What it may be.
    pub expected: String,
    /// What it is.
    pub got: u64,
}

/// Holds a number within a range.
fn within(field: &'static str, got: u64, least: u64, most: u64) -> Result<(), ParametersError> {
    let expected = || format!("{least} to {most}");
    (least..=most).contains(&got).then_some(()).ok_or_else(|| ParametersError {
        field,
        expected: expected(),
        got,
    })
}

impl Parameters {
    /// From a conversion's start until its codes may be read: 0.55 µs and the delay of BUSY.
    const CONVERSION_MOST_NS: u64 = 600;
    /// From a conversion's start until its codes may replace those before, which are then still
    /// being read.
    const CONVERSION_LEAST_NS: u64 = 500;
    /// Clocks of a write of an ADC's register, without the wait before it.
    const WRITE_CLOCKS: u64 = 22;
    /// The time allowed for a pad's switch to break.
    const BREAK_NS: u64 = 1000;

    /// What heartbeats report of the drive, where there is one.
    pub fn output(&self) -> Option<Output> {
        self.drive.map(|drive| drive.output(self.clock_hz))
    }

    /// Clocks of each bit of the serial port.
    pub fn bits(&self) -> BitClocks {
        BitClocks::of(self.clock_hz, self.baud)
    }

    /// Clocks of a conversion.
    pub fn conversion(&self) -> u64 {
        (Self::CONVERSION_MOST_NS * self.clock_hz).div_ceil(1_000_000_000)
    }

    /// Clocks between two pads.
    pub fn dead(&self) -> u64 {
        (Self::BREAK_NS * self.clock_hz).div_ceil(1_000_000_000)
    }

    /// A register of the ADC is written before the next command's first byte is there.
    fn least_divisor(&self) -> u64 {
        (self.conversion() + Self::WRITE_CLOCKS).div_ceil(10).max(4)
    }

    /// Whether a core of the profile can be served with these.
    ///
    /// # Errors
    /// The first number out of its range.
    pub fn check(&self, profile: &Profile) -> Result<(), ParametersError> {
        let (period, bits) = (profile.clocks_per_sample, u64::from(profile.formats.adc.width));
        let channels = profile.channels() as u64;
        let control = u64::from(profile.control.is_some());
        within("clock_hz", self.clock_hz, 1_000_000, 200_000_000)?;
        let least = self.least_divisor();
        within("baud", self.bits().least(), least, 1 << 16).map_err(|error| ParametersError {
            expected: format!("{} to {}", self.clock_hz >> 16, self.clock_hz / least),
            got: self.baud,
            ..error
        })?;
        within("ADC channels", channels, 2, 8)?;
        within("ADC bits", bits, 2, 18)?;
        within("pads", profile.pads, 1, 16)?;
        // A frame's number is on the line before the next frame's comes.
        let byte = self.bits().byte() + 2;
        within("clocks of a byte on the serial line", byte, 1, profile.slot_clocks())?;
        within("clocks_per_sample", period, bits + channels - 1, 1 << 16)?;
        let drives = u64::from(self.drive.is_some());
        within("drives", drives, control, control)?;
        if let Some(control) = &profile.control {
            let bits = 8 * word_bytes(profile);
            within("bits of a drive word", control.drive.width.into(), 1, bits)?;
            within("words of the curve", control.cells + 1, 1, 1 << Kind::AT)?;
        }
        within("sclk_latency", self.sclk_latency, 0, self.conversion())?;
        let least = period + Self::CONVERSION_LEAST_NS * self.clock_hz / 1_000_000_000;
        within(
            "clocks from a conversion to the end of its reading",
            self.conversion() + bits + 1,
            1,
            least,
        )?;
        within("clocks of a conversion", self.conversion(), 1, period - 2)
    }
}
