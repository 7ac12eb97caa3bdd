// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore simulate`: a scene through the core.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use anyhow::{Result, ensure};
use hapticore_contract::profile::Profile;
use hapticore_run::capture::{self, Adc, Recorder, Switched};
use hapticore_run::case::{Case, Outcome, Settings};
use hapticore_run::control::Gains;
use hapticore_run::criteria::{self, CaseRows};
use hapticore_run::findings::{self, Findings};
use hapticore_run::record::{Effect, ForceLawErrors, Provenance, Record, Row, Rows};
use hapticore_run::{errors, haptic, inputs, interrupt};
use hapticore_scene::{
    ControlPlan, Figure, HapticWave, LevelDeviation, Quantity, Record as Wanted, Scene, Timing,
};
use hapticore_waveforms::kind::Kind;
use rayon::prelude::*;

use crate::args::{SimulateArgs, Waves};
use crate::output::{Frames, OfScene, Output, is_of_a_run, summary};
use crate::{console, folder, print, progress, report, say, stability, waves, words};
use hapticore_host::residual::{self, Residual};

/// Below this the haptic voltage is off, V rms.
const HAPTIC_OFF_V: f64 = 1.0;

/// Runs a scene; whether all criteria hold.
///
/// # Errors
/// Bad input, files that cannot be written, an interruption; then nothing is written.
pub fn run(args: &SimulateArgs) -> Result<bool> {
    let scene = inputs::scene(&args.scene, &args.set)?;
    let profile = inputs::profile(args.core.profile.as_ref().unwrap_or(&scene.profile))?;
    let profile = inputs::windowed(profile, &scene)?;
    let timing = Timing { signs: None, ..inputs::timing(&profile) };
    let scene = Arc::new(scene.within_budget(&timing)?);
    let folder = args.out.clone().unwrap_or_else(|| folder::of_scene(args, &scene.name));
    let (record, files) = write(args, &scene, &profile, &folder)?;
    print::warnings(&record);
    if args.core.json {
        console::print(format_args!("{}", summary(&record)));
    } else {
        print::finish(&record, &files);
    }
    Ok(record.criteria.iter().all(|criterion| criterion.pass))
}

/// Runs a scene and writes everything; what it left, and the files.
fn write(
    args: &SimulateArgs,
    scene: &Arc<Scene>,
    profile: &Profile,
    folder: &Path,
) -> Result<(Record, Vec<PathBuf>)> {
    let cases = cases(args, scene, profile)?;
    let stability = stability::of_cases(&cases, args.unstable)?;
    let output = Output::new(folder)?;
    let capture = capture_path(args, scene, folder);
    capture.iter().try_for_each(|path| check_capture(path, folder))?;
    let recorder = capture.as_deref().map(|path| recorder(path, args, &cases)).transpose()?;
    announce(args, scene, &cases)?;
    let (mut record, recorder) = simulate(args, scene, &cases, recorder)?;
    record.warnings.extend(stability::warnings(&stability));
    record.stability = stability;
    record.gains = gains(&cases)?;
    if let Some(force_n) = args.bode {
        record.bode = stability::measure(&cases, &settings(args), force_n)?;
        output.write("bode.csv", stability::csv(&record.bode))?;
    }
    if let Some(kind) = wave_kind(args, scene) {
        waves::trace(
            &cases[0],
            kind,
            args.waves_window.as_ref(),
            output.partial_path(),
            args.core.json,
        )?;
    }
    let report = || output.write("report.html", report::html(&record));
    let (frames, report) = rayon::join(|| write_frames(&output, &record), report);
    frames.and(report)?;
    output.write("summary.json", summary(&record))?;
    for (name, text) in words::of_cases(&cases)? {
        output.write(&name, text)?;
    }
    let mut files = Vec::new();
    if let (Some(path), Some(recorder)) = (capture, recorder) {
        let calibration = capture::calibration_path(&path);
        capture::write_text(&calibration, &cases[0].device.text())?;
        recorder.keep()?;
        files = vec![path, calibration];
    }
    files.splice(0..0, output.keep()?);
    Ok((record, files))
}

/// Writes `frames.csv`.
fn write_frames(output: &Output, record: &Record) -> Result<()> {
    let of_scene = OfScene {
        cases: record.cases.clone(),
        swept: record.swept.clone(),
        driven: record.rows.iter().any(|row| row.driven.is_some()),
        walled: record.rows.iter().any(|row| row.driven.is_some_and(|it| it.free.is_some())),
    };
    let mut frames = Frames::create(output, Some(of_scene))?;
    record.rows.cases().try_for_each(|rows| frames.rows(rows))?;
    frames.finish()
}

/// The cases to be run, one after the other in time.
fn cases(args: &SimulateArgs, scene: &Arc<Scene>, profile: &Profile) -> Result<Vec<Case>> {
    let names: Vec<_> = scene.cases.iter().map(|case| case.name.as_str()).collect();
    if let Some(unknown) = args.case.iter().find(|name| !names.contains(&name.as_str())) {
        anyhow::bail!("--case: expected a case among {}, got \"{unknown}\"", names.join(", "));
    }
    let chosen =
        |index: &usize| args.case.is_empty() || args.case.iter().any(|name| name == names[*index]);
    let mut cases: Vec<Case> = Vec::new();
    for index in (0..names.len()).filter(chosen) {
        interrupt::check()?;
        let case = Case::new(scene, index, profile, &cases)?;
        case.check(&args.scene, args.core.fidelity())?;
        cases.push(case);
    }
    Ok(cases)
}

