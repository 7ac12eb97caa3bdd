// SPDX-License-Identifier: MIT OR Apache-2.0
//! The mechanics of a patch of the pad, per unit of its area.
//!
//!   m·g̈ + c(g)·ġ = κ(g₀ − g) + k₁(g₀ − g − z) + p₀·e^(−g/λ) − ½ε₀V²/(g+d)² − W/S
//!   ż = (g₀ − g − z)/τ,   c(g) = 1.5·η·R²/(g+g_v)³
//!
//! z is the part of the compression that the rubber has crept after; relaxed, z = g₀ − g. The film
//! is Stefan's for a disc of the patch's area: 1.5πηR⁴ over the area πR². Source: docs/physics.md
//! §3.

use super::lanes::{Lanes, Real};
use crate::device::EPSILON_0;

/// A value and its derivative by the gap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sloped<R = f64> {
    pub value: R,
    pub slope: R,
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

/// Where a patch is and how it moves; several, where `R` is [`Lanes`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct State<R = f64> {
    /// Gap g, m.
    pub gap_m: R,
    /// Speed ġ of the gap, m/s.
    pub speed_m_s: R,
    /// Crept part z of the compression, m.
    pub creep_m: R,
}

impl<const N: usize> State<Lanes<N>> {
    /// Patches side by side.
    #[inline(always)]
    pub fn of_patches(patches: &[State; N]) -> Self {
        State {
            gap_m: Lanes::each(|k| patches[k].gap_m),
            speed_m_s: Lanes::each(|k| patches[k].speed_m_s),
            creep_m: Lanes::each(|k| patches[k].creep_m),
        }
    }

    /// One of the patches.
    #[inline(always)]
    pub fn patch(&self, k: usize) -> State {
        let (gap_m, speed_m_s) = (self.gap_m.0[k], self.speed_m_s.0[k]);
        State { gap_m, speed_m_s, creep_m: self.creep_m.0[k] }
    }

    /// Replaces one of the patches.
    #[inline(always)]
    pub fn set_patch(&mut self, k: usize, patch: State) {
        self.gap_m.0[k] = patch.gap_m;
        self.speed_m_s.0[k] = patch.speed_m_s;
        self.creep_m.0[k] = patch.creep_m;
    }
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
    #[inline(always)]
    pub fn relaxed<R: Real>(&self, gap_m: R, rest_m: R, drive: Drive) -> Sloped<R> {
        let of = R::of;
        let contact = of(self.contact_pa) * (-gap_m / of(self.contact_decay_m)).exp();
        let height = gap_m + of(self.insulator_m);
        let attraction = of(drive.pull_n) / (height * height);
        Sloped {
            value: of(self.spring_pa_per_m) * (rest_m - gap_m) + contact
                - attraction
                - of(drive.pressure_pa),
            slope: of(-self.spring_pa_per_m) - contact / of(self.contact_decay_m)
                + of(2.0) * attraction / height,
        }
    }

    /// Pressure of the rubber that has not crept yet, with z brought along implicitly: z = (crept +
    /// share·x)/(1 + share).
    #[inline(always)]
    pub fn creeping<R: Real>(&self, gap_m: R, rest_m: R, crept_m: R, share: f64) -> Sloped<R> {
        let spring = self.creep_spring_pa_per_m / (1.0 + share);
        Sloped { value: R::of(spring) * (rest_m - gap_m - crept_m), slope: R::of(-spring) }
    }

    /// Damping c(g) of the air film, Pa·s/m, and its derivative.
    #[inline(always)]
    pub fn film<R: Real>(&self, gap_m: R) -> Sloped<R> {
        let thickness = gap_m + R::of(self.film_rest_m);
        let damping = R::of(self.film_n_s) / (thickness * thickness * thickness);
        Sloped { value: damping, slope: R::of(-3.0) * damping / thickness }
    }

    /// g̈ and ż.
    #[inline(always)]
    pub fn rates<R: Real>(&self, state: State<R>, rest_m: R, drive: Drive) -> (R, R) {
        let State { gap_m, speed_m_s, creep_m } = state;
        let opening = self.relaxed(gap_m, rest_m, drive).value
            + self.creeping(gap_m, rest_m, creep_m, 0.0).value;
        let acceleration =
            (opening - self.film(gap_m).value * speed_m_s) / R::of(self.inertia_kg_m2);
        (acceleration, (rest_m - gap_m - creep_m) / R::of(self.creep_s))
    }
}

/// Root of a function that is positive at `low` and negative at `high`, to the last bits; `low` or
/// `high` where it has none. Newton's steps from `at`, halving the bracket wherever one would leave
/// it.
#[inline(always)]
pub(super) fn root(low: f64, high: f64, at: f64, f: impl Fn(f64) -> Sloped) -> f64 {
    let of_one = |Lanes([at]): Lanes<1>| {
        let Sloped { value, slope } = f(at);
        Sloped { value: Lanes([value]), slope: Lanes([slope]) }
    };
    roots(Lanes([low]), Lanes([high]), Lanes([at]), of_one).0[0]
}

/// The [`root`] of each of several functions, all of which are evaluated until the last has its own.
#[inline(always)]
pub(super) fn roots<const N: usize>(
    mut low: Lanes<N>,
    mut high: Lanes<N>,
    mut at: Lanes<N>,
    f: impl Fn(Lanes<N>) -> Sloped<Lanes<N>>,
) -> Lanes<N> {
    let mut found = [false; N];
    for _ in 0..100 {
        let Sloped { value, slope } = f(at);
        let newton = at - value / slope;
        for (k, found) in found.iter_mut().enumerate().filter(|(_, found)| !**found) {
            let (low, high, at) = (&mut low.0[k], &mut high.0[k], &mut at.0[k]);
            *(if value.0[k] >= 0.0 { &mut *low } else { &mut *high }) = *at;
            let is_within = slope.0[k] < 0.0 && newton.0[k] >= *low && newton.0[k] <= *high;
            let next = if is_within { newton.0[k] } else { 0.5 * (*low + *high) };
            *found = (next - *at).abs() <= 1e-15 * *high;
            *at = next;
        }
        if found == [true; N] {
            break;
        }
    }
    at
}
