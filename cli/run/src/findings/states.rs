// SPDX-License-Identifier: MIT OR Apache-2.0
//! What keeps a controller from its target, frame by frame: added to the flags of the frame.
//!
//! | flag | from when on |
//! | --- | --- |
//! | `at_rail` | the drive has been at its rail, and the force short of its target |
//! | `at_curve` | the inverse law's drive has been at its curve, and the force short of its target |
//! | `at_slew` | the drive has changed by the most that it may |
//! | `swings` | the force has gone to and fro about a target that stays |
//!
//! Each has to last for 40 ms and 6 frames. They follow from what a host knows: the frame, the target and the
//! tuning; so they are of no core.

use hapticore_contract::control::{Control, Tuning};
use hapticore_scene::{ControlLaw, ControlPlan};

use crate::record::{Driven, Row};

/// How long a state lasts before a frame says so: longer than a gap takes to close.
const HELD_S: f64 = 0.04;
const HELD: usize = 6;
/// A force is short of its target by more than this part of it, and this many N. Eq. 8 alone reads up to 9 % low on random
/// devices at 0.3 to 0.4 N, where the true force lacks 4 % at most.
const SHORT: f64 = 0.12;
const SHORT_N: f64 = 0.005;
/// How near to a limit a drive is at it.
const NEAR: f64 = 0.003;
/// Frames that show a swing, how often it turns in them, and how wide it is, by its target.
const SWING: usize = 16;
const TURNS: usize = 6;
const WIDE: f64 = 0.15;

/// The names of the states, as flags.
pub const STATES: [&str; 4] = ["at_rail", "at_curve", "at_slew", "swings"];

/// What limits the drives of a case, followed from row to row.
pub struct Limits {
    drives: Drives,
    /// Of each part of each pad.
    watches: Vec<Watch>,
}

/// The limits themselves.
struct Drives {
    plan: ControlPlan,
    tuning: Tuning,
    root_full_scale: f64,
    /// Slots of each pad, the last of which is that of its drive.
    parts: usize,
    held: usize,
}

/// What has been going on at a pad.
#[derive(Default)]
struct Watch {
    before: Option<Driven>,
    lasted: [usize; 3],
    forces_n: Vec<f64>,
}

impl Limits {
    /// Those of a tuning, before the first row; `frame_s` is the time from a pad's slot to its next,
    /// `served` counts the parts of all pads.
    pub fn new(
        (plan, control): (ControlPlan, &Control),
        tuning: Tuning,
        (parts, frame_s): (usize, f64),
        served: usize,
    ) -> Self {
        let held = ((HELD_S / frame_s).ceil() as usize).max(HELD);
        let root_full_scale = control.root_full_scale();
        let watches = (0..served).map(|_| Watch::default()).collect();
        Limits { drives: Drives { plan, tuning, root_full_scale, parts, held }, watches }
    }

    /// Adds to the flags of the next frame what keeps its pad from its target.
    pub fn mark(&mut self, row: &mut Row) {
        let parts = self.drives.parts;
        let Some(driven) = row.driven.filter(|_| row.pad % parts == parts - 1) else { return };
        let states = self.watches[row.pad].look(&self.drives, &driven, row.measured.force_n);
        for (name, _) in STATES.iter().zip(states).filter(|(_, is_so)| *is_so) {
            if !row.flags.is_empty() {
                row.flags.push('+');
            }
            row.flags.push_str(name);
        }
    }
}

impl Drives {
    /// The curve's voltage for a target.
    fn curve_v(&self, target_n: f64) -> f64 {
        let (curve, cells) = (&self.tuning.curve, self.tuning.curve.len() - 1);
        let at = (target_n.max(0.0).sqrt() / self.root_full_scale).min(1.0) * cells as f64;
        let cell = (at as usize).min(cells - 1);
        let part = curve[cell] + (curve[cell + 1] - curve[cell]) * (at - cell as f64);
        self.plan.full_scale_v * part
    }
}

impl Watch {
    /// Which states a frame is in.
    fn look(&mut self, limits: &Drives, driven: &Driven, force_n: f64) -> [bool; 4] {
        let plan = &limits.plan;
        let Driven { target_n, drive_v_rms, fault, .. } = *driven;
        let before = self.before.replace(*driven);
        let near = |limit_v: f64| drive_v_rms >= limit_v * (1.0 - NEAR);
        let is_short = !fault && force_n < target_n * (1.0 - SHORT) - SHORT_N;
        let at_rail = is_short && near(plan.rail_v);
        let of_curve = plan.law == ControlLaw::Inverse && !at_rail;
        let at_curve = of_curve && is_short && near(limits.curve_v(target_n));
        let changed_v = before.map_or(0.0, |before| (drive_v_rms - before.drive_v_rms).abs());
        let at_slew = !fault && changed_v >= plan.slew_v * (1.0 - NEAR);
        for (lasted, is_so) in self.lasted.iter_mut().zip([at_rail, at_curve, at_slew]) {
            *lasted = if is_so { *lasted + 1 } else { 0 };
        }
        if before.is_none_or(|before| before.target_n != target_n) || target_n <= 0.0 {
            self.forces_n.clear();
        }
        if self.forces_n.len() == SWING {
            self.forces_n.remove(0);
        }
        self.forces_n.push(force_n);
        let [rail, curve, slew] = self.lasted.map(|lasted| lasted >= limits.held);
        [rail, curve, slew, swings(&self.forces_n, target_n)]
    }
}

/// Whether forces go to and fro.
fn swings(forces_n: &[f64], target_n: f64) -> bool {
    if forces_n.len() < SWING {
        return false;
    }
    let most = forces_n.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = forces_n.iter().copied().fold(f64::INFINITY, f64::min);
    let middle = 0.5 * (most + least);
    let crossings = forces_n.windows(2).filter(|pair| (pair[0] > middle) != (pair[1] > middle));
    most - least > WIDE * target_n + 2.0 * SHORT_N && crossings.count() >= TURNS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_that_goes_to_and_fro_swings_and_one_that_rises_does_not() {
        let swinging: Vec<f64> = (0..SWING).map(|n| [0.2, 0.7][n % 2]).collect();
        let rising: Vec<f64> = (0..SWING).map(|n| 0.05 * n as f64).collect();
        assert!(swings(&swinging, 0.4) && !swings(&rising, 0.4) && !swings(&swinging[1..], 0.4));
    }
}
