// SPDX-License-Identifier: MIT OR Apache-2.0
//! A case of a scene, run: while the core works on some slots, workers generate the next ones (`prefetch.rs`).

use std::sync::{Arc, LazyLock, OnceLock};

use anyhow::{Result, bail, ensure};
use hapticore_contract::calibration::Calibration;
use hapticore_contract::control::Tuning;
use hapticore_contract::profile::{ForceLaw, Profile};
use hapticore_host::device::{DeviceWordsError, Force};
use hapticore_host::profile::{for_terminals, serving};
use hapticore_host::{
    CrosstalkCanceller, DeviceCalibration, QUANTITIES, Residual, SlotClock, quantities_of,
};
use hapticore_scene::{
    ControlPlan, EffectCost, Figure, LevelDeviation, NominalSheet, Plant, Scene, Truth,
    signs_by_place,
};

use crate::calibrate::{self, bench::Bench};
use crate::capture::Recorder;
use crate::control::plant::LoopPlant;
use crate::control::{self, Gains, controlled};
use crate::direction::Directions;
use crate::engine::Fidelity;
use crate::findings::states::Limits;
use crate::inputs::{buildable, timing};
use crate::interrupt;
use crate::maker::Maker;
use crate::prefetch::{PreparedSlot, prefetch};
use crate::record::{self, Row, SignalError};
use crate::session::{Options, Session};
use crate::stepper::Stepper;

/// Bytes of the slots that are generated ahead of the core.
const KEPT: usize = 8 << 20;

/// The most slots of all cases that are run: a row of each is kept until the end.
const MOST_SLOTS: usize = 10_000_000;

/// Figures that show the force by eq. 8 and by the table side by side.
const BOTH: [Figure; 2] = [Figure::Fig6, Figure::Fig7];

/// A case, ready to be run. Clones share what is known of the device and the controller's tuning.
#[derive(Clone)]
pub struct Case {
    /// Scene that the case belongs to.
    pub scene: Arc<Scene>,
    /// Which of the scene's cases it is.
    pub index: usize,
    /// Which of the cases that are run it is.
    pub number: usize,
    /// The profile of a core that serves the pads of the case.
    pub profile: Arc<Profile>,
    /// The device's calibration, one for all cases of a device.
    pub device: Arc<OnDemand<DeviceCalibration>>,
    /// Number of slots of the case.
    pub slots: usize,
    /// The time of each slot.
    pub clock: SlotClock,
    /// The device is calibrated for a force table.
    tabled: bool,
    /// What decides its forces then.
    bench: Option<Bench>,
    calibrated: Arc<Calibrated>,
    /// The controller's tuning, once it has been asked for.
    tuned: Arc<OnceLock<Option<(Gains, Tuning)>>>,
}

/// A value that is computed on first access. So a device is calibrated while other threads generate slots.
pub type OnDemand<T> = LazyLock<T, Box<dyn FnOnce() -> T + Send>>;

/// What cases of one device share, made when it is first asked for.
#[derive(Default)]
struct Calibrated {
    /// The device's calibration as words of the core.
    words: OnceLock<Result<Calibration, DeviceWordsError>>,
    /// What their position table leaves of its own places.
    residual: OnceLock<Residual>,
}

/// What a host knows of a plant, for the core and for the reference.
pub(crate) struct OfPlant {
    sheets: Option<[NominalSheet; 2]>,
    directions: [Option<Directions>; 2],
}

impl OfPlant {
    pub fn new(plant: &Plant) -> Self {
        OfPlant {
            sheets: plant.nominal_sheet().zip(plant.nominal_sheet()).map(Into::into),
            directions: [0, 1].map(|_| Directions::of(plant)),
        }
    }
}

/// What a case left.
#[derive(Default)]
pub struct Outcome {
    /// One row per finished slot.
    pub rows: Vec<Row>,
    /// Effects and what they cost.
    pub effects: Vec<EffectCost>,
    /// The largest sample, as a fraction of full scale.
    pub peak: f64,
    /// Rounding errors, where they were asked for.
    pub errors: Vec<SignalError>,
}

