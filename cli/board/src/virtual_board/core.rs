// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core of a virtual board, made of the words that the host has written.

use hapticore_contract::calibration::Calibration;
use hapticore_contract::control::Drive;
use hapticore_contract::frame::Frame;
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_host::Driven;
use hapticore_model::fidelity::fixed::FixedSimulation;
use hapticore_model::fidelity::force_loop::FixedLoop;

use super::words::DriveWords;

/// A core, with its controller where the board drives its pads.
pub(super) enum Core {
    Sensor(Box<FixedSimulation<i64>>),
    Driven(Box<DrivenCore>),
}

/// A core with its controller.
pub(super) struct DrivenCore {
    core: FixedLoop,
    /// What packets report of the drive.
    pub driven: Driven,
}

impl Core {
    pub fn new(
        profile: &Profile,
        calibration: &Calibration,
        words: Option<&DriveWords>,
    ) -> Result<Self, ProfileError> {
        let (Some(words), Some(control)) = (words, &profile.control) else {
            return Ok(Core::Sensor(Box::new(FixedSimulation::new(profile, calibration))));
        };
        let mut core = FixedLoop::new(profile, calibration, &words.tuning(profile, control))?;
        for pad in 0..words.targets.len() {
            core.set_target(pad, words.target_n(pad, control));
            if let Some(surface) = words.surface(pad, profile).filter(|_| profile.wall.is_some()) {
                core.set_surface(pad, surface);
            }
        }
        Ok(Core::Driven(Box::new(DrivenCore { core, driven: Driven::default() })))
    }

    /// The frame of a slot, and its drive word.
    pub fn slot(&mut self, pad: usize, codes: &[i32]) -> (Frame, Option<Drive>) {
        match self {
            Core::Sensor(core) => (core.slot(pad, codes), None),
            Core::Driven(core) => core.core.slot(|of| of.slot(pad, codes)),
        }
    }

    /// The loop, where there is one.
    pub fn driven(&mut self) -> Option<&mut DrivenCore> {
        match self {
            Core::Sensor(_) => None,
            Core::Driven(core) => Some(core),
        }
    }
}

impl DrivenCore {
    /// A millisecond has passed.
    pub fn tick(&mut self) {
        self.core.tick();
    }

    /// A word of this pad was written: its target and surface hold from now on, and the host lives.
    pub fn hear(&mut self, pad: usize, words: &DriveWords, profile: &Profile) {
        let Some(control) = &profile.control else { return };
        self.core.set_target(pad, words.target_n(pad, control));
        if let Some(surface) = words.surface(pad, profile).filter(|_| profile.wall.is_some()) {
            self.core.set_surface(pad, surface);
        }
    }

    /// Keeps what packets report; the drive's fraction of full scale, zero where drives do not follow.
    pub fn keep(&mut self, drive: &Drive, follows: bool, profile: &Profile) -> f64 {
        let fraction = if follows && !drive.faults.any() { drive.fraction } else { 0.0 };
        let format = profile.control.as_ref().map(|control| control.drive);
        self.driven = Driven {
            word: format.map_or(0, |format| format.code_saturating(fraction)),
            pad: drive.pad as u8,
            low: drive.low,
            high: drive.high,
            free: drive.walled.is_some_and(|walled| walled.free),
            // A fault takes the converter off, too.
            live: !drive.faults.any(),
            faults: drive.faults,
        };
        fraction
    }
}
