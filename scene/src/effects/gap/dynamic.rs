// SPDX-License-Identifier: MIT OR Apache-2.0
//! A patch in motion: one step of its equations by methods of rising accuracy.
//!
//! | method | order | at long steps |
//! | --- | --- | --- |
//! | semi-implicit: film and creep implicit, everything else as it was | 1 | stable while the contact is soft |
//! | implicit Euler | 1 | stable, damps |
//! | trapezoid | 2 | stable, rings after a jump |
//! | TR-BDF2, γ = 2 − √2 (Bank et al., 1985) | 2 | stable, damps: the reference |
//!
//! An implicit stage of length θ asks for g = a + θ·v, v = b + θ·g̈, z = e + θ·ż. As g alone
//! decides v and z, it is one equation in g, solved by Newton's steps within a bracket. Source:
//! docs/physics.md §3.

use super::lanes::{Lanes, Real};
use super::law::{Drive, Law, Patch, Sloped, State, roots};

/// How a step is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Method {
    SemiImplicit,
    ImplicitEuler,
    Trapezoid,
    TrBdf2,
}

/// The drive at the start of a step, where TR-BDF2 has its first stage, and at the end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stages {
    start: Drive,
    middle: Drive,
    end: Drive,
}

/// Patches that are computed together.
const TOGETHER: usize = 4;

/// Where TR-BDF2 has its first stage: γ.
const GAMMA: f64 = 2.0 - std::f64::consts::SQRT_2;

impl Method {
    /// The stiffest spring that steps are stable with at a gap: h·K < 2·(m/h + c) where the film is
    /// implicit and the spring is not; any where all is implicit.
    pub fn stiffest_pa_per_m(self, law: &Law, gap_m: f64, step_s: f64) -> f64 {
        match self {
            Method::SemiImplicit => {
                2.0 * (law.inertia_kg_m2 / step_s + law.film(gap_m).value) / step_s
            }
            _ => f64::INFINITY,
        }
    }

    /// What a step needs of a drive, which is asked for at fractions of the step.
    #[inline]
    pub fn stages(self, drive: impl Fn(f64) -> Drive) -> Stages {
        let end = drive(1.0);
        match self {
            Method::SemiImplicit | Method::ImplicitEuler => Stages { start: end, middle: end, end },
            Method::Trapezoid => Stages { start: drive(0.0), middle: end, end },
            Method::TrBdf2 => Stages { start: drive(0.0), middle: drive(GAMMA), end },
        }
    }

    /// The states of patches a step later.
    pub fn step(
        self,
        law: &Law,
        patches: &[Patch],
        states: &mut [State],
        step_s: f64,
        drive: &Stages,
    ) {
        let (patches, patches_left) = patches.as_chunks::<TOGETHER>();
        let (states, states_left) = states.as_chunks_mut::<TOGETHER>();
        for (patches, states) in patches.iter().zip(states) {
            Together::of(law, patches, states, step_s).step(self, drive, states);
        }
        for (patch, state) in patches_left.iter().zip(states_left) {
            let state = std::array::from_mut(state);
            Together::of(law, &[*patch], state, step_s).step(self, drive, state);
        }
    }
}

/// Patches that take a step together.
struct Together<'a, const N: usize> {
    law: &'a Law,
    patch: Patch<Lanes<N>>,
    from: State<Lanes<N>>,
    step_s: f64,
}

impl<'a, const N: usize> Together<'a, N> {
    #[inline(always)]
    fn of(law: &'a Law, patches: &[Patch; N], states: &[State; N], step_s: f64) -> Self {
        let (patch, from) = (Patch::of_patches(patches), State::of_patches(states));
        Together { law, patch, from, step_s }
    }

    /// Brings the patches to where they are after the step.
    #[inline]
    fn step(&self, method: Method, drive: &Stages, states: &mut [State; N]) {
        let to = match method {
            Method::SemiImplicit => self.semi_implicit(drive.end),
            Method::ImplicitEuler => self.euler(drive.end),
            Method::Trapezoid => self.trapezoid(drive),
            Method::TrBdf2 => self.tr_bdf2(drive),
        };
        for (k, state) in states.iter_mut().enumerate() {
            *state = to.patch(k);
        }
    }

    fn semi_implicit(&self, drive: Drive) -> State<Lanes<N>> {
        let (Together { law, patch, from, .. }, of) = (self, Lanes::of);
        let (step_s, share) = (of(self.step_s), self.step_s / law.creep_s);
        let opening = law.creeping(from.gap_m, *patch, drive, from.crept_pa, share).value;
        let damping = of(1.0) + step_s * law.film(from.gap_m).value / of(law.inertia_kg_m2);
        let speed_m_s = (from.speed_m_s + step_s * opening / of(law.inertia_kg_m2)) / damping;
        self.settled(from.crept_pa, share, from.gap_m + step_s * speed_m_s, speed_m_s)
    }

    fn euler(&self, drive: Drive) -> State<Lanes<N>> {
        self.stage(self.from, self.from, self.step_s, drive)
    }