fn capture_path(args: &SimulateArgs, scene: &Scene, folder: &Path) -> Option<PathBuf> {
    let wanted = scene.record.contains(&Wanted::Capture).then(|| folder.join("capture.csv"));
    args.capture.clone().or(wanted)
}

/// Checks that neither a capture nor its calibration would be in the way of what the run writes
/// itself.
fn check_capture(path: &Path, folder: &Path) -> Result<()> {
    let calibration = capture::calibration_path(path);
    ensure!(
        !calibration.is_dir(),
        "{}: expected a file to write, there is a folder of this name",
        calibration.display()
    );
    let of = path.parent().filter(|of| !of.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let same = of
        .canonicalize()
        .ok()
        .is_some_and(|of| folder.canonicalize().is_ok_and(|folder| folder == of));
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    ensure!(
        !(same && is_of_a_run(&name)),
        "--capture {}: expected a name of its own, the run writes its {name} there",
        path.display()
    );
    Ok(())
}

fn recorder(path: &Path, args: &SimulateArgs, cases: &[Case]) -> Result<Box<dyn Recorder + Send>> {
    let names = cases.iter().map(Case::name).collect::<Vec<_>>().join(", ");
    ensure!(cases.len() == 1, "--capture: expected one case, got {names}; choose one with --case");
    let case = &cases[0];
    let sampled = case.scene.cases[case.index].sampled();
    ensure!(
        sampled,
        "{}: carrier.rung: expected \"samples\" for --capture; try --set carrier.rung=samples",
        args.scene
    );
    let adc = Adc { terminals: case.profile.terminals.x.len(), format: case.profile.formats.adc };
    let recorder = capture::create(path, adc, case.device.device.sample_rate_hz)?;
    Ok(Box::new(Switched::new(recorder, &case.profile)))
}

fn wave_kind(args: &SimulateArgs, scene: &Scene) -> Option<Kind> {
    let wanted = if scene.record.contains(&Wanted::Waves) { Waves::Vcd } else { Waves::None };
    match args.waves.unwrap_or(wanted) {
        Waves::Vcd => Some(Kind::Vcd),
        Waves::Fst => Some(Kind::Fst),
        Waves::None => None,
    }
}

fn announce(args: &SimulateArgs, scene: &Scene, cases: &[Case]) -> Result<()> {
    let window = args.waves_window.as_ref();
    let waves =
        wave_kind(args, scene).map(|kind| waves::extent(&cases[0], kind, window)).transpose()?;
    waves
        .iter()
        .filter(|waves| waves.is_large())
        .for_each(|waves| console::warn(&waves.to_string()));
    if args.core.json {
        return Ok(());
    }
    let (slots, seconds) =
        (cases.iter().map(|case| case.slots).sum::<usize>(), cases.iter().map(Case::seconds).sum());
    say!("{}", scene.title);
    say!(
        "core {} · profile {} · {} cases · {slots} slots · {} s",
        args.core.fidelity().name(),
        cases[0].profile.name,
        cases.len(),
        print::number(seconds)
    );
    say!(
        "effects: {}",
        print::effects_line(cases.iter().flat_map(|case| scene.cases[case.index].effects()))
    );
    waves.iter().filter(|waves| !waves.is_large()).for_each(|waves| say!("{waves}"));
    Ok(())
}

type Capture = Option<Box<dyn Recorder + Send>>;

/// Runs all cases side by side; returns what they leave together.
fn simulate(
    args: &SimulateArgs,
    scene: &Scene,
    cases: &[Case],
    mut recorder: Capture,
) -> Result<(Record, Capture)> {
    let start = Instant::now();
    let settings = settings(args);
    let bar = progress::bar(
        Some(cases.iter().map(|case| case.slots as u64).sum()),
        "slots",
        args.core.json,
    );
    let tick = || bar.inc(1);
    let outcomes = match recorder.as_deref_mut() {
        Some(recorder) => vec![cases[0].run(&settings, Some(recorder), &tick)?],
        None => cases
            .par_iter()
            .map(|case| case.run(&settings, None, &tick))
            .collect::<Result<Vec<_>>>()?,
    };
    bar.finish_and_clear();
    let mut record = gather(scene, cases, outcomes);
    record.wall_seconds = start.elapsed().as_secs_f64();
    let (residual, deviations) = rayon::join(|| position_table(cases), || deviations(cases));
    record.position_table = residual?;
    add_deviations(&mut record.effects, deviations?);
    record.fidelity = args.core.fidelity().name().into();
    record.provenance = Provenance::of_scene(scene, &args.set);
    record.warnings.extend(haptic_warning(&record, cases));
    record.warnings.extend(doubts(scene, cases));
    record.warnings.extend(findings::warnings(&record.findings));
    let warned =
        record.position_table.and_then(|residual| residual.warning(position_limit_mm(scene)));
    record.warnings.extend(warned);
    Ok((record, recorder))
}

/// What the position tables leave of their own places, at the worst of the cases.
fn position_table(cases: &[Case]) -> Result<Option<Residual>> {
    let residuals = cases.iter().map(Case::residual).collect::<Result<Vec<_>>>()?;
    Ok(residuals.into_iter().reduce(Residual::worse))
}

fn settings(args: &SimulateArgs) -> Settings {
    Settings { fidelity: args.core.fidelity(), errors: args.core.errors }
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
        provenance: Provenance::default(),
        rows,
    }
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
        let wall = of.control.as_ref().and_then(|plan| plan.wall.as_ref());
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
