// SPDX-License-Identifier: MIT OR Apache-2.0
//! One case of a scene at work: the truth, the phasors and the ADC samples, slot by slot.
//!
//! Slot s serves pad s mod pads. Its sample n is taken at (s·slot_samples + n)/sample rate; the carrier starts afresh at
//! n = 0. A pad is held for the whole slot as it is in the middle of the slot's window. Effects may have a state: ask for
//! slots in rising order.

use std::ops::Range;
use std::time::Instant;

use num_complex::Complex64;

use crate::device::{CHANNELS, Device};
use crate::effects::{ChannelEffect, Effect, Pad, Phasors, Run, Setting};
use crate::error::{Place, SceneError};
use crate::pad::resting;
use crate::path::raster;
use crate::scene::{Case, Length, Scene};

/// How the core divides its time, from its profile.
#[derive(Clone, Debug, PartialEq)]
pub struct Timing {
    /// Pads that the core can serve.
    pub pads: usize,
    /// ADC samples of a slot.
    pub slot_samples: usize,
    /// First sample of the integration window within the slot.
    pub window_start: usize,
    /// Samples of the integration window.
    pub window_samples: usize,
    /// ADC samples per carrier period.
    pub samples_per_period: f64,
}

/// The plant in one slot, at the middle of its integration window.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// Time since the start of the case, s.
    pub time_s: f64,
    /// The pad that the slot serves.
    pub pad: usize,
    /// Point of the sweep, 0 where nothing is swept.
    pub point: usize,
    /// Points that differ in position alone share a group.
    pub group: usize,
    /// Eq. 2 with the true currents.
    pub r_x: f64,
    /// Eq. 3 with the true currents.
    pub r_y: f64,
    /// Position, mm right of the sheet's centre.
    pub x_mm: f64,
    /// Position, mm above the sheet's centre.
    pub y_mm: f64,
    /// Capacitance between pad and sheet, pF.
    pub capacitance_pf: f64,
    /// Resistance R_p of the sheet at the pad, Ω.
    pub sheet_ohm: f64,
    /// Haptic voltage at the pad, V rms.
    pub haptic_v_rms: f64,
    /// Haptic force, N.
    pub force_n: f64,
    /// Direction of the push, eq. 10; 0 where no hand pushes.
    pub direction: f64,
    /// Load on the pad, g.
    pub load_g: f64,
}

/// A place of the calibration map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapPoint {
    /// Position, mm right of the sheet's centre.
    pub x_mm: f64,
    /// Position, mm above the sheet's centre.
    pub y_mm: f64,
    /// Eq. 2.
    pub r_x: f64,
    /// Eq. 3.
    pub r_y: f64,
    /// Resistance R_p of the sheet there, Ω.
    pub sheet_ohm: f64,
}

/// What an effect has cost so far.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectCost {
    /// Its table, or table and key.
    pub name: &'static str,
    /// Its rung.
    pub rung: String,
    /// Wall time, s.
    pub seconds: f64,
    /// How often it was evaluated: slots, or runs of samples.
    pub evaluations: u64,
}

/// One case of a scene at work.
pub struct Plant {
    case: Case,
    device: Device,
    timing: Timing,
    seed: u64,
    index: usize,
    effects: Vec<Running>,
    /// The slot last asked for, so that truth, phasors and samples of a slot are of one evaluation.
    now: Option<(usize, Pad)>,
}

struct Running {
    effect: Effect,
    cost: EffectCost,
}

impl Running {
    /// Runs `work` on the effect and books its time.
    fn timed(&mut self, work: impl FnOnce(&mut Effect)) {
        let start = Instant::now();
        work(&mut self.effect);
        self.cost.seconds += start.elapsed().as_secs_f64();
        self.cost.evaluations += 1;
    }

    fn on_pad(&self) -> bool {
        matches!(self.effect, Effect::Pad(_))
    }
}

