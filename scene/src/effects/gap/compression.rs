// SPDX-License-Identifier: MIT OR Apache-2.0
//! A single patch under pressure, without voltage: what a laboratory fits to capacitances under loads.

use super::law::{Sloped, pressure, root};

/// Spring and contact of a patch, P(g) = κ·(g₀ − g) + p₀·e^(−g/λ), as `[gap]` has them.
///
/// ```
/// let patch = hapticore_scene::Compression {
///     spring_pa_per_m: 4.5e7,
///     rest_m: 7e-6,
///     contact_pa: 2e5,
///     contact_decay_m: 1.25e-6,
/// };
/// let gap_m = patch.gap_m(1000.0);
/// assert!((patch.pressure_pa(gap_m) - 1000.0).abs() < 1e-6);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compression {
    /// κ, Pa/m.
    pub spring_pa_per_m: f64,
    /// g₀: the gap without spring force, m.
    pub rest_m: f64,
    /// p₀: pressure of the contact at zero gap, Pa.
    pub contact_pa: f64,
    /// λ: over which it decays, m.
    pub contact_decay_m: f64,
}

impl Compression {
    /// The pressure at a gap, Pa.
    pub fn pressure_pa(&self, gap_m: f64) -> f64 {
        self.at(gap_m).value
    }

    /// How much the pressure rises as the gap closes, Pa/m.
    pub fn stiffness_pa_per_m(&self, gap_m: f64) -> f64 {
        -self.at(gap_m).slope
    }

    /// The gap under a pressure, m; closed where it bears less.
    pub fn gap_m(&self, pressure_pa: f64) -> f64 {
        let top_m = self.rest_m + self.contact_pa / self.spring_pa_per_m;
        root(0.0, top_m, self.rest_m.max(0.0), |gap_m| {
            let at = self.at(gap_m);
            Sloped { value: at.value - pressure_pa, ..at }
        })
    }

    fn at(&self, gap_m: f64) -> Sloped {
        let Compression { spring_pa_per_m, contact_pa, contact_decay_m, .. } = *self;
        pressure(spring_pa_per_m, [contact_pa, contact_decay_m], gap_m, self.rest_m)
    }
}
