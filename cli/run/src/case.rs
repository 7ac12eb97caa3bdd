// SPDX-License-Identifier: MIT OR Apache-2.0
//! A case of a scene, run: its samples are made on one thread while the core works on another.
//!
//! The plant's samples depend on the slot alone, so that results do not depend on threads.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;

use anyhow::{Result, ensure};
use hapticore_contract::control::Tuning;
use hapticore_contract::profile::{ForceLaw, Profile};
use hapticore_host::profile::{for_terminals, serving};
use hapticore_host::{CrosstalkCanceller, DeviceCalibration, Residual, SlotClock, quantities_of};
use hapticore_scene::{
    Complex, EffectCost, Figure, LevelDeviation, Plant, Scene, Truth, signs_by_place,
};

use crate::calibrate;
use crate::capture::Recorder;
use crate::control::plant::LoopPlant;
use crate::control::{self, controlled};
use crate::digitiser::Digitiser;
use crate::engine::{Fidelity, Signals, Slot};
use crate::inputs::{buildable, timing};
use crate::interrupt;
use crate::record::{self, Row, SignalError};
use crate::session::Session;

/// Slots made ahead of the core.
const AHEAD: usize = 8;

/// Figures that show the force by eq. 8 and by the table side by side.
const BOTH: [Figure; 2] = [Figure::Fig6, Figure::Fig7];

/// A case, ready to be run.
pub struct Case<'a> {
    /// Scene that the case belongs to.
    pub scene: &'a Scene,
    /// Which of the scene's cases it is.
    pub index: usize,
    /// Which of the cases that are run it is.
    pub number: usize,
    /// The profile of a core that serves the pads of the case.
    pub profile: Arc<Profile>,
    /// The device's calibration.
    pub device: DeviceCalibration,
    /// Number of slots of the case.
    pub slots: usize,
    /// The time of each slot.
    pub clock: SlotClock,
}

/// What a case left.
pub struct Outcome {
    /// One row per finished slot.
    pub rows: Vec<Row>,
    /// Effects and what they cost.
    pub effects: Vec<EffectCost>,
    /// The largest sample, as a fraction of full scale.
    pub peak: f64,
    /// Rounding errors, where they were asked for.
    pub errors: Vec<SignalError>,
    /// What the position table leaves of its own places.
    pub residual: Residual,
}

/// How to run cases.
pub struct Settings {
    /// How exactly the core is run.
    pub fidelity: Fidelity,
    /// Whether rounding errors are asked for.
    pub errors: bool,
}

/// A slot on its way to the core.
struct Made {
    slot: Slot,
    truth: Truth,
    peak: f64,
}

impl<'a> Case<'a> {
    /// Case `index` of the scene, the `number`th to be run, from `start_s` on.
    ///
    /// # Errors
    /// A case that the profile cannot serve.
    pub fn new(
        scene: &'a Scene,
        index: usize,
        number: usize,
        profile: &Profile,
        start_s: f64,
    ) -> Result<Self> {
        let device = &scene.cases[index].device;
        let signs = signs_by_place(&device.terminals_mm, [device.width_mm, device.height_mm]);
        let control = scene.cases[index].control.as_ref();
        let profile = for_terminals(profile, &signs)?;
        let profile =
            buildable(control.map_or(profile.clone(), |plan| controlled(&profile, plan)))?;
        let plant = Plant::new(scene, index, &timing(&profile))?;
        let pads = plant.pad_names().len();
        let profile = Arc::new(serving(&profile, pads));
        let calibrated = plant.as_calibrated()?;
        let mut device = calibrate::of_plant(calibrated.as_ref().unwrap_or(&plant), &profile);
        if profile.force.law == ForceLaw::Table || scene.figure.is_some_and(|of| BOTH.contains(&of))
        {
            let document = &scene.cases[index].document;
            device.force = Some(calibrate::force_table(document, device.device.force_k)?);
        }
        let clock = SlotClock::new(&profile, device.device.sample_rate_hz, start_s);
        Ok(Case { scene, index, number, profile, device, slots: plant.slots(), clock })
    }

    /// Name of the case, as the scene gives it.
    pub fn name(&self) -> &str {
        &self.scene.cases[self.index].name
    }

