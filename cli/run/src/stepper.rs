// SPDX-License-Identifier: MIT OR Apache-2.0
//! A case that is stepped slot by slot, with inputs while it runs. [`Case::run`] of a case with a
//! controller is a loop over it, so that both give the same rows.
//!
//! ```text
//! apply(input) ─┐
//! step() ─ plant ─ slot ─ core, controller, readout ─ row
//!            └───────── drive of the pad ──┘
//! ```
//!
//! Where the scene has an `[arena]`, the stepper is the game's host too: after each slot it plays on and sets targets and
//! walls of the pads (`stepper/arena.rs`).
//!
//! An input is applied between two slots: it takes effect when the next slot begins. A log of slot
//! numbers and inputs, applied to another stepper of the same case, gives the same rows to the bit.

use std::collections::VecDeque;
use std::sync::Arc;

use anyhow::{Result, bail};
use hapticore_contract::control::Surface;
use hapticore_contract::profile::Profile;
use hapticore_host::air_hockey::Game;
use hapticore_scene::{EffectCost, Plant, Scene, Timing};

use crate::case::{Case, OfPlant, record_truth};
use crate::control::plant::LoopPlant;
use crate::engine::{Signals, Slot};
use crate::findings::states::Limits;
use crate::inputs::{timing, windowed};
use crate::maker::Maker;
use crate::record::{Driven, Row, SignalError};
use crate::session::Session;

mod arena;
mod input;

pub use crate::session::Options;
use arena::Arena;
pub use input::{Input, InputError, RELEASE_S};

/// A case that is stepped slot by slot: plant, core, and what closes its force loop.
///
/// ```
/// use hapticore_run::engine::Fidelity;
/// use hapticore_run::inputs;
/// use hapticore_run::stepper::{Input, Options, Stepper};
/// # fn main() -> anyhow::Result<()> {
/// let scene = inputs::scene("hockey", &[])?;
/// let profile = inputs::profile(&scene.profile)?;
/// let options = Options { fidelity: Fidelity::Fixed, errors: false, reference: false };
/// let mut stepper = Stepper::new(scene.into(), 0, &profile, options)?;
/// let row = stepper.step()?.expect("a row per slot at this fidelity");
/// assert_eq!((row.pad, stepper.slot()), (0, 1));
/// stepper.apply(&Input::Lead { pad: 0, to_mm: [3.0, 150.0], within_s: 0.012 })?;
/// assert!(stepper.apply(&Input::Press { pad: 99, load_g: 60.0 }).is_err());
/// # Ok(())
/// # }
/// ```
pub struct Stepper {
    case: Case,
    options: Options,
    source: Source,
    session: Session,
    arena: Option<Arena>,
    limits: Option<Limits>,
    /// Drives are prompt; the row of a short slot comes while the next window is sampled.
    drives: VecDeque<Option<Driven>>,
    next: usize,
    last: Option<Slot>,
    peak: f64,
    failed: Option<String>,
}

/// What makes the slots: a plant that its scene drives, or its controller.
enum Source {
    Open(Box<Maker>),
    Closed(Box<LoopPlant>),
}

impl Source {
    fn plant(&self) -> &Plant {
        match self {
            Source::Open(maker) => maker.device(),
            Source::Closed(plant) => plant.device(),
        }
    }

    fn maker(&mut self) -> &mut Maker {
        match self {
            Source::Open(maker) => maker,
            Source::Closed(plant) => plant.maker(),
        }
    }
}

impl Stepper {
    /// Case `index` of a scene before its first slot, with the slot lengths and the effects' levels that
    /// the scene asks for, as `hapticore simulate` runs it.
    ///
    /// # Errors
    /// A case that the profile cannot serve, a calibration that it cannot represent, phasors at
    /// fidelity `clock`.
    pub fn new(
        scene: Arc<Scene>,
        index: usize,
        profile: &Profile,
        options: Options,
    ) -> Result<Stepper> {
        let profile = windowed(profile.clone(), &scene)?;
        let any_device = Timing { signs: None, ..timing(&profile) };
        let scene = Arc::new(Arc::unwrap_or_clone(scene).within_budget(&any_device)?);
        let case = Case::new(&scene, index, &profile, &[])?;
        case.check(&scene.name, options.fidelity)?;
        let plant = case.plant()?;
        Stepper::with_plant(case, plant, options, options.is_whole())
    }

