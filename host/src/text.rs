// SPDX-License-Identifier: MIT OR Apache-2.0
//! Text files, and the messages about wrong ones.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A file that cannot be read, or is no text.
#[derive(Debug, thiserror::Error)]
#[error("{}", path.display())]
pub struct ReadError {
    /// Path of the file.
    pub path: PathBuf,
    /// The file system's error.
    pub source: io::Error,
}

/// A file's text.
///
/// # Errors
/// It cannot be read, or is no text.
pub fn read(path: &Path) -> Result<String, ReadError> {
    fs::read_to_string(path).map_err(|source| ReadError { path: path.to_owned(), source })
}

/// A message `LINE: what` about a TOML text, with the key of the line.
pub fn with_key(text: &str, message: &str) -> String {
    let named = message.split_once(':').and_then(|(number, what)| {
        let line = text.lines().nth(number.parse::<usize>().ok()?.checked_sub(1)?)?;
        let key = line.split_once('=')?.0.trim();
        Some(format!("{number}: {key}:{what}"))
    });
    named.unwrap_or_else(|| message.to_string())
}
