// SPDX-License-Identifier: MIT OR Apache-2.0
//! The host of a table of air hockey: frames of the core in, targets and walls of the pads out.
//!
//! ```text
//! row of slot n ─[mean of a pad's parts]─ game ─ targets and walls from slot n + 2 on
//! ```
//!
//! A host has the frame of a slot while the next one is sampled. So the game takes each row one slot late, at every
//! fidelity, and all fidelities play the same game.

use std::collections::VecDeque;

use hapticore_contract::control::Surface;
use hapticore_host::air_hockey::{Game, Puck, Rules};
use hapticore_scene::ArenaPlan;

use crate::control::plant::LoopInputs;
use crate::record::{GameRow, Row};

/// Standard gravity, mm/s².
const GRAVITY_MM_S2: f64 = 9806.65;

/// Flags of a frame that does not say where its pad is.
const UNPLACED: [&str; 5] = ["invalid", "lifted", "lost", "clipped", "saturated"];

/// Where a part of a pad was measured, and when, s; no place where it was not.
#[derive(Clone, Copy)]
struct Measured {
    part: usize,
    time_s: f64,
    place_mm: Option<[f64; 2]>,
}

/// A game, and the rows that it has not taken yet.
pub(super) struct Arena {
    game: Game,
    serve_s: Vec<f64>,
    /// How many of these times are over.
    served: usize,
    /// Parts of each pad.
    parts: usize,
    /// Of each part of each pad.
    latest: Vec<Option<Measured>>,
    rows: VecDeque<Measured>,
    /// Rows that the game has taken.
    taken: usize,
    /// Of the slots whose rows are still to come.
    states: VecDeque<GameRow>,
}

/// The rules that a scene asks for.
fn rules(plan: &ArenaPlan) -> Rules {
    Rules {
        half_mm: plan.half_mm,
        goal_half_mm: plan.goal_half_mm,
        mallet_radius_mm: plan.mallet_radius_mm,
        puck_radius_mm: plan.puck_radius_mm,
        puck_kg: 1e-3 * plan.puck_g,
        deceleration_mm_s2: plan.puck_mu * GRAVITY_MM_S2,
        serve: Puck { place_mm: plan.puck_mm, velocity_mm_s: plan.puck_mm_s },
        restitution_wall: plan.restitution_wall,
        restitution_mallet: plan.restitution_mallet,
        impact_s: 1e-3 * plan.impact_ms,
        most_n: plan.force_n,
    }
}

impl Arena {
    /// A game before its first slot. A pad plays the half in which it starts.
    pub fn new(plan: &ArenaPlan, starts_mm: &[[f64; 2]], parts: usize) -> Arena {
        let left: Vec<bool> = starts_mm.iter().map(|[x_mm, _]| *x_mm < 0.0).collect();
        Arena {
            game: Game::new(rules(plan), &left),
            serve_s: plan.serve_s.clone(),
            served: 0,
            parts,
            latest: vec![None; parts * left.len()],
            rows: VecDeque::new(),
            taken: 0,
            states: VecDeque::new(),
        }
    }

    pub fn game(&self) -> &Game {
        &self.game
    }

    pub fn serve(&mut self) {
        self.game.serve();
    }

    /// Sets what the game asks for before the slot of a part, which ends at `end_s`.
    pub fn begin(&mut self, part: usize, end_s: f64, inputs: &mut LoopInputs) {
        while self.serve_s.get(self.served).is_some_and(|serve_s| *serve_s < end_s) {
            self.served += 1;
            self.game.serve();
        }
        for (pad, target_n) in inputs.targets_n.iter_mut().enumerate() {
            *target_n = Some(self.game.target_n(pad));
        }
        for (pad, surfaces) in inputs.surfaces.iter_mut().enumerate() {
            *surfaces = Some(self.game.surfaces(pad));
        }
        let puck = self.game.puck();
        self.states.push_back(GameRow {
            puck_mm: puck.place_mm,
            puck_mm_s: puck.speed_mm_s(),
            impact_n: self.game.target_n(part / self.parts),
            score: self.game.score(),
        });
    }

