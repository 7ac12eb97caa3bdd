// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ctrl-C, SIGTERM and SIGHUP ask a run to stop, so that it can remove what it has begun to write.
//!
//! A run that does not check, since it waits for something that may never come (a named pipe
//! without a writer), is ended after a while. What it leaves is cleared as that of a killed one.

use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

/// The exit status of a run that was told to stop.
pub const STATUS: u8 = 130;

/// A run asks within this time.
const PATIENCE: Duration = Duration::from_secs(10);

static REQUESTED: AtomicBool = AtomicBool::new(false);
static NOTICED: AtomicBool = AtomicBool::new(false);

/// The run was told to stop.
#[derive(Debug, thiserror::Error)]
#[error("interrupted: nothing written")]
pub struct Interrupted;

/// Begins to listen for these signals. Where the system has none, runs end as they would.
pub fn listen() {
    let _ = ctrlc::set_handler(|| {
        REQUESTED.store(true, Ordering::Relaxed);
        thread::sleep(PATIENCE);
        if !NOTICED.load(Ordering::Relaxed) {
            eprintln!("interrupted");
            process::exit(STATUS.into());
        }
    });
}

/// Asks all runs of this process to stop, where a program that holds them hears signals itself.
pub fn request() {
    REQUESTED.store(true, Ordering::Relaxed);
}

/// Lets later runs begin again.
pub fn withdraw() {
    REQUESTED.store(false, Ordering::Relaxed);
    NOTICED.store(false, Ordering::Relaxed);
}

/// Whether to go on.
///
/// # Errors
/// After such a signal, or [`request`].
pub fn check() -> Result<(), Interrupted> {
    if !REQUESTED.load(Ordering::Relaxed) {
        return Ok(());
    }
    NOTICED.store(true, Ordering::Relaxed);
    Err(Interrupted)
}
