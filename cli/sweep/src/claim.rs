// SPDX-License-Identifier: MIT OR Apache-2.0
//! Chunks that some runner is at: locked files, so that two runners of one store share its work.
//!
//! The system takes the lock from a runner that is killed. Results never depend on a claim: where a
//! file system has no locks, or two hosts do not see each other's, points are run twice and are equal.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Duration;

use anyhow::{Context, Result};
use hapticore_run::interrupt;

/// How often a claim of another runner is tried again.
const AGAIN: Duration = Duration::from_millis(100);

/// Exclusive access to a chunk, until this is dropped.
#[derive(Debug)]
pub struct Claim {
    path: PathBuf,
    _file: File,
}

impl Claim {
    /// Claims what a file stands for; none while another runner has it.
    ///
    /// # Errors
    /// The file cannot be made.
    pub fn take(path: &Path) -> Result<Option<Claim>> {
        let file = File::create(path).with_context(|| path.display().to_string())?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => Ok(None),
            Ok(()) | Err(TryLockError::Error(_)) => {
                Ok(Some(Claim { path: path.into(), _file: file }))
            }
        }
    }

    /// Claims it as soon as no other runner has it.
    ///
    /// # Errors
    /// As [`Claim::take`]; an interruption.
    pub fn wait(path: &Path) -> Result<Claim> {
        loop {
            if let Some(claim) = Claim::take(path)? {
                return Ok(claim);
            }
            interrupt::check()?;
            sleep(AGAIN);
        }
    }
}

impl Drop for Claim {
    /// A runner that opened the file before its removal finds, once it has the lock, what was stored
    /// under it.
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}
