// SPDX-License-Identifier: MIT OR Apache-2.0
//! Session: a board over a link, from its identity to its frames, with a drive that is off until it is armed.
//!
//! ```text
//! disconnected ─ identifying ─ starting up ─ testing lines ─ measuring ─[arm]─ armed
//!      ↑              ↑   └────────┴─────── refused ──[3 s]──┐   ↑  └────[disarm, fault]──┘
//!      └─ line ended  └──────── silent, restarted ───────────┴───┘      off ←[disable]
//! ```
//!
//! Whatever is unknown drives nothing: each way into *identifying* begins with `rest` and `DISABLE`, and only
//! [`Session::arm`] sends a tuning. Signs of life are sent by [`Session::poll`], so that they cease with the program.

use std::fmt;
use std::time::{Duration, Instant};

use super::{Event, Line, Link, Statistics, words};
use crate::bringup::{BringUp, Step};
use crate::command::{Command, encode};
use crate::drive;
use crate::packet::{Heartbeat, Message, Packet};
use crate::startup::{AdcSetup, LineFault, StartupError};
use hapticore_contract::calibration::Calibration;
use hapticore_contract::control::Tuning;
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_protocol::Output;

/// What a board is brought up with.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The profile that the board was printed for, with its controller where it drives.
    pub profile: Profile,
    /// The device's calibration for it.
    pub calibration: Calibration,
    /// How the ADC is set up.
    pub adc: AdcSetup,
    /// What the board drives its pads with; none of a board without a drive.
    pub output: Option<Output>,
    /// The tuning of the controller; without one the drive cannot be armed.
    pub tuning: Option<Tuning>,
    /// Bits a second of the line.
    pub baud: u32,
    /// Tests all data lines before a board is refused for one.
    pub all_lines: bool,
}

/// Where a session is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// The line is not open.
    Disconnected,
    /// The board says nothing any more.
    Silent,
    /// It waits for the board's first heartbeat.
    Identifying,
    /// The board takes calibration and ADC setup.
    Preparing,
    /// The board tests this data line of the ADC.
    TestingLine(u8),
    /// Frames come, the drive is off.
    Measuring,
    /// Frames come, the drive follows its targets.
    Armed,
    /// The board was disabled on request.
    Off,
    /// The board is not as it should be; it is tried again.
    Refused,
}

/// What a session reports.
#[derive(Debug, Clone, PartialEq)]
pub enum SessionEvent {
    /// It is in another phase.
    Phase(Phase),
    /// Something that its user should read: what happened, what to do.
    Note(String),
    /// A frame.
    Frame(Packet),
}

/// Why a session does not do what is asked.
#[derive(Debug, Clone, PartialEq)]
pub struct Refusal(String);

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Refusal {}

fn refuse<T>(words: impl Into<String>) -> Result<T, Refusal> {
    Err(Refusal(words.into()))
}

/// Without a heartbeat for this long the board is disabled once more.
const IDENTIFY: Duration = Duration::from_secs(1);
/// How long after `ENABLE` heartbeats may still come.
const IN_FLIGHT: Duration = Duration::from_millis(500);
/// What a serial adapter may keep bytes for, beside their time on the line.
const ADAPTER: Duration = Duration::from_millis(40);
/// When a refused board is tried again.
const AGAIN: Duration = Duration::from_secs(3);
/// How often a start-up is repeated in which commands were lost.
const ATTEMPTS: u8 = 3;

/// A board over a link.
pub struct Session {
    link: Link,
    plan: Plan,
    phase: Phase,
    bring_up: BringUp,
    /// When the phase, or the step of it, began.
    since: Instant,
    /// Before that heartbeats may have begun before the last commands were taken.
    settled_at: Instant,
    /// The first heartbeat after it may have begun before it.
    skips: bool,
    attempts: u8,
    /// Damaged packets before the phase.
    damaged_before: u64,
    has_complained: bool,
    refused: Option<StartupError>,
    targets_n: Vec<f64>,
    /// Surface of each wall, mm, and whether its inside is right of it.
    surfaces: Vec<Option<(f64, bool)>>,
    spoke_at: Instant,
    since_armed: Instant,
    /// A frame without faults has come since the drive was armed.
    was_clear: bool,
}

impl Session {
    /// A session over a line; [`Session::poll`] opens it.
    pub fn new(line: Box<dyn Line>, plan: Plan) -> Self {
        let (now, pads) = (Instant::now(), plan.profile.pads as usize);
        Session {
            link: Link::new(line, &plan.profile),
            bring_up: BringUp::new(&plan.profile, &plan.calibration, plan.output),
            phase: Phase::Disconnected,
            since: now,
            settled_at: now,
            skips: true,
            attempts: 0,
            damaged_before: 0,
            has_complained: false,
            refused: None,
            targets_n: vec![0.0; pads],
            surfaces: vec![None; pads],
            spoke_at: now,
            since_armed: now,
            was_clear: false,
            plan,
        }
    }

