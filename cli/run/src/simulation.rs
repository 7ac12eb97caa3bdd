// SPDX-License-Identifier: MIT OR Apache-2.0
//! A whole run of a scene: its cases side by side, and the record of what they leave.
//!
//! ```text
//! prepare ─ cases ─ predicted stability ─ run ─ Record
//! ```

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

use anyhow::{Result, bail};
use hapticore_contract::frame::{Field, Flags, Frame};
use hapticore_contract::profile::Profile;
use hapticore_host::residual::{self, Residual};
use hapticore_host::{Quantities, Units};
use hapticore_scene::{
    ControlPlan, Figure, HapticWave, LevelDeviation, Quantity, Scene, Timing, did_you_mean,
};
use rayon::prelude::*;

use crate::capture::Recorder;
use crate::case::{Case, Outcome, Settings};
use crate::control::Gains;
use crate::control::prediction;
use crate::criteria::{self, CaseRows};
use crate::engine::Fidelity;
use crate::findings::{self, Findings};
use crate::record::{Effect, ForceLawErrors, Provenance, Record, Row, Rows, Stability};
use crate::{errors, haptic, inputs, interrupt, provenance};

/// Below this the haptic voltage is off, V rms.
const HAPTIC_OFF_V: f64 = 1.0;

/// A scene within its budget and the profile of its core: the named one, or that of the scene, with the slots that
/// the scene asks for.
///
/// # Errors
/// No such profile, a window that its core cannot have, effects that the budget has no levels for.
pub fn prepare(scene: Scene, profile: Option<&str>) -> Result<(Arc<Scene>, Profile)> {
    let profile = inputs::profile(profile.unwrap_or(&scene.profile))?;
    let profile = inputs::windowed(profile, &scene)?;
    let timing = Timing { signs: None, ..inputs::timing(&profile) };
    Ok((Arc::new(scene.within_budget(&timing)?), profile))
}

/// The cases of these names, all where none is named, one after the other in time. `file` is what messages call the scene.
///
/// # Errors
/// No such case, one that the profile cannot serve, an interruption.
pub fn cases(
    (scene, file): (&Arc<Scene>, &str),
    chosen: &[String],
    profile: &Profile,
    fidelity: Fidelity,
) -> Result<Vec<Case>> {
    let names: Vec<_> = scene.cases.iter().map(|case| case.name.as_str()).collect();
    if let Some(unknown) = chosen.iter().find(|name| !names.contains(&name.as_str())) {
        let near = did_you_mean(unknown, names.iter().copied());
        bail!("--case: expected a case among {}, got \"{unknown}\"{near}", names.join(", "));
    }
    let is_chosen =
        |index: &usize| chosen.is_empty() || chosen.iter().any(|name| name == names[*index]);
    let mut cases: Vec<Case> = Vec::new();
    for index in (0..names.len()).filter(is_chosen) {
        interrupt::check()?;
        let case = Case::new(scene, index, profile, &cases)?;
        case.check(file, fidelity)?;
        cases.push(case);
    }
    Ok(cases)
}

/// Where the samples of a run go, if anywhere.
pub type Capture = Option<Box<dyn Recorder + Send>>;

/// Runs all cases side by side; what they leave together. `set` is what was set of the scene, `progress` is called at
/// each slot.
///
/// # Errors
/// As [`Case::run`].
pub fn run(
    (scene, set): (&Scene, &[(String, String)]),
    (cases, stability): (&[Case], BTreeMap<String, Stability>),
    settings: &Settings,
    mut recorder: Capture,
    progress: &(dyn Fn() + Sync),
) -> Result<(Record, Capture)> {
    let (date, start) = (provenance::now(), Instant::now());
    let outcomes = match recorder.as_deref_mut() {
        Some(recorder) => vec![cases[0].run(settings, Some(recorder), progress)?],
        None => cases
            .par_iter()
            .map(|case| case.run(settings, None, progress))
            .collect::<Result<Vec<_>>>()?,
    };
    let mut record = gather(scene, cases, outcomes);
    record.wall_seconds = start.elapsed().as_secs_f64();
    record.date = date;
    let (residual, deviations) = rayon::join(|| position_table(cases), || deviations(cases));
    record.position_table = residual?;
    add_deviations(&mut record.effects, deviations?);
    record.fidelity = settings.fidelity.name().into();
    record.provenance = Provenance::of_scene(scene, set);
    record.warnings.extend(haptic_warning(&record, cases));
    record.warnings.extend(doubts(scene, cases));
    record.warnings.extend(findings::warnings(&record.findings));
    let warned =
        record.position_table.and_then(|residual| residual.warning(position_limit_mm(scene)));
    record.warnings.extend(warned);
    record.warnings.extend(prediction::warnings(&stability));
    record.stability = stability;
    record.gains = gains(cases)?;
    Ok((record, recorder))
}

