// SPDX-License-Identifier: MIT OR Apache-2.0
//! Slots in, rows out: the core at its fidelity, the floating-point reference on the same samples, and rounding errors.

use std::collections::VecDeque;
use std::sync::Arc;

use anyhow::Result;
use hapticore_contract::frame::{Flags, Reading};
use hapticore_contract::profile::Profile;
use hapticore_reference::Reference as FloatCore;
use hapticore_scene::Uncoupler;

use crate::args::Fidelity;
use crate::calibrate::DeviceCalibration;
use crate::engine::{Engine, Slot, engine};
use crate::errors::Errors;
use crate::placement::Placement;
use crate::record::{Reference, Row, SignalError, Truth};
use crate::residual::Residual;
use crate::uncoupling::Uncoupling;
use crate::units::Units;

/// A core at work on one stream of slots.
pub struct Session {
    residual: Residual,
    engine: Box<dyn Engine>,
    reference: FloatCore,
    errors: Option<Errors>,
    units: Units,
    clock: SlotClock,
    case: usize,
    waiting: VecDeque<Row>,
    /// Of the core and of the reference.
    uncoupling: Option<[Uncoupling; 2]>,
    placement: Placement,
}

/// When slots are.
#[derive(Debug, Clone, Copy)]
pub struct SlotClock {
    start_s: f64,
    slot_samples: f64,
    middle: f64,
    sample_rate_hz: f64,
    slots: u64,
}

impl SlotClock {
    /// Slots of the profile from `start_s` on.
    pub fn new(profile: &Profile, sample_rate_hz: f64, start_s: f64) -> Self {
        let middle = profile.slot.blanking() as f64 + profile.slot.integrate as f64 / 2.0;
        SlotClock { start_s, slot_samples: profile.slot.samples() as f64, middle, sample_rate_hz, slots: 0 }
    }

    /// The middle of the next slot's window.
    fn tick(&mut self) -> f64 {
        let samples = self.slots as f64 * self.slot_samples + self.middle;
        self.slots += 1;
        self.start_s + samples / self.sample_rate_hz
    }

    /// When the first slot begins.
    pub fn start_s(&self) -> f64 {
        self.start_s
    }

    /// How long `slots` take.
    pub fn seconds(&self, slots: usize) -> f64 {
        slots as f64 * self.slot_samples / self.sample_rate_hz
    }
}

impl Session {
    /// A core of the profile for a device, just before its first slot. `case` is the number of the case in rows.
    ///
    /// # Errors
    /// A calibration that the profile's formats do not hold.
    pub fn new(
        profile: &Arc<Profile>,
        device: &DeviceCalibration,
        fidelity: Fidelity,
        errors: bool,
        (case, clock): (usize, SlotClock),
    ) -> Result<Self> {
        let calibration = device.of(profile)?;
        Ok(Session {
            residual: device.residual(&calibration),
            engine: engine(fidelity, profile, &calibration),
            reference: FloatCore::new(profile, &calibration),
            errors: errors.then(|| Errors::new(profile, &calibration)),
            units: Units::new(profile, &device.device),
            clock,
            case,
            waiting: VecDeque::new(),
            uncoupling: None,
            placement: Placement::new(device),
        })
    }

    /// The same session, which takes out of its readings, the core's and the reference's, what other pads did to them.
    pub fn uncoupling(mut self, uncouplers: Option<[Uncoupler; 2]>) -> Self {
        self.uncoupling = uncouplers.map(|both| both.map(Uncoupling::new));
        self
    }

    /// Takes a slot and what is known of it; the row that is finished, if one is.
    pub fn slot(&mut self, slot: &Slot, truth: Option<Truth>) -> Option<Row> {
        if let Some(errors) = &mut self.errors {
            errors.slot(slot);
        }
        let reference = self.refer(slot);
        self.waiting.push_back(Row {
            case: self.case,
            time_s: self.clock.tick(),
            pad: slot.pad,
            measured: reference.quantities,
            flags: String::new(),
            truth,
            reference: Some(reference),
        });
        let reading = self.engine.slot(slot)?;
        self.finished(&reading)
    }

    /// The last row, where it is still to come.
    pub fn finish(&mut self) -> Option<Row> {
        let reading = self.engine.finish()?;
        self.finished(&reading)
    }

    /// What the position table leaves of its own places.
    pub fn residual(&self) -> Residual {
        self.residual
    }

    /// Rounding errors, where they were asked for.
    pub fn errors(&self) -> Vec<SignalError> {
        self.errors.as_ref().map(Errors::largest).unwrap_or_default()
    }

    fn refer(&mut self, slot: &Slot) -> Reference {
        let reading = slot.refer(&mut self.reference);
        let capacitance_pf = self.reference.capacitance_eq6();
        let ratio = capacitance_pf / reading.capacitance_pf;
        let mut quantities = self.units.quantities(&reading);
        if let Some([_, reference]) = self.uncoupling.as_mut().filter(|_| !reading.flags.invalid) {
            reference.apply(slot.pad, &mut quantities);
        }
        Reference {
            quantities,
            capacitance_eq6_pf: capacitance_pf,
            force_eq6_n: if reading.capacitance_pf > 0.0 { reading.force_n * ratio * ratio } else { 0.0 },
        }
    }

    fn finished(&mut self, reading: &Reading) -> Option<Row> {
        let row = self.waiting.pop_front()?;
        assert_eq!(row.pad, reading.pad, "readings come in the order of their slots");
        let mut measured = self.units.quantities(reading);
        if let Some([core, _]) = self.uncoupling.as_mut().filter(|_| !reading.flags.invalid) {
            core.apply(row.pad, &mut measured);
        }
        let at_mm = (!reading.flags.invalid).then_some([measured.x_mm, measured.y_mm]);
        let flags: Vec<_> = names(reading.flags).chain(self.placement.flags(row.pad, at_mm)).collect();
        Some(Row { measured, flags: flags.join("+"), ..row })
    }
}

/// The names of the core's flags that are set.
fn names(flags: Flags) -> impl Iterator<Item = &'static str> {
    let named =
        [(flags.clipped, "clipped"), (flags.saturated, "saturated"), (flags.invalid, "invalid"), (flags.lost, "lost")];
    named.into_iter().filter(|(set, _)| *set).map(|(_, name)| name)
}
