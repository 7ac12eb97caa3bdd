// SPDX-License-Identifier: MIT OR Apache-2.0
//! Start-up: from a board's first heartbeat to its frames. Whatever goes wrong, the board is disabled.

use std::time::{Duration, Instant};

use super::{IN_FLIGHT, Phase, Plan, Session, SessionEvent};
use crate::bringup::{BringUp, Step};
use crate::drive;
use crate::link::words;
use crate::packet::Heartbeat;
use crate::startup::StartupError;

/// Without a heartbeat for this long the board is disabled once more.
const IDENTIFY: Duration = Duration::from_secs(1);
/// When a refused board is tried again.
const AGAIN: Duration = Duration::from_secs(3);
/// How often a start-up is repeated in which commands were lost.
const ATTEMPTS: u8 = 3;

impl Session {
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

    /// Begins from the board's first heartbeat.
    pub(super) fn identify(&mut self) {
        self.hush();
        self.phase = Phase::Identifying;
        self.since = Instant::now();
        self.damaged_before = self.link.statistics().damaged;
        self.has_complained = false;
    }

    pub(super) fn heartbeat(
        &mut self,
        heartbeat: &Heartbeat,
        report: &mut impl FnMut(SessionEvent),
    ) {
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
    pub(super) fn step(&mut self, heartbeat: &Heartbeat, report: &mut impl FnMut(SessionEvent)) {
        if self.phase == Phase::Identifying {
            // A refused board is asked again and again: what it says is said once.
            let identity = Some(words::identity(heartbeat));
            if self.identity != identity {
                self.identity = identity;
                report(SessionEvent::Note(self.identity.clone().unwrap_or_default()));
            }
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
                if self.refused.as_ref() != Some(&error) {
                    report(SessionEvent::Note(format!(
                        "refused: {error}; it is tried again every 3 s"
                    )));
                }
                self.refused = Some(error);
                self.hush();
                (self.phase, self.since) = (Phase::Refused, Instant::now());
            }
        }
    }

    /// What follows from time alone.
    pub(super) fn watch(&mut self, report: &mut impl FnMut(SessionEvent)) {
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
}
