// SPDX-License-Identifier: MIT OR Apache-2.0
//! Laws of other controllers ([`crate::rivals::laws`]) around the plant of the controller's block.

use super::rig::Plant;
use crate::rivals::laws::{FULL_SCALE_V, Law, Seen};

/// A law around a plant.
pub struct Rival<L> {
    law: L,
    plant: Plant,
    drive: f64,
}

impl<L: Law> Rival<L> {
    /// With a plant in equilibrium.
    pub fn new(law: L) -> Self {
        Rival { law, plant: Plant::new(), drive: 0.0 }
    }

    /// Forces of `frames` frames with this target, N.
    pub fn forces(&mut self, target_n: f64, frames: usize) -> Vec<f64> {
        (0..frames).map(|_| self.frame(target_n)).collect()
    }

    fn frame(&mut self, target_n: f64) -> f64 {
        let force_n = self.plant.frame(self.drive);
        let seen = Seen { target_n, force_n, capacitance_pf: self.plant.capacitance_pf };
        self.drive = (self.law.volts(&seen) / FULL_SCALE_V).clamp(0.0, 1.0);
        force_n
    }
}
