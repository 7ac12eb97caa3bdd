// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore simulate`: a scene through the core.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Result, ensure};
use hapticore_contract::profile::Profile;
use hapticore_run::capture::{self, Adc, Recorder, Switched};
use hapticore_run::case::{Case, Settings};
use hapticore_run::columns::OfScene;
use hapticore_run::control::prediction;
use hapticore_run::record::Record;
use hapticore_run::{inputs, simulation};
use hapticore_scene::{Record as Wanted, Scene};
use hapticore_waveforms::kind::Kind;

use crate::args::{SimulateArgs, Waves};
use crate::output::{Frames, Output, is_of_a_run, summary};
use crate::{console, folder, print, progress, report, say, stability, waves, words};

/// Runs a scene; whether all criteria hold.
///
/// # Errors
/// Bad input, files that cannot be written, an interruption; then nothing is written.
pub fn run(args: &SimulateArgs) -> Result<bool> {
    let scene = inputs::scene(&args.scene, &args.set)?;
    let (scene, profile) = simulation::prepare(scene, args.core.profile.as_deref())?;
    let folder = args.out.clone().unwrap_or_else(|| folder::of_scene(args, &scene.name));
    let (record, files) = write(args, &scene, &profile, &folder)?;
    print::warnings(&record);
    if args.core.json {
        console::print(format_args!("{}", summary(&record)));
    } else if !args.core.quiet {
        print::finish(&record, &files, args.core.verbose);
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
    let fidelity = args.core.fidelity();
    let cases = simulation::cases((scene, &args.scene), &args.case, profile, fidelity)?;
    let stability = prediction::of_cases(&cases, args.unstable)?;
    let output = Output::new(folder)?;
    let capture = capture_path(args, scene, folder);
    capture.iter().try_for_each(|path| check_capture(path, folder))?;
    let recorder = capture.as_deref().map(|path| recorder(path, args, &cases)).transpose()?;
    announce(args, scene, &cases)?;
    let slots = cases.iter().map(|case| case.slots as u64).sum();
    let bar = progress::bar(Some(slots), "slots", args.core.is_silent());
    let (mut record, recorder) = simulation::run(
        (scene, &args.set),
        (&cases, stability),
        &settings(args),
        recorder,
        &|| bar.inc(1),
    )?;
    bar.finish_and_clear();
    if let Some(force_n) = args.bode {
        record.bode = prediction::measure(&cases, &settings(args), force_n)?;
        output.write("bode.csv", stability::csv(&record.bode))?;
    }
    if let Some(kind) = wave_kind(args, scene) {
        waves::trace(
            &cases[0],
            kind,
            args.waves_window.as_ref(),
            output.partial_path(),
            args.core.is_silent(),
        )?;
    }
    for (name, text) in words::of_cases(&cases)? {
        output.write(&name, text)?;
    }
    let report = || output.write("report.html", report::html(&record, &output.names()?));
    let (frames, report) = rayon::join(|| write_frames(&output, &record), report);
    frames.and(report)?;
    output.write("summary.json", summary(&record))?;
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
    let mut frames = Frames::create(output, Some(OfScene::of(record)))?;
    record.rows.cases().try_for_each(|rows| frames.rows(rows))?;
    frames.finish()
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
    if args.core.is_silent() {
        return Ok(());
    }
    let (slots, seconds) =
        (cases.iter().map(|case| case.slots).sum::<usize>(), cases.iter().map(Case::seconds).sum());
    say!("{}", scene.title);
    say!(
        "core {} · profile {} · {} cases · {slots} slots · {} s of device time",
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

fn settings(args: &SimulateArgs) -> Settings {
    Settings { fidelity: args.core.fidelity(), errors: args.core.errors }
}
