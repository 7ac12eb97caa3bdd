// SPDX-License-Identifier: MIT OR Apache-2.0
//! Start-up: the commands that make a sensor of a board and its AD7606C, and whether the board has
//! taken them.
//!
//! ```text
//! RESET_ADC, DISABLE ─ registers, table ─ ADC: read, write …, read the ID, end ─ heartbeat: check
//!   ─ ADC: fixed codes ─ test of each line ─ ADC: samples ─ heartbeat: check ─ ENABLE
//! ```
//!
//! | word | what it does |
//! | --- | --- |
//! | 6F00 | reads register 2F: the first read after a reset only enters register mode, without which writes are refused |
//! | 0218 | CONFIG: DOUT_FORMAT, bits 4 and 3, both set: eight data lines |
//! | 03 … 06 | the ranges, of two channels each |
//! | 07 | the bandwidths, a bit a channel: 220 kHz where it is set, else 25 kHz, a quarter of the carrier |
//! | 2181 | the interface check: a fixed code of its own on each line; 2101 ends it, as after a reset |
//! | 6F00 | reads register 2F again |
//! | 0000 | ends register mode, and brings the answer to the read before |
//!
//! After a reset the ADC takes 253 µs until it may be spoken to; the calibration takes longer to
//! send. The upper half of its ID is 3 by data sheet and no-OS driver; users of the AD7606C-16 also
//! report 22 (hex), so that 2 is taken as well. 1 is an AD7606B, which is too slow. Sources: data
//! sheets AD7606C-16 and -18 (register map, serial interface); `drivers/adc/ad7606` of Analog
//! Devices' no-OS (`ad7606_spi_reg_write`: a dummy read before the first write; `ad7606_init`: 253
//! µs, ID) and of Linux.

use crate::command::Command;
use crate::packet::Heartbeat;
use hapticore_contract::calibration::Calibration;
use hapticore_contract::profile::Profile;
use hapticore_protocol::framing::{VERSION, board_digest};
use hapticore_protocol::{CalibrationWords, Output, Register};

/// What a channel of the ADC spans, to either side of zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Range {
    /// ±2.5 V.
    V2_5,
    /// ±5 V.
    V5,
    /// ±6.25 V.
    V6_25,
    /// ±10 V, the default after a reset.
    #[default]
    V10,
    /// ±12.5 V.
    V12_5,
}

/// How the ADC is set up.
///
/// ```
/// use hapticore_host::startup::{AdcSetup, Range};
///
/// let mut setup = AdcSetup::default();
/// setup.ranges[0] = Range::V5;
/// assert_eq!(setup.words()[2], 0x0331, "register 3: channel 2 as after a reset, channel 1 to 5 V");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct AdcSetup {
    /// The range of each channel.
    pub ranges: [Range; 8],
}

/// A word that reads the ADC's ID.
const READ_ID: i64 = 0x6f00;
/// A word that ends register mode.
const CONVERT: i64 = 0x0000;

impl AdcSetup {
    /// The words that set up an ADC that has just been reset.
    pub fn words(&self) -> Vec<i64> {
        let pair = |pair: usize| {
            i64::from(self.ranges[2 * pair + 1] as u8) << 4 | self.ranges[2 * pair] as i64
        };
        let ranges = (0..4).map(|k| (0x03 + k as i64) << 8 | pair(k));
        [READ_ID, 0x0218].into_iter().chain(ranges).chain([0x07ff, READ_ID, CONVERT]).collect()
    }
}

/// The commands that make a calibrated sensor of a board: all but the last, [`Command::ENABLE`],
/// before which a heartbeat should be [`check`]ed.
pub fn prepare(profile: &Profile, calibration: &Calibration, adc: &AdcSetup) -> Vec<Command> {
    let words = CalibrationWords::new(profile, calibration);
    let table = words.table.iter().enumerate();
    let table = table.map(|(address, &code)| Command::Table { address: address as u16, code });
    let adc = adc.words().into_iter().map(|word| Command::Register(Register::Adc, word));
    let registers =
        words.constants.map(|word| Command::Register(Register::Constant(word.constant), word.code));
    [Command::RESET_ADC, Command::DISABLE]
        .into_iter()
        .chain(registers)
        .chain(table)
        .chain(adc)
        .collect()
}

/// As [`prepare`] with the ADC's ranges as after a reset, and on without looking.
pub fn start(profile: &Profile, calibration: &Calibration) -> Vec<Command> {
    let mut commands = prepare(profile, calibration, &AdcSetup::default());
    commands.push(Command::ENABLE);
    commands
}

