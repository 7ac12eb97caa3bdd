// SPDX-License-Identifier: MIT OR Apache-2.0
//! The stability of a scene's force loops: predicted before a run, measured where that is asked for.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use anyhow::{Result, bail, ensure};
use hapticore_run::case::{Case, Settings};
use hapticore_run::control::bode;
use hapticore_run::control::stability::{LEAST_PHASE_DEG, OpenLoop};
use hapticore_run::record::{Bode, Stability};
use rayon::prelude::*;

use crate::print::number;

/// Parts of the largest target at which a loop is looked at.
const PARTS: [f64; 2] = [0.5, 1.0];

/// How stable the loop of each case is, where it has one: at the force where its margins are least.
///
/// # Errors
/// A loop that is predicted to be unstable, unless it may be.
pub fn of_cases(cases: &[Case], unstable: bool) -> Result<BTreeMap<String, Stability>> {
    let most_n: Vec<f64> = cases.iter().map(largest_n).collect::<Result<_>>()?;
    let looked_at = |n: usize| PARTS.map(|part| part * most_n[n]).into_iter().filter(|n| *n > 0.0);
    let mut asked: Vec<(&Case, f64)> = Vec::new();
    for (n, case) in cases.iter().enumerate() {
        for force_n in looked_at(n) {
            if !asked.iter().any(|(other, known_n)| *known_n == force_n && is_same(other, case)) {
                asked.push((case, force_n));
            }
        }
    }
    let predict =
        || asked.par_iter().map(|(case, force_n)| at(case, *force_n)).collect::<Result<Vec<_>>>();
    // All loops of a device wait for its calibration, and what is wrong with it they will say.
    let closed = cases.iter().find(|case| case.plan().is_some());
    let (_, found) = rayon::join(|| closed.map(|case| case.calibration().is_ok()), predict);
    let found = found?;
    let worst = |(n, case): (usize, &Case)| {
        let of_case = |force_n: f64| {
            let same =
                |(other, known_n): &(&Case, f64)| *known_n == force_n && is_same(other, case);
            found[asked.iter().position(same)?]
        };
        let worst = looked_at(n).filter_map(of_case).min_by(|a, b| room(a).total_cmp(&room(b)))?;
        Some((case.name().to_string(), worst))
    };
    let found: BTreeMap<_, _> = cases.iter().enumerate().filter_map(worst).collect();
    for (name, margins) in &found {
        if !margins.stable() && !unstable {
            bail!(
                "control: expected a stable loop, got a gain margin of {} at {} N in case \"{name}\"; \
                 lower gains, or --unstable, which runs it",
                number(margins.gain_margin.unwrap_or_default()),
                margins.force_n
            );
        }
    }
    Ok(found)
}

/// Whether the loops of two cases are one: the cases differ in the course of their targets alone.
fn is_same(a: &Case, b: &Case) -> bool {
    let [a, b] = [a, b].map(|case| &case.scene.cases[case.index]);
    a.control == b.control && a.differs_in_targets_alone(b)
}

fn largest_n(case: &Case) -> Result<f64> {
    Ok(case.plant()?.largest_targets_n().into_iter().fold(0.0, f64::max))
}

/// How stable the loop of a case is at a force, where it has one.
fn at(case: &Case, force_n: f64) -> Result<Option<Stability>> {
    Ok(OpenLoop::of(case, force_n)?.map(|open| open.margins(force_n)))
}

/// How far a loop is from the limit: its gain margin, or its phase margin over 60°.
fn room(margins: &Stability) -> f64 {
    let phase = margins.phase_margin_deg.map_or(f64::INFINITY, |margin| margin / 60.0);
    margins.gain_margin.unwrap_or(f64::INFINITY).min(1.0 + phase)
}

/// What is to be said of loops with little phase margin.
pub fn warnings(stability: &BTreeMap<String, Stability>) -> Vec<String> {
    let warning = |(name, of): (&String, &Stability)| {
        let margin = of.phase_margin_deg.filter(|margin| *margin < LEAST_PHASE_DEG)?;
        let least = number(LEAST_PHASE_DEG);
        Some(format!(
            "control: the loop of case \"{name}\" is predicted to have a phase margin of {}° at {} N, \
             less than {least}°",
            number(margin),
            of.force_n
        ))
    };
    stability.iter().filter_map(warning).collect()
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

/// The measured loops, a row for each frequency.
pub fn csv(loops: &[Bode]) -> String {
    let mut text = String::from(
        "case,frequency_hz,gain_db,phase_deg,predicted_gain_db,predicted_phase_deg,target_to_force_db\n",
    );
    for (of, point) in loops.iter().flat_map(|of| of.points.iter().map(move |point| (of, point))) {
        let [[gain, phase], [predicted_gain, predicted_phase]] = [point.open, point.predicted];
        let case = of.case.replace('"', "\"\"");
        let (hz, closed) = (point.hz, point.closed_db);
        let _ = writeln!(
            text,
            "\"{case}\",{hz},{gain},{phase},{predicted_gain},{predicted_phase},{closed}"
        );
    }
    text
}