/// How to run cases.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Settings {
    /// How exactly the core is run.
    pub fidelity: Fidelity,
    /// Whether rounding errors are asked for.
    pub errors: bool,
}

impl Settings {
    /// The core with the floating-point reference on the same samples.
    pub(crate) fn options(&self) -> Options {
        Options { fidelity: self.fidelity, errors: self.errors, reference: true }
    }
}

impl Case {
    /// Case `index` of the scene, to be run after others: of a device that one of them has, the
    /// calibration is that one's.
    ///
    /// # Errors
    /// A number that the scene has no case of, a case that the profile cannot serve.
    pub fn new(
        scene: &Arc<Scene>,
        index: usize,
        profile: &Profile,
        others: &[Case],
    ) -> Result<Self> {
        ensure!(
            index < scene.cases.len(),
            "{}: case: expected below {}, got {index}",
            scene.name,
            scene.cases.len()
        );
        let device = &scene.cases[index].device;
        let signs = signs_by_place(&device.terminals_mm, [device.width_mm, device.height_mm]);
        let control = scene.cases[index].control.as_ref();
        let profile = for_terminals(profile, &signs)?;
        let plant = Plant::new(scene, index, &timing(&profile))?;
        let slots = plant.slots();
        let all = slots + others.iter().map(|other| other.slots).sum::<usize>();
        ensure!(
            all <= MOST_SLOTS,
            "{}: expected at most {MOST_SLOTS} slots of all cases, got {all}",
            scene.name
        );
        let profile = for_parts(serving(&profile, plant.served()), plant.parts());
        let rate_hz = plant.device().sample_rate_hz;
        let frame_s = (profile.slot.samples() as usize * plant.served()) as f64 / rate_hz;
        let profile = match control {
            Some(plan) => controlled(&profile, plan, (plant.parts(), frame_s))?,
            None => profile,
        };
        let profile = Arc::new(buildable(profile)?);
        ensure!(
            plant.parts() == 1 || profile.force.law == ForceLaw::Eq8,
            "control.force: expected \"eq8\" with halves.senses = \"each\", for a force table is of whole pads"
        );
        let tabled = profile.force.law == ForceLaw::Table
            || scene.figure.is_some_and(|figure| BOTH.contains(&figure));
        let bench = if tabled { Bench::of(&scene.cases[index].document)? } else { None };
        let start_s = others.iter().map(Case::seconds).sum();
        let clock = SlotClock::new(&profile, rate_hz, start_s);
        let device =
            calibrated((&scene.cases[index], plant), &profile, (tabled, bench.as_ref()), others)?;
        let uncontrolled = |of: &Profile| Profile { control: None, wall: None, ..of.clone() };
        let mut same = others.iter().filter(|other| {
            (Arc::ptr_eq(&other.device, &device) || **other.device == **device)
                && uncontrolled(&other.profile) == uncontrolled(&profile)
        });
        Ok(Case {
            calibrated: same.next().map(|same| same.calibrated.clone()).unwrap_or_default(),
            tuned: Arc::default(),
            number: others.len(),
            slots,
            scene: scene.clone(),
            index,
            profile,
            device,
            clock,
            tabled,
            bench,
        })
    }

    /// The device's calibration as words of the case's core.
    ///
    /// # Errors
    /// A number that the profile's formats do not hold, a map that no position table fits.
    pub fn calibration(&self) -> Result<&Calibration> {
        let words = self.calibrated.words.get_or_init(|| self.device.for_profile(&self.profile));
        words.as_ref().map_err(|error| error.clone().into())
    }

