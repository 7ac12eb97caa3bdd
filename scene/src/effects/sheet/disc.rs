// SPDX-License-Identifier: MIT OR Apache-2.0
//! Places spread evenly over a disc.

use std::f64::consts::TAU;

/// Rings of as many places each, for as much area each.
pub(super) struct Disc {
    from_centre_m: Vec<[f64; 2]>,
}

impl Disc {
    pub fn new(radius_m: f64, rings: usize) -> Self {
        let on_a_ring = 6 * rings;
        let place = |n: usize| {
            let (ring, turn) = (n / on_a_ring, (n % on_a_ring) as f64 / on_a_ring as f64);
            let radius_m = radius_m * ((ring as f64 + 0.5) / rings as f64).sqrt();
            let (sin, cos) = (TAU * turn).sin_cos();
            [radius_m * cos, radius_m * sin]
        };
        Disc { from_centre_m: (0..rings * on_a_ring).map(place).collect() }
    }

    /// The disc's places around its centre.
    pub fn at(&self, [x, y]: [f64; 2]) -> impl ExactSizeIterator<Item = [f64; 2]> {
        self.from_centre_m.iter().map(move |[right, up]| [x + right, y + up])
    }
}