    /// When the case begins.
    pub fn start_s(&self) -> f64 {
        self.clock.start_s()
    }

    /// Simulated time of the case, s.
    pub fn seconds(&self) -> f64 {
        self.clock.seconds(self.slots)
    }

    /// The plant, before its first slot.
    ///
    /// # Errors
    /// As [`Case::new`].
    pub fn plant(&self) -> Result<Plant> {
        Ok(Plant::new(self.scene, self.index, &timing(&self.profile))?)
    }

    /// Checks that a core at this fidelity can be given what the scene's carrier offers.
    ///
    /// # Errors
    /// Where the carrier has phasors only.
    pub fn check(&self, scene: &str, fidelity: Fidelity) -> Result<()> {
        let sampled = self.scene.cases[self.index].sampled();
        ensure!(
            sampled || fidelity != Fidelity::Clock,
            "{scene}: carrier.rung: expected \"samples\" for --core clock, got \"phasor\"; try --set carrier.rung=samples"
        );
        Ok(())
    }

    /// The case's levels, each with its error against a finer one.
    ///
    /// # Errors
    /// As [`Case::new`].
    pub fn level_deviations(&self) -> Result<Vec<LevelDeviation>> {
        Ok(self.scene.level_deviations(self.index, &timing(&self.profile))?)
    }

    /// Runs the case; `progress` is called at each slot.
    ///
    /// # Errors
    /// A calibration that the profile does not hold, a capture that cannot be written, an
    /// interruption.
    pub fn run(
        &self,
        settings: &Settings,
        recorder: Option<&mut (dyn Recorder + Send)>,
        progress: &(dyn Fn() + Sync),
    ) -> Result<Outcome> {
        let at = (self.number, self.clock);
        let plant = self.plant()?;
        let canceller =
            || Some(CrosstalkCanceller::calibrated(plant.nominal_sheet()?, &self.device));
        let cancellers = canceller().zip(canceller()).map(<[_; 2]>::from);
        let tuning = self.tuning(&plant)?;
        let fidelity = (settings.fidelity, tuning.as_ref());
        let session = Session::new(&self.profile, &self.device, fidelity, settings.errors, at)?
            .with_cancellers(cancellers);
        let whole = settings.fidelity == Fidelity::Clock || recorder.is_some();
        let mut maker = Maker::new(
            plant.metered(),
            &self.profile,
            self.scene.cases[self.index].sampled(),
            whole,
        );
        if tuning.is_some() {
            return self.close(session, maker, recorder, progress);
        }
        let (sender, receiver) = sync_channel(AHEAD);
        thread::scope(|scope| {
            let maker = scope.spawn(move || {
                maker.make(self.slots, &sender);
                maker.plant.effects()
            });
            let mut outcome = consume(session, receiver, recorder, progress)?;
            outcome.effects = maker.join().expect("the plant does not panic");
            Ok(outcome)
        })
    }
}

/// A force loop: the plant of a slot waits for the drives that follow from the slots before.
impl Case<'_> {
    /// The controller's tuning, where the scene has one.
    ///
    /// # Errors
    /// A gain that its word does not hold.
    pub fn tuning(&self, plant: &Plant) -> Result<Option<Tuning>> {
        let (Some(plan), Some(control)) =
            (&self.scene.cases[self.index].control, &self.profile.control)
        else {
            return Ok(None);
        };
        let calibrated = plant.as_calibrated()?;
        let at =
            (calibrated.as_ref().unwrap_or(plant), self.clock.seconds(plant.pad_names().len()));
        control::tuning(plan, control, &self.profile, &self.device, at).map(Some)
    }

    fn close(
        &self,
        mut session: Session,
        maker: Maker,
        mut recorder: Option<&mut (dyn Recorder + Send)>,
        progress: &(dyn Fn() + Sync),
    ) -> Result<Outcome> {
        let mut plant = LoopPlant::new(self, maker)?;
        let (mut rows, mut peak) = (Vec::new(), 0f64);
        for number in 0..self.slots {
            interrupt::check()?;
            let made = plant.slot(number);
            session.set_target(made.slot.pad, made.target_n);
            if let Some(recorder) = recorder.as_mut() {
                recorder.slot(made.slot.pad, made.slot.whole())?;
            }
            peak = peak.max(made.peak);
            let row = session.slot(&made.slot, Some(record_truth(&made.truth)));
            let Some(drive) = session.take_drive() else { continue };
            let driven = Some(plant.drive(&made, &drive)?);
            rows.extend(row.map(|row| Row { driven, ..row }));
            progress();
        }
        Ok(Outcome {
            rows,
            effects: plant.effects(),
            peak,
            errors: session.errors(),
            residual: session.residual(),
        })
    }
}

