// SPDX-License-Identifier: MIT OR Apache-2.0
//! Converters by the names that commands give them.

use super::Converter;
use super::serial::Frame;
use hapticore_protocol::output::{Dac, NameError};
use std::str::FromStr;

/// Bits of a parallel converter's words.
const PARALLEL_BITS: u8 = 16;

impl From<Dac> for Converter {
    fn from(dac: Dac) -> Self {
        match dac {
            Dac::Pulses => Converter::Pulses,
            Dac::Ad5664 => Converter::Serial(Frame::AD5664),
            Dac::Ad5664r => Converter::Serial(Frame::AD5664R),
            Dac::Ad5668 => Converter::Serial(Frame::AD5668),
            Dac::Parallel => Converter::Parallel { bits: PARALLEL_BITS },
        }
    }
}

/// The name of a [`Dac`].
impl FromStr for Converter {
    type Err = NameError;

    fn from_str(text: &str) -> Result<Self, NameError> {
        text.parse::<Dac>().map(Converter::from)
    }
}

impl Converter {
    /// Its name.
    pub fn dac(self) -> Dac {
        match self {
            Converter::Pulses => Dac::Pulses,
            Converter::Serial(frame) => frame.dac,
            Converter::Parallel { .. } => Dac::Parallel,
        }
    }

    /// The most channels that it has.
    pub fn most_channels(self) -> u64 {
        match self {
            Converter::Serial(frame) => frame.channels,
            Converter::Pulses | Converter::Parallel { .. } => 16,
        }
    }
}
