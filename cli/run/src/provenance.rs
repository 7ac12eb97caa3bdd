// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where a run comes from, for `summary.json` and the report.

use chrono::{SecondsFormat, Utc};
use hapticore_scene::Scene;

use crate::record::Provenance;

/// The commit that this program was built from; empty or none where that is not known.
const COMMIT: Option<&str> = option_env!("HAPTICORE_COMMIT");

/// Version and commit of this program: `0.1.0 (1234567890ab)`.
pub fn version() -> String {
    let Provenance { version, commit, .. } = Provenance::new();
    commit.map_or(version.clone(), |commit| format!("{version} ({commit})"))
}

/// The time, UTC: `2026-11-30T01:02:03Z`.
pub fn now() -> String {
    Utc::now().to_rfc3339_opts(SecondsFormat::Secs, true)
}

impl Provenance {
    /// Of this program, as it was called.
    pub fn new() -> Self {
        Provenance {
            version: env!("CARGO_PKG_VERSION").into(),
            commit: COMMIT.filter(|commit| !commit.is_empty()).map(Into::into),
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