    /// Where it is.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// What it was begun with.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The link below.
    pub fn link(&self) -> &Link {
        &self.link
    }

    /// What has come so far.
    pub fn statistics(&self) -> Statistics {
        self.link.statistics()
    }

    /// Whether frames come.
    pub fn is_measuring(&self) -> bool {
        matches!(self.phase, Phase::Measuring | Phase::Armed)
    }

    /// Why the board was refused last.
    pub fn refusal(&self) -> Option<&StartupError> {
        self.refused.as_ref()
    }

    /// Data lines that have failed in the last start-up.
    pub fn line_faults(&self) -> &[(u8, LineFault)] {
        self.bring_up.line_faults()
    }

    /// Moves on, and reports what has happened since. Never waits for the board.
    pub fn poll(&mut self, mut report: impl FnMut(SessionEvent)) {
        let mut events = Vec::new();
        self.link.poll(|event| events.push(event));
        for event in events {
            self.take(event, &mut report);
        }
        self.watch(&mut report);
        self.speak();
    }

    /// Lets the drives follow their targets.
    ///
    /// # Errors
    /// A board without a drive, no tuning, or a board that does not measure.
    pub fn arm(&mut self) -> Result<(), Refusal> {
        let Some(tuning) = self.plan.tuning.clone() else {
            return match self.plan.output {
                None => refuse("arm: this board has no drive: print one with --control and --dac"),
                Some(_) => refuse("arm: expected a tuning of this board's controller (--tuning)"),
            };
        };
        if self.phase == Phase::Armed {
            return Ok(());
        }
        if self.phase != Phase::Measuring {
            return refuse(format!(
                "arm: expected a board that measures, it is {}",
                self.phase.word()
            ));
        }
        // The curve is written while the drives are at zero.
        let mut commands = vec![drive::rest()];
        commands.extend(self.positions().map_err(|error| Refusal(error.to_string()))?);
        let tuned = drive::tune(&self.plan.profile, &tuning);
        commands.extend(tuned.map_err(|error| Refusal(error.to_string()))?);
        match self.send(&commands) {
            true => {
                (self.phase, self.was_clear) = (Phase::Armed, false);
                self.since_armed = Instant::now();
                Ok(())
            }
            false => refuse("arm: the line has ended"),
        }
    }

    /// Takes all drives to zero; the board goes on measuring.
    pub fn disarm(&mut self) {
        self.targets_n.fill(0.0);
        if self.plan.output.is_some() {
            self.send(&[drive::rest()]);
        }
        if self.phase == Phase::Armed {
            self.phase = Phase::Measuring;
        }
    }

    /// Disables the board: pads open, drives at 0 V.
    pub fn disable(&mut self) {
        self.hush();
        self.phase = Phase::Off;
    }

    /// Brings the board up with another plan of the same profile, its drive off.
    pub fn begin_again(&mut self, plan: Plan) {
        debug_assert_eq!(plan.profile, self.plan.profile);
        (self.plan, self.attempts, self.refused) = (plan, 0, None);
        if self.link.is_connected() {
            self.identify();
        }
    }

    /// Brings a disabled or refused board up again, its drive off.
    pub fn enable(&mut self) {
        if matches!(self.phase, Phase::Off | Phase::Refused) {
            self.attempts = 0;
            self.identify();
        }
    }

    /// The target of a pad, N. It counts while the drive is armed.
    ///
    /// # Errors
    /// No such pad, a force beyond the tuning's cap or below zero.
    pub fn set_target(&mut self, pad: usize, newtons: f64) -> Result<(), Refusal> {
        let pads = self.targets_n.len();
        if pad >= pads {
            return refuse(format!("pad: expected below {pads}, got {pad}"));
        }
        let cap_n = self.largest_target_n();
        if !(0.0..=cap_n).contains(&newtons) {
            return refuse(format!("target: expected 0 to {cap_n:.3} N, got {newtons}"));
        }
        self.targets_n[pad] = newtons;
        self.tell(drive::target(&self.plan.profile, pad as u8, newtons))
    }

