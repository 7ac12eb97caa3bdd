// SPDX-License-Identifier: MIT OR Apache-2.0
//! A folder whose files appear together.

use crate::partial;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Files in the making, for one folder. Dropped before [`AtomicFolder::persist`], they leave
/// nothing behind, nor does a folder that was made for them.
///
/// ```
/// # let root = tempfile::tempdir()?;
/// # let out = root.path().join("out/fig6");
/// let run = hapticore_files::AtomicFolder::create(&out)?;
/// std::fs::write(run.partial_path().join("frames.csv"), "time_s\n")?;
/// assert!(!out.join("frames.csv").exists());
/// assert_eq!(run.persist()?, [out.join("frames.csv")]);
/// assert!(out.join("frames.csv").exists());
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct AtomicFolder {
    folder: PathBuf,
    partial: Option<TempDir>,
    lock: Option<File>,
    created: Vec<PathBuf>,
}

impl AtomicFolder {
    /// Makes the folder where it is not there; clears what killed writers left in it.
    ///
    /// # Errors
    /// It cannot be made or written to.
    pub fn create(folder: &Path) -> io::Result<Self> {
        let missing = |path: &&Path| !path.as_os_str().is_empty() && !path.exists();
        let created = folder.ancestors().take_while(missing).map(Path::to_owned).collect();
        let mut made =
            AtomicFolder { folder: folder.to_owned(), partial: None, lock: None, created };
        fs::create_dir_all(folder)?;
        partial::clear(folder);
        made.partial = Some(tempfile::Builder::new().prefix(partial::PREFIX).tempdir_in(folder)?);
        made.lock = Some(partial::hold(made.partial_path())?);
        Ok(made)
    }

    /// The temporary folder in which files are written.
    ///
    /// # Panics
    /// Proved: it is there until the files are persisted.
    pub fn partial_path(&self) -> &Path {
        self.partial.as_ref().expect("there until persisted").path()
    }

    /// Path of the folder that the files will appear in.
    pub fn path(&self) -> &Path {
        &self.folder
    }

    /// Gives all files their names, in place of older ones; their paths, in order.
    ///
    /// # Errors
    /// A file cannot be renamed; the message names it.
    pub fn persist(mut self) -> io::Result<Vec<PathBuf>> {
        let entries = fs::read_dir(self.partial_path())?.collect::<Result<Vec<_>, _>>()?;
        let mut names: Vec<_> = entries.into_iter().map(|entry| entry.file_name()).collect();
        names.retain(|name| name != partial::LOCK);
        names.sort();
        let mut paths = Vec::new();
        for name in names {
            let path = self.folder.join(&name);
            fs::rename(self.partial_path().join(&name), &path).map_err(|error| {
                io::Error::new(error.kind(), format!("{}: {error}", path.display()))
            })?;
            paths.push(path);
        }
        self.created.clear();
        Ok(paths)
    }
}

impl Drop for AtomicFolder {
    fn drop(&mut self) {
        drop(self.partial.take());
        drop(self.lock.take());
        for folder in &self.created {
            // Somebody else may have written there meanwhile: only empty folders go.
            let _ = fs::remove_dir(folder);
        }
    }
}