    /// What the position table of [`Case::calibration`] leaves of its own places.
    ///
    /// # Errors
    /// As [`Case::calibration`].
    pub fn residual(&self) -> Result<Residual> {
        let words = self.calibration()?;
        Ok(*self.calibrated.residual.get_or_init(|| self.device.residual(words)))
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
        Ok(Plant::new(&self.scene, self.index, &timing(&self.profile))?)
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
        if self.plan().is_some() {
            return self.close(settings, recorder, progress);
        }
        let options = settings.options();
        let plant = self.plant()?;
        let of_plant = OfPlant::new(&plant);
        let whole = options.is_whole() || recorder.is_some();
        let another = || self.maker(self.plant().expect("as the first").metered(), whole);
        let (plant, size) = (plant.metered(), (self.slots, self.kept(whole)));
        let (outcome, effects) = prefetch(plant, size, another, |slots| {
            // In here, so that the device is calibrated while workers generate slots.
            consume(self.session(of_plant, None, options)?, slots, recorder, progress)
        });
        let outcome = Outcome { effects, ..outcome? };
        outcome.rows.iter().try_for_each(|row| self.check_finite(row))?;
        Ok(outcome)
    }

    /// Refuses results that are no numbers: a plant whose parameters lead to them is none.
    pub(crate) fn check_finite(&self, row: &Row) -> Result<()> {
        let Some(of) = row.truth else { return Ok(()) };
        let own = [
            ("load_g", of.load_g),
            ("friction_n", of.friction_n),
            ("hand_x_n", of.hand_x_n),
            ("hand_y_n", of.hand_y_n),
        ];
        let named =
            QUANTITIES.iter().map(|quantity| (quantity.name, (quantity.get)(&of.quantities)));
        let Some((name, value)) = named.chain(own).find(|(_, value)| !value.is_finite()) else {
            return Ok(());
        };
        bail!(
            "{}: case \"{}\": expected a finite true_{name} of pad {}, got {value} at {} s; a key of the scene is \
             too large or too small",
            self.scene.file,
            self.name(),
            row.pad,
            row.time_s
        );
    }

    /// The core of the case, before its first slot.
    pub(crate) fn session(
        &self,
        OfPlant { sheets, directions }: OfPlant,
        tuning: Option<&Tuning>,
        options: Options,
    ) -> Result<Session> {
        let session = Session::new(
            &self.profile,
            (&**self.device, self.calibration()?),
            (options, tuning),
            (self.number, self.clock),
        )?;
        let canceller = |sheet| CrosstalkCanceller::calibrated(sheet, &self.device);
        let cancellers = sheets.map(|sheets| sheets.map(canceller));
        Ok(session.with_cancellers(cancellers).with_directions(directions))
    }

    /// The core of the case before its first slot, with the host's corrections and without its controller: for
    /// samples from elsewhere.
    ///
    /// # Errors
    /// A calibration that the profile cannot represent.
    pub fn core(&self, options: Options) -> Result<Session> {
        self.session(OfPlant::new(&self.plant()?), None, options)
    }

    /// What makes the slots of a plant; `whole` with the samples of the blanking.
    pub(crate) fn maker(&self, plant: Plant, whole: bool) -> Maker {
        let sampled = self.scene.cases[self.index].sampled();
        Maker::new(plant, &self.profile, sampled, whole)
    }

    /// Slots kept at most that are generated ahead: sixteen at least. They are whole, or their windows.
    fn kept(&self, whole: bool) -> usize {
        let slot = &self.profile.slot;
        let samples = if whole { slot.samples() } else { slot.integrate };
        let codes = samples as usize * self.profile.channels();
        (KEPT / (codes * size_of::<i32>())).max(16)
    }
}

/// The profile for pads that are served part by part: half a pad has half its capacitance, so that
/// the gain of (C·V)² is four times the pad's, that of a quadrant sixteen times.
fn for_parts(mut profile: Profile, parts: usize) -> Profile {
    profile.formats.force_gain.frac -= match parts {
        1 => 0,
        4 => 4,
        _ => 2,
    };
    profile
}