    /// Where it would close the gap, it has overshot: then implicit Euler, for a start from closed
    /// throws the patch open again.
    fn trapezoid(&self, drive: &Stages) -> State<Lanes<N>> {
        let Together { law, patch, from, step_s } = *self;
        let base = ahead(from, law.rates(from, patch, drive.start), 0.5 * step_s);
        let to = self.stage(base, from, 0.5 * step_s, drive.end);
        self.or_euler(to, to.gap_m, drive.end)
    }

    /// The trapezoid over γ of the step, then a backward difference over the whole, both with the same
    /// θ; closed, as above.
    fn tr_bdf2(&self, drive: &Stages) -> State<Lanes<N>> {
        const MIDDLE: f64 = 1.0 / (GAMMA * (2.0 - GAMMA));
        let Together { law, patch, from, step_s } = *self;
        let theta = 0.5 * GAMMA * step_s;
        let base = ahead(from, law.rates(from, patch, drive.start), theta);
        let middle = self.stage(base, from, theta, drive.middle);
        let mix = |middle: Lanes<N>, from: Lanes<N>| {
            Lanes::of(MIDDLE) * middle + Lanes::of(1.0 - MIDDLE) * from
        };
        let base = State {
            gap_m: mix(middle.gap_m, from.gap_m),
            speed_m_s: mix(middle.speed_m_s, from.speed_m_s),
            crept_pa: mix(middle.crept_pa, from.crept_pa),
        };
        let to = self.stage(base, middle, theta, drive.end);
        let least_m = Lanes::each(|k| middle.gap_m.0[k].min(to.gap_m.0[k]));
        self.or_euler(to, least_m, drive.end)
    }

    /// Patches after the step, those whose gap has closed in it by implicit Euler.
    #[inline(always)]
    fn or_euler(
        &self,
        mut to: State<Lanes<N>>,
        least_m: Lanes<N>,
        drive: Drive,
    ) -> State<Lanes<N>> {
        for k in (0..N).filter(|k| least_m.0[*k] <= 0.0) {
            let (patch, from) = ([self.patch.patch(k)], [self.from.patch(k)]);
            let alone = Together::of(self.law, &patch, &from, self.step_s);
            to.set_patch(k, alone.euler(drive).patch(0));
        }
        to
    }

    /// An implicit stage of length θ from `base`, sought from `near` on.
    #[inline(always)]
    fn stage(
        &self,
        base: State<Lanes<N>>,
        near: State<Lanes<N>>,
        theta_s: f64,
        drive: Drive,
    ) -> State<Lanes<N>> {
        let (Together { law, patch, .. }, of) = (self, Lanes::of);
        let share = theta_s / law.creep_s;
        let inertia = of(law.inertia_kg_m2 / theta_s);
        let excess = |gap_m: Lanes<N>| {
            let speed = (gap_m - base.gap_m) / of(theta_s);
            let opening = law.creeping(gap_m, *patch, drive, base.crept_pa, share);
            let film = law.film(gap_m);
            Sloped {
                value: opening.value - film.value * speed - inertia * (speed - base.speed_m_s),
                slope: opening.slope - film.slope * speed - (film.value + inertia) / of(theta_s),
            }
        };
        let top = of(2.0) * (patch.rest_m + of(law.insulator_m))
            + base.gap_m.abs()
            + of(law.contact_pa / law.spring_pa_per_m);
        let gap_m = roots(of(0.0), top, near.gap_m, excess);
        self.settled(base.crept_pa, share, gap_m, (gap_m - base.gap_m) / of(theta_s))
    }

    /// The states at these gaps, their creep brought along implicitly; a gap that would be negative is
    /// closed, and still.
    #[inline(always)]
    fn settled(
        &self,
        crept_pa: Lanes<N>,
        share: f64,
        gap_m: Lanes<N>,
        speed_m_s: Lanes<N>,
    ) -> State<Lanes<N>> {
        let rest_m = self.patch.rest_m;
        let is_open = |k: usize| gap_m.0[k] > f64::EPSILON * rest_m.0[k];
        let where_open = |of: Lanes<N>| Lanes::each(|k| if is_open(k) { of.0[k] } else { 0.0 });
        let gap_after_m = where_open(gap_m);
        let crept_pa = self.law.crept(gap_after_m, rest_m, crept_pa, share);
        State { gap_m: gap_after_m, speed_m_s: where_open(speed_m_s), crept_pa }
    }
}

/// Explicitly ahead by θ.
#[inline(always)]
fn ahead<R: Real>(from: State<R>, (acceleration, creep_pa_s): (R, R), theta_s: f64) -> State<R> {
    let theta_s = R::of(theta_s);
    State {
        gap_m: from.gap_m + theta_s * from.speed_m_s,
        speed_m_s: from.speed_m_s + theta_s * acceleration,
        crept_pa: from.crept_pa + theta_s * creep_pa_s,
    }
}
