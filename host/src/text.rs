// SPDX-License-Identifier: MIT OR Apache-2.0
//! Text files, and the messages about wrong ones.

use std::fs::File;
use std::io::{self, Read};
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

/// The largest text, bytes: all of it is held in memory, and a device or a pipe may have no end.
pub const MOST_BYTES: u64 = 1 << 22;

/// A file's text.
///
/// # Errors
/// It cannot be read, is no text, or is longer than [`MOST_BYTES`].
pub fn read(path: &Path) -> Result<String, ReadError> {
    let mut text = String::new();
    let no_text = |error: io::Error| match error.kind() {
        io::ErrorKind::InvalidData => io::Error::other("expected text (UTF-8), got other bytes"),
        _ => error,
    };
    File::open(path)
        .and_then(|file| file.take(MOST_BYTES + 1).read_to_string(&mut text).map_err(no_text))
        .and_then(|bytes| match bytes as u64 > MOST_BYTES {
            true => Err(io::Error::other(format!("expected a text of at most {MOST_BYTES} bytes"))),
            false => Ok(text),
        })
        .map_err(|source| ReadError { path: path.to_owned(), source })
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