    /// A case with a plant of it; `whole` where the samples of the blanking are asked for.
    pub(crate) fn with_plant(
        case: Case,
        plant: Plant,
        options: Options,
        whole: bool,
    ) -> Result<Stepper> {
        let tuning = case.tuning(&plant)?;
        let limits = case.limits(&plant)?;
        let of_scene = &case.scene.cases[case.index];
        let arena = of_scene.arena.as_ref();
        let arena = arena.map(|plan| Arena::new(plan, &of_scene.starts_mm(), plant.parts()));
        let session = case.session(OfPlant::new(&plant), tuning.as_ref(), options)?;
        let maker = case.maker(plant, whole);
        let source = match tuning {
            Some(_) => Source::Closed(Box::new(case.loop_plant(maker)?)),
            None => Source::Open(Box::new(maker)),
        };
        Ok(Stepper {
            case,
            options,
            source,
            session,
            arena,
            limits,
            drives: VecDeque::new(),
            next: 0,
            last: None,
            peak: 0.0,
            failed: None,
        })
    }

    /// The same case before its first slot, without an input. It shares what this one knows of the device.
    ///
    /// # Errors
    /// As [`Stepper::new`].
    pub fn restart(&self) -> Result<Stepper> {
        let plant = self.case.plant()?;
        Stepper::with_plant(self.case.clone(), plant, self.options, self.options.is_whole())
    }

    /// The case.
    pub fn case(&self) -> &Case {
        &self.case
    }

    /// The plant.
    pub fn plant(&self) -> &Plant {
        self.source.plant()
    }

    /// Runs the next slot. Returns the row that it finishes: at fidelity `clock` that of the slot
    /// before. Slots go on after the end of the case without a limit: timelines hold their last value,
    /// sweeps begin again.
    ///
    /// # Errors
    /// A result that is not finite. Every later step returns the same error.
    pub fn step(&mut self) -> Result<Option<Row>> {
        if let Some(why) = &self.failed {
            bail!("{why}");
        }
        let row = self.advance();
        self.failed = row.as_ref().err().map(|error| format!("{error:#}"));
        row
    }

    fn advance(&mut self) -> Result<Option<Row>> {
        if let Some(slot) = self.last.take() {
            self.source.maker().reuse(slot.signals);
        }
        let row = match self.source {
            Source::Open(_) => self.step_open()?,
            Source::Closed(_) => self.step_closed()?,
        };
        self.next += 1;
        Ok(row)
    }

    fn step_open(&mut self) -> Result<Option<Row>> {
        let maker = self.source.maker();
        let truth = maker.plant().truth(self.next);
        let (signals, peak) = maker.signals(self.next);
        let slot = Slot { pad: truth.pad, signals };
        let row = self.session.slot(&slot, Some(record_truth(&truth)))?;
        (self.peak, self.last) = (peak, Some(slot));
        row.map(|row| self.complete(row)).transpose()
    }

    fn step_closed(&mut self) -> Result<Option<Row>> {
        let Source::Closed(plant) = &mut self.source else { return Ok(None) };
        if let Some(arena) = &mut self.arena {
            let part = self.next % plant.device().served();
            arena.begin(part, self.case.clock.seconds(self.next + 1), plant.inputs());
        }
        let made = plant.slot(self.next);
        self.session.set_target(made.slot.pad, made.target_n)?;
        if let Some(surface) = made.surface {
            self.session.set_surface(made.slot.pad, surface)?;
        }
        let row = self.session.slot(&made.slot, Some(record_truth(&made.truth)))?;
        self.drives.push_back(plant.drive(&made, self.session.take_drive())?);
        (self.peak, self.last) = (made.peak, Some(made.slot));
        let row = row.map(|row| self.complete(row)).transpose()?;
        if let Some(arena) = &mut self.arena {
            arena.play(self.next);
        }
        Ok(row)
    }

