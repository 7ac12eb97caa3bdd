// SPDX-License-Identifier: MIT OR Apache-2.0
//! Keys that belong to a scene as a whole, so that a case cannot set them.

use crate::error::SceneError;
use crate::format::{Key, Table, Word, keys};

keys! { KEYS:
    /// Title of the scene, one line.
    TITLE: String = Key::text("title").required("text");
    /// A few sentences about the scene.
    SUMMARY: String = Key::text("summary").or("");
    /// Profile of the core: a bundled name or a TOML file.
    PROFILE: String = Key::text("profile").or("standard");
    /// Samples of the core's window, where the profile's is too short for the haptic frequency.
    WINDOW_SAMPLES: Option<u64> = Key::whole("window_samples", 1, 1 << 20).usually("the profile's");
    /// Samples blanked before the window, where the profile's slots are too long.
    SETTLE_SAMPLES: Option<u64> = Key::whole("settle_samples", 0, 1 << 20).usually("the profile's");
    /// Seed of noise and mismatch.
    SEED: u64 = Key::whole("seed", 0, i64::MAX as u64).or(1);
    /// How a report draws the scene, after the paper's figures.
    FIGURE: Option<Figure> = Key::words("figure");
    /// What a run writes, some of `frames`, `report`, `capture` and `waves`.
    RECORD: Option<Vec<String>> = Key::texts("record").usually("`[\"frames\", \"report\"]`");
}

/// How a report draws the scene, after the paper's figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Figure {
    /// The sensor's sum over pad position.
    Fig3,
    /// The sensor's sum over load and haptic voltage.
    Fig4,
    /// Friction and eq. 8 over the haptic voltage.
    Fig6,
    /// Friction, eq. 8 and the pad's voltage over time.
    Fig7,
    /// The force beside its target.
    Fig9,
    /// The direction that is read over the eccentricity of the push.
    Fig13,
    /// A pad at a wall: its place, the hand's force and the wall's over time.
    Fig15,
    /// Paths of several pads.
    Hockey,
}

impl Word for Figure {
    const WORDS: &[(&str, Figure)] = &[
        ("fig3", Figure::Fig3),
        ("fig4", Figure::Fig4),
        ("fig6", Figure::Fig6),
        ("fig7", Figure::Fig7),
        ("fig9", Figure::Fig9),
        ("fig13", Figure::Fig13),
        ("fig15", Figure::Fig15),
        ("hockey", Figure::Hockey),
    ];
}

/// Something that running a scene writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Record {
    /// One row per finished slot.
    Frames,
    /// A report with figures.
    Report,
    /// The ADC's samples.
    Capture,
    /// Waveforms of the core's signals.
    Waves,
}

/// What a run writes.
pub(crate) fn record(root: &Table) -> Result<Vec<Record>, SceneError> {
    let Some(words) = root.get(&RECORD)? else {
        return Ok(vec![Record::Frames, Record::Report]);
    };
    let record = |word: &String| match word.as_str() {
        "frames" => Ok(Record::Frames),
        "report" => Ok(Record::Report),
        "capture" => Ok(Record::Capture),
        "waves" => Ok(Record::Waves),
        other => Err(root.error(
            "record",
            format!("expected \"frames\", \"report\", \"capture\" or \"waves\", got {other:?}"),
        )),
    };
    words.iter().map(record).collect()
}

/// Whether a dotted key belongs to the scene as a whole.
pub(crate) fn is_whole(key: &str) -> bool {
    let first = key.split('.').next().unwrap_or_default();
    ["case", "criterion"].contains(&first) || KEYS.iter().any(|key| key.name == first)
}