/// What is known of a case's device, with a force table or without; the same as of another case that has it.
fn calibrated(
    (case, plant): (&hapticore_scene::Case, Plant),
    profile: &Arc<Profile>,
    (tabled, bench): (bool, Option<&Bench>),
    others: &[Case],
) -> Result<Arc<OnDemand<DeviceCalibration>>> {
    let has_it = |other: &&Case| {
        case.has_device_of(&other.scene.cases[other.index])
            && timing(&other.profile) == timing(profile)
    };
    let mut same = others.iter().filter(has_it);
    if let Some(other) = same.clone().find(|other| other.tabled == tabled) {
        return Ok(other.device.clone());
    }
    let without = match same.next() {
        // It has the table that this case does not need.
        Some(other) if !tabled => {
            let device = other.device.clone();
            on_demand(move || DeviceCalibration { force: None, ..(**device).clone() })
        }
        Some(other) => other.device.clone(),
        None => {
            let (plant, profile) = (plant.as_calibrated()?.unwrap_or(plant), profile.clone());
            on_demand(move || calibrate::of_plant(&plant, &profile))
        }
    };
    if !tabled {
        return Ok(without);
    }
    let force = Some(force_table(bench, without.device.force_k, others)?);
    Ok(on_demand(move || DeviceCalibration { force, ..(**without).clone() }))
}

fn on_demand<T>(make: impl FnOnce() -> T + Send + 'static) -> Arc<OnDemand<T>> {
    Arc::new(LazyLock::new(Box::new(make)))
}

/// The force table of a device on its bench, or the same of another case.
fn force_table(bench: Option<&Bench>, force_k: f64, others: &[Case]) -> Result<Force> {
    let same = |other: &&Case| {
        bench.is_some() && other.bench.as_ref() == bench && other.device.device.force_k == force_k
    };
    let made = others.iter().find(same).and_then(|other| other.device.force.clone());
    made.map_or_else(|| calibrate::force_table(bench, force_k), Ok)
}

/// A force loop: the plant of a slot waits for the drives that follow from the slots before.
impl Case {
    /// The controller's tuning, where the scene has one.
    ///
    /// # Errors
    /// A gain that its word does not hold.
    pub fn tuning(&self, plant: &Plant) -> Result<Option<Tuning>> {
        Ok(self.tuned(plant)?.map(|(_, tuning)| tuning))
    }

    /// The controller's gains, those that the scene leaves open with what follows from device and profile; zero
    /// without a controller.
    ///
    /// # Errors
    /// As [`Case::tuning`].
    pub fn gains(&self) -> Result<Gains> {
        Ok(self.tuned(&self.plant()?)?.map_or(Gains::default(), |(gains, _)| gains))
    }

    fn tuned(&self, plant: &Plant) -> Result<Option<(Gains, Tuning)>> {
        if let Some(tuned) = self.tuned.get() {
            return Ok(tuned.clone());
        }
        let tuned = self.tune(plant)?;
        Ok(self.tuned.get_or_init(|| tuned).clone())
    }

    /// The tuning that the case was run with, where the scene has a controller and the case has been run.
    pub fn ran_with(&self) -> Option<&Tuning> {
        self.tuned.get()?.as_ref().map(|(_, tuning)| tuning)
    }

    fn tune(&self, plant: &Plant) -> Result<Option<(Gains, Tuning)>> {
        let (Some(plan), Some(control)) = (self.plan(), &self.profile.control) else {
            return Ok(None);
        };
        let most_n = control.target.real(control.target.max_code() as i64);
        for (key, force_n) in self.asked_forces(plan, plant) {
            ensure!(
                force_n <= most_n,
                "{key}: expected at most {most_n:.3} N, what the controller's word holds, got {force_n}"
            );
        }
        let calibrated = plant.as_calibrated()?;
        control::tuning(self, plan, calibrated.as_ref().unwrap_or(plant)).map(Some)
    }

    /// The largest force that each key of the scene asks of the controller, N.
    fn asked_forces(&self, plan: &ControlPlan, plant: &Plant) -> Vec<(String, f64)> {
        let targets = plant.largest_targets_n().into_iter().enumerate();
        let of_pads = targets.map(|(pad, target_n)| (format!("pad.{pad}.target_n"), target_n));
        let of_wall = plan.wall.iter().map(|wall| ("wall.force_n".to_owned(), wall.force_n));
        let arena = &self.scene.cases[self.index].arena;
        let of_arena = arena.iter().map(|arena| ("arena.force_n".to_owned(), arena.force_n));
        of_pads.chain(of_wall).chain(of_arena).collect()
    }

