// SPDX-License-Identifier: MIT OR Apache-2.0
//! How soon a wall in the core is felt, how soon it releases, and how much it stands out, as Bernard et al. (2023, arXiv
//! 2308.15190) state it of displays whose friction is switched.

use std::ops::Range;

use rayon::prelude::*;

use super::core::InCore;
use super::device::with_hand;
use super::hand::{Hand, Phase};
use super::trial::Seen;

/// Latency and contrast of a wall, medians over hands.
#[derive(Clone, Copy, Debug)]
pub struct Latency {
    /// From the pad's crossing of the surface until the force is half of that of the press, ms.
    pub engage_ms: f64,
    /// From the turn of the hand's force outwards until the force is a tenth of that of the press, ms.
    pub release_ms: f64,
    /// Friction in the wall while the hand presses over that outside.
    pub contrast: f64,
}

impl InCore {
    /// Of hands of these seeds that cross the surface at a mean speed and leave at twice that.
    pub fn latency(&self, seeds: Range<u64>, mm_per_s: f64) -> Latency {
        let of_hand = |seed: u64| {
            let hand = Hand::crossing(seed, self.n_per_mm, mm_per_s);
            let (frames, frame_ms) = self.run(&hand, 2.0, 1000 + seed);
            let base_n = with_hand(self.pad, &hand, 2.0, frame_ms).device().mu * hand.load_n;
            of_frames(&frames, base_n)
        };
        let of_hands: Vec<_> = seeds.into_par_iter().map(of_hand).collect();
        let median = |of: fn(&Latency) -> f64| {
            let mut values: Vec<f64> = of_hands.iter().map(of).collect();
            values.sort_by(f64::total_cmp);
            values[values.len() / 2]
        };
        Latency {
            engage_ms: median(|one| one.engage_ms),
            release_ms: median(|one| one.release_ms),
            contrast: median(|one| one.contrast),
        }
    }
}

fn of_frames(frames: &[Seen], base_n: f64) -> Latency {
    let presses = |seen: &&Seen| seen.part.1 == Phase::Press;
    let pressed: Vec<f64> = frames.iter().filter(presses).map(|seen| seen.force_n).collect();
    let late = &pressed[pressed.len() / 2..];
    let press_n = late.iter().sum::<f64>() / late.len() as f64;
    let enters = |seen: &Seen| matches!(seen.part.1, Phase::Enter | Phase::Press);
    let surface_s = crossing_s(frames, &enters, |seen| -seen.x_mm);
    let felt_s = crossing_s(frames, &enters, |seen| seen.force_n - press_n / 2.0);
    let leaves = |seen: &Seen| seen.part.1 == Phase::LeaveFast;
    let turn_s = crossing_s(frames, &leaves, |seen| seen.hand_n);
    let gone_s = crossing_s(frames, &leaves, |seen| press_n / 10.0 - seen.force_n);
    Latency {
        engage_ms: 1e3 * (felt_s - surface_s),
        release_ms: 1e3 * (gone_s - turn_s),
        contrast: (base_n + press_n) / base_n,
    }
}

/// When a value becomes positive in some of the frames, straight between two; not a number where it never does.
fn crossing_s(
    frames: &[Seen],
    within: &dyn Fn(&Seen) -> bool,
    value: impl Fn(&Seen) -> f64,
) -> f64 {
    let crosses =
        |pair: &&[Seen]| within(&pair[1]) && value(&pair[0]) <= 0.0 && value(&pair[1]) > 0.0;
    frames.windows(2).find(crosses).map_or(f64::NAN, |pair| {
        let [before, after] = [value(&pair[0]), value(&pair[1])];
        pair[0].time_s + (pair[1].time_s - pair[0].time_s) * before / (before - after)
    })
}
