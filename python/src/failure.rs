// SPDX-License-Identifier: MIT OR Apache-2.0
//! Errors of Rust as exceptions of the package (hapticore/errors.py).
//!
//! | error | exception |
//! | --- | --- |
//! | of a scene, or no such scene | `SceneError`, with key, file and line |
//! | of a profile | `ProfileError` |
//! | of a file that cannot be read or written | `OSError` |
//! | of a board | `BoardError` |
//! | an interruption | `KeyboardInterrupt` |
//! | any other | `Error` |

use std::io;

use anyhow::Result;
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_host::LoadProfileError;
use hapticore_run::engine::Fidelity;
use hapticore_run::inputs;
use hapticore_run::inputs::NoProfile;
use hapticore_run::interrupt::Interrupted;
use hapticore_scene::{Place, Scene, SceneError};
use pyo3::PyErr;
use pyo3::exceptions::PyKeyboardInterrupt;

/// The exceptions, as Python defines them.
mod exceptions {
    pyo3::import_exception!(hapticore.errors, Error);
    pyo3::import_exception!(hapticore.errors, SceneError);
    pyo3::import_exception!(hapticore.errors, ProfileError);
    pyo3::import_exception!(hapticore.errors, BoardError);
}

/// The longest message, characters: what an input holds is cited, however long.
const LONGEST: usize = 2000;

/// Flags of the command that messages name, which are arguments here.
const FLAGS: [&str; 19] = [
    "--set ",
    "--set:",
    "--case",
    "--core ",
    "--profile",
    "--calibration",
    "--pads",
    "--channels",
    "--bits",
    "--full-scale-v",
    "--skip",
    "--truncated",
    "--baud",
    "--control",
    "--dac",
    "--wave",
    "--tuning",
    "--slots",
    "--family",
];

/// No such scene.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct NoScene(String);

/// The scene of a bundled name or a file.
///
/// # Errors
/// No such scene, or one that cannot be run.
pub fn scene(name: &str, set: &[(String, String)]) -> Result<Scene> {
    inputs::scene(name, set).map_err(|error| match is_known(&error) {
        true => error,
        false => NoScene(format!("{error:#}")).into(),
    })
}

/// The profile of a bundled name or a file.
///
/// # Errors
/// No such profile, or one that no core can have.
pub fn profile(name: &str) -> Result<Profile> {
    inputs::profile(name)
}

/// The fidelity of a name.
///
/// # Errors
/// No such fidelity.
pub fn fidelity(name: &str) -> Result<Fidelity> {
    let all = [Fidelity::Float, Fidelity::Fixed, Fidelity::Clock];
    let found = all.into_iter().find(|fidelity| fidelity.name() == name);
    found.ok_or_else(|| anyhow::anyhow!("core: expected float, fixed or clock, got {name:?}"))
}

fn cause<T: std::error::Error + 'static>(error: &anyhow::Error) -> Option<&T> {
    error.chain().find_map(|cause| cause.downcast_ref::<T>())
}

fn is_known(error: &anyhow::Error) -> bool {
    cause::<SceneError>(error).is_some() || cause::<io::Error>(error).is_some()
}

/// An error as an exception.
pub fn exception(error: anyhow::Error) -> PyErr {
    if cause::<Interrupted>(&error).is_some() {
        return PyKeyboardInterrupt::new_err(());
    }
    if let Some(of_scene) = cause::<SceneError>(&error) {
        return of_a_scene(of_scene);
    }
    let message = shown(&format!("{error:#}"));
    if let Some(of_file) = cause::<io::Error>(&error) {
        return io::Error::new(of_file.kind(), message).into();
    }
    if cause::<NoScene>(&error).is_some() {
        return exceptions::SceneError::new_err((message, "", "", None::<usize>));
    }
    let of_profile =
        cause::<ProfileError>(&error).is_some() || cause::<NoProfile>(&error).is_some();
    if of_profile || cause::<LoadProfileError>(&error).is_some() {
        return exceptions::ProfileError::new_err(message);
    }
    exceptions::Error::new_err(message)
}

/// An exception with a message.
pub fn error(message: impl Into<String>) -> PyErr {
    exceptions::Error::new_err(message.into())
}

/// An exception of a board with a message.
pub fn board_error(message: impl AsRef<str>) -> PyErr {
    exceptions::BoardError::new_err(shown(message.as_ref()))
}

fn of_a_scene(error: &SceneError) -> PyErr {
    let line = match error.place {
        Place::Line(line) => Some(line),
        Place::Override | Place::File => None,
    };
    let message = shown(&error.to_string());
    exceptions::SceneError::new_err((message, error.key.clone(), error.file.clone(), line))
}

/// A message without the dashes of the command's flags, on one line.
pub fn shown(message: &str) -> String {
    let mut line = message.lines().map(str::trim).collect::<Vec<_>>().join(" ");
    for flag in FLAGS {
        line = line.replace(flag, &flag.trim_start_matches("--").replace('-', "_"));
    }
    match line.char_indices().nth(LONGEST) {
        Some((end, _)) => line[..end].to_string() + "…",
        None => line,
    }
}
