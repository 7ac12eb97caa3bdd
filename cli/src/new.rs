// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore new`: commented files that run as they are.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::Path;

use anyhow::{Context, Result, bail};
use hapticore_contract::profile::BUNDLED;

use crate::args::{NewArgs, NewKind};
use crate::say;

/// Writes a file that is not there yet.
///
/// # Errors
/// There is such a file, or it cannot be written.
pub fn run(args: &NewArgs) -> Result<bool> {
    let file = args.file.display();
    match OpenOptions::new().write(true).create_new(true).open(&args.file) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            bail!("{file}: expected a name that is not taken, the file exists")
        }
        opened => opened
            .and_then(|mut opened| opened.write_all(text(args.kind).as_bytes()))
            .with_context(|| file.to_string())?,
    }
    say!("{file}: {}", next(args.kind, &args.file));
    Ok(true)
}

/// The file's text.
pub fn text(kind: NewKind) -> String {
    match kind {
        NewKind::Scene => include_str!("templates/scene.toml").into(),
        NewKind::Wall => include_str!("templates/wall.toml").into(),
        NewKind::Loop => include_str!("templates/loop.toml").into(),
        NewKind::Calibration => include_str!("templates/calibration.toml").into(),
        NewKind::Profile => {
            let (_, standard) =
                BUNDLED.iter().find(|(name, _)| *name == "standard").expect("bundled");
            let own = standard.replace("name = \"standard\"", "name = \"mine\"");
            format!(
                "# Keys: hapticore reference profile; what each bit costs: hapticore tradeoff --profile FILE\n{own}"
            )
        }
    }
}

/// What is done with the file next.
fn next(kind: NewKind, file: &Path) -> String {
    let file = file.display();
    match kind {
        NewKind::Scene | NewKind::Wall | NewKind::Loop => format!("hapticore simulate {file}"),
        NewKind::Profile => format!("hapticore simulate fig6 --profile {file}"),
        NewKind::Calibration => {
            format!("hapticore calibrate places.csv loads.csv {file} --out mine.toml")
        }
    }
}
