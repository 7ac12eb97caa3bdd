// SPDX-License-Identifier: MIT OR Apache-2.0
//! Hands that slide along a wall in the core while they press into it.

use std::ops::Range;

use rayon::prelude::*;

use super::core::InCore;
use super::hand::{Hand, Phase};
use super::trial::Seen;

/// What a hand feels that slides along the surface.
#[derive(Clone, Copy, Debug)]
pub struct Slid {
    /// The wall's force over that of its stiffness, where the hand has pressed and stands still.
    pub held: f64,
    /// How far it sinks in while it slides, mm.
    pub sunk_mm: f64,
    /// The wall's mean friction in the second half of the way, N.
    pub drag_n: f64,
    /// What a wall of this stiffness would give there, N.
    pub wall_n: f64,
}

/// The largest force of the scene's wall, N.
const MOST_N: f64 = 1.0;

impl InCore {
    /// What hands of these seeds feel that slide at a speed.
    pub fn sliding(&self, seeds: Range<u64>, mm_per_s: f64) -> Vec<Slid> {
        let slid = |seed: u64| {
            let hand = Hand::sliding(seed, self.n_per_mm, mm_per_s);
            let (frames, _) = self.run(&hand, 2.0, 1000 + seed);
            self.slid(&hand, &frames)
        };
        seeds.into_par_iter().map(slid).collect()
    }

    fn slid(&self, hand: &Hand, frames: &[Seen]) -> Slid {
        let [begins_s, ends_s] = [hand.along[0][0], hand.along[1][0]];
        let within = |from_s: f64, to_s: f64| -> Vec<&Seen> {
            let is_within = |seen: &&Seen| (from_s..to_s).contains(&seen.time_s);
            frames.iter().filter(is_within).collect()
        };
        let pressed = within(begins_s - 0.1, begins_s);
        let half = within((begins_s + ends_s) / 2.0, ends_s);
        assert!(half.iter().all(|seen| seen.part.1 == Phase::Slide), "the hand slides");
        let wall_n = |seen: &Seen| (self.n_per_mm * -seen.x_mm).clamp(0.0, MOST_N);
        let mean = |of: &[&Seen], value: &dyn Fn(&Seen) -> f64| {
            of.iter().map(|seen| value(seen)).sum::<f64>() / of.len() as f64
        };
        let x_mm = |of: &[&Seen]| mean(of, &|seen| seen.x_mm);
        Slid {
            held: mean(&pressed, &|seen| seen.force_n) / mean(&pressed, &wall_n),
            sunk_mm: x_mm(&pressed) - x_mm(&half),
            drag_n: mean(&half, &|seen| seen.felt_n),
            wall_n: mean(&half, &wall_n),
        }
    }
}
