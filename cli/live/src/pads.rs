// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rows of slots as rows of pads: what a page shows.
//!
//! A split pad has a slot for each part. Its place is the mean of those that its parts give, its capacitance their sum,
//! its force that which its controller uses: the mean of the halves or quadrants, or that of the part that brakes.

use hapticore_run::record::{Driven, Quantities, Row, Truth};

use crate::protocol::{Event, PadRow, State};
use crate::state::{Signs, Watch};

/// Parts of a pad whose last one alone brakes.
const STRIPS: usize = 3;

/// By how much a force is more than that of impacts where a wall brakes, N: more than a word's rounding.
const ROUNDING_N: f64 = 1e-3;

/// Least force of a hand that leaves a wall, N.
const PULLS_N: f64 = 0.01;

/// A wall as a pad meets it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// 0: it lies across x, 1: across y.
    pub axis: usize,
    /// Its surface, mm; none where it is off.
    pub mm: Option<f64>,
    /// Its inside is where coordinates are greater.
    pub above: bool,
}

impl Surface {
    /// How deep a place lies within the wall, mm; negative outside.
    fn depth_mm(&self, place_mm: [f64; 2]) -> Option<f64> {
        Some(self.inwards() * (place_mm[self.axis] - self.mm?))
    }

    fn inwards(&self) -> f64 {
        if self.above { 1.0 } else { -1.0 }
    }
}

/// The latest rows of all pads.
pub struct Pads {
    parts_mm: Vec<[f64; 2]>,
    has_finger: bool,
    /// Of each part of each pad.
    latest: Vec<Option<Row>>,
    rows: Vec<Option<PadRow>>,
    watches: Vec<Watch>,
}

impl Pads {
    /// Pads without a row.
    pub fn new(pads: usize, parts_mm: &[[f64; 2]], has_finger: bool) -> Pads {
        Pads {
            latest: (0..pads * parts_mm.len()).map(|_| None).collect(),
            rows: vec![None; pads],
            watches: vec![Watch::default(); pads],
            parts_mm: parts_mm.to_vec(),
            has_finger,
        }
    }

    /// Takes the row of a slot; the event that it leads to.
    pub fn add(&mut self, row: &Row, walls: &[Surface]) -> Option<Event> {
        let (parts, time_s) = (self.parts_mm.len(), row.time_s);
        let (pad, part) = (row.pad / parts, row.pad % parts);
        *self.latest.get_mut(row.pad)? = Some(row.clone());
        if part != parts - 1 {
            return None;
        }
        let mut of_pad = self.joined(pad, walls)?;
        let signs = self.signs(&of_pad, row, walls);
        let watch = &mut self.watches[pad];
        of_pad.state = watch.state(time_s, &of_pad.flags, &signs);
        let event = watch.event(time_s, &of_pad);
        self.rows[pad] = Some(of_pad);
        event
    }

    /// The latest row of each pad that has one, at a device time.
    pub fn rows(&self, time_s: f64) -> Vec<PadRow> {
        let parts = self.parts_mm.len();
        let aged = |row: &PadRow| {
            let last_s = self.latest[row.pad * parts + parts - 1].as_ref().map(|row| row.time_s);
            PadRow { age_ms: last_s.map(|last_s| 1e3 * (time_s - last_s)), ..row.clone() }
        };
        self.rows.iter().flatten().map(aged).collect()
    }

