// SPDX-License-Identifier: MIT OR Apache-2.0
//! A case beside a run of finer levels: the largest difference, in the slots that are affordable.

use super::bench::{Bench, Mechanics, Run};
use super::core::Core;
use super::norm::{Norm, Seen};
use super::worst::{Search, affordable, extremes};
use crate::case::Case;
use crate::effects::Spec;
use crate::error::SceneError;

/// What a core costs to read a slot of an ideal device, ns.
const READ_NS: f64 = 2e3;

/// What a slot's samples cost, ns.
const SAMPLED_NS: f64 = 1e5;

/// A case with effect `n` at another level.
pub(super) fn at_level(case: &Case, n: usize, level: Spec) -> Case {
    let mut case = case.clone();
    case.effects[n] = level;
    case
}

/// What others are compared with: a run of finer levels, and a core that is calibrated on it.
pub(super) struct Reference<'a> {
    run: Run<'a>,
    core: Core,
    pub norm: Norm,
    seen: Vec<Option<Seen>>,
    first: Vec<usize>,
    pads: usize,
}

/// A case that is compared with a reference, and when it is known to be too far off, percent.
pub(super) struct Compared<'a> {
    pub bench: &'a Bench<'a>,
    pub case: &'a Case,
    pub mechanics: &'a Mechanics,
    pub enough: f64,
}

impl<'a> Reference<'a> {
    pub fn new(
        bench: &'a Bench<'a>,
        case: &Case,
        mechanics: &Mechanics,
    ) -> Result<Reference<'a>, SceneError> {
        let run = bench.over(case, mechanics)?;
        Ok(Reference {
            core: run.core()?,
            norm: Norm::new(&case.device, &mechanics.slots),
            seen: vec![None; mechanics.slots.len()],
            first: extremes(&mechanics.slots, &case.device.terminals_mm),
            pads: case.pads.len(),
            run,
        })
    }

    /// The largest difference of a case from it, percent; some of it, where that is enough.
    pub fn percent(&mut self, compared: &Compared) -> Result<f64, SceneError> {
        let mut run = compared.bench.over(compared.case, compared.mechanics)?;
        let sampled = f64::from(u8::from(run.sampled) + u8::from(self.run.sampled)) * SAMPLED_NS;
        let look_ns = run.cost_ns + self.run.cost_ns + sampled + 2.0 * READ_NS;
        let (slots, first) = (self.seen.len(), self.first.clone());
        let looks = affordable(slots, look_ns);
        let search =
            Search { slots, looks, first: &first, pads: self.pads, enough: compared.enough };
        search.worst(|slot| {
            let fine = *self.seen[slot].get_or_insert_with(|| self.run.see(slot, &self.core));
            Ok(self.norm.percent(&run.see(slot, &self.core), &fine))
        })
    }
}

/// A case whose levels are chosen, and its mechanics.
#[derive(Clone)]
pub(super) struct Chosen {
    pub case: Case,
    pub mechanics: Mechanics,
}
