// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore simulate`: a scene through the core.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Result, ensure};
use hapticore_model::profile::Profile;
use hapticore_scene::{Figure, Record as Wanted, Scene, Timing};
use hapticore_waveforms::wave::Kind;
use rayon::prelude::*;

use crate::args::{SimulateArgs, Waves};
use crate::capture::{self, Adc, Recorder};
use crate::case::{Case, Outcome, Settings};
use crate::criteria::{self, CaseRows};
use crate::output::{Frames, Output, summary};
use crate::record::{Effect, Record};
use crate::{errors, inputs, print, progress, report, waves};

/// Runs a scene; whether all criteria hold.
///
/// # Errors
/// Bad input, files that cannot be written, an interruption; then nothing is written.
pub fn run(args: &SimulateArgs) -> Result<bool> {
    let scene = inputs::scene(&args.scene, &args.set)?;
    let profile = inputs::profile(args.core.profile.as_ref().unwrap_or(&scene.profile))?;
    let profile = inputs::windowed(profile, &scene)?;
    let scene = scene.within_budget(&Timing { signs: None, ..inputs::timing(&profile) })?;
    let folder = args.out.clone().unwrap_or_else(|| Path::new("out").join(&scene.name));
    let (record, files) = write(args, &scene, &profile, &folder)?;
    if args.core.json {
        print!("{}", summary(&record));
    } else {
        print::finish(&record, &files);
    }
    Ok(record.criteria.iter().all(|criterion| criterion.pass))
}

/// Runs a scene and writes everything; what it left, and the files.
fn write(args: &SimulateArgs, scene: &Scene, profile: &Profile, folder: &Path) -> Result<(Record, Vec<PathBuf>)> {
    let cases = cases(args, scene, profile)?;
    let output = Output::new(folder)?;
    let capture = capture_path(args, scene, folder);
    let recorder = capture.as_deref().map(|path| recorder(path, args, &cases)).transpose()?;
    announce(args, scene, &cases);
    let (record, recorder) = simulate(args, scene, &cases, recorder)?;
    if let Some(kind) = wave_kind(args, scene) {
        waves::trace(&cases[0], kind, args.waves_window.as_ref(), output.aside())?;
    }
    let mut frames = Frames::create(&output.aside().join("frames.csv"), true)?;
    record.rows.iter().try_for_each(|row| frames.row(row))?;
    frames.finish()?;
    output.write("summary.json", &summary(&record))?;
    output.write("report.html", &report::html(&record))?;
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

/// The cases to be run, one after the other in time.
fn cases<'a>(args: &SimulateArgs, scene: &'a Scene, profile: &Profile) -> Result<Vec<Case<'a>>> {
    let names: Vec<_> = scene.cases.iter().map(|case| case.name.as_str()).collect();
    if let Some(unknown) = args.case.iter().find(|name| !names.contains(&name.as_str())) {
        anyhow::bail!("--case: expected a case among {}, got \"{unknown}\"", names.join(", "));
    }
    let chosen = |index: &usize| args.case.is_empty() || args.case.iter().any(|name| name == names[*index]);
    let mut cases: Vec<Case> = Vec::new();
    for index in (0..names.len()).filter(chosen) {
        let start_s = cases.iter().map(Case::seconds).sum();
        let case = Case::new(scene, index, cases.len(), profile, start_s)?;
        case.check(&args.scene, args.core.core)?;
        cases.push(case);
    }
    Ok(cases)
}

fn capture_path(args: &SimulateArgs, scene: &Scene, folder: &Path) -> Option<PathBuf> {
    let wanted = scene.record.contains(&Wanted::Capture).then(|| folder.join("capture.csv"));
    args.capture.clone().or(wanted)
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
    capture::create(path, adc, case.device.device.sample_rate_hz)
}

fn wave_kind(args: &SimulateArgs, scene: &Scene) -> Option<Kind> {
    let wanted = if scene.record.contains(&Wanted::Waves) { Waves::Vcd } else { Waves::None };
    match args.waves.unwrap_or(wanted) {
        Waves::Vcd => Some(Kind::Vcd),
        Waves::Fst => Some(Kind::Fst),
        Waves::None => None,
    }
}

