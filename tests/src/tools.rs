// SPDX-License-Identifier: MIT OR Apache-2.0
//! The HDL tools that tests look through.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Whether all these commands are on the path.
pub fn have(commands: &[&str]) -> bool {
    commands.iter().all(|command| find(command).is_some())
}

/// The file of a command, where it is on the path.
pub fn find(command: &str) -> Option<PathBuf> {
    let paths = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&paths).map(|folder| folder.join(command)).find(|file| file.is_file())
}

/// Runs a command in a folder to its end.
///
/// # Panics
/// Where it cannot be started, or fails; with all of its output.
pub fn run(command: &mut Command, folder: &Path) -> String {
    let Output { status, stdout, stderr } =
        command.current_dir(folder).output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let log = String::from_utf8_lossy(&stdout).into_owned();
    assert!(status.success(), "{command:?}: {status}\n{log}\n{}", String::from_utf8_lossy(&stderr));
    log
}
