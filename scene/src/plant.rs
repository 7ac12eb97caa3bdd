// SPDX-License-Identifier: MIT OR Apache-2.0
//! One case of a scene at work: the truth, the phasors and the ADC samples, slot by slot.
//!
//! Slot s serves pad s mod pads, or that part of a pad where each has slots of its own. Its sample n is taken at (s·slot_samples + n)/sample rate; the
//! carrier starts afresh at n = 0. A pad is held for the whole slot as it is in the middle of the
//! slot's window. Effects may have a state, which moves through all of time, whichever pad is
//! served: ask for slots in rising order. Slots may go on after the case's end, without a limit:
//! timelines hold their last value, sweeps begin again.

mod calibrating;
mod inputs;

use std::ops::Range;

use num_complex::Complex64;

use crate::case::{Case, Length};
use crate::device::Device;
use crate::drive::{Electrode, PadDrive};
use crate::effects::{EffectCost, Effects, Pad, Phasors, Run, SPLITTING, Setting};
use crate::error::{Place, SceneError};
use crate::nominal::NominalSheet;
use crate::pad::resting;
use crate::pad_inputs::PadInputs;
use crate::ratios::{self, Ratios};
use crate::scene::Scene;
use crate::stimulus::Moment;
use crate::timing::Timing;
use crate::truth::Truth;

/// A slot that a plant has evaluated: the pad that it selects, on which all effects have acted.
#[derive(Clone, Debug)]
pub struct Slot {
    slot: usize,
    pad: Pad,
}

/// One case of a scene at work.
///
/// ```
/// use hapticore_scene::{Plant, Scene, Timing, gallery};
///
/// let scene = Scene::parse(gallery::find("minimal-gap").unwrap(), "minimal-gap.toml", &[])?;
/// # let timing = Timing {
/// #     pads: 4, slot_samples: 1700, window_start: 700, window_samples: 1000, samples_per_period: 10.0, signs: None,
/// # };
/// let mut plant = Plant::new(&scene, 0, &timing)?.metered();
/// for slot in 0..10 {
///     let truth = plant.truth(slot);
///     assert!(truth.capacitance_pf > 300.0 && truth.force_n >= 0.0);
/// }
/// let gap = plant.effects().into_iter().find(|effect| effect.name == "gap").unwrap();
/// assert_eq!((gap.level.as_str(), gap.evaluations), ("tr-bdf2 100 µs", 10));
/// # Ok::<(), hapticore_scene::SceneError>(())
/// ```
pub struct Plant {
    case: Case,
    device: Device,
    timing: Timing,
    seed: u64,
    index: usize,
    ratios: Ratios,
    effects: Effects,
    /// What has been set in place of what the scene says, for each pad; empty where nothing has been set.
    inputs: Vec<PadInputs>,
    /// The latest time that was asked for.
    latest_s: f64,
    /// The pads that the slot does not serve, where effects ask for them.
    others: Vec<Pad>,
    /// The slot last asked for, so that truth, phasors and samples of a slot are of one evaluation.
    now: (Option<usize>, Pad),
}

impl Plant {
    /// Sets up case number `case` of a scene for a profile's timing.
    ///
    /// # Errors
    /// A scene with more pads than the profile serves, a timing without a window, no such case, an
    /// error budget for which no levels have been [chosen](Scene::within_budget).
    pub fn new(scene: &Scene, case: usize, timing: &Timing) -> Result<Plant, SceneError> {
        let fail = |key: &str, message: String| {
            SceneError::new(Place::File, key, message).in_file(&scene.file)
        };
        let Some(chosen) = scene.cases.get(case) else {
            return Err(fail(
                "case",
                format!("expected a case below {}, got {case}", scene.cases.len()),
            ));
        };
        // Parts of a pad that is served part by part have slots beyond the profile's.
        if chosen.pads.len() > timing.pads {
            let (pads, name) = (chosen.pads.len(), &scene.profile);
            return Err(fail(
                "pad",
                format!(
                    "expected at most {} pads, as profile {name} serves, got {pads}",
                    timing.pads
                ),
            ));
        }
        if chosen.budget_percent.is_some() {
            return Err(fail(
                "error_budget_percent",
                "expected levels that have been chosen within it".to_string(),
            ));
        }
        Plant::of_case(chosen.clone(), scene.seed, case, timing)
            .map_err(|error| error.in_file(&scene.file))
    }

