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

mod armed;
mod startup;

use std::fmt;
use std::time::{Duration, Instant};

use super::{Event, Line, Link, Statistics, words};
use crate::bringup::BringUp;
use crate::command::{Command, encode};
use crate::drive;
use crate::packet::{Message, Packet};
use crate::startup::{AdcSetup, LineFault, StartupError};
use hapticore_contract::calibration::Calibration;
use hapticore_contract::control::Tuning;
use hapticore_contract::profile::Profile;
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

impl Phase {
    /// Its name, as `status` and a page show it.
    pub fn word(&self) -> &'static str {
        match self {
            Phase::Disconnected => "disconnected",
            Phase::Silent => "silent",
            Phase::Identifying => "identifying",
            Phase::Preparing => "starting up",
            Phase::TestingLine(_) => "testing lines",
            Phase::Measuring => "measuring",
            Phase::Armed => "armed",
            Phase::Off => "off",
            Phase::Refused => "refused",
        }
    }
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

/// Frames from which the share of dropped ones is judged.
const FEW_FRAMES: u64 = 200;
/// How long after `ENABLE` heartbeats may still come.
const IN_FLIGHT: Duration = Duration::from_millis(500);
/// What a serial adapter may keep bytes for, beside their time on the line.
const ADAPTER: Duration = Duration::from_millis(40);

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
    /// What the board has said that it is since the line was opened.
    identity: Option<String>,
    targets_n: Vec<f64>,
    /// Surface of each wall, mm, and whether its inside is right of it.
    surfaces: Vec<Option<(f64, bool)>>,
    spoke_at: Instant,
    since_armed: Instant,
    /// A frame without faults has come since the drive was armed.
    was_clear: bool,
    /// The user knows that the line is too slow.
    has_said_dropped: bool,
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
            identity: None,
            targets_n: vec![0.0; pads],
            surfaces: vec![None; pads],
            spoke_at: now,
            since_armed: now,
            was_clear: false,
            has_said_dropped: false,
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

    /// What the board has said that it is since the line was opened: protocol, digest, drive output.
    pub fn identity(&self) -> Option<&str> {
        self.identity.as_deref()
    }

    /// Why the board was refused last.
    pub fn refusal(&self) -> Option<&StartupError> {
        self.refused.as_ref()
    }

    /// Data lines that have failed in the last start-up.
    pub fn line_faults(&self) -> &[(u8, LineFault)] {
        self.bring_up.line_faults()
    }

    /// Whether the drive follows its targets: it is armed, and the faults that arming clears are gone.
    pub fn drives(&self) -> bool {
        self.phase == Phase::Armed && self.was_clear
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

    /// Disables the board: pads open, drives at 0 V.
    pub fn disable(&mut self) {
        self.hush();
        self.phase = Phase::Off;
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

    fn take(&mut self, event: Event, report: &mut impl FnMut(SessionEvent)) {
        let before = self.phase;
        match event {
            Event::Connected => {
                report(SessionEvent::Note(format!("{}: the line is open", self.link.name())));
                (self.attempts, self.identity, self.refused) = (0, None, None);
                self.identify();
            }
            Event::Disconnected(why) => {
                let name = self.link.name();
                self.lose(Phase::Disconnected, &format!("{name}: {why}"), report);
            }
            Event::Silent if self.phase != Phase::Identifying => {
                self.lose(Phase::Silent, "the board is silent: check its power and cable", report);
            }
            Event::Message(_) if self.phase == Phase::Silent => {
                report(SessionEvent::Note("the board is back".into()));
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
        self.check_dropped(report);
        report(SessionEvent::Frame(packet));
    }

    /// Reports once that the board drops more than a few frames.
    fn check_dropped(&mut self, report: &mut impl FnMut(SessionEvent)) {
        let counts = self.link.statistics();
        let are_many = counts.frames > FEW_FRAMES && 20 * counts.dropped > counts.frames;
        if are_many && !std::mem::replace(&mut self.has_said_dropped, true) {
            report(SessionEvent::Note(words::dropped(&counts, self.plan.baud)));
        }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.hush();
    }
}
