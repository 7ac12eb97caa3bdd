// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore replay`: recorded ADC samples through the core, in constant memory.

use std::path::PathBuf;

use anyhow::Result;
use hapticore_run::record::{Record, Row, Rows};
use hapticore_run::replay::{self, Plan, Replayed};

use crate::args::ReplayArgs;
use crate::output::{Frames, Output, summary};
use crate::{console, folder, print, progress, report, say};

/// Rows kept for the report: of longer captures every second, fourth, … row.
const MOST_ROWS: usize = 1 << 15;

/// Replays a capture.
///
/// # Errors
/// Bad input, files that cannot be written, an interruption; then nothing is written.
pub fn run(args: &ReplayArgs) -> Result<bool> {
    let folder = args.out.clone().unwrap_or_else(|| folder::of_capture(args));
    let output = Output::new(&folder)?;
    let mut frames = Frames::create(&output, None)?;
    let mut rows = Thinned::default();
    let mut sink = |row: Row| {
        frames.row(&row)?;
        rows.push(row);
        Ok(())
    };
    let bar = progress::bar(None, "slots", args.core.is_silent());
    let Replayed { mut record, left, silent } =
        replay::run(&plan(args), &mut sink, &|| bar.inc(1))?;
    bar.finish_and_clear();
    frames.finish()?;
    if rows.every > 1 {
        let Thinned { every, seen, .. } = rows;
        record
            .warnings
            .push(format!("report: drawn of every {every}th of {seen} slots; frames.csv has all"));
    }
    record.rows = Rows::of_cases([rows.kept]);
    output.write("summary.json", summary(&record))?;
    output.write("report.html", report::html(&record, &output.names()?))?;
    let files = output.keep()?;
    print_result(args, &record, (left, &silent), &files);
    Ok(true)
}

fn plan(args: &ReplayArgs) -> Plan {
    Plan {
        capture: args.capture.clone(),
        calibration: args.calibration.clone(),
        profile: args.core.profile.clone(),
        fidelity: args.core.fidelity(),
        errors: args.core.errors,
        reference: true,
        pads: args.pads,
        channels: args.channels.clone(),
        bits: args.bits,
        full_scale_v: args.full_scale_v,
        skip: args.skip.unwrap_or(0),
        truncated: args.truncated,
    }
}

fn print_result(
    args: &ReplayArgs,
    record: &Record,
    (left, silent): (usize, &str),
    files: &[PathBuf],
) {
    print::warnings(record);
    if args.core.json {
        console::print(format_args!("{}", summary(record)));
        return;
    }
    if args.core.quiet {
        return;
    }
    let core = args.core.fidelity();
    say!("{} · core {} · profile {}", record.title, core.name(), record.profile);
    if left > 0 {
        say!("{left} samples at the end are no whole slot and were left out");
    }
    say!("{silent}");
    print::finish(record, files, args.core.verbose);
}

/// Rows evenly thinned, so that they stay few.
struct Thinned {
    kept: Vec<Row>,
    every: usize,
    seen: usize,
}

impl Default for Thinned {
    fn default() -> Self {
        Thinned { kept: Vec::new(), every: 1, seen: 0 }
    }
}

impl Thinned {
    fn push(&mut self, row: Row) {
        if self.seen.is_multiple_of(self.every) {
            self.kept.push(row);
        }
        self.seen += 1;
        if self.kept.len() > MOST_ROWS {
            let mut index = 0;
            self.kept.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.every *= 2;
        }
    }
}
