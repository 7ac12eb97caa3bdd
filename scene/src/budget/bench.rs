// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs of a case for comparison: its mechanics once through all of time, then what the sheet, the
//! carrier and the sensors make of them, in the slots that are asked for.

use std::sync::Arc;

use super::core::{Core, Signals};
use super::norm::{Norm, Quantities, Seen, of_truth};
use crate::case::Case;
use crate::effects::recorded::{Recording, Tape};
use crate::effects::{FILM_AND_CURRENTS, JOINING, RANDOM, Spec};
use crate::error::{Place, SceneError};
use crate::plant::Plant;
use crate::scene::Scene;
use crate::timing::Timing;

/// The most slots of a case whose levels are compared: some 300 bytes of each are kept.
const MOST_SLOTS: usize = 1_000_000;

/// Where plants are set up.
#[derive(Clone, Copy)]
pub(super) struct Bench<'a> {
    pub scene: &'a Scene,
    pub index: usize,
    pub timing: &'a Timing,
}

/// What the mechanics of a case do: supply, gap, friction and finger.
#[derive(Clone)]
pub(super) struct Mechanics {
    /// The truth of every slot; its R_p is none.
    pub slots: Arc<Vec<Quantities>>,
    /// The largest difference from what it was compared with, percent.
    pub percent: f64,
    recording: Arc<Recording>,
}

/// What mechanics are compared with, and the most that they may differ, percent.
pub(super) struct Against<'a> {
    pub norm: &'a Norm,
    pub slots: &'a [Quantities],
    pub most_percent: f64,
}

/// Where the effects on film and currents begin.
pub(super) fn electrics(effects: &[Spec]) -> usize {
    let first = effects.iter().position(|effect| FILM_AND_CURRENTS.contains(&effect.name));
    first.unwrap_or(effects.len())
}

impl Bench<'_> {
    fn plant(&self, case: Case) -> Result<Plant, SceneError> {
        Plant::of_case(case, self.scene.seed, self.index, self.timing)
            .map_err(|error| error.in_file(&self.scene.file))
    }

    /// Whether a case has more slots than are compared.
    pub fn is_too_long(&self, case: &Case) -> bool {
        case.slots(self.timing) > MOST_SLOTS
    }

    /// Runs the mechanics of a case, until they are too far off where they are compared; what they
    /// did up to there has no use then.
    ///
    /// # Errors
    /// A case of too many slots, a case that no plant can be made of.
    pub fn mechanics(
        &self,
        case: &Case,
        against: Option<&Against>,
    ) -> Result<Mechanics, SceneError> {
        if self.is_too_long(case) {
            let expected =
                format!("expected at most {MOST_SLOTS} slots of a case whose levels are compared");
            let message = format!("{expected}, got {}", case.slots(self.timing));
            return Err(SceneError::new(Place::File, "", message).in_file(&self.scene.file));
        }
        let tape = Tape::default();
        let joined = case.effects.iter().any(|effect| JOINING.contains(&effect.name));
        let mut alone = case.clone();
        alone.effects.truncate(electrics(&case.effects));
        alone.effects.extend(tape.recorders(joined));
        let mut plant = self.plant(alone)?;
        let (mut slots, mut percent) = (Vec::with_capacity(plant.slots()), 0.0);
        for slot in 0..plant.slots() {
            let found = of_truth(&plant.truth(slot));
            if let Some(against) = against {
                percent = against.norm.of(&found, &against.slots[slot]).max(percent);
                if percent > against.most_percent {
                    break;
                }
            }
            slots.push(found);
        }
        Ok(Mechanics { slots: Arc::new(slots), percent, recording: Arc::new(tape.take()) })
    }

    /// A case over mechanics that are known.
    pub fn over(&self, case: &Case, mechanics: &Mechanics) -> Result<Run<'_>, SceneError> {
        let mut over = case.clone();
        over.effects.drain(..electrics(&case.effects));
        over.effects.retain(|effect| !RANDOM.contains(&effect.name));
        over.effects.splice(0..0, mechanics.recording.player());
        let cost_of = |those: &dyn Fn(&str) -> bool| {
            let those = over.effects.iter().filter(|effect| those(effect.name));
            those.map(|effect| effect.level().cost_ns).sum()
        };
        let place_ns = cost_of(&|name| ["sheet", "shunt"].contains(&name));
        let cost_ns = cost_of(&|_| true);
        let sampled = case.sampled();
        Ok(Run { plant: self.plant(over)?, sampled, cost_ns, place_ns, timing: self.timing })
    }
}

/// A case over mechanics that are known, slot by slot.
pub(super) struct Run<'a> {
    pub plant: Plant,
    /// The core receives samples; else phasors, so that codes do not hide what the plant does.
    pub sampled: bool,
    /// What a slot costs.
    pub cost_ns: f64,
    /// What a place of the calibration costs.
    place_ns: f64,
    timing: &'a Timing,
}

impl Run<'_> {
    /// A core that is calibrated on it.
    pub fn core(&self) -> Result<Core, SceneError> {
        Core::calibrated(&self.plant, self.timing, self.place_ns)
            .map_err(|message| SceneError::new(Place::File, "profile", message))
    }

    /// A slot, as it is and as a core reads it.
    pub fn see(&mut self, slot: usize, core: &Core) -> Seen {
        let truth = of_truth(&self.plant.truth(slot));
        let signals = match self.sampled {
            true => Signals::of_samples(&mut self.plant, slot, self.timing),
            false => Signals::of_phasors(&mut self.plant, slot),
        };
        Seen { truth, read: core.read(&signals, [truth[0], truth[1]]) }
    }
}
