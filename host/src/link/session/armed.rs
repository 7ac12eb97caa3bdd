// SPDX-License-Identifier: MIT OR Apache-2.0
//! The drive of a board: armed, its targets and surfaces, its signs of life.

use std::time::{Duration, Instant};

use hapticore_contract::profile::ProfileError;

use super::{Phase, Refusal, Session, refuse};
use crate::command::Command;
use crate::drive;

impl Session {
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

    /// Whether a pad takes a target, N.
    ///
    /// # Errors
    /// No such pad, a force beyond the tuning's cap or below zero.
    pub fn check_target(&self, pad: usize, newtons: f64) -> Result<(), Refusal> {
        let pads = self.targets_n.len();
        if pad >= pads {
            return refuse(format!("pad: expected below {pads}, got {pad}"));
        }
        let cap_n = self.largest_target_n();
        if !(0.0..=cap_n).contains(&newtons) {
            // Rounded down: what is printed is taken.
            let most_n = (1e3 * cap_n).floor() / 1e3;
            return refuse(format!("target: expected 0 to {most_n} N, got {newtons}"));
        }
        Ok(())
    }

    /// Sets the target of a pad of an armed drive, N. All targets are 0 N when the drive is armed.
    ///
    /// # Errors
    /// As [`Session::check_target`], a drive that is off.
    pub fn set_target(&mut self, pad: usize, newtons: f64) -> Result<(), Refusal> {
        self.check_target(pad, newtons)?;
        if self.phase != Phase::Armed {
            return refuse("target: expected an armed drive; targets are 0 N when it is armed");
        }
        self.targets_n[pad] = newtons;
        self.tell(drive::target(&self.plan.profile, pad as u8, newtons))
    }

    /// The target of a pad, N; 0 where the drive is off, and of a pad that is none.
    pub fn target_n(&self, pad: usize) -> f64 {
        self.targets_n.get(pad).copied().unwrap_or(0.0)
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
    pub(super) fn tell(&mut self, command: Result<Command, ProfileError>) -> Result<(), Refusal> {
        let command = command.map_err(|error| Refusal(error.to_string()))?;
        if self.phase == Phase::Armed {
            self.send(&[command]);
        }
        Ok(())
    }

    /// The commands of all targets and surfaces.
    pub(super) fn positions(&self) -> Result<Vec<Command>, ProfileError> {
        let profile = &self.plan.profile;
        let targets = (0..).zip(&self.targets_n);
        let targets = targets.map(|(pad, newtons)| drive::target(profile, pad, *newtons));
        let surfaces = (0..).zip(&self.surfaces);
        let surfaces = surfaces.filter_map(|(pad, surface)| Some((pad, (*surface)?)));
        let surfaces = surfaces.map(|(pad, (mm, right))| drive::surface(profile, pad, mm, right));
        targets.chain(surfaces).collect()
    }

    /// Signs of life of an armed drive, four within the time after which the board misses its host.
    pub(super) fn speak(&mut self) {
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