fn announce(args: &SimulateArgs, scene: &Scene, cases: &[Case]) {
    if args.core.json {
        return;
    }
    let (slots, seconds) = (cases.iter().map(|case| case.slots).sum::<usize>(), cases.iter().map(Case::seconds).sum());
    println!("{}", scene.title);
    println!(
        "core {} · profile {} · {} cases · {slots} slots · {} s",
        args.core.core.name(),
        cases[0].profile.name,
        cases.len(),
        print::number(seconds)
    );
    println!("effects: {}", print::effects_line(cases.iter().flat_map(|case| scene.cases[case.index].effects())));
}

type Capture = Option<Box<dyn Recorder + Send>>;

/// Runs all cases at once; what they leave together.
fn simulate(args: &SimulateArgs, scene: &Scene, cases: &[Case], mut recorder: Capture) -> Result<(Record, Capture)> {
    let start = Instant::now();
    let settings = Settings { fidelity: args.core.core, errors: args.core.errors };
    let bar = progress::bar(Some(cases.iter().map(|case| case.slots as u64).sum()), args.core.json);
    let outcomes = match recorder.as_deref_mut() {
        Some(recorder) => vec![cases[0].run(&settings, Some(recorder), &bar)?],
        None => cases.par_iter().map(|case| case.run(&settings, None, &bar)).collect::<Result<Vec<_>>>()?,
    };
    bar.finish_and_clear();
    let mut record = gather(scene, cases, outcomes);
    record.fidelity = args.core.core.name().into();
    record.wall_seconds = start.elapsed().as_secs_f64();
    add_errors(&mut record.effects, cases)?;
    Ok((record, recorder))
}

fn gather(scene: &Scene, cases: &[Case], outcomes: Vec<Outcome>) -> Record {
    let measured = |(case, outcome): (&'_ Case, &'_ Outcome)| (case.start_s(), outcome.peak);
    let starts: Vec<_> = cases.iter().zip(&outcomes).map(measured).collect();
    let rows = cases.iter().zip(&outcomes).zip(starts).map(|((case, outcome), (start_s, peak))| CaseRows {
        name: case.name(),
        start_s,
        peak,
        rows: &outcome.rows,
    });
    let criteria = criteria::measure(&scene.criteria, &rows.collect::<Vec<_>>());
    let (mut effects, mut signal_errors, mut all) = (Vec::new(), Vec::new(), Vec::new());
    for outcome in outcomes {
        add_effects(&mut effects, &outcome);
        errors::merge(&mut signal_errors, outcome.errors);
        all.extend(outcome.rows);
    }
    Record {
        scene: scene.name.clone(),
        title: scene.title.clone(),
        summary: scene.summary.clone(),
        figure: scene.figure.map(figure_name),
        profile: cases[0].profile.name.clone(),
        fidelity: String::new(),
        cases: cases.iter().map(|case| case.name().to_string()).collect(),
        pads: scene.cases[cases[0].index].pad_names().iter().map(ToString::to_string).collect(),
        effects,
        criteria,
        errors: signal_errors,
        simulated_seconds: cases.iter().map(Case::seconds).sum(),
        wall_seconds: 0.0,
        rows: all,
    }
}

/// Adds what the effects of a case cost to those of the same name and rung.
fn add_effects(effects: &mut Vec<Effect>, outcome: &Outcome) {
    for cost in &outcome.effects {
        match effects.iter_mut().find(|effect| effect.name == cost.name && effect.rung == cost.rung) {
            Some(effect) => effect.seconds += cost.seconds,
            None => effects.push(Effect {
                name: cost.name.into(),
                rung: cost.rung.clone(),
                seconds: cost.seconds,
                finer: None,
            }),
        }
    }
}

/// Adds how far each rung is from the next finer one: in the case where that is furthest.
fn add_errors(effects: &mut [Effect], cases: &[Case]) -> Result<()> {
    for error in cases.par_iter().map(Case::rung_errors).collect::<Result<Vec<_>>>()?.into_iter().flatten() {
        let same = effects.iter_mut().find(|effect| effect.name == error.effect && effect.rung == error.rung);
        let (Some(effect), Some((finer, percent))) = (same, error.finer) else { continue };
        if effect.finer.as_ref().is_none_or(|(_, known)| *known < percent) {
            effect.finer = Some((finer, percent));
        }
    }
    Ok(())
}

fn figure_name(figure: Figure) -> String {
    match figure {
        Figure::Fig3 => "fig3",
        Figure::Fig4 => "fig4",
        Figure::Fig6 => "fig6",
        Figure::Fig7 => "fig7",
        Figure::Hockey => "hockey",
    }
    .into()
}
