// SPDX-License-Identifier: MIT OR Apache-2.0
//! Manual pages of the command and of each subcommand, for `man`.

use std::path::Path;

use anyhow::{Context as _, Result};
use clap::{Command, CommandFactory as _};
use clap_mangen::Man;

use crate::args::Args;

/// Writes `hapticore.1`, `hapticore-simulate.1`, … into a folder, which is made where there is none; their names.
///
/// # Errors
/// A file that cannot be written.
pub fn write(folder: &Path) -> Result<Vec<String>> {
    std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let mut command = Args::command().disable_help_subcommand(true);
    // Subcommands get their whole names, `hapticore sweep run`.
    command.build();
    let mut names = Vec::new();
    pages(&command, folder, &mut names)?;
    Ok(names)
}

fn pages(command: &Command, folder: &Path, names: &mut Vec<String>) -> Result<()> {
    let man = Man::new(command.clone());
    let mut page = Vec::new();
    man.render(&mut page)?;
    let name = man.get_filename();
    let path = folder.join(&name);
    hapticore_files::write_bytes(&path, &page).with_context(|| path.display().to_string())?;
    names.push(name);
    command.get_subcommands().try_for_each(|within| pages(within, folder, names))
}
