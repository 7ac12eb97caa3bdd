// SPDX-License-Identifier: MIT OR Apache-2.0
//! A part of a store: a file of lines, read with what is wrong in it, and written whole or not at all.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};

use crate::result::Line;

/// A part with lines that cannot be read.
#[derive(Debug)]
pub struct Torn {
    /// The file.
    pub path: PathBuf,
    /// What is wrong: `FILE:LINE: what`.
    pub message: String,
    /// Its good lines.
    pub(crate) good: String,
}

/// A part as it was read.
pub(crate) struct Part {
    pub path: PathBuf,
    pub lines: Vec<Line>,
    pub torn: Option<Torn>,
}

impl Part {
    pub fn read(path: PathBuf) -> Result<Part> {
        let bytes = fs::read(&path).with_context(|| path.display().to_string())?;
        let (mut lines, mut good, mut wrong) = (Vec::new(), String::new(), None);
        for (n, bytes) in bytes.split_inclusive(|byte| *byte == b'\n').enumerate() {
            let text = std::str::from_utf8(bytes).map_err(|error| error.to_string());
            let whole = text.and_then(|text| {
                text.strip_suffix('\n').ok_or_else(|| "the line has no end".to_string())
            });
            match whole.and_then(|text| Ok((Line::read(text)?, text))) {
                Ok((line, text)) => {
                    lines.push(line);
                    good += text;
                    good.push('\n');
                }
                Err(what) => {
                    wrong.get_or_insert_with(|| format!("{}:{}: {what}", path.display(), n + 1));
                }
            }
        }
        let torn = wrong.map(|message| Torn { path: path.clone(), message, good });
        Ok(Part { path, lines, torn })
    }
}

/// Writes a file whole or not at all.
pub(crate) fn write(path: &Path, text: &str) -> Result<()> {
    write_bytes(path, text.as_bytes())
}

/// As [`write()`], of any bytes.
pub(crate) fn write_bytes(path: &Path, bytes: &[u8]) -> Result<()> {
    hapticore_files::write_bytes(path, bytes)
        .map_err(|error| anyhow!("{}: {error}", path.display()))
}
