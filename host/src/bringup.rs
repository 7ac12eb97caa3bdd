// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bring-up: from a reset to a board that may be enabled, step by step; the test of the ADC's data lines is one of them.
//!
//! ```text
//! prepare ─ check ─ fixed codes on ─┬─ line 0 … n ─┬─ fixed codes off ─ check ─ ENABLE
//!                                   └── code, or not ┘
//! ```
//!
//! Each step waits for a heartbeat that has begun after its commands were sent. A board that is not as it should be is never
//! given [`Command::ENABLE`]. The codes themselves are not compared with a data sheet: each is neither all zeros nor all
//! ones, the same 64 times, and no other line's, which an open, stuck or shorted wire fails. Lines that are exchanged pass.

use crate::command::Command;
use crate::packet::Heartbeat;
use crate::startup::{AdcSetup, LineFault, StartupError, check, prepare};
use hapticore_contract::calibration::Calibration;
use hapticore_contract::profile::Profile;
use hapticore_protocol::{Control, Output, Register};

/// Heartbeats within which a step's answer has to come, once the board has taken the commands.
const PATIENCE: u8 = 8;
/// Heartbeats within which it has to take them, a tenth of a second at 1 Mbaud: some may have waited on the line since before.
const TAKEN: u8 = 128;

/// A word that reads the ADC's ID, and so enters register mode.
const READ_ID: i64 = 0x6f00;
/// A word that ends register mode.
const CONVERT: i64 = 0x0000;
/// Words that put a fixed code on each line, and end that: register 21 (hex), whose lowest bit is set after a reset.
const FIXED_CODES: i64 = 0x2181;
const SAMPLES: i64 = 0x2101;

/// What to do next.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// Waits for a heartbeat.
    Wait,
    /// Sends these commands, then waits for a heartbeat that begins after them.
    Send(Vec<Command>),
    /// The board is ready: targets, tuning, then this command.
    Ready(Command),
}

/// Where a bring-up is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    Prepared,
    Line(u8),
    Tested,
}

/// The bring-up of a board.
///
/// ```
/// use hapticore_host::bringup::{BringUp, Step};
/// use hapticore_host::startup::AdcSetup;
/// use hapticore_host::{DeviceCalibration, Heartbeat, Status, profile};
///
/// let device = DeviceCalibration::read("recordings/hockey.calibration.toml".as_ref())?;
/// let profile = device.profile(&profile::load("small")?)?;
/// let calibration = device.for_profile(&profile)?;
/// let mut bring_up = BringUp::new(&profile, &calibration, None);
/// let commands = bring_up.begin(&AdcSetup::default(), 0);
/// // The board has taken none of them.
/// let heartbeat = Heartbeat::new(Status::default(), &profile, None);
/// let steps: Vec<_> = (0..128).map(|_| bring_up.heartbeat(&heartbeat)).collect();
/// assert_eq!(steps[0], Ok(Step::Wait));
/// assert!(steps[127].is_err(), "it has had its time for {} commands", commands.len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct BringUp {
    profile: Profile,
    calibration: Calibration,
    output: Option<Output>,
    /// Commands that the board had accepted before, modulo 16, and those sent since.
    before: u8,
    sent: usize,
    stage: Stage,
    /// Heartbeats since the last commands were sent: before the board had taken them, and after.
    untaken: u8,
    waited: u8,
    codes: Vec<Option<u64>>,
    /// Goes on behind a line that fails.
    all_lines: bool,
    faults: Vec<(u8, LineFault)>,
}

impl BringUp {
    /// Of a board of this profile, with an output where it drives its pads.
    pub fn new(profile: &Profile, calibration: &Calibration, output: Option<Output>) -> Self {
        let (stage, codes) = (Stage::Prepared, Vec::new());
        let (profile, calibration) = (profile.clone(), calibration.clone());
        BringUp {
            profile,
            calibration,
            output,
            before: 0,
            sent: 0,
            stage,
            untaken: 0,
            waited: 0,
            codes,
            all_lines: false,
            faults: Vec::new(),
        }
    }

    /// The same, which tests every line before it refuses the board for the first that fails: see
    /// [`BringUp::line_faults`].
    pub fn with_all_lines(self) -> Self {
        BringUp { all_lines: true, ..self }
    }

    /// The lines that have failed so far, and what each brings.
    pub fn line_faults(&self) -> &[(u8, LineFault)] {
        &self.faults
    }

    /// The line that is tested now; none before and after the test of the lines.
    pub fn line_under_test(&self) -> Option<u8> {
        match self.stage {
            Stage::Line(line) => Some(line),
            Stage::Prepared | Stage::Tested => None,
        }
    }

