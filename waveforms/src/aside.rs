// SPDX-License-Identifier: MIT OR Apache-2.0
//! A file written aside and renamed when whole.

use std::fs;
use std::path::{Path, PathBuf};

use crate::Error;

/// The place beside `path` where a file grows. Unless kept, it goes when this goes.
pub(crate) struct Aside {
    path: PathBuf,
    partial: PathBuf,
    kept: bool,
}

impl Aside {
    /// A place beside `path`, in the same folder so that the rename is one step. Creates nothing. The process id keeps
    /// two runs into one folder apart.
    pub(crate) fn new(path: &Path) -> Self {
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".{}.partial", std::process::id()));
        Aside { path: path.to_owned(), partial: path.with_file_name(name), kept: false }
    }

    /// Where to write.
    pub(crate) fn partial(&self) -> &Path {
        &self.partial
    }

    /// The name the file will have.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the finished file its name, in place of any older file of that name.
    pub(crate) fn keep(&mut self) -> Result<(), Error> {
        fs::rename(&self.partial, &self.path).map_err(Error::io(&self.path))?;
        self.kept = true;
        Ok(())
    }
}

impl Drop for Aside {
    fn drop(&mut self) {
        if !self.kept {
            // Nobody is left to tell: it may never have been created.
            let _ = fs::remove_file(&self.partial);
        }
    }
}

/// Writes a whole small file aside and gives it its name.
pub(crate) fn write(path: &Path, text: &str) -> Result<(), Error> {
    let mut aside = Aside::new(path);
    fs::write(aside.partial(), text).map_err(Error::io(path))?;
    aside.keep()
}
