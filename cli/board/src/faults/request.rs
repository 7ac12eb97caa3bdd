// SPDX-License-Identifier: MIT OR Apache-2.0
//! Faults by their names, as a command line asks for them.
//!
//! | name | what is wrong |
//! | --- | --- |
//! | `open=CHANNEL`, `reversed=CHANNEL`, `noisy=CHANNEL`, `clipped=CHANNEL` | a wire; channels count from 1 |
//! | `swapped=TERMINAL,TERMINAL` | wires of two terminals |
//! | `pad-missing=PAD`, `pads-swapped=PAD,PAD` | select lines; pads count from 0 |
//! | `line-low=LINE`, `line-high=LINE`, `line-shorted=LINE,LINE` | data lines of the ADC, from 0 |
//! | `lost=SHARE`, `flipped=SHARE` | bytes on the serial line |
//! | `clock=FACTOR` | the board's clock |

use std::str::FromStr;

use anyhow::{Result, ensure};

use super::{Faults, Wrong};
use crate::virtual_line::Running;

/// Noise of a noisy channel, full scales.
const NOISE: f64 = 0.1;
/// Clocks that are off by more than a quarter are no clocks.
const CLOCKS: [f64; 2] = [0.75, 1.25];

/// A fault that is asked for by name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Request {
    /// Of a wire, a pad or a data line.
    Wrong(Wrong),
    /// Share of bytes that are lost.
    Lost(f64),
    /// Share of bytes of which a bit is another.
    Flipped(f64),
    /// The board's clock over the right one.
    Clock(f64),
}

/// Names, and what stands behind `=`.
const NAMES: [(&str, &str); 13] = [
    ("open", "CHANNEL"),
    ("reversed", "CHANNEL"),
    ("noisy", "CHANNEL"),
    ("clipped", "CHANNEL"),
    ("swapped", "TERMINAL,TERMINAL"),
    ("pad-missing", "PAD"),
    ("pads-swapped", "PAD,PAD"),
    ("line-low", "LINE"),
    ("line-high", "LINE"),
    ("line-shorted", "LINE,LINE"),
    ("lost", "SHARE"),
    ("flipped", "SHARE"),
    ("clock", "FACTOR"),
];

impl FromStr for Request {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text.split_once('=').and_then(|(name, value)| parse(name, value));
        parsed.ok_or_else(|| {
            let names = NAMES.map(|(name, value)| format!("{name}={value}"));
            format!(
                "expected one of {}, with channels from 1, pads and lines from 0",
                names.join(", ")
            )
        })
    }
}

fn parse(name: &str, value: &str) -> Option<Request> {
    let number = || value.parse::<usize>().ok();
    let channel = || number()?.checked_sub(1);
    let pair = || {
        let (a, b) = value.split_once(',')?;
        let [a, b]: [usize; 2] = [a.parse().ok()?, b.parse().ok()?];
        (a != b).then_some((a, b))
    };
    let within = |[least, most]: [f64; 2]| {
        value.parse::<f64>().ok().filter(|value| (least..=most).contains(value))
    };
    let wrong = match name {
        "open" => Wrong::Open(channel()?),
        "reversed" => Wrong::Reversed(channel()?),
        "noisy" => Wrong::Noisy(channel()?, NOISE),
        "clipped" => Wrong::Clipped(channel()?),
        "swapped" => {
            pair().and_then(|(a, b)| Some(Wrong::Swapped(a.checked_sub(1)?, b.checked_sub(1)?)))?
        }
        "pad-missing" => Wrong::PadMissing(number()?),
        "pads-swapped" => pair().map(|(a, b)| Wrong::PadsSwapped(a, b))?,
        "line-low" => Wrong::LineLow(number()?),
        "line-high" => Wrong::LineHigh(number()?),
        "line-shorted" => pair().map(|(a, b)| Wrong::LineShorted(a, b))?,
        "lost" => return within([0.0, 1.0]).map(Request::Lost),
        "flipped" => return within([0.0, 1.0]).map(Request::Flipped),
        "clock" => return within(CLOCKS).map(Request::Clock),
        _ => return None,
    };
    Some(Request::Wrong(wrong))
}

impl Request {
    /// Breaks a board.
    ///
    /// # Errors
    /// A channel, a line or a pad that it does not have.
    pub(crate) fn act(self, board: &Running) -> Result<()> {
        match self {
            Request::Wrong(wrong) => {
                let (channels, pads) =
                    board.with(|board| (board.profile().channels(), board.profile().pads as usize));
                fits(wrong, channels, pads)?;
                board.break_with(|faults| faults.wrong.push(wrong));
            }
            Request::Lost(share) => {
                board.break_with(|faults: &mut Faults| faults.noise.lost = share)
            }
            Request::Flipped(share) => board.break_with(|faults| faults.noise.flipped = share),
            Request::Clock(factor) => board.set_speed(factor),
        }
        Ok(())
    }
}

/// Whether a board has what is to be broken.
fn fits(wrong: Wrong, channels: usize, pads: usize) -> Result<()> {
    let terminals = channels - 2;
    let (kind, first, most, used) = match wrong {
        Wrong::Open(a) | Wrong::Noisy(a, _) | Wrong::Clipped(a) => ("channel", 1, channels, a),
        Wrong::Reversed(a) => ("terminal", 1, terminals, a),
        Wrong::Swapped(a, b) => ("terminal", 1, terminals, a.max(b)),
        Wrong::PadMissing(a) => ("pad", 0, pads, a),
        Wrong::PadsSwapped(a, b) => ("pad", 0, pads, a.max(b)),
        Wrong::LineLow(a) | Wrong::LineHigh(a) => ("line", 0, channels, a),
        Wrong::LineShorted(a, b) => ("line", 0, channels, a.max(b)),
    };
    ensure!(used < most, "{kind}: expected {first} to {}, got {}", most - 1 + first, used + first);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_name_is_a_fault_and_nothing_else_is() {
        for (name, value) in NAMES {
            let value = match value {
                "SHARE" => "0.01",
                "FACTOR" => "1.03",
                _ if value.contains(',') => "1,2",
                _ => "3",
            };
            assert!(format!("{name}={value}").parse::<Request>().is_ok(), "{name}");
        }
        for text in ["open", "open=0", "open=x", "swapped=2,2", "lost=2", "clock=NaN", "burnt=1"] {
            assert!(text.parse::<Request>().is_err(), "{text}");
        }
        assert_eq!("open=3".parse(), Ok(Request::Wrong(Wrong::Open(2))));
    }
}
