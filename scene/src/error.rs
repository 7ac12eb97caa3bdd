// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is wrong with a scene, in one line: file, line, key, what was expected and what was found.

use std::fmt;

/// Where a value was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line of the scene file, counted from one.
    Line(usize),
    /// An override given beside the file, as `--set KEY=VALUE`.
    Override,
    /// Not tied to a line: something missing from the file as a whole.
    File,
}

/// A scene that cannot be run, and why.
///
/// ```
/// use hapticore_scene::Scene;
///
/// let text = "title = \"typo\"\n[[pad]]\nposition_mm = [0, 0]\nload = 50\n";
/// let error = Scene::parse(text, "typo.toml", &[]).unwrap_err();
/// assert_eq!(error.to_string(), "typo.toml:4: pad.0.load: expected load_g, since a key names its unit");
/// ```
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct SceneError {
    /// The scene's file, or the name of a bundled scene.
    pub file: String,
    /// Where in the file, or that an override did it.
    pub place: Place,
    /// The key in dotted form, `sheet.rung`; empty where the text is no TOML at all.
    pub key: String,
    /// What was expected and what was found.
    pub message: String,
}

impl SceneError {
    pub(crate) fn new(place: Place, key: impl Into<String>, message: impl Into<String>) -> Self {
        SceneError { file: String::new(), place, key: key.into(), message: message.into() }
    }

    pub(crate) fn in_file(mut self, file: &str) -> Self {
        self.file = file.to_string();
        self
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file)?;
        match self.place {
            Place::Line(line) => write!(f, ":{line}: ")?,
            Place::Override => write!(f, ": --set ")?,
            Place::File => write!(f, ": ")?,
        }
        match self.key.as_str() {
            "" => write!(f, "{}", self.message),
            key => write!(f, "{key}: {}", self.message),
        }
    }
}