/// Takes slots to the core until there are no more.
fn consume(
    mut session: Session,
    slots: Receiver<Made>,
    mut recorder: Option<&mut (dyn Recorder + Send)>,
    progress: &(dyn Fn() + Sync),
) -> Result<Outcome> {
    let (mut rows, mut peak) = (Vec::new(), 0f64);
    for Made { slot, truth, peak: of_slot } in slots {
        interrupt::check()?;
        if let Some(recorder) = recorder.as_mut() {
            recorder.slot(slot.pad, slot.whole())?;
        }
        peak = peak.max(of_slot);
        rows.extend(session.slot(&slot, Some(record_truth(&truth))));
        progress();
    }
    rows.extend(session.finish());
    Ok(Outcome {
        rows,
        effects: Vec::new(),
        peak,
        errors: session.errors(),
        residual: session.residual(),
    })
}

/// What the record keeps of the plant's truth.
pub fn record_truth(truth: &Truth) -> record::Truth {
    let quantities = quantities_of!(truth);
    let Truth { load_g, friction_n, set, point, group, over_edge, touching, .. } = *truth;
    record::Truth { quantities, load_g, friction_n, set, point, group, over_edge, touching }
}

/// Produces the samples or amplitudes of slots in order.
pub struct Maker {
    plant: Plant,
    digitiser: Digitiser,
    sampled: bool,
    blanking: usize,
    samples: usize,
    whole: bool,
    fractions: Vec<f64>,
}

impl Maker {
    /// A maker of slots from a plant: with the samples of the blanking where `whole`.
    pub fn new(plant: Plant, profile: &Profile, sampled: bool, whole: bool) -> Self {
        let (blanking, samples) =
            (profile.slot.blanking() as usize, profile.slot.samples() as usize);
        let digitiser = Digitiser::new(profile.formats.adc);
        Maker { plant, digitiser, sampled, blanking, samples, whole, fractions: Vec::new() }
    }

    fn make(&mut self, slots: usize, to: &SyncSender<Made>) {
        for slot in 0..slots {
            let truth = self.plant.truth(slot);
            let (signals, peak) = self.signals(slot);
            let slot = Slot { pad: truth.pad, signals };
            if to.send(Made { slot, truth, peak }).is_err() {
                return; // The core has stopped: it tells why.
            }
        }
    }

    /// What the core is given of a slot, and the largest sample.
    pub fn signals(&mut self, slot: usize) -> (Signals, f64) {
        if self.sampled { self.sample(slot) } else { self.phasors(slot) }
    }

    /// The samples of a slot, and the largest.
    pub fn sample(&mut self, slot: usize) -> (Signals, f64) {
        let first = if self.whole { 0 } else { self.blanking };
        self.fractions.clear();
        if self.whole {
            self.plant.samples(slot, 0..self.blanking, &mut self.fractions);
        }
        self.plant.samples(slot, self.blanking..self.samples, &mut self.fractions);
        let mut codes = Vec::with_capacity(self.fractions.len());
        let peak = self.digitiser.codes(&self.fractions, &mut codes);
        let blanking = (self.blanking - first) * self.plant.channels();
        (Signals::Samples { codes, blanking }, peak)
    }

    /// Simulated device of the case.
    pub fn plant(&mut self) -> &mut Plant {
        &mut self.plant
    }

    fn phasors(&mut self, slot: usize) -> (Signals, f64) {
        let mut found = vec![Complex::default(); self.plant.channels() - 1];
        let mean_square = self.plant.phasors(slot, &mut found);
        let largest =
            found.iter().map(|phasor| phasor.norm()).fold((2.0 * mean_square).sqrt(), f64::max);
        let amplitudes = found.iter().map(|phasor| (phasor.re, phasor.im)).collect();
        (Signals::Phasors { amplitudes, mean_square }, largest)
    }
}