    pub(crate) fn of_case(
        case: Case,
        seed: u64,
        index: usize,
        timing: &Timing,
    ) -> Result<Plant, SceneError> {
        timing.check().map_err(|message| SceneError::new(Place::File, "profile", message))?;
        let device = case.device.clone().sampled(timing);
        let setting = Setting { device: &device, timing, seed, case: index };
        let effects = Effects::build(&case.effects, &setting);
        let now = (None, resting([0.0; 2], 0.0, 0.0, &device));
        let ratios = ratios::of_device(&device, timing.signs.as_ref());
        let ratios = ratios.map_err(|message| SceneError::new(Place::File, "profile", message))?;
        let (timing, inputs, others) = (timing.clone(), Vec::new(), Vec::new());
        let plant = Plant {
            effects,
            ratios,
            case,
            device,
            timing,
            seed,
            index,
            inputs,
            latest_s: 0.0,
            others,
            now,
        };
        plant.check_limited_levels()?;
        Ok(plant)
    }

    /// Asks levels that refuse some scenes, at slots spread evenly over the case, each pad in turn.
    fn check_limited_levels(&self) -> Result<(), SceneError> {
        const ASKED: usize = 256;
        if !self.case.effects.iter().any(|effect| effect.level().limited) {
            return Ok(());
        }
        let mut effects = self.fresh_effects();
        let slots = self.slots();
        for slot in (0..slots).step_by(slots.div_ceil(ASKED).max(1)) {
            for index in 0..self.case.pads.len() {
                let drive = self.drive(index);
                let mut pad = drive.pad(Moment::at(self.time_s(slot)));
                effects.on_pad(&mut pad, &drive);
                if let Some((n, why)) = effects.refusal(&pad) {
                    return Err(SceneError::new(
                        Place::File,
                        format!("{}.rung", self.case.effects[n].name),
                        why,
                    ));
                }
            }
        }
        Ok(())
    }

    /// The plant as it was when the device was calibrated; none where it has not changed since.
    ///
    /// ```
    /// # use hapticore_scene::{Plant, Scene, Timing};
    /// # let timing = Timing {
    /// #     pads: 4, slot_samples: 1700, window_start: 700, window_samples: 1000, samples_per_period: 10.0, signs: None,
    /// # };
    /// let text = "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n[device]\nmu = 0.3\n\
    ///             [calibration]\nset = { \"device.mu\" = 0.12 }\n";
    /// let plant = Plant::new(&Scene::parse(text, "worn.toml", &[])?, 0, &timing)?;
    /// let before = plant.as_calibrated()?.expect("it has changed");
    /// assert_eq!((plant.device().mu, before.device().mu), (0.3, 0.12));
    /// # Ok::<(), hapticore_scene::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Plant::new`].
    pub fn as_calibrated(&self) -> Result<Option<Plant>, SceneError> {
        let Some(case) = &self.case.calibrated else { return Ok(None) };
        Plant::of_case((**case).clone(), self.seed, self.index, &self.timing).map(Some)
    }

    /// The same, which stays at the first point of its sweep, where it has one: for a device that a user has before them.
    ///
    /// ```
    /// # use hapticore_scene::{Plant, Scene, Timing};
    /// # let timing = Timing {
    /// #     pads: 4, slot_samples: 1700, window_start: 700, window_samples: 1000, samples_per_period: 10.0, signs: None,
    /// # };
    /// let text = "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\ncapacitance_pf = { sweep = [100, 200] }\n";
    /// let mut plant = Plant::new(&Scene::parse(text, "t.toml", &[])?, 0, &timing)?.at_first_point();
    /// assert_eq!([0, 1, 2].map(|slot| plant.truth(slot).capacitance_pf), [100.0; 3]);
    /// # Ok::<(), hapticore_scene::SceneError>(())
    /// ```
    pub fn at_first_point(mut self) -> Plant {
        if matches!(self.case.length, Length::Sweep { .. }) {
            self.case.length = Length::Time { duration_s: f64::INFINITY };
        }
        self
    }

