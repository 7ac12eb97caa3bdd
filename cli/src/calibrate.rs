// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore calibrate`: a device's calibration from what a lab measured, or a scene's `[gap]`.

use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;

use anyhow::{Result, ensure};
use hapticore_contract::profile::Profile;
use hapticore_host::DeviceCalibration;
use hapticore_run::lab::{self, Data, Outcome, gap};
use hapticore_run::record::Provenance;
use hapticore_run::{capture, inputs, interrupt};

use crate::args::CalibrateArgs;
use crate::{console, print, progress, report, say};

/// The profile where none is named.
const PROFILE: &str = "standard";

/// How often a run asks whether to go on.
const PATIENCE: Duration = Duration::from_millis(50);

/// Makes a calibration.
///
/// # Errors
/// Data that make none, with what is missing; files that cannot be read or written.
pub fn run(args: &CalibrateArgs) -> Result<bool> {
    let files = lab::texts(&args.data)?;
    if let Some(data) = gap::Data::of(&files)? {
        return of_gap(args, &data);
    }
    let profile = inputs::profile(args.profile.as_deref().unwrap_or(PROFILE))?;
    let (device, outcome) = calibrated(Data::of(&files)?, profile, args.json)?;
    let report = report_path(&args.out);
    capture::write_text(
        &args.out,
        &(head(&outcome.provenance, &print::calibration_lines(&outcome)) + &device.text()),
    )?;
    capture::write_text(&report, &report::of_calibration(&outcome))?;
    outcome.warnings.iter().for_each(|warning| console::warn(warning));
    if args.json {
        say!("{}", serde_json::to_string_pretty(&outcome)?);
        return Ok(true);
    }
    print::calibration_lines(&outcome).iter().for_each(|line| say!("{line}"));
    [&args.out, &report].iter().for_each(|path| say!("  {}", path.display()));
    Ok(true)
}

/// The tables of a scene, from capacitances under loads.
fn of_gap(args: &CalibrateArgs, data: &gap::Data) -> Result<bool> {
    ensure!(args.profile.is_none(), "--profile: a gap depends on none; leave it out");
    let outcome = data.fit()?;
    let text = head(&outcome.provenance, &outcome.lines()) + &outcome.text();
    capture::write_text(&args.out, &text)?;
    outcome.warnings.iter().for_each(|warning| console::warn(warning));
    if args.json {
        say!("{}", serde_json::to_string_pretty(&outcome)?);
        return Ok(true);
    }
    outcome.lines().iter().for_each(|line| say!("{line}"));
    say!("  {}", args.out.display());
    Ok(true)
}

/// The calibration of data, computed on a thread of its own: equations of many places take half a minute, in
/// which an interrupted run stops.
fn calibrated(data: Data, profile: Profile, quiet: bool) -> Result<(DeviceCalibration, Outcome)> {
    let bar = progress::work("calibrating", quiet);
    let work = thread::spawn(move || lab::calibrate(&data, &profile));
    while !work.is_finished() {
        interrupt::check()?;
        bar.tick();
        thread::sleep(PATIENCE);
    }
    bar.finish_and_clear();
    work.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// Where the report goes: `mine.toml.report.html`.
fn report_path(out: &Path) -> PathBuf {
    let mut name = out.as_os_str().to_owned();
    name.push(".report.html");
    name.into()
}

/// What stands at the head of a file: what made it, and its results.
fn head(Provenance { version, command, .. }: &Provenance, results: &[String]) -> String {
    let words: Vec<_> =
        command.iter().skip(1).map(|word| word.replace(char::is_control, " ")).collect();
    let made = format!("Made by hapticore {version}: hapticore {}", words.join(" "));
    [made].iter().chain(results).map(|line| format!("# {line}\n")).collect()
}
