// SPDX-License-Identifier: MIT OR Apache-2.0
//! Levels that stand in for the finest one, where that takes long to build: meshes, coarsest first.
//!
//! A stand-in's own error follows from how the meshes before it have converged. The next coarser
//! one is off it by d, the one before was off its next by d'. Where each step leaves q = d/d' of
//! the error, the remaining steps sum up to d·(q + q² + …) = d·q/(1 − q). Second order of
//! convergence has q = 1/4; no less than 1/2, first order, is relied on.

use super::bench::Bench;
use super::compared::{Chosen, Compared, Reference, at_level};
use crate::case::Case;
use crate::error::SceneError;

/// What a step to a finer mesh leaves of an error, at least, and where no two steps have shown it.
const LEAST_LEFT: f64 = 0.5;
const LEFT_UNSEEN: f64 = 0.6;

/// The finest case, after it with levels that stand in for one that takes long to build, coarsest
/// first.
pub(super) fn stand_ins(finest: &Case, open: &[usize]) -> Vec<Case> {
    let dear = open.iter().map(|&n| (n, finest.effects[n].stand_ins()));
    match dear.max_by_key(|(_, levels)| levels.len()) {
        Some((n, levels)) => levels.into_iter().map(|level| at_level(finest, n, level)).collect(),
        None => Vec::new(),
    }
}

/// A case that others are compared with, and the level in it that stands in for a finer one.
pub(super) struct StandIn {
    pub chosen: Chosen,
    pub own: Option<OwnError>,
}

/// The error that a level has itself, which stands in for a finer one.
#[derive(Clone, Copy)]
pub(super) struct OwnError {
    /// The effect.
    pub n: usize,
    /// The difference of the next coarser level from it; some of it, where that is over the budget.
    pub step_percent: f64,
    /// What it is off the finest at most.
    pub percent: f64,
}

impl StandIn {
    /// A case with effect `standing` at a level that stands in for a finer one, if one does.
    pub fn new(
        bench: &Bench,
        reference: &mut Reference,
        chosen: Chosen,
        standing: Option<usize>,
        budget_percent: f64,
        before_percent: Option<f64>,
    ) -> Result<StandIn, SceneError> {
        let Some(n) = standing else { return Ok(StandIn { chosen, own: None }) };
        let Chosen { case, mechanics } = &chosen;
        let coarser = case.effects[n].coarser().expect("the coarsest level stands in for none");
        let case = &at_level(case, n, coarser);
        let compared = Compared { bench, case, mechanics, enough: budget_percent };
        let step_percent = reference.percent(&compared)?;
        let percent = to_come(step_percent, before_percent);
        Ok(StandIn { chosen, own: Some(OwnError { n, step_percent, percent }) })
    }
}

/// Whether effect `n` has the same level in both.
pub(super) fn is_same(a: &Case, b: &Case, n: usize) -> bool {
    a.effects[n].level().label == b.effects[n].level().label
}

/// What the steps to the finest level sum up to after a step and one before it; more, where only
/// some of the latter is known.
fn to_come(step: f64, before: Option<f64>) -> f64 {
    let left = before.map_or(LEFT_UNSEEN, |before| step / before).max(LEAST_LEFT);
    if left < 1.0 { step * left / (1.0 - left) } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::to_come;

    /// Errors of meshes that halve: of first and second order, and of slower convergence.
    #[test]
    fn what_is_to_come_is_not_below_the_error_that_is_left() {
        for left in [0.25, 0.5, 0.7] {
            let error = |mesh: i32| f64::powi(left, mesh);
            let step = |mesh: i32| error(mesh - 1) - error(mesh);
            let bound = to_come(step(3), Some(step(2)));
            assert!(bound >= 0.999 * error(3) && bound <= 3.1 * error(3), "{left}: {bound}");
            // Of the step before only a part was evaluated.
            assert!(to_come(step(3), Some(0.9 * step(2))) >= 0.999 * bound, "{left}");
        }
        assert_eq!(to_come(2.0, Some(2.0)), f64::INFINITY);
        assert!((to_come(2.0, None) - 3.0).abs() < 1e-12);
        assert_eq!(to_come(0.0, Some(0.0)), 0.0);
    }
}
