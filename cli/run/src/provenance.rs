// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where a run comes from, for `summary.json` and the report.

use std::time::{SystemTime, UNIX_EPOCH};

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
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    date(since.as_secs())
}

/// A time in seconds since 1970, by the days of the Gregorian calendar.
fn date(seconds: u64) -> String {
    let of_day = seconds % 86_400;
    let (mut days, mut year, mut month) = (seconds / 86_400, 1970, 0);
    let leaps =
        |year: u64| year.is_multiple_of(4) && !year.is_multiple_of(100) || year.is_multiple_of(400);
    while days >= 365 + u64::from(leaps(year)) {
        days -= 365 + u64::from(leaps(year));
        year += 1;
    }
    let february = 28 + u64::from(leaps(year));
    for length in [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31] {
        month += 1;
        if days < length {
            break;
        }
        days -= length;
    }
    let (hour, minute, second) = (of_day / 3600, of_day / 60 % 60, of_day % 60);
    format!("{year}-{month:02}-{:02}T{hour:02}:{minute:02}:{second:02}Z", days + 1)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        let dates = [0, 951_782_399, 951_782_400, 4_107_542_399].map(date);
        let known = [
            "1970-01-01T00:00:00Z",
            "2000-02-28T23:59:59Z",
            "2000-02-29T00:00:00Z",
            "2100-02-28T23:59:59Z",
        ];
        assert_eq!(dates, known);
    }
}