    /// A row with its drive and what limits it.
    fn complete(&mut self, mut row: Row) -> Result<Row> {
        let core_n = self.session.core_force_n();
        let driven = self.drives.pop_front().flatten();
        row.driven = driven.map(|driven| Driven { core_n, ..driven });
        if let Some(arena) = &mut self.arena {
            arena.complete(&mut row);
        }
        if let Some(limits) = &mut self.limits {
            limits.mark(&mut row);
        }
        self.case.check_finite(&row)?;
        Ok(row)
    }

    /// The row of the last slot, where it is still to come. The case is over then.
    ///
    /// # Errors
    /// As [`Stepper::step`].
    pub fn finish(&mut self) -> Result<Option<Row>> {
        let row = self.session.finish()?;
        row.map(|row| self.complete(row)).transpose()
    }

    /// The number of the next slot.
    pub fn slot(&self) -> usize {
        self.next
    }

    /// When the next slot begins, s: the time of inputs.
    pub fn time_s(&self) -> f64 {
        self.case.clock.seconds(self.next)
    }

    /// The ADC codes of the last slot's window, shape (window, channels), row-major; none before the
    /// first slot, or where the carrier has phasors only.
    pub fn codes(&self) -> Option<&[i32]> {
        match &self.last.as_ref()?.signals {
            Signals::Samples { codes, blanking } => Some(&codes[*blanking..]),
            Signals::Phasors { .. } => None,
        }
    }

    /// The largest sample of each channel in the last slot, as a fraction of full scale; empty where there are
    /// no [codes](Self::codes).
    pub fn amplitudes(&self) -> Vec<f64> {
        let Some(codes) = self.codes() else { return Vec::new() };
        let profile = &self.case.profile;
        let mut largest = vec![0; profile.channels()];
        for sample in codes.chunks_exact(profile.channels()) {
            for (largest, code) in largest.iter_mut().zip(sample) {
                *largest = code.unsigned_abs().max(*largest);
            }
        }
        let lsb = profile.formats.adc.lsb();
        largest.into_iter().map(|code| f64::from(code) * lsb).collect()
    }

    /// What the core received of the last slot.
    pub(crate) fn last(&self) -> Option<&Slot> {
        self.last.as_ref()
    }

    /// The largest sample of the last slot, as a fraction of full scale.
    pub fn peak(&self) -> f64 {
        self.peak
    }

    /// Where the walls along x and y begin now, mm from the sheet's centre; none where there is no such
    /// wall, where it is off, or where each pad has [its own](Self::arena_walls).
    pub fn walls_mm(&self) -> [Option<f64>; 2] {
        match &self.source {
            Source::Closed(plant) if self.arena.is_none() => plant.walls_mm(self.time_s()),
            _ => [None; 2],
        }
    }

    /// The game, where the scene has an `[arena]`.
    pub fn game(&self) -> Option<&Game> {
        self.arena.as_ref().map(Arena::game)
    }

    /// The walls along x and y of a pad of the scene, where the scene has an `[arena]`.
    ///
    /// # Panics
    /// Where there is no such pad.
    pub fn arena_walls(&self, pad: usize) -> Option<[Surface; 2]> {
        self.arena.as_ref().map(|arena| arena.surfaces(pad))
    }

    /// Effects of the plant and what they cost, where it is metered.
    pub(crate) fn effects(&self) -> Vec<EffectCost> {
        self.plant().effects()
    }

    /// Rounding errors, where they were asked for.
    pub fn errors(&self) -> Vec<SignalError> {
        self.session.errors()
    }
}

/// It can be moved to a thread of its own.
const _: fn() = || {
    fn is_send<T: Send>() {}
    is_send::<Stepper>();
};