    /// One row of the latest of a pad's parts; none before each has one.
    fn joined(&self, pad: usize, walls: &[Surface]) -> Option<PadRow> {
        let parts = self.parts_mm.len();
        let rows: Vec<&Row> = self.latest[pad * parts..][..parts]
            .iter()
            .map(Option::as_ref)
            .collect::<Option<_>>()?;
        let last = *rows.last()?;
        let sum = |of: fn(&Row) -> f64| rows.iter().map(|row| of(row)).sum::<f64>();
        let mean = |of| sum(of) / parts as f64;
        let true_sum = |of: fn(&Row) -> f64| last.truth.map(|_| sum(of));
        let true_mean = |of| true_sum(of).map(|sum| sum / parts as f64);
        let of_truth = |of: fn(&Truth) -> f64| last.truth.as_ref().map(of);
        let of_finger = |of| of_truth(of).filter(|_| self.has_finger);
        // Parts lie around the pad's centre, so that their mean is it.
        let place = [mean(|row| row.measured.x_mm), mean(|row| row.measured.y_mm)];
        let force_n = match parts {
            STRIPS => last.measured.force_n,
            _ => mean(|row| row.measured.force_n),
        };
        Some(PadRow {
            pad,
            age_ms: None,
            x_mm: Some(place[0]),
            y_mm: Some(place[1]),
            force_n: Some(force_n),
            capacitance_pf: Some(sum(|row| row.measured.capacitance_pf)),
            haptic_v_rms: Some(last.measured.haptic_v_rms),
            true_x_mm: true_mean(|row| true_of(row, |of| of.x_mm)),
            true_y_mm: true_mean(|row| true_of(row, |of| of.y_mm)),
            true_force_n: of_truth(|truth| truth.quantities.force_n),
            true_capacitance_pf: true_sum(|row| true_of(row, |of| of.capacitance_pf)),
            true_haptic_v_rms: of_truth(|truth| truth.quantities.haptic_v_rms),
            finger_x_mm: of_finger(|truth| truth.set.x_mm),
            finger_y_mm: of_finger(|truth| truth.set.y_mm),
            hand_x_n: of_finger(|truth| truth.hand_x_n),
            hand_y_n: of_finger(|truth| truth.hand_y_n),
            load_g: of_truth(|truth| truth.load_g),
            target_n: last.driven.map(|driven| driven.target_n),
            drive_v_rms: last.driven.map(|driven| driven.drive_v_rms),
            depth_mm: walls.iter().filter_map(|wall| wall.depth_mm(place)).reduce(f64::max),
            state: State::default(),
            flags: joined_flags(&rows),
        })
    }

    /// What the state of a pad follows from.
    fn signs(&self, row: &PadRow, last: &Row, walls: &[Surface]) -> Signs {
        let measured = [row.x_mm, row.y_mm, row.force_n, row.capacitance_pf];
        // Where walls are off, a pad with a target of its own is in none.
        let has_wall = walls.iter().any(|wall| wall.mm.is_some());
        // An impact is no wall.
        let impact_n = last.game.map_or(0.0, |game| game.impact_n + ROUNDING_N);
        // A board says what it drives, not the force that the wall asks for.
        let is_within = row.depth_mm.is_some_and(|mm| mm > 0.0);
        let gives = |driven: &Driven| {
            driven.target_n > impact_n
                || last.truth.is_none() && is_within && driven.drive_v_rms > 0.0
        };
        let brakes = |driven: &Driven| has_wall && driven.free == Some(false) && gives(driven);
        let is_short = |driven: &Driven| driven.limited && driven.drive_v_rms > 0.0;
        let place = [row.true_x_mm, row.true_y_mm].map(|mm| mm.unwrap_or(f64::NAN));
        let hand_n = [row.hand_x_n, row.hand_y_n].map(|force_n| force_n.unwrap_or(0.0));
        let around: Vec<&Surface> =
            walls.iter().filter(|wall| wall.depth_mm(place).is_some_and(|mm| mm > 0.0)).collect();
        let pulls = |wall: &&Surface| -wall.inwards() * hand_n[wall.axis] > PULLS_N;
        Signs {
            not_finite: measured.iter().any(|value| !value.is_some_and(f64::is_finite)),
            fault: last.driven.is_some_and(|driven| driven.fault),
            braked: last.driven.as_ref().is_some_and(brakes),
            // Rows of a run have flags for it.
            limited: last.truth.is_none() && last.driven.as_ref().is_some_and(is_short),
            // In a corner the other wall may rightly brake.
            pulled_out: !around.is_empty() && around.iter().all(pulls),
        }
    }
}

fn true_of(row: &Row, of: fn(&Quantities) -> f64) -> f64 {
    row.truth.as_ref().map_or(f64::NAN, |truth| of(&truth.quantities))
}

/// The flags of all parts, each once.
fn joined_flags(rows: &[&Row]) -> String {
    let mut flags: Vec<&str> = Vec::new();
    for flag in rows.iter().flat_map(|row| row.flags.split('+')).filter(|flag| !flag.is_empty()) {
        if !flags.contains(&flag) {
            flags.push(flag);
        }
    }
    flags.join("+")
}
