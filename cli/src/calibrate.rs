// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore calibrate`: a device's calibration from what a lab measured.

use std::path::{Path, PathBuf};

use anyhow::Result;
use hapticore_run::lab::{self, Data, Outcome};
use hapticore_run::record::Provenance;
use hapticore_run::{capture, inputs};

use crate::args::CalibrateArgs;
use crate::{console, print, report, say};

/// The profile where none is named.
const PROFILE: &str = "standard";

/// Makes a calibration.
///
/// # Errors
/// Data that make none, with what is missing; files that cannot be read or written.
pub fn run(args: &CalibrateArgs) -> Result<bool> {
    let profile = inputs::profile(args.profile.as_deref().unwrap_or(PROFILE))?;
    let (device, outcome) = lab::calibrate(&Data::read(&args.data)?, &profile)?;
    let report = report_path(&args.out);
    capture::write_text(&args.out, &(comments(&outcome) + &device.text()))?;
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

/// Where the report goes: `mine.toml.report.html`.
fn report_path(out: &Path) -> PathBuf {
    let mut name = out.as_os_str().to_owned();
    name.push(".report.html");
    name.into()
}

/// What stands at the head of a calibration file.
fn comments(outcome: &Outcome) -> String {
    let Provenance { version, command, .. } = &outcome.provenance;
    let files: Vec<_> =
        command.iter().skip(1).map(|word| word.replace(char::is_control, " ")).collect();
    let head = format!("Made by hapticore {version}: hapticore {}", files.join(" "));
    [head]
        .iter()
        .chain(&print::calibration_lines(outcome))
        .map(|line| format!("# {line}\n"))
        .collect()
}
