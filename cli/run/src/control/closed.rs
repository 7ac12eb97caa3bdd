// SPDX-License-Identifier: MIT OR Apache-2.0
//! Core and controller at the three fidelities: a slot and a target in, a measurement and a drive
//! out.

use std::sync::Arc;

use anyhow::Result;
use hapticore_contract::calibration::Calibration;
use hapticore_contract::control::{Drive, Tuning};
use hapticore_contract::frame::Measurement;
use hapticore_contract::profile::Profile;
use hapticore_model::fidelity::force_loop::{ClockLoop, FixedLoop};
use hapticore_reference::Reference;
use hapticore_reference::control::Controller;

use crate::engine::{Engine, Fidelity, Slot};

/// A core with its controller at a fidelity.
///
/// # Errors
/// A profile whose controller cannot be.
pub fn engine(
    fidelity: Fidelity,
    profile: &Arc<Profile>,
    calibration: &Calibration,
    tuning: &Tuning,
) -> Result<Box<dyn Engine>> {
    let profile = profile.clone();
    Ok(match fidelity {
        Fidelity::Float => Box::new(Float::new(&profile, calibration, tuning)),
        Fidelity::Fixed => {
            let core = FixedLoop::new(&profile, calibration, tuning)?;
            Box::new(Fixed { core, profile, drive: None })
        }
        Fidelity::Clock => {
            let core = ClockLoop::new(&profile, calibration, tuning)?;
            Box::new(Clock { core, profile, drive: None })
        }
    })
}

struct Float {
    core: Reference,
    controller: Controller,
    targets: Vec<f64>,
    drive: Option<Drive>,
}

impl Float {
    fn new(profile: &Profile, calibration: &Calibration, tuning: &Tuning) -> Self {
        let pads = profile.pads as usize;
        let control = profile.control.as_ref().expect("a scene with a controller sets it");
        Float {
            core: Reference::new(profile, calibration),
            controller: Controller::new(control, tuning, pads),
            targets: vec![0.0; pads],
            drive: None,
        }
    }
}

impl Engine for Float {
    fn slot(&mut self, slot: &Slot) -> Option<Measurement> {
        let measurement = slot.refer(&mut self.core);
        self.drive = Some(self.controller.drive(&self.core.prompt(), self.targets[slot.pad]));
        Some(measurement)
    }

    fn set_target(&mut self, pad: usize, newtons: f64) {
        self.targets[pad] = newtons;
        self.controller.hear();
    }

    fn take_drive(&mut self) -> Option<Drive> {
        self.drive.take()
    }
}

struct Fixed {
    core: FixedLoop,
    profile: Arc<Profile>,
    drive: Option<Drive>,
}

impl Engine for Fixed {
    fn slot(&mut self, slot: &Slot) -> Option<Measurement> {
        let (frame, drive) = self.core.slot(|core| slot.frame(core));
        self.drive = Some(drive);
        Some(frame.measurement(&self.profile))
    }

    fn set_target(&mut self, pad: usize, newtons: f64) {
        self.core.set_target(pad, newtons);
    }

    fn take_drive(&mut self) -> Option<Drive> {
        self.drive.take()
    }
}

struct Clock {
    core: ClockLoop,
    profile: Arc<Profile>,
    drive: Option<Drive>,
}

impl Engine for Clock {
    fn slot(&mut self, slot: &Slot) -> Option<Measurement> {
        let (frame, drive) = self.core.slot(slot.window());
        self.drive = Some(drive);
        Some(frame.measurement(&self.profile))
    }

    fn set_target(&mut self, pad: usize, newtons: f64) {
        self.core.set_target(pad, newtons);
    }

    fn take_drive(&mut self) -> Option<Drive> {
        self.drive.take()
    }
}