    /// The plant of the case's force loop, before its first slot: no pad is driven.
    ///
    /// # Errors
    /// A profile without a controller.
    pub fn loop_plant(&self, maker: Maker) -> Result<LoopPlant> {
        let full_scale_v = self.plan().map_or(0.0, |plan| plan.full_scale_v);
        let wall = self.plan().and_then(|plan| plan.wall.clone());
        LoopPlant::new(maker, &self.profile, (self.clock, full_scale_v), wall)
    }

    /// What keeps the drives from their targets, where the case has a controller.
    pub(crate) fn limits(&self, plant: &Plant) -> Result<Option<Limits>> {
        let tuning = self.tuning(plant)?;
        let (Some(plan), Some(control), Some(tuning)) =
            (self.plan(), &self.profile.control, tuning)
        else {
            return Ok(None);
        };
        let of_pads = (plant.parts(), self.clock.seconds(plant.served()));
        Ok(Some(Limits::new((plan.clone(), control), tuning, of_pads, plant.served())))
    }

    /// From a slot's end to the drive that follows from it, s.
    ///
    /// # Errors
    /// A profile without a controller.
    pub fn drive_latency_s(&self) -> Result<f64> {
        control::plant::latency_s(&self.profile, &self.clock)
    }

    /// What the scene asks of the controller, where it has one.
    pub fn plan(&self) -> Option<&ControlPlan> {
        self.scene.cases[self.index].control.as_ref()
    }

    fn close(
        &self,
        settings: &Settings,
        mut recorder: Option<&mut (dyn Recorder + Send)>,
        progress: &(dyn Fn() + Sync),
    ) -> Result<Outcome> {
        let options = settings.options();
        let whole = options.is_whole() || recorder.is_some();
        let mut stepper =
            Stepper::with_plant(self.clone(), self.plant()?.metered(), options, whole)?;
        let (mut rows, mut peak) = (Vec::new(), 0f64);
        for _ in 0..self.slots {
            interrupt::check()?;
            rows.extend(stepper.step()?);
            if let Some((recorder, slot)) = recorder.as_mut().zip(stepper.last()) {
                recorder.slot(slot.pad, slot.whole())?;
            }
            peak = peak.max(stepper.peak());
            progress();
        }
        rows.extend(stepper.finish()?);
        Ok(Outcome { rows, effects: stepper.effects(), peak, errors: stepper.errors() })
    }
}

/// Runs the core on slots of the plant.
fn consume(
    mut session: Session,
    slots: impl Iterator<Item = PreparedSlot>,
    mut recorder: Option<&mut (dyn Recorder + Send)>,
    progress: &(dyn Fn() + Sync),
) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    for PreparedSlot { slot, truth, peak } in slots {
        interrupt::check()?;
        if let Some(recorder) = recorder.as_mut() {
            recorder.slot(slot.pad, slot.whole())?;
        }
        outcome.peak = outcome.peak.max(peak);
        outcome.rows.extend(session.slot(&slot, Some(record_truth(&truth)))?);
        progress();
    }
    outcome.rows.extend(session.finish()?);
    outcome.errors = session.errors();
    Ok(outcome)
}

/// What the record keeps of the plant's truth.
pub fn record_truth(truth: &Truth) -> record::Truth {
    let quantities = quantities_of!(truth);
    record::Truth {
        quantities,
        load_g: truth.load_g,
        friction_n: truth.friction_n,
        haptic_friction_n: truth.haptic_friction_n,
        hand_x_n: truth.hand_n[0],
        hand_y_n: truth.hand_n[1],
        part: truth.part,
        set: truth.set,
        point: truth.point,
        group: truth.group,
        over_edge: truth.over_edge,
        touching: truth.touching,
    }
}