/// Why a board should not be enabled.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StartupError {
    /// It speaks another version.
    #[error("the board's line is of version {0}, expected {VERSION}")]
    Version(u8),
    /// It was made for another profile, converter, wave, full scale or clock.
    #[error(
        "the board was printed for {got} (digest {got_digest:04x}), expected {expected} (digest {expected_digest:04x}): print it again with these options, or tune for that board; where both are the same, the profiles differ"
    )]
    Made {
        /// What the host tunes for.
        expected: String,
        /// What the board reports.
        got: String,
        /// Digest of the host's profile and output.
        expected_digest: u16,
        /// Digest that the board reports.
        got_digest: u16,
    },
    /// A data line of the ADC does not bring its code.
    #[error("dout[{line}] (DOUT{letter} of the ADC): expected a fixed code of its own, got {fault}: check this wire", letter = char::from(b'A' + .line))]
    Line {
        /// Number of the line.
        line: u8,
        /// What it brings.
        fault: LineFault,
    },
    /// A command was lost or refused.
    #[error(
        "the board has accepted commands up to {got} modulo 16, expected {expected}, or has refused one"
    )]
    Commands {
        /// As sent, modulo 16.
        expected: u8,
        /// As accepted, modulo 16.
        got: u8,
    },
    /// A register is not as it was written.
    #[error("{register} reads back {got:x} (hex), expected {expected:x}")]
    Register {
        /// Register that differs.
        register: Register,
        /// Value that was written.
        expected: u64,
        /// Value that was read back.
        got: u64,
    },
    /// The ADC is none, or another.
    #[error("the ADC's ID is {0:02x} (hex) at dout[0] (DOUTA), expected 2x or 3x, an AD7606C")]
    Adc(u8),
}

/// What a data line of the ADC brings in place of a code of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LineFault {
    /// Zero bits, or a code that was not always the same.
    #[error("zeros, or a code that changes")]
    Silent,
    /// All bits are one.
    #[error("ones")]
    Ones,
    /// The code of another line.
    #[error("the code {code:x} (hex) of dout[{other}]")]
    Shorted {
        /// The other line.
        other: u8,
        /// The code of both.
        code: u64,
    },
}

/// Whether a board may be enabled after `commands` commands, [`prepare`]'s first. Before these it had accepted
/// `before` commands modulo 16 (none after its own reset). `output` is what it is to drive its pads with, where it
/// has a drive. The ADC's lines are not tested: see [`BringUp`](crate::bringup::BringUp).
///
/// # Errors
/// The first thing that is not as it should be.
pub fn check(
    heartbeat: &Heartbeat,
    profile: &Profile,
    output: Option<&Output>,
    calibration: &Calibration,
    (before, commands): (u8, usize),
) -> Result<(), StartupError> {
    if heartbeat.version != VERSION {
        return Err(StartupError::Version(heartbeat.version));
    }
    check_made(heartbeat, profile, output)?;
    let (expected, got) =
        (((usize::from(before) + commands) % 16) as u8, heartbeat.status.commands);
    if expected != got || heartbeat.status.refused || !heartbeat.calibrated {
        return Err(StartupError::Commands { expected, got });
    }
    for word in CalibrationWords::new(profile, calibration).constants {
        let register = Register::Constant(word.constant);
        let Some((got, bits)) = heartbeat.register(register) else { continue };
        // A command may bring more bits than its register has.
        let mask = (1 << bits.min(word.format.width)) - 1;
        let (expected, got) = (word.code as u64 & mask, got & mask);
        if expected != got {
            return Err(StartupError::Register { register, expected, got });
        }
    }
    match heartbeat.adc_answer() >> 4 {
        2 | 3 => Ok(()),
        _ => Err(StartupError::Adc(heartbeat.adc_answer())),
    }
}

/// Whether a board was printed for a profile and an output.
fn check_made(
    heartbeat: &Heartbeat,
    profile: &Profile,
    output: Option<&Output>,
) -> Result<(), StartupError> {
    let (expected_digest, got_digest) = (board_digest(profile, output), heartbeat.digest());
    if expected_digest == got_digest {
        return Ok(());
    }
    let expected = output.map_or("no drive".into(), Output::to_string);
    let got = heartbeat.output();
    Err(StartupError::Made { expected, got, expected_digest, got_digest })
}