    /// Completes the next row.
    pub fn complete(&mut self, row: &mut Row) {
        row.game = self.states.pop_front();
        let is_unplaced = row.flags.split('+').any(|flag| UNPLACED.contains(&flag));
        let place_mm = (!is_unplaced).then_some([row.measured.x_mm, row.measured.y_mm]);
        self.rows.push_back(Measured { part: row.pad, time_s: row.time_s, place_mm });
    }

    /// Plays on after a slot, with the rows of all slots before it.
    pub fn play(&mut self, slot: usize) {
        while self.taken < slot
            && let Some(measured) = self.rows.pop_front()
        {
            self.taken += 1;
            self.take(measured);
        }
    }

    fn take(&mut self, measured: Measured) {
        let (pad, part) = (measured.part / self.parts, measured.part % self.parts);
        self.latest[measured.part] = Some(measured);
        if part != self.parts - 1 {
            return;
        }
        let of_pad = &self.latest[pad * self.parts..][..self.parts];
        let count = self.parts as f64;
        let mut time_s = 0.0;
        let mut place_mm = Some([0.0; 2]);
        for part in of_pad {
            // Parts lie around the pad's centre, so that their mean is it.
            let of = part.and_then(|part| part.place_mm);
            place_mm =
                place_mm.zip(of).map(|(sum, of)| [0, 1].map(|axis| sum[axis] + of[axis] / count));
            time_s += part.map_or(measured.time_s, |part| part.time_s) / count;
        }
        self.game.frame(pad, time_s, place_mm);
    }

    /// The walls along x and y of a pad.
    pub fn surfaces(&self, pad: usize) -> [Surface; 2] {
        self.game.surfaces(pad)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inputs;

    /// Slots of 250 µs of two pads in four parts; the left one lies where a puck comes, and its frames have these flags.
    fn play(flags: &str) -> (Arena, f64) {
        let served = [("arena.puck_mm", "[-110, 0]"), ("arena.puck_mm_s", "[-500, 0]")];
        let set: Vec<_> = served.map(|(key, value)| (key.to_string(), value.to_string())).into();
        let scene = inputs::scene("air-hockey", &set).expect("a bundled scene");
        let plan = scene.cases[0].arena.as_ref().expect("an arena");
        let mut arena = Arena::new(plan, &scene.cases[0].starts_mm(), 4);
        let mut most_n = 0.0f64;
        for slot in 0..400 {
            let mut inputs = LoopInputs {
                targets_n: vec![None; 2],
                surfaces: vec![None; 2],
                ..LoopInputs::default()
            };
            arena.begin(slot % 8, 250e-6 * (slot + 1) as f64, &mut inputs);
            most_n =
                inputs.targets_n.iter().flatten().fold(most_n, |most_n, of_n| most_n.max(*of_n));
            let mut row = Row {
                case: 0,
                time_s: 250e-6 * slot as f64,
                pad: slot % 8,
                measured: Default::default(),
                flags: if slot % 8 == 2 { flags.into() } else { String::new() },
                laws: None,
                truth: None,
                driven: None,
                game: None,
                reference: None,
            };
            row.measured.x_mm = if slot % 8 < 4 { -150.0 } else { 150.0 };
            arena.complete(&mut row);
            assert!(row.game.is_some());
            arena.play(slot);
        }
        (arena, most_n)
    }

    #[test]
    fn a_mallet_that_is_lifted_or_not_measured_meets_no_puck_and_has_no_target() {
        let (arena, most_n) = play("");
        assert_eq!(arena.game().puck().velocity_mm_s[0].signum(), 1.0, "it bounces");
        assert!(most_n > 0.3, "{most_n} N");
        assert_eq!(play("at_edge").1, most_n, "a flag that leaves the place known");
        for flags in UNPLACED {
            let (arena, most_n) = play(flags);
            assert_eq!(arena.game().puck().velocity_mm_s[0].signum(), -1.0, "{flags}");
            assert_eq!(most_n, 0.0, "{flags}");
        }
    }
}