impl Plant {
    /// Sets up case number `case` of a scene for a profile's timing.
    ///
    /// # Errors
    /// A scene with more pads than the profile serves, a timing without a window, no such case.
    pub fn new(scene: &Scene, case: usize, timing: &Timing) -> Result<Plant, SceneError> {
        let fail = |key: &str, message: String| SceneError::new(Place::File, key, message).in_file(&scene.name);
        let Some(chosen) = scene.cases.get(case) else {
            return Err(fail("case", format!("expected a case below {}, got {case}", scene.cases.len())));
        };
        if chosen.pads.len() > timing.pads {
            let (pads, name) = (chosen.pads.len(), &scene.profile);
            return Err(fail(
                "pad",
                format!("expected at most {} pads, as profile {name} serves, got {pads}", timing.pads),
            ));
        }
        timing.check().map_err(|message| fail("profile", message))?;
        let sample_rate_hz = chosen.device.carrier_hz * timing.samples_per_period;
        let device = Device { sample_rate_hz, ..chosen.device.clone() };
        let mut plant = Plant {
            case: chosen.clone(),
            device,
            timing: timing.clone(),
            seed: scene.seed,
            index: case,
            effects: Vec::new(),
            now: None,
        };
        plant.effects = plant.build();
        Ok(plant)
    }

    fn build(&self) -> Vec<Running> {
        let setting = Setting { device: &self.device, timing: &self.timing, seed: self.seed, case: self.index };
        let running = |spec: &crate::effects::Spec| Running {
            effect: (spec.build)(&setting),
            cost: EffectCost { name: spec.name, rung: spec.rung.clone(), seconds: 0.0, evaluations: 0 },
        };
        self.case.effects.iter().map(running).collect()
    }

    /// Finished slots of this case.
    pub fn slots(&self) -> usize {
        match self.case.length {
            Length::Sweep { points, dwell_slots } => points * dwell_slots * self.case.pads.len(),
            Length::Time { duration_s } => {
                (duration_s * self.device.sample_rate_hz / self.timing.slot_samples as f64).floor() as usize
            }
        }
    }

    /// Number of ADC channels: terminals, sensing voltage, haptic voltage.
    pub fn channels(&self) -> usize {
        CHANNELS
    }

    /// What a calibration may know.
    pub fn device(&self) -> Device {
        self.device.clone()
    }

    /// The pads' names, in the order of their slots.
    pub fn pad_names(&self) -> Vec<&str> {
        self.case.pad_names()
    }

    /// What each effect has cost so far, in the order in which they act.
    pub fn effects(&self) -> Vec<EffectCost> {
        self.effects.iter().map(|running| running.cost.clone()).collect()
    }

    /// The plant in a slot.
    pub fn truth(&mut self, slot: usize) -> Truth {
        let pad = self.pad(slot);
        let point = self.point(slot);
        let (r_x, r_y) = ratios(&pad.split);
        Truth {
            time_s: pad.time_s,
            pad: pad.index,
            point,
            group: self.case.pads[pad.index].group(point),
            r_x,
            r_y,
            x_mm: pad.x_mm,
            y_mm: pad.y_mm,
            capacitance_pf: pad.capacitance_f * 1e12,
            sheet_ohm: pad.sheet_ohm,
            haptic_v_rms: pad.haptic_v_rms,
            force_n: pad.force_n.unwrap_or(self.device.force_k * (pad.capacitance_f * pad.haptic_v_rms).powi(2)),
            direction: 0.0,
            load_g: pad.load_g,
        }
    }

    /// What an ideal demodulator over the slot's window finds, as fractions of full scale: one amplitude per terminal, then
    /// the sensing voltage's, into `out` (channels − 1 of them); returns the mean square of the haptic channel.
    ///
    /// # Panics
    /// If `out` is shorter than that.
    pub fn phasors(&mut self, slot: usize, out: &mut [Complex64]) -> f64 {
        let pad = self.pad(slot);
        let mut phasors = Phasors { slot: slot as u64, ..Phasors::default() };
        self.channel_effects(|effect| effect.phasors(&pad, &mut phasors));
        out[..CHANNELS - 1].copy_from_slice(&phasors.carrier);
        phasors.haptic_mean_square
    }

