// SPDX-License-Identifier: MIT OR Apache-2.0
//! Slots in, rows out: the core at its fidelity, the floating-point reference on the same samples,
//! and rounding errors.

use std::collections::VecDeque;
use std::sync::Arc;

use anyhow::{Result, bail, ensure};
use hapticore_contract::calibration::Calibration;
use hapticore_contract::control::{Drive, Surface, Tuning};
use hapticore_contract::frame::Measurement;
use hapticore_contract::profile::Profile;
use hapticore_host::profile::serving;
use hapticore_host::{CrosstalkCanceller, DeviceCalibration, ForceLaws, Readout, SlotClock};
use hapticore_reference::Reference as FloatCore;

use crate::control::closed;
use crate::direction::Directions;
use crate::engine::{Engine, Fidelity, Signals, Slot, engine};
use crate::errors::Errors;
use crate::inputs::buildable;
use crate::record::{Quantities, Reference, Row, SignalError, Truth};

/// The most pads that are selected in turn.
pub const MOST_PADS: u64 = 256;

/// How a core is run on slots.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// How exactly the core is run.
    pub fidelity: Fidelity,
    /// Whether rounding errors are asked for.
    pub errors: bool,
    /// Whether the floating-point reference runs on the same samples, for [`Row::reference`].
    pub reference: bool,
}

impl Options {
    /// Whether the core takes the samples of the blanking, too.
    pub(crate) fn is_whole(&self) -> bool {
        self.fidelity == Fidelity::Clock
    }
}

/// A core at work on one stream of slots.
pub struct Session {
    engine: Box<dyn Engine>,
    reference: Option<FloatCore>,
    errors: Option<Errors>,
    /// Of the core and of the reference.
    readouts: [Readout; 2],
    /// Of the core and of the reference, where pads are served part by part.
    directions: [Option<Directions>; 2],
    /// Both laws of the force, where the device has a table.
    laws: Option<ForceLaws>,
    clock: SlotClock,
    case: usize,
    waiting: VecDeque<Row>,
    /// The force of the last row as the core measured it, N, where the host takes crosstalk out.
    core_n: Option<f64>,
    cancels: bool,
    pads: usize,
    /// Codes of a slot's window, and of the whole slot.
    lengths: [usize; 2],
    /// The least and the largest code of the ADC.
    codes: [i64; 2],
    channels: usize,
    /// The core takes the samples of the blanking, too.
    takes_whole: bool,
    takes_phasors: bool,
}

impl Session {
    /// A core of the profile for a device, with the words of its calibration, just before its first
    /// slot. `case` is the number of the case in rows. With a tuning the profile's controller
    /// drives the pads.
    ///
    /// # Errors
    /// A profile whose controller cannot be.
    pub fn new(
        profile: &Arc<Profile>,
        (device, calibration): (&DeviceCalibration, &Calibration),
        (options, tuning): (Options, Option<&Tuning>),
        (case, clock): (usize, SlotClock),
    ) -> Result<Self> {
        let Options { fidelity, errors, reference } = options;
        let engine = match tuning {
            Some(tuning) => closed::engine(fidelity, profile, calibration, tuning)?,
            None => engine(fidelity, profile, calibration),
        };
        Ok(Session {
            engine,
            reference: reference.then(|| FloatCore::new(profile, calibration)),
            errors: errors.then(|| Errors::new(profile, calibration)),
            readouts: [0, 1].map(|_| Readout::new(profile, device)),
            directions: [None, None],
            laws: device.force.as_ref().map(|_| ForceLaws::new(profile, calibration)),
            clock,
            case,
            waiting: VecDeque::new(),
            core_n: None,
            cancels: false,
            pads: profile.pads as usize,
            lengths: [profile.slot.integrate as usize, profile.slot.samples() as usize]
                .map(|samples| samples * profile.channels()),
            codes: [profile.formats.adc.min_code(), profile.formats.adc.max_code()]
                .map(|code| code as i64),
            channels: profile.channels(),
            takes_whole: fidelity == Fidelity::Clock && tuning.is_none(),
            takes_phasors: fidelity != Fidelity::Clock,
        })
    }

    /// A core of the profile for a device that is recorded or read, not simulated; of `pads` pads, those of the
    /// calibration where none is named.
    ///
    /// # Errors
    /// A device that no core of the profile can serve, a calibration that it cannot represent, a number of pads out of
    /// 1 to [`MOST_PADS`].
    pub fn of_device(
        profile: &Profile,
        device: &DeviceCalibration,
        pads: Option<u64>,
        options: Options,
    ) -> Result<(Session, Arc<Profile>)> {
        let profile = buildable(device.profile(profile)?)?;
        let pads = pads.unwrap_or(device.pads);
        ensure!((1..=MOST_PADS).contains(&pads), "pads: expected 1 to {MOST_PADS}, got {pads}");
        let profile = Arc::new(serving(&profile, pads as usize));
        let clock = SlotClock::new(&profile, device.device.sample_rate_hz, 0.0);
        let calibration = device.for_profile(&profile)?;
        let session = Session::new(&profile, (device, &calibration), (options, None), (0, clock))?;
        Ok((session, profile))
    }

    /// The same session, which takes out of its measurements, the core's and the reference's, what
    /// other pads did to them.
    pub fn with_cancellers(mut self, cancellers: Option<[CrosstalkCanceller; 2]>) -> Self {
        self.cancels = cancellers.is_some();
        let cancellers = cancellers.map_or([None, None], |both| both.map(Some));
        let [core, reference] = self.readouts;
        let [of_core, of_reference] = cancellers;
        self.readouts = [core.with_canceller(of_core), reference.with_canceller(of_reference)];
        self
    }