    /// Where the wall that is known by a pad's number begins, mm, and whether its inside is right of that.
    ///
    /// # Errors
    /// No such pad, a place that is no number.
    pub fn set_surface(&mut self, pad: usize, mm: f64, right: bool) -> Result<(), Refusal> {
        let pads = self.surfaces.len();
        if pad >= pads {
            return refuse(format!("pad: expected below {pads}, got {pad}"));
        }
        if !mm.is_finite() {
            return refuse(format!("wall: expected a number of millimetres, got {mm}"));
        }
        self.surfaces[pad] = Some((mm, right));
        self.tell(drive::surface(&self.plan.profile, pad as u8, mm, right))
    }

    /// The largest target that is taken, N: the tuning's cap, or what the controller's word holds.
    pub fn largest_target_n(&self) -> f64 {
        let cap_n = self.plan.tuning.as_ref().map_or(0.0, |tuning| tuning.force_cap);
        let format = self.plan.profile.control.as_ref().map(|control| control.target);
        cap_n.min(format.map_or(0.0, |format| format.real(format.max_code() as i64)))
    }

    /// Sends a word of the drive while it is armed.
    fn tell(&mut self, command: Result<Command, ProfileError>) -> Result<(), Refusal> {
        let command = command.map_err(|error| Refusal(error.to_string()))?;
        if self.phase == Phase::Armed {
            self.send(&[command]);
        }
        Ok(())
    }

    /// The commands of all targets and surfaces.
    fn positions(&self) -> Result<Vec<Command>, ProfileError> {
        let profile = &self.plan.profile;
        let targets = (0..).zip(&self.targets_n);
        let targets = targets.map(|(pad, newtons)| drive::target(profile, pad, *newtons));
        let surfaces = (0..).zip(&self.surfaces);
        let surfaces = surfaces.filter_map(|(pad, surface)| Some((pad, (*surface)?)));
        let surfaces = surfaces.map(|(pad, (mm, right))| drive::surface(profile, pad, mm, right));
        targets.chain(surfaces).collect()
    }

    fn send(&mut self, commands: &[Command]) -> bool {
        let bytes = encode(commands, &self.plan.profile);
        self.spoke_at = Instant::now();
        let on_line_s = 10.0 * bytes.len() as f64 / f64::from(self.plan.baud.max(1));
        self.settled_at = self.spoke_at + Duration::from_secs_f64(on_line_s) + ADAPTER;
        self.skips = true;
        self.link.send(&bytes)
    }

    /// Takes the drives to zero and the board out of its work.
    fn hush(&mut self) {
        self.targets_n.fill(0.0);
        let rest = self.plan.output.map(|_| drive::rest());
        let commands: Vec<_> = rest.into_iter().chain([Command::DISABLE]).collect();
        self.send(&commands);
    }

    /// Begins from the board's first heartbeat.
    fn identify(&mut self) {
        self.hush();
        self.phase = Phase::Identifying;
        self.since = Instant::now();
        self.damaged_before = self.link.statistics().damaged;
        self.has_complained = false;
    }

    fn take(&mut self, event: Event, report: &mut impl FnMut(SessionEvent)) {
        let before = self.phase;
        match event {
            Event::Connected => {
                report(SessionEvent::Note(format!("{}: the line is open", self.link.name())));
                self.attempts = 0;
                self.identify();
            }
            Event::Disconnected(why) => {
                let name = self.link.name();
                self.lose(Phase::Disconnected, &format!("{name}: {why}"), report);
            }
            Event::Silent if self.phase != Phase::Identifying => {
                self.lose(Phase::Silent, "the board is silent: check its power and cable", report);
            }
            Event::Message(message) if self.phase == Phase::Silent => {
                report(SessionEvent::Note("the board is back".into()));
                let _ = message;
                self.attempts = 0;
                self.identify();
            }
            Event::Message(Message::Heartbeat(heartbeat)) => self.heartbeat(&heartbeat, report),
            Event::Message(Message::Frame(packet)) => self.frame(packet, report),
            Event::Silent | Event::Damaged(_) => (),
        }
        if self.phase != before {
            report(SessionEvent::Phase(self.phase));
        }
    }

    /// Nothing is known of the board any more; once it is back, its drive stays off.
    fn lose(&mut self, phase: Phase, why: &str, report: &mut impl FnMut(SessionEvent)) {
        let was_armed = self.phase == Phase::Armed;
        self.targets_n.fill(0.0);
        if self.phase != phase || !self.has_complained {
            let drive =
                if was_armed { "; the drive stays off until it is armed again" } else { "" };
            report(SessionEvent::Note(format!("{why}{drive}")));
        }
        (self.phase, self.has_complained) = (phase, true);
    }

