// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cheapest levels of a case within its budget.

use super::bench::{Against, Bench, Mechanics, electrics};
use super::compared::{Chosen, Compared, Reference, at_level};
use super::norm::Norm;
use super::stand_in::{StandIn, is_same, stand_ins};
use crate::case::Case;
use crate::effects::Spec;
use crate::error::SceneError;

/// How often shares are halved before everything is left at its finest.
const MOST_TRIES: usize = 4;

/// The effects of a case at the cheapest levels within its budget.
pub(super) fn cheapest(
    bench: &Bench,
    case: &Case,
    budget_percent: f64,
) -> Result<Vec<Spec>, SceneError> {
    let mut open: Vec<_> = (0..case.effects.len()).filter(|n| case.effects[*n].is_free()).collect();
    open.sort_by_key(|n| case.effects[*n].rivals().len());
    let mut finest = case.clone();
    open.iter().for_each(|n| finest.effects[*n] = case.effects[*n].finest());
    if open.is_empty() {
        return Ok(finest.effects);
    }
    let mechanics = bench.mechanics(&finest, None)?;
    let mut before = None;
    for stand_in in stand_ins(&finest, &open) {
        let chosen = Chosen { case: stand_in, mechanics: mechanics.clone() };
        let mut reference = Reference::new(bench, &chosen.case, &chosen.mechanics)?;
        let standing = open.iter().copied().find(|n| !is_same(&finest, &chosen.case, *n));
        let stand_in =
            StandIn::new(bench, &mut reference, chosen, standing, budget_percent, before)?;
        before = stand_in.own.map(|own| own.step_percent);
        if let Some(effects) = below(bench, &mut reference, &stand_in, &open, budget_percent)? {
            return Ok(effects);
        }
    }
    Ok(finest.effects)
}

/// The cheapest levels that are found within the budget by a comparison with a reference. Where
/// that only stands in for the finest levels, errors against these are at most twice as large. With
/// a method of first order, in steps that halve, the next level leaves half of the error. Where no
/// coarser level than the stand-in will do, it is taken itself if its own error leaves room.
fn below(
    bench: &Bench,
    reference: &mut Reference,
    stand_in: &StandIn,
    open: &[usize],
    budget_percent: f64,
) -> Result<Option<Vec<Spec>>, SceneError> {
    let most_percent = if stand_in.own.is_some() { 0.5 * budget_percent } else { budget_percent };
    let mut shared = most_percent;
    for _ in 0..MOST_TRIES {
        let chosen = within(bench, reference, &stand_in.chosen, open, shared);
        let Chosen { case, mechanics } = &chosen;
        let stays = stand_in.own.filter(|own| is_same(case, &stand_in.chosen.case, own.n));
        let most_percent = stays.map_or(most_percent, |own| budget_percent - own.percent);
        if most_percent <= 0.0 {
            return Ok(None);
        }
        let compared = Compared { bench, case, mechanics, enough: most_percent };
        if reference.percent(&compared)? <= most_percent {
            return Ok(Some(chosen.case.effects));
        }
        shared *= 0.5;
    }
    Ok(None)
}

/// The cheapest level of each open effect, with an even share of what the ones before have left.
fn within(
    bench: &Bench,
    reference: &mut Reference,
    finest: &Chosen,
    open: &[usize],
    budget_percent: f64,
) -> Chosen {
    let (mut chosen, mut left) = (finest.clone(), budget_percent);
    let first = electrics(&finest.case.effects);
    for (done, &n) in open.iter().enumerate() {
        let share = left / (open.len() - done) as f64;
        let mut levels = finest.case.effects[n].rivals();
        levels.sort_by(|a, b| a.level().cost_ns.total_cmp(&b.level().cost_ns));
        let most_ns = finest.case.effects[n].level().cost_ns;
        // The finest has been chosen already: what costs as much is no alternative.
        for level in levels.into_iter().take_while(|level| level.level().cost_ns < most_ns) {
            let case = at_level(&finest.case, n, level.clone());
            let off = if n < first {
                moved(bench, reference, finest, &case, share)
                    .inspect(|mechanics| chosen.mechanics = mechanics.clone())
                    .map(|mechanics| mechanics.percent)
            } else {
                let mechanics = &finest.mechanics;
                let compared = Compared { bench, case: &case, mechanics, enough: share };
                // A level that refuses the scene is one that does not fit.
                reference.percent(&compared).ok().filter(|percent| *percent <= share)
            };
            if let Some(percent) = off {
                chosen.case.effects[n] = level;
                left -= percent;
                break;
            }
        }
    }
    chosen
}

/// The mechanics of a case, where they are within a share of the finest ones.
fn moved(
    bench: &Bench,
    reference: &Reference,
    finest: &Chosen,
    case: &Case,
    share_percent: f64,
) -> Option<Mechanics> {
    let slots = &finest.mechanics.slots;
    let against = Against { norm: &reference.norm, slots, most_percent: share_percent };
    let mechanics = bench.mechanics(case, Some(&against)).ok()?;
    Some(mechanics).filter(|mechanics| mechanics.percent <= share_percent)
}

/// The level that effect `n` of a case is compared with, and the difference, percent.
pub(super) fn off_finer(
    bench: &Bench,
    case: &Case,
    mechanics: &Mechanics,
    n: usize,
) -> Result<Option<(String, f64)>, SceneError> {
    let Some(finer) = case.effects[n].finer() else { return Ok(None) };
    let (label, finer) = (finer.level().label.clone(), at_level(case, n, finer));
    if n < electrics(&case.effects) {
        let finer = bench.mechanics(&finer, None)?.slots;
        let norm = Norm::new(&case.device, &finer);
        let slots = mechanics.slots.iter().zip(finer.iter());
        let percent = slots.map(|(coarse, fine)| norm.of(coarse, fine)).fold(0.0, f64::max);
        return Ok(Some((label, percent)));
    }
    let mut finer = Reference::new(bench, &finer, mechanics)?;
    let compared = Compared { bench, case, mechanics, enough: f64::INFINITY };
    Ok(Some((label, finer.percent(&compared)?)))
}