    /// The same session, whose measurements and references have the direction of the push, where pads are
    /// served part by part.
    pub fn with_directions(self, directions: [Option<Directions>; 2]) -> Self {
        Session { directions, ..self }
    }

    /// Takes a slot and what is known of it; the row that is finished, if one is.
    ///
    /// # Errors
    /// A slot that the core cannot take: of a pad that the profile does not serve, with other than one
    /// code per channel and sample, with a code that the ADC does not have, with phasors at fidelity `clock`.
    /// The core stays as it was.
    pub fn slot(&mut self, slot: &Slot, truth: Option<Truth>) -> Result<Option<Row>> {
        self.check(slot)?;
        if let Some(errors) = &mut self.errors {
            errors.slot(slot);
        }
        let reference = self.refer(slot);
        let measured = reference.map_or(Quantities::default(), |reference| reference.quantities);
        self.waiting.push_back(Row {
            case: self.case,
            time_s: self.clock.tick(),
            pad: slot.pad,
            measured,
            flags: String::new(),
            laws: None,
            truth,
            driven: None,
            game: None,
            reference,
        });
        let Some(measurement) = self.engine.slot(slot) else { return Ok(None) };
        self.finished(&measurement)
    }

    /// Whether the core takes a slot.
    ///
    /// # Errors
    /// As [`Session::slot`].
    pub fn check(&self, slot: &Slot) -> Result<()> {
        self.check_pad(slot.pad)?;
        let [window, whole] = self.lengths;
        let (got, expected) = match &slot.signals {
            Signals::Samples { codes, .. } if self.takes_whole => (codes.len(), whole),
            Signals::Samples { codes, blanking } => (codes.len().saturating_sub(*blanking), window),
            Signals::Phasors { amplitudes, .. } => {
                ensure!(
                    self.takes_phasors,
                    "slot: expected samples at fidelity clock, got phasors"
                );
                (amplitudes.len(), self.channels - 1)
            }
        };
        ensure!(got == expected, "slot: expected {expected} numbers, got {got}");
        match &slot.signals {
            Signals::Samples { codes, .. } => self.check_codes(codes),
            Signals::Phasors { .. } => Ok(()),
        }
    }

    fn check_codes(&self, codes: &[i32]) -> Result<()> {
        let [least, most] = self.codes;
        let ends = codes.iter().fold([0, 0], |[low, high], code| [low.min(*code), high.max(*code)]);
        if let Some(code) =
            ends.map(i64::from).into_iter().find(|code| !(least..=most).contains(code))
        {
            bail!("codes: expected {least} to {most}, the codes of the ADC, got {code}");
        }
        Ok(())
    }

    fn check_pad(&self, pad: usize) -> Result<()> {
        ensure!(pad < self.pads, "pad: expected below {}, got {pad}", self.pads);
        Ok(())
    }

    /// Sets the target force of a pad, N, from its next slot on.
    ///
    /// # Errors
    /// A pad that the profile does not serve.
    pub fn set_target(&mut self, pad: usize, newtons: f64) -> Result<()> {
        self.check_pad(pad)?;
        self.engine.set_target(pad, newtons);
        Ok(())
    }

    /// Sets where the wall that is known by this number begins, from the pad's next slot on.
    ///
    /// # Errors
    /// As [`Session::set_target`].
    pub fn set_surface(&mut self, pad: usize, surface: Surface) -> Result<()> {
        self.check_pad(pad)?;
        self.engine.set_surface(pad, surface);
        Ok(())
    }

    /// The drive of the last slot's pad, where there is a controller.
    pub fn take_drive(&mut self) -> Option<Drive> {
        self.engine.take_drive()
    }

    /// The force of the last row as the core measured it, N, where the host takes crosstalk out of its frames.
    pub fn core_force_n(&self) -> Option<f64> {
        self.core_n
    }

    /// The last row, where it is still to come.
    ///
    /// # Errors
    /// Slots that were not of the pads in turn, as a core at fidelity `clock` takes them.
    pub fn finish(&mut self) -> Result<Option<Row>> {
        let Some(measurement) = self.engine.finish() else { return Ok(None) };
        self.finished(&measurement)
    }

    /// Rounding errors, where they were asked for.
    pub fn errors(&self) -> Vec<SignalError> {
        self.errors.as_ref().map(Errors::largest).unwrap_or_default()
    }

    fn refer(&mut self, slot: &Slot) -> Option<Reference> {
        let reference = self.reference.as_mut()?;
        let measurement = slot.refer(reference);
        let capacitance_pf = reference.capacitance_eq6();
        let ratio = capacitance_pf / measurement.capacitance_pf;
        let (mut quantities, _) = self.readouts[1].convert(&measurement);
        if let Some(directions) = &mut self.directions[1] {
            directions.complete(measurement.pad, &mut quantities);
        }
        Some(Reference {
            quantities,
            capacitance_eq6_pf: capacitance_pf,
            force_eq6_n: if measurement.capacitance_pf > 0.0 {
                measurement.force_n * ratio * ratio
            } else {
                0.0
            },
        })
    }

    fn finished(&mut self, measurement: &Measurement) -> Result<Option<Row>> {
        let Some(row) = self.waiting.pop_front() else { return Ok(None) };
        ensure!(
            row.pad == measurement.pad,
            "slot: expected the pads in turn, as a core at fidelity clock takes them: pad {}, got {}",
            measurement.pad,
            row.pad
        );
        self.core_n = self.cancels.then_some(measurement.force_n);
        let (mut measured, flags) = self.readouts[0].convert(measurement);
        if let Some(directions) = &mut self.directions[0] {
            directions.complete(measurement.pad, &mut measured);
        }
        let laws = self.laws.as_mut().map(|laws| laws.forces(measurement));
        Ok(Some(Row { measured, flags, laws, ..row }))
    }
}