    fn heartbeat(&mut self, heartbeat: &Heartbeat, report: &mut impl FnMut(SessionEvent)) {
        match self.phase {
            Phase::Measuring | Phase::Armed if self.since.elapsed() > IN_FLIGHT => {
                let why = match heartbeat.calibrated {
                    true => "the board was disabled by another program or a lost command",
                    false => "the board has restarted",
                };
                let drive = match self.phase {
                    Phase::Armed => "; the drive stays off until it is armed again",
                    _ => "",
                };
                report(SessionEvent::Note(format!("{why}: it is brought up again{drive}")));
                self.attempts = 0;
                self.identify();
            }
            Phase::Identifying | Phase::Preparing | Phase::TestingLine(_) => {
                if Instant::now() < self.settled_at || std::mem::take(&mut self.skips) {
                    return;
                }
                self.step(heartbeat, report);
            }
            _ => (),
        }
    }

    /// A step of the start-up.
    fn step(&mut self, heartbeat: &Heartbeat, report: &mut impl FnMut(SessionEvent)) {
        if self.phase == Phase::Identifying {
            report(SessionEvent::Note(words::identity(heartbeat)));
            let Plan { profile, calibration, output, all_lines, .. } = &self.plan;
            self.bring_up = BringUp::new(profile, calibration, *output);
            if *all_lines {
                self.bring_up = self.bring_up.clone().with_all_lines();
            }
            let commands = self.bring_up.begin(&self.plan.adc, heartbeat.status.commands);
            self.send(&commands);
            self.phase = Phase::Preparing;
            return;
        }
        match self.bring_up.heartbeat(heartbeat) {
            Ok(Step::Wait) => (),
            Ok(Step::Send(commands)) => {
                self.send(&commands);
                self.phase = match self.bring_up.line_under_test() {
                    Some(line) => Phase::TestingLine(line),
                    None => Phase::Preparing,
                };
            }
            Ok(Step::Ready(enable)) => {
                let rest = self.plan.output.map(|_| drive::rest());
                let commands: Vec<_> = rest.into_iter().chain([enable]).collect();
                self.send(&commands);
                self.link.begin_sequence();
                (self.phase, self.since, self.refused) = (Phase::Measuring, Instant::now(), None);
                let lines = self.plan.profile.channels();
                report(SessionEvent::Note(format!(
                    "start-up passed: {lines} data lines tested, calibration written; the drive is off"
                )));
            }
            Err(error @ StartupError::Commands { .. }) if self.attempts < ATTEMPTS => {
                self.attempts += 1;
                report(SessionEvent::Note(format!("{error}: the start-up is repeated")));
                self.identify();
            }
            Err(error) => {
                report(SessionEvent::Note(format!("refused: {error}")));
                self.refused = Some(error);
                self.hush();
                (self.phase, self.since) = (Phase::Refused, Instant::now());
            }
        }
    }

    fn frame(&mut self, packet: Packet, report: &mut impl FnMut(SessionEvent)) {
        if !self.is_measuring() {
            return;
        }
        let faults = packet.status.driven.map(|driven| driven.faults).unwrap_or_default();
        // Frames from before the drive was armed still have the faults that arming clears.
        let is_old = !self.was_clear && self.since_armed.elapsed() < IN_FLIGHT;
        self.was_clear |= !faults.any();
        if self.phase == Phase::Armed && faults.any() && !is_old {
            report(SessionEvent::Note(words::faults(faults)));
            self.disarm();
        }
        report(SessionEvent::Frame(packet));
    }

    /// What follows from time alone.
    fn watch(&mut self, report: &mut impl FnMut(SessionEvent)) {
        match self.phase {
            Phase::Identifying if self.since.elapsed() > IDENTIFY => {
                let counts = self.link.statistics();
                let damaged = counts.damaged - self.damaged_before;
                if !std::mem::replace(&mut self.has_complained, true) {
                    let text = words::unheard(&counts, damaged, self.plan.baud);
                    report(SessionEvent::Note(text));
                }
                self.hush();
                self.since = Instant::now();
            }
            Phase::Preparing | Phase::TestingLine(_) if self.settled_at.elapsed() > IDENTIFY => {
                self.identify();
                report(SessionEvent::Phase(self.phase));
            }
            Phase::Refused if self.since.elapsed() > AGAIN && self.link.is_connected() => {
                self.attempts = 0;
                self.identify();
                report(SessionEvent::Phase(self.phase));
            }
            _ => (),
        }
    }

    /// Signs of life of an armed drive, four within the time after which the board misses its host.
    fn speak(&mut self) {
        let Some(control) = &self.plan.profile.control else { return };
        let every = Duration::from_millis(control.silent_ms.div_ceil(4).max(1));
        if self.phase != Phase::Armed || self.spoke_at.elapsed() < every {
            return;
        }
        if let Ok(commands) = self.positions() {
            self.send(&commands);
        }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.hush();
    }
}
