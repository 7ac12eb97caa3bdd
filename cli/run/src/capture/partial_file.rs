// SPDX-License-Identifier: MIT OR Apache-2.0
//! A capture's file, written atomically.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use anyhow::{Context, Result};
use hapticore_files::AtomicFile;

/// A file that gets its name when it is complete.
pub(super) struct PartialFile {
    /// Buffered writer into the temporary file.
    pub file: BufWriter<File>,
    atomic: AtomicFile,
}

impl PartialFile {
    /// A file that will be called `path`.
    pub fn create(path: &Path) -> Result<Self> {
        let within = || path.display().to_string();
        let atomic = AtomicFile::create(path).with_context(within)?;
        let file = BufWriter::with_capacity(1 << 18, atomic.reopen().with_context(within)?);
        Ok(PartialFile { file, atomic })
    }

    /// The name that it will have.
    pub fn path(&self) -> &Path {
        self.atomic.path()
    }

    /// Completes the file and gives it its name.
    pub fn keep(mut self) -> Result<()> {
        let path = self.path().display().to_string();
        self.file.flush().and_then(|()| self.atomic.persist()).context(path)
    }
}
