// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ctrl-C: a run is told to stop, so that it can take away what it has begun to write.

use std::sync::atomic::{AtomicBool, Ordering};

static REQUESTED: AtomicBool = AtomicBool::new(false);

/// The run was stopped by Ctrl-C.
#[derive(Debug, thiserror::Error)]
#[error("interrupted: nothing written")]
pub struct Interrupted;

/// Begins to listen for Ctrl-C. Where the system has no such signal, runs end as they would.
pub fn listen() {
    let _ = ctrlc::set_handler(|| REQUESTED.store(true, Ordering::Relaxed));
}

/// Whether to go on.
///
/// # Errors
/// After Ctrl-C.
pub fn check() -> Result<(), Interrupted> {
    if REQUESTED.load(Ordering::Relaxed) { Err(Interrupted) } else { Ok(()) }
}
