// SPDX-License-Identifier: MIT OR Apache-2.0
//! How exact the levels are on a scene, and the cheapest ones within an error budget.
//!
//! The error of a level against a finer one is the largest difference it makes, all other effects
//! alike, over the slots of the case: of a terminal's amplitude in percent of the sum of all, of
//! the capacitance in percent, of the force in percent of the largest force. An ideal demodulator
//! reads the amplitudes: from the samples where the carrier itself is asked about, else from the
//! phasors, so that codes do not hide what the plant does. Noise is left out.
//!
//! `error_budget_percent` is shared evenly by the effects whose level the scene leaves open. Each
//! gets the cheapest level that is within its share of its finest one while all others are at their
//! finest.

use num_complex::Complex64;

use crate::case::Case;
use crate::effects::carrier::CARRIER;
use crate::effects::{NOISE, Spec};
use crate::error::SceneError;
use crate::plant::Plant;
use crate::rotor::Rotor;
use crate::scene::Scene;
use crate::terminals::PerTerminal;
use crate::timing::Timing;

/// Slots that are looked at, spread evenly over those that are run.
const LOOKS: usize = 64;

/// Slots that are run at most, so that states evolve as in the scene.
const MOST_SLOTS: usize = 4096;

/// A level that a case uses and how far it is from the next finer one.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelDeviation {
    /// Name of the effect.
    pub effect: &'static str,
    /// Fidelity level in use.
    pub level: String,
    /// The next finer level and the error against it, percent; none where there is no finer one.
    pub finer: Option<(String, f64)>,
}

impl Scene {
    /// The scene with the cheapest levels that its error budgets allow, for a profile's timing; as
    /// it is where it has none.
    ///
    /// # Errors
    /// As [`Plant::new`].
    pub fn within_budget(mut self, timing: &Timing) -> Result<Scene, SceneError> {
        for index in 0..self.cases.len() {
            let Some(budget_percent) = self.cases[index].budget_percent.take() else { continue };
            let mut finest = self.cases[index].clone();
            for effect in finest.effects.iter_mut().filter(|effect| effect.is_free()) {
                *effect = effect.finest();
            }
            let free: Vec<_> =
                (0..finest.effects.len()).filter(|n| finest.effects[*n].is_free()).collect();
            for &n in &free {
                let share_percent = budget_percent / free.len() as f64;
                self.cases[index].effects[n] =
                    self.cheapest(&finest, index, n, share_percent, timing)?;
            }
        }
        Ok(self)
    }

    /// Effect `n` at the cheapest level that is within `share_percent` of the finest.
    fn cheapest(
        &self,
        finest: &Case,
        index: usize,
        n: usize,
        share_percent: f64,
        timing: &Timing,
    ) -> Result<Spec, SceneError> {
        let exact = self.looks(finest, index, &finest.effects[n], timing)?;
        let mut levels = finest.effects[n].all();
        levels.sort_by(|a, b| a.level().cost_ns.total_cmp(&b.level().cost_ns));
        for level in levels {
            // A level that refuses the scene is one that does not fit.
            if let Ok(looks) = self.looks(finest, index, &level, timing)
                && error_percent(&looks, &exact) <= share_percent
            {
                return Ok(level);
            }
        }
        Ok(finest.effects[n].clone())
    }

    /// The levels of a case, each with its error against the next finer one on this scene.
    ///
    /// # Errors
    /// As [`Plant::new`].
    pub fn level_deviations(
        &self,
        index: usize,
        timing: &Timing,
    ) -> Result<Vec<LevelDeviation>, SceneError> {
        let case = &self.cases[index];
        let against = |effect: &Spec| -> Result<LevelDeviation, SceneError> {
            let finer = effect.finer().map(|finer| -> Result<(String, f64), SceneError> {
                let [coarse, fine] =
                    [effect, &finer].map(|level| self.looks(case, index, level, timing));
                Ok((finer.level().label.clone(), error_percent(&coarse?, &fine?)))
            });
            Ok(LevelDeviation {
                effect: effect.name,
                level: effect.level().label.clone(),
                finer: finer.transpose()?,
            })
        };
        case.effects.iter().map(against).collect()
    }

    /// What is seen of a case whose effect of that name is at another level.
    fn looks(
        &self,
        case: &Case,
        index: usize,
        level: &Spec,
        timing: &Timing,
    ) -> Result<Vec<Look>, SceneError> {
        let mut case = case.clone();
        case.effects.retain(|effect| effect.name != NOISE);
        case.effects
            .iter_mut()
            .filter(|effect| effect.name == level.name)
            .for_each(|effect| *effect = level.clone());
        let sampled = level.name == CARRIER && case.sampled();
        let mut plant = Plant::of_case(case, self.seed, index, timing)
            .map_err(|error| error.in_file(&self.name))?;
        let slots = plant.slots().min(MOST_SLOTS);
        let every = slots.div_ceil(LOOKS);
        let look = |slot| {
            plant.truth(slot);
            (slot % every == 0).then(|| Look::at(&mut plant, slot, sampled, timing))
        };
        Ok((0..slots).filter_map(look).collect())
    }
}

/// What is seen in one slot.
struct Look {
    currents: PerTerminal<Complex64>,
    capacitance_pf: f64,
    force_n: f64,
}

impl Look {
    fn at(plant: &mut Plant, slot: usize, sampled: bool, timing: &Timing) -> Look {
        let truth = plant.truth(slot);
        let mut phasors = vec![Complex64::ZERO; plant.channels() - 1];
        if sampled {
            lock_in(plant, slot, timing, &mut phasors);
        } else {
            plant.phasors(slot, &mut phasors);
        }
        let currents = phasors[..plant.terminals().len()].iter().copied().collect();
        Look { currents, capacitance_pf: truth.capacitance_pf, force_n: truth.force_n }
    }
}

/// Amplitudes from the slot's window under a Hann weight.
fn lock_in(plant: &mut Plant, slot: usize, timing: &Timing, phasors: &mut [Complex64]) {
    let mut samples = Vec::new();
    let first = timing.window_start;
    plant.samples(slot, first..first + timing.window_samples, &mut samples);
    let turns = 1.0 / timing.samples_per_period;
    let mut carrier = Rotor::new(-turns * first as f64, -turns);
    let mut hann = Rotor::new(0.0, 1.0 / timing.window_samples as f64);
    for row in samples.chunks_exact(plant.channels()) {
        let weight = carrier.turn() * ((1.0 - hann.turn().re) * 2.0 / timing.window_samples as f64);
        phasors.iter_mut().zip(row).for_each(|(phasor, sample)| *phasor += weight * sample);
    }
}

fn error_percent(coarse: &[Look], fine: &[Look]) -> f64 {
    let largest_n = fine.iter().map(|look| look.force_n.abs()).fold(f64::MIN_POSITIVE, f64::max);
    let error = |(coarse, fine): (&Look, &Look)| {
        let sum = fine.currents.iter().sum::<Complex64>().norm();
        let currents =
            coarse.currents.iter().zip(fine.currents.iter()).map(|(a, b)| (a - b).norm() / sum);
        let capacitance = (coarse.capacitance_pf / fine.capacitance_pf - 1.0).abs();
        let force = (coarse.force_n - fine.force_n).abs() / largest_n;
        currents.fold(capacitance.max(force), f64::max)
    };
    100.0 * coarse.iter().zip(fine).map(error).fold(0.0, f64::max)
}
