// SPDX-License-Identifier: MIT OR Apache-2.0
//! Output: what a board that drives its pads was printed for, as its heartbeats report it and as a host expects it.
//!
//! | heartbeat's word | holds |
//! | --- | --- |
//! | [`SETUP`] | [`Dac`] (3 bits, from 1), kind of [`Wave`] (2 bits), its slots or clocks (11 bits, saturated) |
//! | [`FULL_SCALE`] | full scale, V |
//! | [`CLOCK`] | clock, 10 kHz |
//!
//! All of it is in the digest, too, to the last bit: [`crate::framing::board_digest`].

use crate::register::Register;
use std::fmt;
use std::str::FromStr;

/// Number of the word of a heartbeat that holds converter and wave; zero without a drive.
pub const SETUP: usize = 5;
/// Number of the word that holds the full scale, V.
pub const FULL_SCALE: usize = 6;
/// Number of the word that holds the clock, 10 kHz.
pub const CLOCK: usize = 7;
const _: () = assert!(SETUP >= Register::ALL.len());
/// The unit of the word [`CLOCK`], Hz.
const CLOCK_UNIT_HZ: u64 = 10_000;
/// The first bit of the wave's kind, and that of its slots or clocks.
const KIND: u8 = 3;
const TURN: u8 = 5;
/// The largest number of slots or clocks that the word tells.
const MOST_TURN: u64 = (1 << (16 - TURN)) - 1;

/// The wave that a drive word is the amplitude of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wave {
    /// A constant voltage.
    Dc,
    /// A voltage that reverses its polarity every `turn_slots` slots of its pad.
    Square {
        /// Slots of a pad from turn to turn.
        turn_slots: u64,
    },
    /// A sine.
    Sine {
        /// Points of a period: a power of two, 8 at least.
        points: u64,
        /// Clocks from point to point.
        point_clocks: u64,
    },
}

impl fmt::Display for Wave {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Wave::Dc => f.write_str("dc"),
            Wave::Square { turn_slots } => write!(f, "square:{turn_slots}"),
            Wave::Sine { points, point_clocks } => write!(f, "sine:{}", points * point_clocks),
        }
    }
}

/// A converter, by the name that commands give it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dac {
    /// One bit per pad, whose mean is the magnitude: for a low-pass filter.
    Pulses,
    /// AD5664: four channels, external reference.
    Ad5664,
    /// AD5664R: four channels, own reference.
    Ad5664r,
    /// AD5668: eight channels, own reference.
    Ad5668,
    /// A word of 16 bits, an address and a write strobe.
    Parallel,
}

impl Dac {
    /// All of them.
    pub const ALL: [Dac; 5] = [Dac::Pulses, Dac::Ad5664, Dac::Ad5664r, Dac::Ad5668, Dac::Parallel];

    /// Its name: `ad5664r`.
    pub fn name(self) -> &'static str {
        match self {
            Dac::Pulses => "pulses",
            Dac::Ad5664 => "ad5664",
            Dac::Ad5664r => "ad5664r",
            Dac::Ad5668 => "ad5668",
            Dac::Parallel => "parallel",
        }
    }

    /// Which parts power up at 0 V, and what their reference needs.
    pub fn advice(self) -> &'static str {
        match self {
            Dac::Pulses => "pulses: pins that are low are 0 V",
            Dac::Ad5664 => "AD5664: powers up at 0 V; connect an external reference to VREFIN",
            Dac::Ad5664r => {
                "AD5664R-3 or AD5664R-5: powers up at 0 V; the design switches its reference on, so connect none to VREFIN/VREFOUT"
            }
            Dac::Ad5668 => {
                "AD5668-1 or AD5668-2, never AD5668-3, which powers up at half of full scale: powers up at 0 V; the design switches its reference on, so connect none to VREFIN/VREFOUT"
            }
            Dac::Parallel => "parallel: a converter that powers up with code 0 at 0 V",
        }
    }
}

impl FromStr for Dac {
    type Err = NameError;

    fn from_str(text: &str) -> Result<Self, NameError> {
        let dac = Dac::ALL.into_iter().find(|dac| dac.name() == text);
        dac.ok_or_else(|| {
            let names = Dac::ALL.map(Dac::name);
            let (last, others) = names.split_last().expect("there are converters");
            NameError { expected: format!("{} or {last}", others.join(", ")), got: text.into() }
        })
    }
}