/// What the position tables leave of their own places, at the worst of the cases.
fn position_table(cases: &[Case]) -> Result<Option<Residual>> {
    let residuals = cases.iter().map(Case::residual).collect::<Result<Vec<_>>>()?;
    Ok(residuals.into_iter().reduce(Residual::worse))
}

/// What the scene allows a position, mm.
fn position_limit_mm(scene: &Scene) -> f64 {
    let positions = scene.criteria.iter().filter(|criterion| criterion.of == Quantity::PositionMm);
    positions.map(|criterion| criterion.limit).fold(residual::LIMIT_MM, f64::min)
}

/// Says where the core's window is too short for the haptic voltage, in the first case where it is.
fn haptic_warning(record: &Record, cases: &[Case]) -> Option<String> {
    let is_on = |case: &&Case| {
        let volts =
            |row: &Row| row.truth.is_some_and(|truth| truth.quantities.haptic_v_rms > HAPTIC_OFF_V);
        record.rows.iter().any(|row| row.case == case.number && volts(row))
    };
    let is_sine =
        |case: &&Case| case.scene.cases[case.index].device.haptic_wave == HapticWave::Sine;
    let sampled = cases.iter().filter(|case| case.scene.cases[case.index].sampled());
    let sampled = sampled.filter(is_sine).filter(is_on);
    let warning = |case: &Case| {
        let rate = case.device.device.sample_rate_hz;
        haptic::warning(&case.profile, case.scene.cases[case.index].device.haptic_hz, rate)
    };
    sampled.map(warning).find(Option::is_some).flatten()
}

fn gather(scene: &Scene, cases: &[Case], outcomes: Vec<Outcome>) -> Record {
    let measured = |(case, outcome): (&'_ Case, &'_ Outcome)| (case.start_s(), outcome.peak);
    let starts: Vec<_> = cases.iter().zip(&outcomes).map(measured).collect();
    let rows = cases.iter().zip(&outcomes).zip(starts).map(|((case, outcome), (start_s, peak))| {
        CaseRows { name: case.name(), start_s, peak, rows: &outcome.rows }
    });
    let criteria = criteria::measure(&scene.criteria, &rows.collect::<Vec<_>>());
    let (mut effects, mut signal_errors, mut all) = (Vec::new(), Vec::new(), Vec::new());
    for outcome in outcomes {
        add_effects(&mut effects, &outcome);
        errors::merge(&mut signal_errors, outcome.errors);
        all.push(outcome.rows);
    }
    let findings = findings(scene, cases, &all);
    let rows = Rows::of_cases(all);
    let device = &scene.cases[cases[0].index].device;
    Record {
        scene: scene.name.clone(),
        title: scene.title.clone(),
        summary: scene.summary.clone(),
        figure: scene.figure.map(figure_name),
        profile: cases[0].profile.name.clone(),
        fidelity: String::new(),
        cases: cases.iter().map(|case| case.name().to_string()).collect(),
        pads: scene.cases[cases[0].index].served_names(),
        effects,
        criteria,
        force_laws: ForceLawErrors::of(&rows),
        errors: signal_errors,
        simulated_seconds: cases.iter().map(Case::seconds).sum(),
        wall_seconds: 0.0,
        findings,
        warnings: Vec::new(),
        position_table: None,
        sheet_mm: Some([device.width_mm, device.height_mm]),
        swept: swept(scene, cases),
        laws: laws(scene, cases),
        gains: BTreeMap::new(),
        stability: BTreeMap::new(),
        bode: Vec::new(),
        date: String::new(),
        codes: codes(&cases[0]),
        provenance: Provenance::default(),
        rows,
    }
}

/// One code of each word; the haptic voltage is no multiple of one, but a square root.
fn codes(case: &Case) -> Quantities {
    let frame = Frame { pad: 0, codes: [1; Field::ALL.len()], flags: Flags::default() };
    let units = Units::new(&case.profile, &case.device.device);
    Quantities { haptic_v_rms: 0.0, ..units.quantities(&frame.measurement(&case.profile)) }
}

