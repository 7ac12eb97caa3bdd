// SPDX-License-Identifier: MIT OR Apache-2.0
//! How exact the levels are on a scene, and the cheapest ones within an error budget.
//!
//! The error of a level is the largest difference from a finer one, all other effects alike, over
//! the slots of the case and over every quantity that a user reads of them. [`norm`] lists these
//! quantities and what each is a percent of. Levels are compared only where they approximate the
//! same thing: `[gap]`'s `static` or a law of friction is a choice of question. Noise and jitter
//! are left out.
//!
//! `error_budget_percent` is what all levels together that the scene leaves open may differ from
//! their finest ones. Effect by effect, those with the fewest levels first, the cheapest level is
//! taken that is within an even share of what is left of it, all others at their finest. Then all
//! of the chosen levels together are compared with the finest. Where that exceeds the budget, as
//! errors that amplify each other can, the shares are halved. Source: docs/physics.md §8.

mod bench;
mod compared;
mod core;
mod norm;
mod search;
mod stand_in;
mod worst;

use crate::effects::Spec;
use crate::error::SceneError;
use crate::scene::Scene;
use crate::timing::Timing;
use bench::Bench;

/// A level that a case uses and how far it is from a finer one.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelDeviation {
    /// Name of the effect.
    pub effect: &'static str,
    /// Fidelity level in use.
    pub level: String,
    /// A finer level and the error against it, percent; none where there is no finer one of the
    /// same question, and for cases of more than a million slots.
    pub finer: Option<(String, f64)>,
}

impl Scene {
    /// The scene with the cheapest levels that its error budgets allow, for a profile's timing; as
    /// it is where it has none.
    ///
    /// # Errors
    /// As [`Plant::new`](crate::Plant::new).
    pub fn within_budget(mut self, timing: &Timing) -> Result<Scene, SceneError> {
        for index in 0..self.cases.len() {
            let Some(budget_percent) = self.cases[index].budget_percent.take() else { continue };
            let bench = Bench { scene: &self, index, timing };
            let effects = search::cheapest(&bench, &self.cases[index], budget_percent)?;
            // The device was calibrated at the same levels: only what has changed since may differ.
            if let Some(then) = &mut self.cases[index].calibrated {
                then.effects = then.effects.iter().map(|effect| effect.as_in(&effects)).collect();
            }
            self.cases[index].effects = effects;
        }
        Ok(self)
    }

    /// The levels of a case, each with its error against a finer one on this scene.
    ///
    /// # Errors
    /// As [`Plant::new`](crate::Plant::new).
    pub fn level_deviations(
        &self,
        index: usize,
        timing: &Timing,
    ) -> Result<Vec<LevelDeviation>, SceneError> {
        let (case, bench) = (&self.cases[index], Bench { scene: self, index, timing });
        let mechanics = match bench.is_too_long(case) {
            true => None,
            false => Some(bench.mechanics(case, None)?),
        };
        let of = |(n, effect): (usize, &Spec)| {
            let off_finer = |mechanics| search::off_finer(&bench, case, mechanics, n);
            Ok(LevelDeviation {
                effect: effect.name,
                level: effect.level().label.clone(),
                finer: mechanics.as_ref().map(off_finer).transpose()?.flatten(),
            })
        };
        case.effects.iter().enumerate().map(of).collect()
    }
}