    /// The first commands, for a board that has accepted `before` commands, modulo 16: none after its
    /// reset.
    pub fn begin(&mut self, adc: &AdcSetup, before: u8) -> Vec<Command> {
        (self.before, self.sent) = (before, 0);
        self.stage = Stage::Prepared;
        self.codes.clear();
        self.faults.clear();
        self.sending(prepare(&self.profile, &self.calibration, adc))
    }

    /// The next step, after a heartbeat that has begun after the last commands were sent.
    ///
    /// # Errors
    /// What keeps the board from being enabled: the first thing that is not as it should be.
    pub fn heartbeat(&mut self, heartbeat: &Heartbeat) -> Result<Step, StartupError> {
        let (count, most) = match self.has_taken(heartbeat) {
            true => (&mut self.waited, PATIENCE),
            false => (&mut self.untaken, TAKEN),
        };
        *count += 1;
        let last = *count >= most;
        match self.stage {
            Stage::Prepared | Stage::Tested => match self.check(heartbeat) {
                Err(StartupError::Commands { .. }) if !last => Ok(Step::Wait),
                // The ADC's ID comes over its first line: the test of the lines says whether that is why.
                Err(StartupError::Adc(_)) if self.all_lines && self.stage == Stage::Prepared => {
                    Ok(self.first_line())
                }
                Err(error) => Err(error),
                Ok(()) if self.stage == Stage::Tested => Ok(Step::Ready(Command::ENABLE)),
                Ok(()) => Ok(self.first_line()),
            },
            Stage::Line(line) => match self.code(heartbeat) {
                None if !last => Ok(Step::Wait),
                None => self.judged(line, Err(LineFault::Silent)),
                Some(code) => self.line(line, code),
            },
        }
    }

    fn check(&self, heartbeat: &Heartbeat) -> Result<(), StartupError> {
        let sent = (self.before, self.sent);
        check(heartbeat, &self.profile, self.output.as_ref(), &self.calibration, sent)
    }

    /// The code of the line that is tested, once the board has taken the command for that.
    fn code(&self, heartbeat: &Heartbeat) -> Option<u64> {
        let taken = self.has_taken(heartbeat);
        heartbeat.line_code().filter(|_| taken && !heartbeat.status.late)
    }

    /// Whether the board has taken all commands.
    fn has_taken(&self, heartbeat: &Heartbeat) -> bool {
        let expected = (usize::from(self.before) + self.sent) % 16;
        usize::from(heartbeat.status.commands) == expected
    }

    fn first_line(&mut self) -> Step {
        let words = [READ_ID, FIXED_CODES, CONVERT].map(to_adc);
        let commands = words.into_iter().chain([test_of(0)]).collect();
        self.stage = Stage::Line(0);
        Step::Send(self.sending(commands))
    }

    /// Judges a line, and goes on to the next.
    fn line(&mut self, line: u8, code: u64) -> Result<Step, StartupError> {
        let bits = self.profile.formats.adc.width;
        let code = code & ((1 << bits) - 1);
        if code == (1 << bits) - 1 {
            return self.judged(line, Err(LineFault::Ones));
        }
        match self.codes.iter().position(|before| *before == Some(code)) {
            Some(other) => self.judged(line, Err(LineFault::Shorted { other: other as u8, code })),
            None => self.judged(line, Ok(code)),
        }
    }

    /// Goes on behind a line with its code, or with what is wrong with it.
    fn judged(&mut self, line: u8, code: Result<u64, LineFault>) -> Result<Step, StartupError> {
        self.codes.push(code.ok());
        self.faults.extend(code.err().map(|fault| (line, fault)));
        let is_last = self.codes.len() >= self.profile.channels();
        match self.faults.first() {
            Some(&(line, fault)) if is_last || !self.all_lines => {
                return Err(StartupError::Line { line, fault });
            }
            _ => (),
        }
        let commands = if self.codes.len() < self.profile.channels() {
            self.stage = Stage::Line(line + 1);
            vec![test_of(line + 1)]
        } else {
            self.stage = Stage::Tested;
            let words = [READ_ID, SAMPLES, READ_ID, CONVERT].map(to_adc);
            [Command::DISABLE].into_iter().chain(words).collect()
        };
        Ok(Step::Send(self.sending(commands)))
    }

    fn sending(&mut self, commands: Vec<Command>) -> Vec<Command> {
        self.sent += commands.len();
        (self.untaken, self.waited) = (0, 0);
        commands
    }
}

fn to_adc(word: i64) -> Command {
    Command::Register(Register::Adc, word)
}

/// The command that tests a line.
fn test_of(line: u8) -> Command {
    let code = 1 << Control::LINE_TEST | i64::from(line) << Control::LINE;
    Command::Register(Register::Control, code)
}
