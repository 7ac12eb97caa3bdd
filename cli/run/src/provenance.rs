// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where a run comes from, for `summary.json`.

use hapticore_scene::Scene;

use crate::record::Provenance;

impl Provenance {
    /// Of this program, as it was called.
    pub fn new() -> Self {
        let commit = option_env!("HAPTICORE_COMMIT").filter(|commit| !commit.is_empty());
        Provenance {
            version: env!("CARGO_PKG_VERSION").into(),
            commit: commit.map(Into::into),
            command: std::env::args_os().map(|word| word.to_string_lossy().into_owned()).collect(),
            ..Provenance::default()
        }
    }

    /// The same, of a run of a scene with keys set.
    pub fn of_scene(scene: &Scene, set: &[(String, String)]) -> Self {
        let documents = scene.cases.iter().map(|case| (case.name.clone(), case.document.clone()));
        Provenance {
            seed: Some(scene.seed),
            set: set.to_vec(),
            resolved_scene: documents.collect(),
            ..Provenance::new()
        }
    }
}
