// SPDX-License-Identifier: MIT OR Apache-2.0
//! Readings of several pads, each freed of what the others did to it, as far as their latest frames tell.

use hapticore_scene::{Lying, Uncoupler};

use crate::record::Quantities;

/// The latest place of each pad, and what frees a reading of the others.
pub struct Uncoupling {
    uncoupler: Uncoupler,
    latest: Vec<Option<Lying>>,
}

impl Uncoupling {
    /// Before the first frame.
    pub fn new(uncoupler: Uncoupler) -> Self {
        Uncoupling { uncoupler, latest: Vec::new() }
    }

    /// Puts right a reading of a pad: its place, its capacitance, and the force that goes with its square.
    pub fn apply(&mut self, pad: usize, reading: &mut Quantities) {
        self.latest.resize(self.latest.len().max(pad + 1), None);
        let others: Vec<_> =
            (0..self.latest.len()).filter(|other| *other != pad).filter_map(|n| self.latest[n]).collect();
        let read = Lying { x_mm: reading.x_mm, y_mm: reading.y_mm, capacitance_pf: reading.capacitance_pf };
        let pad_alone = self.uncoupler.uncouple(read, [reading.r_x, reading.r_y], &others);
        self.latest[pad] = Some(pad_alone);
        if read.capacitance_pf > 0.0 {
            reading.force_n *= (pad_alone.capacitance_pf / read.capacitance_pf).powi(2);
        }
        Lying { x_mm: reading.x_mm, y_mm: reading.y_mm, capacitance_pf: reading.capacitance_pf } = pad_alone;
    }
}
