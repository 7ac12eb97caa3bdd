// SPDX-License-Identifier: MIT OR Apache-2.0
//! Summary of a run at its end: flagged frames by kind and pad, and the error of each pad's force against its target
//! and against the core's measurement. For walls, also the sticking force on a hand that leaves.

mod drives;
mod sentences;
pub mod states;

use std::collections::BTreeMap;

use serde::Serialize;

use crate::record::Row;
pub use drives::{Tracking, of_case as of_drives};
pub use sentences::{lines, warnings};

/// A flag of a pad's frames in a case.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Flagged {
    /// Name of the flag.
    pub flag: String,
    /// Name of the case.
    pub case: String,
    /// Name of the pad, or of its part.
    pub pad: String,
    /// Frames that carry it.
    pub frames: usize,
    /// Frames of the pad in the case.
    pub of: usize,
    /// Mean of the force that is read over the mean of the true force in these frames, less one, percent; none without
    /// a true force.
    pub force_percent: Option<f64>,
}

/// What a run leaves to be known at its end.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Findings {
    /// Flagged frames by case, pad and kind.
    pub flagged: Vec<Flagged>,
    /// Controlled pads by case.
    pub tracking: Vec<Tracking>,
    /// What of the device has changed since it was calibrated, by case.
    pub changed: BTreeMap<String, Vec<String>>,
}

impl Findings {
    /// Whether there is nothing to be known.
    pub fn is_empty(&self) -> bool {
        *self == Findings::default()
    }

    /// Adds the flags of a case's rows; `pads` are the names of what is served.
    pub fn add_flags(&mut self, case: &str, pads: &[String], rows: &[Row]) {
        for (pad, name) in pads.iter().enumerate() {
            let of_pad: Vec<&Row> = rows.iter().filter(|row| row.pad == pad).collect();
            let mut kinds: Vec<&str> = of_pad.iter().flat_map(|row| flags(row)).collect();
            kinds.sort_unstable();
            kinds.dedup();
            self.flagged.extend(kinds.into_iter().map(|flag| {
                let frames: Vec<&Row> = of_pad
                    .iter()
                    .copied()
                    .filter(|row| flags(row).any(|other| other == flag))
                    .collect();
                Flagged {
                    flag: flag.into(),
                    case: case.into(),
                    pad: name.clone(),
                    frames: frames.len(),
                    of: of_pad.len(),
                    force_percent: force_percent(&frames),
                }
            }));
        }
    }

    /// Adds the pads that a controller drives.
    pub fn add_tracking(&mut self, tracking: impl IntoIterator<Item = Tracking>) {
        self.tracking.extend(tracking);
    }
}

/// Flags counted row by row, where rows are not kept.
#[derive(Debug, Clone, Default)]
pub struct Tally {
    frames: BTreeMap<usize, usize>,
    flagged: BTreeMap<(usize, String), usize>,
}

impl Tally {
    /// Counts a row.
    pub fn add(&mut self, row: &Row) {
        *self.frames.entry(row.pad).or_default() += 1;
        for flag in flags(row) {
            *self.flagged.entry((row.pad, flag.to_string())).or_default() += 1;
        }
    }

    /// The flagged frames of all pads, in a case of this name.
    pub fn flagged(self, case: &str, pads: &[String]) -> Vec<Flagged> {
        let of = |((pad, flag), frames): ((usize, String), usize)| Flagged {
            flag,
            case: case.into(),
            pad: pads.get(pad).cloned().unwrap_or_else(|| format!("pad {pad}")),
            frames,
            of: self.frames[&pad],
            force_percent: None,
        };
        self.flagged.into_iter().map(of).collect()
    }
}

fn flags(row: &Row) -> impl Iterator<Item = &str> {
    row.flags.split('+').filter(|flag| !flag.is_empty())
}

/// Below this a true force is none, N.
const LEAST_N: f64 = 0.005;

/// What is read of the true force, less one, percent.
fn force_percent(rows: &[&Row]) -> Option<f64> {
    let sum = |of: fn(&Row) -> Option<f64>| rows.iter().filter_map(|row| of(row)).sum::<f64>();
    let truth_n = sum(|row| row.truth.map(|truth| truth.quantities.force_n));
    let read_n = sum(|row| row.truth.map(|_| row.measured.force_n));
    (truth_n > LEAST_N * rows.len() as f64).then(|| 100.0 * (read_n / truth_n - 1.0))
}
