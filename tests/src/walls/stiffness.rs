// SPDX-License-Identifier: MIT OR Apache-2.0
//! How stiff a wall is to a hand that presses: the slope of the true haptic force over the depth, by
//! least squares with a line through the surface. The fit is over the frames in which the hand pushes
//! in and the force is not beyond a stated one.

use std::ops::Range;

use rayon::prelude::*;

use super::device::Drive;
use super::hand::{Hand, Phase};
use super::trial::{Seen, Setup};

/// How much more than the stated force hands press with, N: for their friction without a wall.
const MORE_N: f64 = 0.2;

/// The wall as a hand meets it that presses.
#[derive(Clone, Copy, Debug)]
pub struct Pressed {
    /// Slope of the force over the depth, N/mm.
    pub n_per_mm: f64,
    /// Largest haptic force, N.
    pub peak_n: f64,
}

impl Pressed {
    /// Of the frames of a trial, up to a force.
    pub fn of(frames: &[Seen], to_n: f64) -> Pressed {
        let presses = |seen: &&Seen| {
            matches!(seen.part.1, Phase::Enter | Phase::Press)
                && seen.x_mm < 0.0
                && seen.hand_n < 0.0
        };
        let (mut product, mut square, mut peak_n) = (0.0, 0.0, 0.0f64);
        for seen in frames.iter().filter(presses) {
            peak_n = peak_n.max(seen.force_n);
            if seen.force_n <= to_n {
                product -= seen.force_n * seen.x_mm;
                square += seen.x_mm * seen.x_mm;
            }
        }
        Pressed { n_per_mm: product / square, peak_n }
    }
}

/// The wall over many hands.
#[derive(Clone, Copy, Debug)]
pub struct Stiffness {
    /// Mean slope, N/mm.
    pub n_per_mm: f64,
    /// The least of a hand, N/mm.
    pub least_n_per_mm: f64,
    /// Least of the hands' largest forces, N.
    pub least_peak_n: f64,
}

impl Setup {
    /// How stiff the wall is up to a force, to hands of these seeds.
    pub fn stiffness(&self, seeds: Range<u64>, to_n: f64) -> Stiffness {
        let drive = Drive::calibrated(self.kind.pad());
        let hand = |seed: u64| {
            let hand = Hand::pressing(seed, self.n_per_mm, to_n + MORE_N);
            Pressed::of(&self.of_seed(seed).run(&hand, &drive, 1000 + seed), to_n)
        };
        let hands: Vec<Pressed> = seeds.into_par_iter().map(hand).collect();
        let least = |of: fn(&Pressed) -> f64| hands.iter().map(of).fold(f64::INFINITY, f64::min);
        Stiffness {
            n_per_mm: hands.iter().map(|hand| hand.n_per_mm).sum::<f64>() / hands.len() as f64,
            least_n_per_mm: least(|hand| hand.n_per_mm),
            least_peak_n: least(|hand| hand.peak_n),
        }
    }
}
