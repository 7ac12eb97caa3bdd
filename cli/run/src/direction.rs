// SPDX-License-Identifier: MIT OR Apache-2.0
//! Direction of the push from the slots of a split pad's parts: eq. 10 of the two that sense.
//!
//! ```text
//! direction = x_c·(C_R − C_L)/(C_R + C_L) / (half the sheet's width)
//! ```

use hapticore_host::Quantities;
use hapticore_scene::Plant;

/// What the parts of each pad have read last.
pub struct Directions {
    parts: usize,
    /// Of a reading of 1.
    scale: f64,
    /// Left and right capacitance of each pad, pF.
    sensed_pf: Vec<[f64; 2]>,
}

impl Directions {
    /// Of a plant whose pads are served part by part; none of one that serves whole pads.
    pub fn of(plant: &Plant) -> Option<Directions> {
        let (parts, half_width_mm) = (plant.parts(), 0.5 * plant.device().width_mm);
        let scale = plant.parts_mm().get(1)? / half_width_mm;
        let sensed_pf = vec![[f64::NAN; 2]; plant.served() / parts];
        Some(Directions { parts, scale, sensed_pf })
    }

    /// Gives the measurement of a part the direction of its pad: from the pad's second slot on.
    pub fn complete(&mut self, pad: usize, measured: &mut Quantities) {
        let sensed_pf = &mut self.sensed_pf[pad / self.parts];
        if let Some(of_part) = sensed_pf.get_mut(pad % self.parts) {
            *of_part = measured.capacitance_pf;
        }
        let [left, right] = *sensed_pf;
        let direction = self.scale * (right - left) / (right + left);
        measured.direction = if direction.is_finite() { direction } else { 0.0 };
    }
}
