// SPDX-License-Identifier: MIT OR Apache-2.0
//! Work without the interpreter's lock, which Ctrl-C ends.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use anyhow::Result;
use hapticore_run::interrupt;
use pyo3::prelude::*;

use crate::failure::exception;

/// How often work asks whether Ctrl-C was pressed.
pub const PATIENCE: Duration = Duration::from_millis(50);

/// Does work on another thread, while this one, without the interpreter's lock, listens for signals.
///
/// # Errors
/// What the work returns; what a signal raises, once the work has stopped.
pub fn apart<T: Send>(py: Python<'_>, work: impl FnOnce() -> Result<T> + Send) -> PyResult<T> {
    py.detach(|| {
        thread::scope(|scope| {
            let (done, ended) = channel::<()>();
            let worker = scope.spawn(move || {
                let result = work();
                drop(done);
                result
            });
            while ended.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                let Err(raised) = signals() else { continue };
                interrupt::request();
                let stopped = worker.join();
                interrupt::withdraw();
                drop(stopped);
                return Err(raised);
            }
            let result = worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            result.map_err(exception)
        })
    })
}

/// Raises what a signal asks for.
///
/// # Errors
/// What the signal's handler raises: `KeyboardInterrupt`.
pub fn signals() -> PyResult<()> {
    Python::attach(|py| py.check_signals())
}

/// Holds a lock, for a thread without the interpreter's lock: one that has it would wait for itself.
pub fn held<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}
