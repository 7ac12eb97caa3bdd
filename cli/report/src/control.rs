// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pads with a target force, case by case, and how far each is off it.

use super::select::{extent, pad_name, pads, rms};
use hapticore_run::record::{Driven, Record, Row, Truth};

/// The law that no measurement changes.
pub const OPEN: &str = "open";

/// A pad with a controller in a case.
pub struct Panel<'a> {
    /// The case, and the pad where there are several.
    pub name: String,
    /// The controller's law, where it is known.
    pub law: Option<&'static str>,
    /// Pad number, from 0.
    pub pad: usize,
    /// Its slots, each with the time since the first slot of the case, s, and what is true of it.
    pub rows: Vec<(f64, &'a Row, Truth)>,
}

/// The pads of a run that a controller drives.
pub fn panels(record: &Record) -> Vec<Panel<'_>> {
    let several = pads(record).len() > 1;
    let mut panels = Vec::new();
    for rows in record.rows.cases() {
        for pad in pads(record) {
            let case = record.cases.get(rows[0].case).map_or("", String::as_str);
            let of_several = several.then(|| pad_name(record, pad));
            let name =
                [case].into_iter().chain(of_several.as_deref()).collect::<Vec<_>>().join(", ");
            let law = record.laws.get(case).copied();
            let of_pad = rows.iter().filter(|row| row.pad == pad && row.driven.is_some());
            let start_s = rows[0].time_s;
            let timed = of_pad.filter_map(|row| Some((row.time_s - start_s, row, row.truth?)));
            panels.push(Panel { name, law, pad, rows: timed.collect() });
        }
    }
    panels.retain(|panel| !panel.rows.is_empty());
    panels
}

/// Panels of the same target together, the groups in the order of the first of each.
pub fn by_target(panels: Vec<Panel<'_>>) -> Vec<Vec<Panel<'_>>> {
    let mut groups: Vec<Vec<Panel>> = Vec::new();
    for panel in panels {
        match groups.iter_mut().find(|group| group[0].targets().eq(panel.targets())) {
            Some(group) => group.push(panel),
            None => groups.push(vec![panel]),
        }
    }
    groups
}

impl Panel<'_> {
    fn targets(&self) -> impl Iterator<Item = u64> {
        self.rows.iter().map(|(_, _, truth)| truth.set.target_n.to_bits())
    }

    /// The largest target, N.
    pub fn most_n(&self) -> f64 {
        let targets = self.rows.iter().map(|(_, _, truth)| truth.set.target_n);
        extent(targets).map_or(f64::NAN, |(_, most)| most)
    }

    /// Root mean square of the true force less its target, N.
    pub fn rms_n(&self) -> f64 {
        rms(self.off())
    }

    /// The most by which the true force is above its target, N.
    pub fn overshoot_n(&self) -> f64 {
        extent(self.off()).map_or(f64::NAN, |(_, most)| most)
    }

    /// Slots whose drive is so.
    pub fn count(&self, is_so: fn(&Driven) -> bool) -> usize {
        self.rows.iter().filter(|(_, row, _)| row.driven.as_ref().is_some_and(is_so)).count()
    }

    fn off(&self) -> impl Iterator<Item = f64> {
        self.rows.iter().map(|(_, _, truth)| truth.off_target_n())
    }
}
