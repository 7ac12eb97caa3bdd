// SPDX-License-Identifier: MIT OR Apache-2.0
//! Core and controller at the three fidelities: a slot and a target in, a measurement and a drive
//! out.

use std::sync::Arc;

use anyhow::Result;
use hapticore_contract::calibration::Calibration;
use hapticore_contract::control::{Drive, Surface, Tuning, Walled};
use hapticore_contract::frame::Measurement;
use hapticore_contract::profile::Profile;
use hapticore_model::fidelity::force_loop::{ClockLoop, FixedLoop};
use hapticore_reference::Reference;
use hapticore_reference::control::Controller;
use hapticore_reference::wall::{SplitPads, Whole};

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
    Ok(match fidelity {
        Fidelity::Float => closed(profile, Float::new(profile, calibration, tuning)),
        Fidelity::Fixed => closed(profile, FixedLoop::new(profile, calibration, tuning)?),
        Fidelity::Clock => closed(profile, ClockLoop::new(profile, calibration, tuning)?),
    })
}

/// A core that drives the pad of each slot.
trait Loop: Send + 'static {
    /// The measurement that is finished, if one is, and the drive that the slot led to.
    fn slot(&mut self, slot: &Slot, profile: &Profile) -> (Option<Measurement>, Option<Drive>);
    fn set_target(&mut self, pad: usize, newtons: f64);
    fn set_surface(&mut self, pad: usize, surface: Surface);

    /// The measurement of the last slot, where it is still to come.
    fn finish(&mut self, _: &Profile) -> Option<Measurement> {
        None
    }
}

/// A loop as an engine: the drive of the last slot waits until it is taken.
struct Closed<L> {
    core: L,
    profile: Arc<Profile>,
    drive: Option<Drive>,
}

fn closed(profile: &Arc<Profile>, core: impl Loop) -> Box<dyn Engine> {
    Box::new(Closed { core, profile: profile.clone(), drive: None })
}

impl<L: Loop> Engine for Closed<L> {
    fn slot(&mut self, slot: &Slot) -> Option<Measurement> {
        let (measurement, drive) = self.core.slot(slot, &self.profile);
        self.drive = drive;
        measurement
    }

    fn finish(&mut self) -> Option<Measurement> {
        self.core.finish(&self.profile)
    }

    fn set_target(&mut self, pad: usize, newtons: f64) {
        self.core.set_target(pad, newtons);
    }

    fn set_surface(&mut self, pad: usize, surface: Surface) {
        self.core.set_surface(pad, surface);
    }

    fn take_drive(&mut self) -> Option<Drive> {
        self.drive.take()
    }
}

/// Reference and controller in floating point.
struct Float {
    core: Reference,
    controller: Controller,
    targets: Vec<f64>,
    split_pads: Option<SplitPads>,
}

impl Float {
    fn new(profile: &Profile, calibration: &Calibration, tuning: &Tuning) -> Self {
        let pads = profile.pads as usize;
        let control = profile.control.as_ref().expect("a scene with a controller sets it");
        let walls = profile.wall.as_ref().zip(tuning.walls.as_ref());
        Float {
            core: Reference::new(profile, calibration),
            controller: Controller::new(control, tuning, pads),
            targets: vec![0.0; pads],
            split_pads: walls.map(|(wall, walls)| SplitPads::new(wall, walls, pads)),
        }
    }
}

impl Loop for Float {
    fn slot(&mut self, slot: &Slot, _: &Profile) -> (Option<Measurement>, Option<Drive>) {
        let measurement = slot.refer(&mut self.core);
        let (prompt, target_n) = (self.core.prompt(), self.targets[slot.pad]);
        let Some(split_pads) = &mut self.split_pads else {
            return (Some(measurement), Some(self.controller.drive(&prompt, target_n)));
        };
        let drive = split_pads.estimate(&prompt).map(|Whole { prompt, walled }| {
            let walled = Walled { target_n: walled.target_n.max(target_n), ..walled };
            let drive = self.controller.drive(&prompt, walled.target_n);
            split_pads.drive(slot.pad, drive.fraction);
            Drive { walled: Some(walled), ..drive }
        });
        if !measurement.flags.invalid && !measurement.flags.lifted {
            split_pads.place(slot.pad, [measurement.x_mm, measurement.y_mm]);
        }
        (Some(measurement), drive)
    }

    fn set_surface(&mut self, pad: usize, surface: Surface) {
        if let Some(split_pads) = &mut self.split_pads {
            split_pads.set_surface(pad, surface);
        }
    }

    fn set_target(&mut self, pad: usize, newtons: f64) {
        self.targets[pad] = newtons;
        self.controller.hear();
    }
}

impl Loop for FixedLoop {
    fn slot(&mut self, slot: &Slot, profile: &Profile) -> (Option<Measurement>, Option<Drive>) {
        let (frame, drive) = self.slot(|core| slot.frame(core));
        (Some(frame.measurement(profile)), drive)
    }

    fn set_target(&mut self, pad: usize, newtons: f64) {
        self.set_target(pad, newtons);
    }

    fn set_surface(&mut self, pad: usize, surface: Surface) {
        self.set_surface(pad, surface);
    }
}

impl Loop for ClockLoop {
    fn slot(&mut self, slot: &Slot, profile: &Profile) -> (Option<Measurement>, Option<Drive>) {
        let (frame, drive) = self.slot(slot.window());
        (frame.map(|frame| frame.measurement(profile)), drive)
    }

    fn finish(&mut self, profile: &Profile) -> Option<Measurement> {
        self.finish().map(|frame| frame.measurement(profile))
    }

    fn set_target(&mut self, pad: usize, newtons: f64) {
        self.set_target(pad, newtons);
    }

    fn set_surface(&mut self, pad: usize, surface: Surface) {
        self.set_surface(pad, surface);
    }
}
