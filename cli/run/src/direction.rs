// SPDX-License-Identifier: MIT OR Apache-2.0
//! Direction of the push from the slots of a split pad's parts: eq. 10 of those that sense on the left and on
//! the right, along x.
//!
//! ```text
//! direction = x_c·(C_R − C_L)/(C_R + C_L) / (half the sheet's width)
//! ```

use hapticore_host::Quantities;
use hapticore_scene::Plant;

/// What the parts of each pad have read last.
pub struct Directions {
    /// Of each part: on the right of its pad (1), on its left (−1), or in its middle.
    sides: Vec<f64>,
    /// Of a reading of 1.
    scale: f64,
    /// Capacitance of each part, pF.
    sensed_pf: Vec<f64>,
}

impl Directions {
    /// Of a plant whose pads are served part by part; none of one that serves whole pads.
    pub fn of(plant: &Plant) -> Option<Directions> {
        let half_width_mm = 0.5 * plant.device().width_mm;
        let outer_mm = plant.parts_mm().iter().map(|[x_mm, _]| *x_mm).fold(0.0, f64::max);
        let side = |[x_mm, _]: &[f64; 2]| if *x_mm == 0.0 { 0.0 } else { x_mm.signum() };
        (plant.parts() > 1).then(|| Directions {
            sides: plant.parts_mm().iter().map(side).collect(),
            scale: outer_mm / half_width_mm,
            sensed_pf: vec![f64::NAN; plant.served()],
        })
    }

    /// Gives the measurement of a part the direction of its pad: once all its parts that sense have
    /// been measured.
    pub fn complete(&mut self, pad: usize, measured: &mut Quantities) {
        self.sensed_pf[pad] = measured.capacitance_pf;
        let parts = self.sides.len();
        let of_pad = &self.sensed_pf[pad / parts * parts..][..parts];
        let sum = |side: f64| {
            let of_side = self.sides.iter().zip(of_pad).filter(|(of, _)| **of == side);
            of_side.map(|(_, pf)| pf).sum::<f64>()
        };
        let (left, right) = (sum(-1.0), sum(1.0));
        let direction = self.scale * (right - left) / (right + left);
        measured.direction = if direction.is_finite() { direction } else { 0.0 };
    }
}
