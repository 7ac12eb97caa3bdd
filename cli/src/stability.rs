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
    // Cases that differ in the course of their target alone have one loop.
    let keys: Vec<_> = cases.iter().map(key).collect::<Result<_>>()?;
    let first = |n: usize| keys.iter().position(|key| *key == keys[n]).unwrap_or(n);
    let of_first = |(n, case): (usize, &Case)| match first(n) == n {
        true => of_case(case),
        false => Ok(None),
    };
    let found: Vec<_> = cases.par_iter().enumerate().map(of_first).collect::<Result<_>>()?;
    let named = |(n, case): (usize, &Case)| Some((case.name().to_string(), found[first(n)]?));
    let found: BTreeMap<_, _> = cases.iter().enumerate().filter_map(named).collect();
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

/// What a case's loop depends on: its scene without the course of its targets, and the largest.
fn key(case: &Case) -> Result<(String, u64)> {
    let mut scene: toml::Table = toml::from_str(&case.scene.cases[case.index].document)?;
    for pad in scene.get_mut("pad").and_then(|pads| pads.as_array_mut()).into_iter().flatten() {
        if let Some(pad) = pad.as_table_mut() {
            pad.remove("target_n");
        }
    }
    scene.remove("criterion");
    Ok((scene.to_string(), largest_n(case)?.to_bits()))
}

fn largest_n(case: &Case) -> Result<f64> {
    Ok(case.plant()?.largest_targets_n().into_iter().fold(0.0, f64::max))
}

fn of_case(case: &Case) -> Result<Option<Stability>> {
    let most_n = largest_n(case)?;
    if most_n <= 0.0 {
        return Ok(None);
    }
    let mut worst: Option<Stability> = None;
    for part in PARTS {
        let Some(open) = OpenLoop::of(case, part * most_n)? else { return Ok(None) };
        let margins = open.margins(part * most_n);
        if worst.is_none_or(|worst| room(&margins) < room(&worst)) {
            worst = Some(margins);
        }
    }
    Ok(worst)
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