/// What the scene makes mean less than it seems to, once for all cases.
fn doubts(scene: &Scene, cases: &[Case]) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for doubt in cases.iter().flat_map(|case| &scene.cases[case.index].doubts) {
        if !all.contains(doubt) {
            all.push(doubt.clone());
        }
    }
    all
}

/// What the rows of each case leave to be known.
fn findings(scene: &Scene, cases: &[Case], rows: &[Vec<Row>]) -> Findings {
    let mut findings = Findings::default();
    for (case, rows) in cases.iter().zip(rows) {
        let of = &scene.cases[case.index];
        let pads = of.served_names();
        findings.add_flags(case.name(), &pads, rows);
        // The walls of an arena are those of each pad, on either side of it.
        let walled = of.control.as_ref().filter(|_| of.arena.is_none());
        let wall = walled.and_then(|plan| plan.wall.as_ref());
        let parts_mm = of.parts_mm();
        findings.add_tracking(findings::of_drives(
            (case.name(), &pads),
            rows,
            (case.start_s(), parts_mm),
            wall,
        ));
        let changed = of.changed_since_calibration();
        if !changed.is_empty() {
            findings.changed.insert(case.name().to_string(), changed);
        }
    }
    findings
}

/// The gains of each case whose law or curve has any.
fn gains(cases: &[Case]) -> Result<BTreeMap<String, Gains>> {
    let with_any = cases.iter().filter(|case| case.plan().is_some_and(ControlPlan::has_gains));
    with_any.map(|case| anyhow::Ok((case.name().to_string(), case.gains()?))).collect()
}

/// The law of each case that has a controller.
fn laws(scene: &Scene, cases: &[Case]) -> BTreeMap<String, &'static str> {
    let law = |case: &Case| {
        let plan = scene.cases[case.index].control.as_ref()?;
        Some((case.name().to_string(), plan.law.name()))
    };
    cases.iter().filter_map(law).collect()
}

/// The keys that any of the cases sweeps.
fn swept(scene: &Scene, cases: &[Case]) -> Vec<&'static str> {
    let mut keys: Vec<&str> = Vec::new();
    for key in cases.iter().flat_map(|case| scene.cases[case.index].swept()) {
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    keys
}

/// Adds what the effects of a case cost to those of the same name and level.
fn add_effects(effects: &mut Vec<Effect>, outcome: &Outcome) {
    for cost in &outcome.effects {
        match effects
            .iter_mut()
            .find(|effect| effect.name == cost.name && effect.level == cost.level)
        {
            Some(effect) => effect.seconds += cost.seconds,
            None => effects.push(Effect {
                name: cost.name.into(),
                level: cost.level.clone(),
                seconds: cost.seconds,
                finer: None,
            }),
        }
    }
}

/// How far each level is from a finer one, in each case whose pads do something of their own.
fn deviations(cases: &[Case]) -> Result<Vec<LevelDeviation>> {
    let of = |n: usize| &cases[n].scene.cases[cases[n].index];
    let is_first = |n: &usize| !(0..*n).any(|other| of(*n).differs_in_targets_alone(of(other)));
    let first: Vec<_> = (0..cases.len()).filter(is_first).collect();
    let found: Vec<_> =
        first.into_par_iter().map(|n| cases[n].level_deviations()).collect::<Result<_>>()?;
    Ok(found.into_iter().flatten().collect())
}

/// Adds to each effect how far its level is from a finer one: in the case where that is furthest.
fn add_deviations(effects: &mut [Effect], deviations: Vec<LevelDeviation>) {
    for error in deviations {
        let same = effects
            .iter_mut()
            .find(|effect| effect.name == error.effect && effect.level == error.level);
        let (Some(effect), Some((finer, percent))) = (same, error.finer) else { continue };
        if effect.finer.as_ref().is_none_or(|(_, known)| *known < percent) {
            effect.finer = Some((finer, percent));
        }
    }
}

fn figure_name(figure: Figure) -> String {
    match figure {
        Figure::Fig3 => "fig3",
        Figure::Fig4 => "fig4",
        Figure::Fig6 => "fig6",
        Figure::Fig7 => "fig7",
        Figure::Fig9 => "fig9",
        Figure::Fig13 => "fig13",
        Figure::Fig15 => "fig15",
        Figure::Hockey => "hockey",
    }
    .into()
}
