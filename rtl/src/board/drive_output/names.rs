// SPDX-License-Identifier: MIT OR Apache-2.0
//! Waves and converters by the names that commands give them.

use super::serial::Frame;
use super::{Converter, Wave};
use std::str::FromStr;

/// Points of a sine's period that a command asks for.
const POINTS: u64 = 64;
/// The fewest clocks of a period: those of the shortest points.
const LEAST_PERIOD: u64 = 8 * POINTS;
/// The most, so that a counter of them is a word that any part adds in a clock.
const MOST_PERIOD: u64 = POINTS << 24;
/// The most slots between two turns.
const MOST_SLOTS: u64 = 1 << 16;

/// A name that is no wave's or no converter's.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("expected {expected}, got \"{got}\"")]
pub struct NameError {
    expected: String,
    got: String,
}

fn refused<T>(expected: impl Into<String>, got: &str) -> Result<T, NameError> {
    Err(NameError { expected: expected.into(), got: got.into() })
}

/// `dc`, `square`, `square:SLOTS` or `sine:CLOCKS`, slots from turn to turn or clocks of a period.
///
/// ```
/// use hapticore_rtl::board::drive_output::Wave;
///
/// assert_eq!("square".parse(), Ok(Wave::Square { turn_slots: 1 }));
/// assert_eq!("sine:125000".parse(), Ok(Wave::Sine { points: 64, point_clocks: 1953 }));
/// ```
impl FromStr for Wave {
    type Err = NameError;

    fn from_str(text: &str) -> Result<Self, NameError> {
        let (name, number) = match text.split_once(':') {
            Some((name, number)) => (name, Some(number)),
            None => (text, None),
        };
        let within = |least: u64, most: u64| {
            let parsed = number.and_then(|number| number.parse().ok());
            match parsed.filter(|parsed| (least..=most).contains(parsed)) {
                Some(parsed) => Ok(parsed),
                None => refused(format!("{name}:N with N from {least} to {most}"), text),
            }
        };
        match (name, number) {
            ("dc", None) => Ok(Wave::Dc),
            ("square", None) => Ok(Wave::Square { turn_slots: 1 }),
            ("square", Some(_)) => Ok(Wave::Square { turn_slots: within(1, MOST_SLOTS)? }),
            ("sine", _) => {
                let clocks: u64 = within(LEAST_PERIOD, MOST_PERIOD)?;
                Ok(Wave::Sine { points: POINTS, point_clocks: (clocks + POINTS / 2) / POINTS })
            }
            _ => refused("dc, square, square:SLOTS or sine:CLOCKS", text),
        }
    }
}

/// `pulses`, `ad5664`, `ad5668` or `parallel`, whose words have 16 bits.
impl FromStr for Converter {
    type Err = NameError;

    fn from_str(text: &str) -> Result<Self, NameError> {
        match text {
            "pulses" => Ok(Converter::Pulses),
            "ad5664" => Ok(Converter::Serial(Frame::AD5664)),
            "ad5668" => Ok(Converter::Serial(Frame::AD5668)),
            "parallel" => Ok(Converter::Parallel { bits: 16 }),
            _ => refused("pulses, ad5664, ad5668 or parallel", text),
        }
    }
}

impl Converter {
    /// The most channels that it has.
    pub fn most_channels(self) -> u64 {
        match self {
            Converter::Serial(frame) => frame.channels,
            Converter::Pulses | Converter::Parallel { .. } => 16,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_out_of_range_are_refused_with_what_was_expected() {
        let message = |text: &str| text.parse::<Wave>().unwrap_err().to_string();
        assert_eq!(
            message("square:0"),
            "expected square:N with N from 1 to 65536, got \"square:0\""
        );
        assert_eq!(message("sine"), "expected sine:N with N from 512 to 1073741824, got \"sine\"");
        assert_eq!(
            message("sine:511"),
            "expected sine:N with N from 512 to 1073741824, got \"sine:511\""
        );
        for text in ["", "dc:1", "triangle", "Sine:1000"] {
            assert!(message(text).starts_with("expected dc, square"), "{text}");
        }
        assert_eq!("sine:512".parse(), Ok(Wave::Sine { points: 64, point_clocks: 8 }));
    }
}
