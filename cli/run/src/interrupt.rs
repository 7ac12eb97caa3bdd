// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ctrl-C, SIGTERM, SIGHUP: a run is told to stop, so that it can take away what it has begun to
//! write.

use std::sync::atomic::{AtomicBool, Ordering};

static REQUESTED: AtomicBool = AtomicBool::new(false);

/// The run was told to stop.
#[derive(Debug, thiserror::Error)]
#[error("interrupted: nothing written")]
pub struct Interrupted;

/// Begins to listen for these signals. Where the system has none, runs end as they would.
pub fn listen() {
    let _ = ctrlc::set_handler(|| REQUESTED.store(true, Ordering::Relaxed));
}

/// Whether to go on.
///
/// # Errors
/// After such a signal.
pub fn check() -> Result<(), Interrupted> {
    if REQUESTED.load(Ordering::Relaxed) { Err(Interrupted) } else { Ok(()) }
}
