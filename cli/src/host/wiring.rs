// SPDX-License-Identifier: MIT OR Apache-2.0
//! What has pads put at places, on the console: the check of the wiring, the guided calibration.

use std::io;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use hapticore_board::bench::RealTime;
use hapticore_board::check::check;
use hapticore_board::guide::guide;
use hapticore_board::target::Target;
use hapticore_host::residual::LIMIT_MM;
use hapticore_run::{capture, interrupt};

use crate::{console, say};

/// Ratios of a device that is as its calibration differ by less.
const DEPARTURE: f64 = 0.02;

/// Checks the wiring; whether nothing was found.
pub(super) fn check_wiring(found: Target) -> Result<bool> {
    let device = found.device.clone();
    let stop = || interrupt::check().is_err();
    let report = check(&mut RealTime::new(found, ask, tell, &stop), &device)?;
    report.compared.iter().for_each(|compared| say!("{compared}"));
    report.findings.iter().for_each(|finding| say!("found: {finding}"));
    if report.is_sound() {
        let departure = report.largest_departure();
        say!(
            "nothing is wrong with data lines, wires and pads; ratios differ from the calibration's by {departure:.3} at most"
        );
        if departure > DEPARTURE {
            console::warn(&format!(
                "a device like its calibration differs by less than {DEPARTURE}: --calibrate corrects a calibration"
            ));
        }
    }
    Ok(report.is_sound())
}

/// Corrects the calibration, and writes it to a file.
pub(super) fn calibrate(found: Target, file: &Path) -> Result<()> {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    // Nobody puts a pad at 24 places twice for a file that cannot be written.
    ensure!(
        folder.is_none_or(Path::is_dir) && !file.is_dir(),
        "--calibrate: expected a file in a folder that is there, got {}",
        file.display()
    );
    let device = found.device.clone();
    let stop = || interrupt::check().is_err();
    let corrected = guide(&mut RealTime::new(found, ask, tell, &stop), &device)?;
    let [before, held_out] = [corrected.before, corrected.held_out].map(|of| of.errors());
    let head = format!(
        "# Made by hapticore {}: a calibration corrected at places of the device itself.\n# before: {before}\n# now, at \
         inner places left out one by one: {held_out}\n",
        env!("CARGO_PKG_VERSION")
    );
    capture::write_text(file, &(head + &corrected.device.text()))?;
    say!("the calibration before: {before}");
    say!("now, at inner places left out one by one: {held_out}");
    if corrected.held_out.rms_mm > LIMIT_MM {
        console::warn(
            "the places do not agree with each other: a pad was not where it was asked for, or the device is too unlike \
             the one of the calibration; hapticore calibrate makes one from currents at many places",
        );
    }
    say!("  {}", file.display());
    Ok(())
}

/// Has the user do something.
fn ask(what: &str) -> Result<()> {
    say!("{what}, then press Enter");
    console::flush();
    let mut line = String::new();
    let read = io::stdin().read_line(&mut line).context("standard input")?;
    ensure!(read > 0, "standard input has ended");
    Ok(())
}

fn tell(text: &str) {
    say!("{text}");
    console::flush();
}
