// SPDX-License-Identifier: MIT OR Apache-2.0
//! The mechanics of a patch of the pad, per unit of its area.
//!
//!   P(g) = κ·(g₀ − g) + p₀·e^(−g/λ)                                     (spring and contact)
//!   m·g̈ + c(g)·ġ = P + r·(P − z) − A(g) − s·W/S
//!   ż = (P − z)/τ,   c(g) = 1.5·η·R_f²/(g+g_v)³
//!   A(g) = ½ε₀V²·[a/d² + (1−a)/(g+d)²],   a = p/(p + σ),   p = p₀·e^(−g/λ)
//!
//! a is the share of the patch whose rubber touches the film, where the scene gives its hardness σ; else it is zero. d is
//! that at the haptic frequency here, and that at the carrier's in the capacitance.
//!
//! z is the part of the pressure that the rubber has crept after; relaxed, z = P. Creep brought along
//! implicitly over a share θ/τ of its time, z⁺ = (z + share·P)/(1 + share), so P − z⁺ = (P − z)/(1 + share):
//! g alone decides it. The film is Stefan's for a disc of radius R_f: 1.5πηR_f⁴ over its area. Source:
//! docs/physics.md §3.

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

/// What sets a patch apart from the others; several, where `R` is [`Lanes`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Patch<R = f64> {
    /// Gap g₀ without pressure, m.
    pub rest_m: R,
    /// s: the load per area that the patch bears, over the pad's.
    pub load_share: R,
}

impl<const N: usize> Patch<Lanes<N>> {
    /// Patches side by side.
    #[inline(always)]
    pub fn of_patches(patches: &[Patch; N]) -> Self {
        Patch {
            rest_m: Lanes::each(|k| patches[k].rest_m),
            load_share: Lanes::each(|k| patches[k].load_share),
        }
    }

    /// One of the patches.
    #[inline(always)]
    pub fn patch(&self, k: usize) -> Patch {
        Patch { rest_m: self.rest_m.0[k], load_share: self.load_share.0[k] }
    }
}

/// Where a patch is and how it moves; several, where `R` is [`Lanes`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct State<R = f64> {
    /// Gap g, m.
    pub gap_m: R,
    /// Speed ġ of the gap, m/s.
    pub speed_m_s: R,
    /// Crept part z of the pressure of spring and contact, Pa.
    pub crept_pa: R,
}

impl<const N: usize> State<Lanes<N>> {
    /// Patches side by side.
    #[inline(always)]
    pub fn of_patches(patches: &[State; N]) -> Self {
        State {
            gap_m: Lanes::each(|k| patches[k].gap_m),
            speed_m_s: Lanes::each(|k| patches[k].speed_m_s),
            crept_pa: Lanes::each(|k| patches[k].crept_pa),
        }
    }

    /// One of the patches.
    #[inline(always)]
    pub fn patch(&self, k: usize) -> State {
        let (gap_m, speed_m_s) = (self.gap_m.0[k], self.speed_m_s.0[k]);
        State { gap_m, speed_m_s, crept_pa: self.crept_pa.0[k] }
    }

    /// Replaces one of the patches.
    #[inline(always)]
    pub fn set_patch(&mut self, k: usize, patch: State) {
        self.gap_m.0[k] = patch.gap_m;
        self.speed_m_s.0[k] = patch.speed_m_s;
        self.crept_pa.0[k] = patch.crept_pa;
    }
}

/// The mechanics of a patch, per unit of area.
#[derive(Clone, Debug)]
pub(super) struct Law {
    /// κ: of the relaxed rubber.
    pub spring_pa_per_m: f64,
    /// Contact pressure p₀ at zero gap, Pa.
    pub contact_pa: f64,
    /// Decay length λ of the contact pressure, m.
    pub contact_decay_m: f64,
    /// r: what the pressure has more before it creeps.
    pub creep_share: f64,
    /// Creep time τ, s.
    pub creep_s: f64,
    /// d: thickness of the insulators as so much air, at the carrier's frequency, m.
    pub insulator_m: f64,
    /// d at the haptic frequency, m.
    pub haptic_insulator_m: f64,
    /// Hardness σ of the rubber's contacts, Pa; infinite where none touch.
    pub contact_hardness_pa: f64,
    /// Film constant 1.5·η·R_f², N·s.
    pub film_n_s: f64,
    /// g_v: what the film keeps of its thickness in contact, m.
    pub film_rest_m: f64,
    /// Inertia m per area, kg/m².
    pub inertia_kg_m2: f64,
}

