// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a check has found, in words: what is wrong, what to do.

use std::fmt;

use hapticore_host::startup::LineFault;

use crate::faults::letter;

/// Something that is wrong. Terminals and channels count from 0, in words from 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Finding {
    /// A data line of the ADC.
    DataLine {
        /// Its number.
        line: usize,
        /// What it brings.
        fault: LineFault,
    },
    /// Nothing comes from a terminal.
    Open {
        /// Which.
        terminal: usize,
    },
    /// A terminal's wire is connected the wrong way round.
    Reversed {
        /// Which.
        terminal: usize,
    },
    /// The wires of two terminals are exchanged.
    Swapped {
        /// Which.
        terminals: [usize; 2],
    },
    /// A channel is noisy.
    Noisy {
        /// A terminal, or behind them the sensing voltage.
        channel: usize,
    },
    /// Several channels are noisy.
    AllNoisy,
    /// A channel is at full scale at ±10 V.
    Clipped {
        /// A terminal, or behind them the sensing or the haptic voltage.
        channel: usize,
    },
    /// Codes are at full scale at ±12.5 V, too.
    AllClipped,
    /// No current flows through a pad.
    PadMissing {
        /// Which.
        pad: usize,
    },
    /// The select lines of two pads are exchanged.
    PadsSwapped {
        /// Which.
        pads: [usize; 2],
    },
    /// Nothing is measured anywhere.
    NoSense,
    /// None of the known faults explains what is measured.
    Unclear,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Finding::DataLine { line, fault } => write!(
                f,
                "dout[{line}] (DOUT{} of the ADC) brings {fault}: check this wire",
                letter(line)
            ),
            Finding::Open { terminal } => {
                write!(f, "terminal {}: open; check its wire to the ADC", terminal + 1)
            }
            Finding::Reversed { terminal } => {
                write!(f, "terminal {}: reversed; exchange the two wires of its sensor", terminal + 1)
            }
            Finding::Swapped { terminals: [a, b] } => {
                write!(f, "terminals {} and {}: swapped; exchange their wires", a + 1, b + 1)
            }
            Finding::Noisy { channel } => write!(
                f,
                "channel {}: noisy; check its shield, its ground and its amplifier",
                channel + 1
            ),
            Finding::AllNoisy => f.write_str(
                "several channels are noisy: check what they share, the supply, the ground and the carrier",
            ),
            Finding::Clipped { channel } => write!(
                f,
                "channel {}: clipped at ±10 V; lower its amplifier's gain",
                channel + 1
            ),
            Finding::AllClipped => {
                f.write_str("clipped, at ±12.5 V too: lower the gains, or the sensing voltage")
            }
            Finding::PadMissing { pad } => {
                write!(f, "pad {pad}: missing; check its wire, its switch and its select line")
            }
            Finding::PadsSwapped { pads: [a, b] } => {
                write!(f, "pads {a} and {b}: swapped; exchange their select lines")
            }
            Finding::NoSense => {
                f.write_str("no pad is measured: check the sensing voltage and its channel, and the carrier")
            }
            Finding::Unclear => f.write_str(
                "no known fault explains the ratios above: check that the calibration is this device's, and that each pad \
                 was where it should be",
            ),
        }
    }
}

/// What was expected and measured of a pad at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compared {
    /// Pad, or part of one.
    pub pad: usize,
    /// Where it was put, mm.
    pub at_mm: [f64; 2],
    /// Ratios along x and y.
    pub expected: [f64; 2],
    /// The same, as measured.
    pub measured: [f64; 2],
    /// Capacitance, as measured, pF.
    pub capacitance_pf: f64,
}

impl fmt::Display for Compared {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Compared { pad, at_mm: [x, y], expected, measured, capacitance_pf } = self;
        write!(
            f,
            "pad {pad} at {x:.0}, {y:.0} mm: r_x expected {:.3}, measured {:.3}; r_y expected {:.3}, measured {:.3}; \
             {capacitance_pf:.0} pF",
            expected[0], measured[0], expected[1], measured[1]
        )
    }
}

/// The outcome of a check.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Report {
    /// What is wrong; nothing of a sound board.
    pub findings: Vec<Finding>,
    /// What was expected and measured; nothing where a data line is broken.
    pub compared: Vec<Compared>,
}

impl Report {
    pub(super) fn of_lines(lines: &[(u8, LineFault)]) -> Self {
        Report { findings: lines.iter().map(Finding::from).collect(), compared: Vec::new() }
    }

    /// By how much ratios differ from the expected ones at most.
    pub fn largest_departure(&self) -> f64 {
        let of = |compared: &Compared| {
            let of = |axis: usize| (compared.measured[axis] - compared.expected[axis]).abs();
            of(0).max(of(1))
        };
        self.compared.iter().map(of).fold(0.0, f64::max)
    }

    /// Whether nothing is wrong.
    pub fn is_sound(&self) -> bool {
        self.findings.is_empty()
    }
}