/// What a board's output is: a host that tunes it has to mean the same.
///
/// ```
/// use hapticore_protocol::output::{Dac, Output, Wave};
///
/// let output = Output {
///     dac: Dac::Ad5664r,
///     wave: Wave::Square { turn_slots: 10 },
///     full_scale_v: 500,
///     clock_hz: 25_000_000,
/// };
/// assert_eq!(output.to_string(), "ad5664r, square:10, full scale 500 V, clock 25000000 Hz");
/// assert_eq!(Output::told(output.words()), output.to_string());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Output {
    /// The converter.
    pub dac: Dac,
    /// The wave.
    pub wave: Wave,
    /// The voltage of a drive word of full scale, V.
    pub full_scale_v: u16,
    /// The clock, Hz.
    pub clock_hz: u64,
}

impl fmt::Display for Output {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Output { dac, wave, full_scale_v, clock_hz } = self;
        let dac = dac.name();
        write!(f, "{dac}, {wave}, full scale {full_scale_v} V, clock {clock_hz} Hz")
    }
}

impl Output {
    /// The full scale where none is named, V.
    pub const FULL_SCALE_V: u16 = 500;

    /// The words [`SETUP`], [`FULL_SCALE`] and [`CLOCK`] of its heartbeats.
    pub fn words(&self) -> [u16; 3] {
        let (kind, turn) = match self.wave {
            Wave::Dc => (0, 0),
            Wave::Square { turn_slots } => (1, turn_slots),
            Wave::Sine { points, point_clocks } => (2, points * point_clocks),
        };
        let dac = Dac::ALL.iter().position(|dac| *dac == self.dac).expect("one of all");
        let turn = turn.min(MOST_TURN) as u16;
        let clock = (self.clock_hz / CLOCK_UNIT_HZ).min(u16::MAX.into());
        [(1 + dac as u16) | (kind << KIND) | (turn << TURN), self.full_scale_v, clock as u16]
    }

    /// What these words say.
    pub fn told([setup, full_scale_v, clock]: [u16; 3]) -> String {
        let dac = (setup & ((1 << KIND) - 1)).checked_sub(1);
        let Some(dac) = dac.and_then(|dac| Dac::ALL.get(usize::from(dac))) else {
            return "no drive".into();
        };
        let turn = setup >> TURN;
        let more = if u64::from(turn) == MOST_TURN { " or more" } else { "" };
        let wave = match setup >> KIND & 3 {
            0 => "dc".into(),
            1 => format!("square:{turn}{more}"),
            _ => format!("sine:{turn}{more}"),
        };
        let clock = u64::from(clock) * CLOCK_UNIT_HZ;
        format!("{}, {wave}, full scale {full_scale_v} V, clock {clock} Hz", dac.name())
    }
}

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

impl Wave {
    /// The least time from turn to turn of a square without a number of slots, µs: 20 time constants of a pad of 600 pF and
    /// a cable of 100 pF behind 300 kΩ, so that turns take a tenth of the force (docs/physics.md §7).
    pub const LEAST_TURN_US: u64 = 4200;

    /// A wave by its name on a board whose frames last so many clocks; `square` turns no more often than every
    /// [`Wave::LEAST_TURN_US`].
    ///
    /// ```
    /// use hapticore_protocol::output::Wave;
    ///
    /// let fast = Wave::on_board("square", 25_000, 25_000_000)?; // frames of 1 ms
    /// assert_eq!(fast, Wave::Square { turn_slots: 5 });
    /// assert_eq!(Wave::on_board("square:2", 25_000, 25_000_000)?, Wave::Square { turn_slots: 2 });
    /// # Ok::<(), hapticore_protocol::output::NameError>(())
    /// ```
    ///
    /// # Errors
    /// A name of no wave.
    pub fn on_board(text: &str, frame_clocks: u64, clock_hz: u64) -> Result<Wave, NameError> {
        if text != "square" {
            return text.parse();
        }
        let least_clocks = Wave::LEAST_TURN_US * clock_hz / 1_000_000;
        Ok(Wave::Square { turn_slots: least_clocks.div_ceil(frame_clocks).clamp(1, MOST_SLOTS) })
    }
}

/// `dc`, `square:SLOTS` or `sine:CLOCKS`, slots from turn to turn or clocks of a period.
///
/// ```
/// use hapticore_protocol::output::Wave;
///
/// assert_eq!("square:3".parse(), Ok(Wave::Square { turn_slots: 3 }));
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
            ("square", Some(_)) => Ok(Wave::Square { turn_slots: within(1, MOST_SLOTS)? }),
            ("sine", _) => {
                let clocks: u64 = within(LEAST_PERIOD, MOST_PERIOD)?;
                Ok(Wave::Sine { points: POINTS, point_clocks: (clocks + POINTS / 2) / POINTS })
            }
            _ => refused("dc, square:SLOTS or sine:CLOCKS", text),
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
