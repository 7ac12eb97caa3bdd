// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a run has begun to write, under a name that says so: `.partial-…`, locked as long as the
//! run lives.
//!
//! A run that is stopped takes it away itself. One that is killed cannot: the next run in the same
//! folder finds it unlocked and clears it.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// How names of what is not finished begin.
pub const PREFIX: &str = ".partial-";

/// The file within an unfinished folder that is locked.
pub(crate) const LOCK: &str = ".running";

/// A run locks what it creates within this time.
const GRACE: Duration = Duration::from_secs(1);

/// Locks an unfinished folder, as long as the file is held.
///
/// # Errors
/// The folder cannot be written to.
pub(crate) fn hold(folder: &Path) -> io::Result<File> {
    let lock = File::create(folder.join(LOCK))?;
    lock_file(&lock);
    Ok(lock)
}

/// Locks an unfinished file, as long as it is open.
pub(crate) fn lock_file(file: &File) {
    // Where the file system has no locks, nothing is ever cleared.
    let _ = file.try_lock();
}

/// Removes what runs that are no more have left unfinished in a folder. What cannot be removed
/// stays.
///
/// Writers into the folder do so implicitly; call this where there may be nothing left to write.
pub fn clear(folder: &Path) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let partial = entries.filter(|entry| entry.file_name().to_string_lossy().starts_with(PREFIX));
    for path in partial.map(|entry| entry.path()).filter(|path| is_abandoned(path)) {
        let _ = if path.is_dir() { fs::remove_dir_all(&path) } else { fs::remove_file(&path) };
    }
}

fn is_abandoned(path: &Path) -> bool {
    let lock: PathBuf = if path.is_dir() { path.join(LOCK) } else { path.into() };
    let free = match File::open(lock) {
        Ok(lock) => lock.try_lock().is_ok(),
        Err(error) => error.kind() == io::ErrorKind::NotFound,
    };
    free && is_older(path, GRACE)
}

fn is_older(path: &Path, than: Duration) -> bool {
    let changed = fs::symlink_metadata(path).and_then(|data| data.modified()).ok();
    changed.and_then(|when| when.elapsed().ok()).is_some_and(|age| age >= than)
}
