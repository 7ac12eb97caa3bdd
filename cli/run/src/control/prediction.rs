// SPDX-License-Identifier: MIT OR Apache-2.0
//! The stability of a scene's force loops: predicted before a run, measured where that is asked for.

use std::collections::BTreeMap;

use anyhow::{Result, bail, ensure};
use hapticore_scene::ControlPlan;
use rayon::prelude::*;

use super::bode;
use super::stability::{LEAST_PHASE_DEG, OpenLoop, step};
use crate::case::{Case, Settings};
use crate::number::number;
use crate::record::{Bode, Stability, Step};

/// Parts of the largest target at which a loop is evaluated.
const PARTS: [f64; 2] = [0.5, 1.0];

/// The most that a step may overshoot without a warning.
const MOST_OVERSHOOT_PERCENT: f64 = 30.0;

/// How stable the loop of each case is, where it has one: at the force where its margins are least.
///
/// # Errors
/// A loop that is predicted to be unstable, unless it may be.
pub fn of_cases(cases: &[Case], unstable: bool) -> Result<BTreeMap<String, Stability>> {
    let looks: Vec<_> = cases.iter().map(Look::of).collect::<Result<_>>()?;
    let mut once: Vec<Look> = Vec::new();
    for look in looks.iter().flatten() {
        if !once.contains(look) {
            once.push(*look);
        }
    }
    let margins = predicted(&once)?;
    let seen = |look: &Look| margins[once.iter().position(|other| other == look)?];
    let worst = |room: fn(&Stability) -> f64| -> BTreeMap<String, Stability> {
        let worst = |(case, looks): (&Case, &Vec<Look>)| {
            let worst = looks.iter().filter_map(seen).min_by(|a, b| room(a).total_cmp(&room(b)))?;
            Some((case.name().to_string(), worst))
        };
        cases.iter().zip(&looks).filter_map(worst).collect()
    };
    let linear = worst(linear_room);
    let refused = linear.iter().find(|(_, margins)| !margins.stable() && !unstable);
    if let Some((name, margins)) = refused {
        bail!(
            "control: expected a stable loop, got a gain margin of {} at {} N in case \"{name}\"; \
             lower gains, or --unstable, which runs it",
            number(margins.gain_margin.unwrap_or_default()),
            margins.force_n
        );
    }
    Ok(worst(room))
}

/// A look at a loop at a force.
#[derive(Clone, Copy)]
struct Look<'a> {
    case: &'a Case,
    force_n: f64,
    /// The largest target of the case, from which gains follow that the scene leaves out.
    most_n: f64,
}

impl<'a> Look<'a> {
    /// Those at a case, none where nothing is asked of its pads.
    fn of(case: &'a Case) -> Result<Vec<Self>> {
        let most_n = case.plant()?.largest_targets_n().into_iter().fold(0.0, f64::max);
        let forces_n = PARTS.map(|part| part * most_n).into_iter().filter(|force_n| *force_n > 0.0);
        Ok(forces_n.map(|force_n| Look { case, force_n, most_n }).collect())
    }

    fn margins(&self) -> Result<Option<Stability>> {
        let Some(open) = OpenLoop::of(self.case, self.force_n)? else { return Ok(None) };
        let step = step(self.case, self.force_n)?;
        Ok(Some(Stability { step, ..open.margins(self.force_n) }))
    }
}

/// Cases that differ in the course of their targets alone have one loop, where no gain follows from them.
impl PartialEq for Look<'_> {
    fn eq(&self, other: &Self) -> bool {
        let [a, b] = [self, other].map(|look| &look.case.scene.cases[look.case.index]);
        let has_gains = a.control.as_ref().is_some_and(ControlPlan::has_gains);
        self.force_n == other.force_n
            && a.control == b.control
            && a.differs_in_targets_alone(b)
            && (!has_gains || self.most_n == other.most_n)
    }
}

/// What is seen at each look. Meanwhile the device is calibrated, for which all loops wait once they run; what is wrong
/// with it they will say.
fn predicted(looks: &[Look]) -> Result<Vec<Option<Stability>>> {
    let calibrate = || looks.first().map(|look| look.case.calibration().is_ok());
    let predict = || looks.par_iter().map(Look::margins).collect();
    rayon::join(calibrate, predict).1
}

/// How far a loop is from instability: the smaller of both margins, 60° taken as much as a factor of two.
fn linear_room(margins: &Stability) -> f64 {
    let phase = margins.phase_margin_deg.map_or(f64::INFINITY, |margin| margin / 60.0);
    margins.gain_margin.unwrap_or(f64::INFINITY).min(1.0 + phase)
}

/// The same, where a loop whose step does not settle has less than any other.
fn room(margins: &Stability) -> f64 {
    let settles = margins.step.as_ref().is_none_or(Step::settles);
    if settles { linear_room(margins) } else { f64::NEG_INFINITY }
}

/// What of the margins their user must know: a phase margin too small, or a step that shows what no margin can.
pub fn warnings(stability: &BTreeMap<String, Stability>) -> Vec<String> {
    stability
        .iter()
        .flat_map(|(name, of)| [margin(name, of), stepped(name, of)])
        .flatten()
        .collect()
}

fn margin(name: &str, of: &Stability) -> Option<String> {
    let margin = of.phase_margin_deg.filter(|margin| *margin < LEAST_PHASE_DEG)?;
    let least = number(LEAST_PHASE_DEG);
    Some(format!(
        "control: the loop of case \"{name}\" is predicted to have a phase margin of {}° at {} N, \
         less than {least}°",
        number(margin),
        of.force_n
    ))
}

fn stepped(name: &str, of: &Stability) -> Option<String> {
    let step = of.step.as_ref()?;
    let what = if !step.settles() {
        let swing_n = 0.01 * step.swing_percent * of.force_n;
        format!("does not settle: the force swings over {} N", number(swing_n))
    } else if step.overshoot_percent > MOST_OVERSHOOT_PERCENT {
        format!("overshoots by {} %", number(step.overshoot_percent))
    } else {
        return None;
    };
    Some(format!(
        "control: a simulated step of case \"{name}\" to {} N {what}; linear margins do not show it; lower gains, or \
         a moving gap (gap.rung)",
        of.force_n
    ))
}

/// Measures the loop of each case with a target about a force.
///
/// # Errors
/// No case with a loop, a force that its pads cannot have.
pub fn measure(cases: &[Case], settings: &Settings, force_n: f64) -> Result<Vec<Bode>> {
    let mut found = Vec::new();
    for case in cases {
        let all = |point: &(dyn Fn(usize) -> Result<_> + Sync)| {
            (0..bode::frequencies()).into_par_iter().map(point).collect()
        };
        found.extend(bode::measure(case, settings, force_n, all)?);
    }
    ensure!(!found.is_empty(), "--bode: expected a case with a force loop that is closed");
    Ok(found)
}
