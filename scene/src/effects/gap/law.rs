// SPDX-License-Identifier: MIT OR Apache-2.0
//! The mechanics of a patch of the pad, per unit of its area.
//!
//!   m·g̈ + c(g)·ġ = κ(g₀ − g) + k₁(g₀ − g − z) + p₀·e^(−g/λ) − ½ε₀V²/(g+d)² − W/S
//!   ż = (g₀ − g − z)/τ,   c(g) = 1.5·η·R²/(g+g_v)³
//!
//! z is the part of the compression that the rubber has crept after; relaxed, z = g₀ − g. The film
//! is Stefan's for a disc of the patch's area: 1.5πηR⁴ over the area πR². Source: docs/physics.md
//! §3.

use crate::device::EPSILON_0;

/// A value and its derivative by the gap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sloped {
    pub value: f64,
    pub slope: f64,
}

/// What presses and pulls a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Drive {
    /// ½ε₀V², N: the attraction's pressure times (g+d)².
    pub pull_n: f64,
    /// Pressure W/S of the load, Pa.
    pub pressure_pa: f64,
}

impl Drive {
    pub fn new(volt: f64, pressure_pa: f64) -> Self {
        Drive { pull_n: 0.5 * EPSILON_0 * volt * volt, pressure_pa }
    }
}

/// Where a patch is and how it moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct State {
    /// Gap g, m.
    pub gap_m: f64,
    /// Speed ġ of the gap, m/s.
    pub speed_m_s: f64,
    /// Crept part z of the compression, m.
    pub creep_m: f64,
}

/// The mechanics of a patch, per unit of area.
#[derive(Clone, Debug)]
pub(super) struct Law {
    /// κ: of the relaxed rubber.
    pub spring_pa_per_m: f64,
    /// k₁: what creeps away.
    pub creep_spring_pa_per_m: f64,
    /// Creep time τ, s.
    pub creep_s: f64,
    /// Contact pressure p₀ at zero gap, Pa.
    pub contact_pa: f64,
    /// Decay length λ of the contact pressure, m.
    pub contact_decay_m: f64,
    /// d: thickness of the insulators as so much air.
    pub insulator_m: f64,
    /// Film constant 1.5·η·R², N·s.
    pub film_n_s: f64,
    /// g_v: what the film keeps of its thickness in contact.
    pub film_rest_m: f64,
    /// Inertia m per area, kg/m².
    pub inertia_kg_m2: f64,
}

impl Law {
    /// Pressure that opens a patch of relaxed rubber, resting at `rest_m`, Pa.
    #[inline]
    pub fn relaxed(&self, gap_m: f64, rest_m: f64, drive: Drive) -> Sloped {
        let contact = self.contact_pa * (-gap_m / self.contact_decay_m).exp();
        let height = gap_m + self.insulator_m;
        let attraction = drive.pull_n / (height * height);
        Sloped {
            value: self.spring_pa_per_m * (rest_m - gap_m) + contact
                - attraction
                - drive.pressure_pa,
            slope: -self.spring_pa_per_m - contact / self.contact_decay_m
                + 2.0 * attraction / height,
        }
    }

    /// Pressure of the rubber that has not crept yet, with z brought along implicitly: z = (crept +
    /// share·x)/(1 + share).
    #[inline]
    pub fn creeping(&self, gap_m: f64, rest_m: f64, crept_m: f64, share: f64) -> Sloped {
        let spring = self.creep_spring_pa_per_m / (1.0 + share);
        Sloped { value: spring * (rest_m - gap_m - crept_m), slope: -spring }
    }

    /// Damping c(g) of the air film, Pa·s/m, and its derivative.
    #[inline]
    pub fn film(&self, gap_m: f64) -> Sloped {
        let thickness = gap_m + self.film_rest_m;
        let damping = self.film_n_s / (thickness * thickness * thickness);
        Sloped { value: damping, slope: -3.0 * damping / thickness }
    }

    /// g̈ and ż.
    #[inline]
    pub fn rates(&self, state: State, rest_m: f64, drive: Drive) -> (f64, f64) {
        let State { gap_m, speed_m_s, creep_m } = state;
        let opening = self.relaxed(gap_m, rest_m, drive).value
            + self.creeping(gap_m, rest_m, creep_m, 0.0).value;
        let acceleration = (opening - self.film(gap_m).value * speed_m_s) / self.inertia_kg_m2;
        (acceleration, (rest_m - gap_m - creep_m) / self.creep_s)
    }
}

/// Root of a function that is positive at `low` and negative at `high`, to the last bits; `low` or
/// `high` where it has none. Newton's steps from `at`, halving the bracket wherever one would leave
/// it.
#[inline(always)]
pub(super) fn root(mut low: f64, mut high: f64, mut at: f64, f: impl Fn(f64) -> Sloped) -> f64 {
    for _ in 0..100 {
        let Sloped { value, slope } = f(at);
        *(if value >= 0.0 { &mut low } else { &mut high }) = at;
        let newton = at - value / slope;
        let next = if slope < 0.0 && newton >= low && newton <= high {
            newton
        } else {
            0.5 * (low + high)
        };
        if (next - at).abs() <= 1e-15 * high {
            return next;
        }
        at = next;
    }
    at
}