impl Law {
    /// P(g): pressure of spring and contact, relaxed, Pa.
    #[inline(always)]
    pub fn rubber<R: Real>(&self, gap_m: R, rest_m: R) -> Sloped<R> {
        pressure(self.spring_pa_per_m, [self.contact_pa, self.contact_decay_m], gap_m, rest_m)
    }

    /// Whether parts of a patch touch the film.
    #[inline(always)]
    pub fn touches(&self) -> bool {
        self.contact_hardness_pa.is_finite()
    }

    /// a(g): the share of a patch that touches the film.
    #[inline(always)]
    pub fn contact_share<R: Real>(&self, gap_m: R) -> Sloped<R> {
        let contact = R::of(self.contact_pa) * (-gap_m / R::of(self.contact_decay_m)).exp();
        let share = contact / (contact + R::of(self.contact_hardness_pa));
        let slope = -share * (R::of(1.0) - share) / R::of(self.contact_decay_m);
        Sloped { value: share, slope }
    }

    /// A(g): attraction, Pa.
    #[inline(always)]
    fn attraction<R: Real>(&self, gap_m: R, drive: Drive) -> Sloped<R> {
        let height = gap_m + R::of(self.haptic_insulator_m);
        let free = R::of(drive.pull_n) / (height * height);
        let slope = R::of(-2.0) * free / height;
        if !self.touches() {
            return Sloped { value: free, slope };
        }
        let share = self.contact_share(gap_m);
        let more = R::of(drive.pull_n / self.haptic_insulator_m.powi(2)) - free;
        Sloped {
            value: free + share.value * more,
            slope: (R::of(1.0) - share.value) * slope + share.slope * more,
        }
    }

    /// Attraction and load: what closes a patch, Pa.
    #[inline(always)]
    fn closing<R: Real>(&self, gap_m: R, patch: Patch<R>, drive: Drive) -> Sloped<R> {
        let Sloped { value, slope } = self.attraction(gap_m, drive);
        Sloped { value: value + patch.load_share * R::of(drive.pressure_pa), slope }
    }

    /// Pressure that opens a patch of relaxed rubber, Pa.
    #[inline(always)]
    pub fn relaxed<R: Real>(&self, gap_m: R, patch: Patch<R>, drive: Drive) -> Sloped<R> {
        let (rubber, closing) =
            (self.rubber(gap_m, patch.rest_m), self.closing(gap_m, patch, drive));
        Sloped { value: rubber.value - closing.value, slope: rubber.slope - closing.slope }
    }

    /// Pressure that opens a patch whose rubber creeps on from `crept_pa` over a share of its time.
    #[inline(always)]
    pub fn creeping<R: Real>(
        &self,
        gap_m: R,
        patch: Patch<R>,
        drive: Drive,
        crept_pa: R,
        share: f64,
    ) -> Sloped<R> {
        let more = self.creep_share / (1.0 + share);
        let (rubber, closing) =
            (self.rubber(gap_m, patch.rest_m), self.closing(gap_m, patch, drive));
        let (all, more) = (R::of(1.0 + more), R::of(more));
        Sloped {
            value: all * rubber.value - more * crept_pa - closing.value,
            slope: all * rubber.slope - closing.slope,
        }
    }

    /// z once it has crept on, at the gap after.
    #[inline(always)]
    pub fn crept<R: Real>(&self, gap_m: R, rest_m: R, crept_pa: R, share: f64) -> R {
        let rubber = self.rubber(gap_m, rest_m).value;
        (crept_pa + R::of(share) * rubber) / R::of(1.0 + share)
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
    pub fn rates<R: Real>(&self, state: State<R>, patch: Patch<R>, drive: Drive) -> (R, R) {
        let State { gap_m, speed_m_s, crept_pa } = state;
        let rubber = self.rubber(gap_m, patch.rest_m).value;
        let unrelaxed = rubber - crept_pa;
        let opening = rubber + R::of(self.creep_share) * unrelaxed
            - self.closing(gap_m, patch, drive).value
            - self.film(gap_m).value * speed_m_s;
        (opening / R::of(self.inertia_kg_m2), unrelaxed / R::of(self.creep_s))
    }
}

/// P(g) of spring and contact, Pa, the contact given by p₀ and λ.
#[inline(always)]
pub(super) fn pressure<R: Real>(
    spring_pa_per_m: f64,
    [contact_pa, contact_decay_m]: [f64; 2],
    gap_m: R,
    rest_m: R,
) -> Sloped<R> {
    let contact = R::of(contact_pa) * (-gap_m / R::of(contact_decay_m)).exp();
    Sloped {
        value: R::of(spring_pa_per_m) * (rest_m - gap_m) + contact,
        slope: R::of(-spring_pa_per_m) - contact / R::of(contact_decay_m),
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