    /// ADC samples of a run within the slot, appended to `out`: for each instant the terminals, the sensing voltage and the
    /// haptic voltage, as fractions of full scale in [−1, 1].
    ///
    /// The noise of a run depends on where it starts, not on which runs were asked for before. Take the blanking part and
    /// the window whole, so that it is the same each time.
    pub fn samples(&mut self, slot: usize, range: Range<usize>, out: &mut Vec<f64>) {
        let pad = self.pad(slot);
        let slot_start = (slot * self.timing.slot_samples) as u64;
        let start = out.len();
        out.resize(start + range.len() * CHANNELS, 0.0);
        let run = Run { slot, range, slot_start };
        let rows = out[start..].as_chunks_mut().0;
        self.channel_effects(|effect| effect.samples(&pad, &run, rows));
        out[start..].iter_mut().for_each(|sample| *sample = sample.clamp(-1.0, 1.0));
    }

    /// A raster of places with what the nominal device reads there: no noise, no mismatch, one pad alone and at rest.
    pub fn calibration_map(&self, nx: usize, ny: usize, margin_mm: f64) -> Vec<MapPoint> {
        let mut effects = self.build();
        let places = raster(nx, ny, margin_mm, &self.device).into_iter();
        places
            .map(|place| {
                let mut pad = resting(place, &self.device);
                act(&mut effects, &mut pad);
                let (r_x, r_y) = ratios(&pad.split);
                MapPoint { x_mm: place[0], y_mm: place[1], r_x, r_y, sheet_ohm: pad.sheet_ohm }
            })
            .collect()
    }

    fn point(&self, slot: usize) -> usize {
        match self.case.length {
            Length::Sweep { dwell_slots, .. } => slot / self.case.pads.len() / dwell_slots,
            Length::Time { .. } => 0,
        }
    }

    fn pad(&mut self, slot: usize) -> Pad {
        if let Some((same, pad)) = &self.now
            && *same == slot
        {
            return pad.clone();
        }
        let middle = self.timing.window_start as f64 + self.timing.window_samples as f64 / 2.0;
        let time_s = ((slot * self.timing.slot_samples) as f64 + middle) / self.device.sample_rate_hz;
        let index = slot % self.case.pads.len();
        let mut pad = self.case.pads[index].at(index, self.point(slot), time_s, &self.device);
        act(&mut self.effects, &mut pad);
        self.now = Some((slot, pad.clone()));
        pad
    }

    fn channel_effects(&mut self, mut work: impl FnMut(&mut dyn ChannelEffect)) {
        for running in self.effects.iter_mut().filter(|running| !running.on_pad()) {
            running.timed(|effect| {
                if let Effect::Channels(effect) = effect {
                    work(effect.as_mut());
                }
            });
        }
    }
}

impl Timing {
    fn check(&self) -> Result<(), String> {
        let window_end = self.window_start + self.window_samples;
        let periods = self.samples_per_period;
        let sound = self.window_samples > 0 && window_end <= self.slot_samples && periods.is_finite() && periods > 2.0;
        if sound {
            Ok(())
        } else {
            Err(format!("expected a window within the slot and over 2 samples a period, got {self:?}"))
        }
    }
}

fn act(effects: &mut [Running], pad: &mut Pad) {
    for running in effects.iter_mut().filter(|running| running.on_pad()) {
        running.timed(|effect| {
            if let Effect::Pad(effect) = effect {
                effect.act(pad);
            }
        });
    }
}

/// Eqs. 2 and 3, from the corners' shares.
fn ratios(split: &[f64]) -> (f64, f64) {
    let [top_left, bottom_left, bottom_right, top_right] = [split[0], split[1], split[2], split[3]];
    let sum = top_left + bottom_left + bottom_right + top_right;
    let right = bottom_right + top_right - top_left - bottom_left;
    let up = top_left + top_right - bottom_left - bottom_right;
    (right / sum, up / sum)
}