    /// Whether a sheet divides the currents; without one only those of the corners flow.
    pub fn has_sheet(&self) -> bool {
        self.case.effects().iter().any(|(effect, _)| SPLITTING.contains(effect))
    }

    /// The nominal sheet that a host of this device takes crosstalk out by; none where the case
    /// does not ask for it.
    pub fn nominal_sheet(&self) -> Option<NominalSheet> {
        let nominal = self.case.nominal.as_ref()?;
        let effects = Effects::build(nominal, &self.setting());
        Some(NominalSheet { effects, device: self.device(), ratios: self.ratios.clone() })
    }

    /// Effects of their own, for what must leave the run as it was.
    pub(crate) fn fresh_effects(&self) -> Effects {
        Effects::build(&self.case.effects, &self.setting())
    }

    /// The effects of the case without one of them, before anything has happened.
    pub(crate) fn effects_but(&self, name: &str) -> Effects {
        let others: Vec<_> =
            self.case.effects.iter().filter(|effect| effect.name != name).cloned().collect();
        Effects::build(&others, &self.setting())
    }

    fn setting(&self) -> Setting<'_> {
        Setting { device: &self.device, timing: &self.timing, seed: self.seed, case: self.index }
    }

    /// The ratios that truth tells.
    #[cfg(test)]
    pub(crate) fn ratios(&self) -> Ratios {
        self.ratios.clone()
    }

    /// The same plant, which counts and times every evaluation of an effect.
    pub fn metered(mut self) -> Plant {
        self.effects.metered(&self.case.effects);
        self
    }

    /// Finished slots of this case. Later ones may be asked for, too.
    pub fn slots(&self) -> usize {
        self.case.slots(&self.timing)
    }

    /// Number of ADC channels: terminals, sensing voltage, haptic voltage.
    pub fn channels(&self) -> usize {
        self.device.channels()
    }

    /// Where the terminals are, mm from the sheet's centre, in the order of their channels.
    pub fn terminals(&self) -> &[[f64; 2]] {
        &self.device.terminals_mm
    }

    /// What a calibration may know.
    pub fn device(&self) -> Device {
        self.device.clone()
    }

    /// How many pads a core serves: the scene's, or the parts of them that have slots of their own.
    pub fn served(&self) -> usize {
        self.case.pads.len() * self.parts()
    }

    /// The parts of each pad that have slots of their own; one where it is served as a whole.
    pub fn parts(&self) -> usize {
        self.case.parts()
    }

    /// Where they lie, mm right of the pad's centre and above it.
    pub fn parts_mm(&self) -> &[[f64; 2]] {
        &self.case.parts_mm
    }

    /// The pads' names, in the order of their slots.
    pub fn pad_names(&self) -> Vec<&str> {
        self.case.pad_names()
    }

    /// What each effect has cost so far, in the order in which they act; nothing where the plant is
    /// not [metered](Plant::metered).
    pub fn effects(&self) -> Vec<EffectCost> {
        self.effects.costs()
    }

    /// The force that a controller shall give a pad at a time, N; 0 where the scene has none.
    ///
    /// # Panics
    /// Where there is no such pad.
    pub fn target_n(&self, pad: usize, time_s: f64) -> f64 {
        self.case.pads[pad / self.parts()].target_n(Moment::at(time_s))
    }

    /// The largest force that a controller shall give each pad, N.
    pub fn largest_targets_n(&self) -> Vec<f64> {
        self.case.pads.iter().map(|pad| pad.largest_target_n()).collect()
    }

    /// The mean load of the case's pads, each halfway between its least and its largest, g.
    pub fn mean_load_g(&self) -> f64 {
        let loads_g = self.case.pads.iter().map(|pad| pad.middle_load_g());
        loads_g.sum::<f64>() / self.case.pads.len() as f64
    }

    /// The plant in a slot.
    pub fn truth(&mut self, slot: usize) -> Truth {
        self.look(slot);
        let (pad, point) = (&self.now.1, self.point(slot));
        let [r_x, r_y] = self.ratios.of_amplitudes(&pad.amplitudes());
        Truth {
            time_s: pad.time_s,
            pad: pad.index * self.parts() + pad.part.unwrap_or(0),
            part: pad.part.unwrap_or(0),
            point,
            group: self.case.pads[pad.index].group(point),
            r_x,
            r_y,
            x_mm: pad.x_mm,
            y_mm: pad.y_mm,
            capacitance_pf: pad.capacitance_f * 1e12,
            sheet_ohm: pad.sheet_ohm.re,
            haptic_v_rms: pad.haptic_v_rms,
            force_n: pad.haptic_force_n(&self.device),
            friction_n: pad.friction_n,
            haptic_friction_n: self.haptic_friction_n(pad),
            hand_n: pad.hand_n,
            electrodes_pf: pad.electrodes_f.map(|farad| farad * 1e12),
            direction: pad.direction,
            load_g: pad.load_g,
            set: self.drive(pad.index).set(Moment::at(pad.time_s)),
            over_edge: pad.over_edge,
            touching: pad.touching,
        }
    }

    /// What of a pad's friction is the haptic force's.
    fn haptic_friction_n(&self, pad: &Pad) -> f64 {
        let of_load_n = self.device.mu * self.device.weight_n(pad.load_g);
        (pad.friction_n - of_load_n).clamp(0.0, pad.haptic_force_n(&self.device))
    }

    /// What an ideal demodulator over the slot's window finds, as fractions of full scale: one
    /// amplitude per terminal, then the sensing voltage's, into `out` (channels − 1 of them).
    /// Returns the mean square of the haptic channel.
    ///
    /// # Panics
    /// If `out` is shorter than that.
    pub fn phasors(&mut self, slot: usize, out: &mut [Complex64]) -> f64 {
        let at = self.slot(slot);
        self.phasors_of(&at, out)
    }

    /// As [`Plant::phasors`], of a slot that this or another plant of the case has evaluated.
    ///
    /// # Panics
    /// As [`Plant::phasors`].
    pub fn phasors_of(&mut self, Slot { slot, pad }: &Slot, out: &mut [Complex64]) -> f64 {
        let mut phasors = Phasors { slot: *slot as u64, ..Phasors::default() };
        self.effects.on_channels(|effect| effect.phasors(pad, &mut phasors));
        out[..phasors.carrier.len()].copy_from_slice(&phasors.carrier);
        phasors.haptic_mean_square
    }

    /// ADC samples of a run within the slot, appended to `out`: for each instant the terminals, the
    /// sensing voltage and the haptic voltage, as fractions of full scale in [−1, 1].
    ///
    /// The noise of a run depends on where it starts, not on which runs were asked for before. Take
    /// the blanking part and the window whole, so that it is the same each time.
    pub fn samples(&mut self, slot: usize, range: Range<usize>, out: &mut Vec<f64>) {
        let (at, start) = (self.slot(slot), out.len());
        out.resize(start + range.len() * self.channels(), 0.0);
        self.samples_of(&at, range, &mut out[start..]);
    }

    /// As [`Plant::samples`], in place of others, of a slot that this or another plant of the case has
    /// evaluated. They follow from the slot alone, so that several plants can generate the samples of
    /// different slots in parallel.
    ///
    /// ```
    /// # use hapticore_scene::{Plant, Scene, Timing};
    /// # let text = "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n[sensor]\nnoise_ppm_rms = 18\n";
    /// # let scene = Scene::parse(text, "t.toml", &[])?;
    /// # let timing = Timing {
    /// #     pads: 4, slot_samples: 1700, window_start: 700, window_samples: 1000, samples_per_period: 10.0, signs: None,
    /// # };
    /// let plant = || Plant::new(&scene, 0, &timing);
    /// let (mut looking, mut sampling) = (plant()?, plant()?);
    /// let (mut samples, mut same) = (vec![0.0; 8 * 1000], Vec::new());
    /// sampling.samples_of(&looking.slot(5), 700..1700, &mut samples);
    /// looking.samples(5, 700..1700, &mut same);
    /// assert_eq!(samples, same);
    /// # Ok::<(), hapticore_scene::SceneError>(())
    /// ```
    ///
    /// # Panics
    /// Where `out` is not one number per channel and sample.
    pub fn samples_of(&mut self, Slot { slot, pad }: &Slot, range: Range<usize>, out: &mut [f64]) {
        assert_eq!(out.len(), range.len() * self.channels(), "a number a channel and sample");
        let slot_start = (slot * self.timing.slot_samples) as u64;
        let run = Run { slot: *slot, range, slot_start, channels: self.channels() };
        self.effects.on_channels(|effect| effect.samples(pad, &run, out));
        if self.effects.clip() {
            return;
        }
        out.iter_mut().for_each(|sample| *sample = sample.clamp(-1.0, 1.0));
    }

    /// Evaluates a slot, for a plant that generates its samples.
    pub fn slot(&mut self, slot: usize) -> Slot {
        self.look(slot);
        Slot { slot, pad: self.now.1.clone() }
    }

    /// The middle of a slot's window.
    fn time_s(&self, slot: usize) -> f64 {
        let middle = self.timing.window_start as f64 + self.timing.window_samples as f64 / 2.0;
        ((slot * self.timing.slot_samples) as f64 + middle) / self.device.sample_rate_hz
    }

    /// The point of the sweep in a slot.
    fn point(&self, slot: usize) -> usize {
        match self.case.length {
            Length::Sweep { dwell_slots, .. } => slot / self.served() / dwell_slots,
            Length::Time { .. } => 0,
        }
    }

    /// Lets the effects act on the pad that a slot serves, if they have not yet.
    fn look(&mut self, slot: usize) {
        if self.now.0 == Some(slot) {
            return;
        }
        let time_s = self.time_s(slot);
        let served = slot % self.served();
        let parts = self.parts();
        let (index, part) = (served / parts, (parts > 1).then_some(served % parts));
        self.latest_s = self.latest_s.max(time_s);
        self.now = (Some(slot), self.alone(index, part, time_s));
        if self.effects.joins_pads() {
            let mut others = std::mem::take(&mut self.others);
            others.clear();
            let indices = (0..self.case.pads.len()).filter(|other| *other != index);
            others.extend(indices.map(|other| self.alone(other, None, time_s)));
            self.effects.on_pads(&mut self.now.1, &others);
            self.others = others;
        }
    }

    /// A pad as if it were the only one.
    fn alone(&mut self, index: usize, part: Option<usize>, time_s: f64) -> Pad {
        let drive = drive(&self.case, &self.timing, &self.device, &self.inputs, index);
        let mut pad = Pad { part, ..drive.pad(Moment::at(time_s)) };
        self.effects.on_pad(&mut pad, &drive);
        if let Some(inputs) = self.inputs.get_mut(index) {
            inputs.forget(time_s);
        }
        pad
    }

    /// What is done to a pad.
    fn drive(&self, index: usize) -> PadDrive<'_> {
        drive(&self.case, &self.timing, &self.device, &self.inputs, index)
    }
}

fn drive<'a>(
    case: &'a Case,
    timing: &Timing,
    device: &'a Device,
    inputs: &'a [PadInputs],
    index: usize,
) -> PadDrive<'a> {
    let point_s = match case.length {
        Length::Sweep { dwell_slots, .. } => {
            let slots = dwell_slots * case.pads.len() * case.parts_mm.len();
            (slots * timing.slot_samples) as f64 / device.sample_rate_hz
        }
        Length::Time { .. } => f64::INFINITY,
    };
    let plan = &case.pads[index];
    let inputs = inputs.get(index);
    PadDrive { index, plan, point_s, inputs, device, electrode: Electrode::WHOLE }
}
