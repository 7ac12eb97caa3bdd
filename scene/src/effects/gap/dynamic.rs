// SPDX-License-Identifier: MIT OR Apache-2.0
//! A patch in motion: one step of its equations by methods of rising accuracy.
//!
//! | method | order | at long steps |
//! | --- | --- | --- |
//! | semi-implicit: film and creep implicit, the rest as it was | 1 | stable while the contact is soft |
//! | implicit Euler | 1 | stable, damps |
//! | trapezoid | 2 | stable, rings after a jump |
//! | TR-BDF2, γ = 2 − √2 (Bank et al., 1985) | 2 | stable, damps: the reference |
//!
//! An implicit stage of length θ asks for g = a + θ·v, v = b + θ·g̈, z = e + θ·ż. As g alone
//! decides v and z, it is one equation in g, solved by Newton's steps within a bracket. Source:
//! docs/physics.md §3.

use super::law::{Drive, Law, Sloped, State, root};

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

    /// The state a step later.
    #[inline]
    pub fn step(self, law: &Law, rest_m: f64, from: State, step_s: f64, drive: &Stages) -> State {
        match self {
            Method::SemiImplicit => semi_implicit(law, rest_m, from, step_s, drive.end),
            Method::ImplicitEuler => stage(law, rest_m, from, from, step_s, drive.end),
            Method::Trapezoid => trapezoid(law, rest_m, from, step_s, drive),
            Method::TrBdf2 => tr_bdf2(law, rest_m, from, step_s, drive),
        }
    }
}

fn semi_implicit(law: &Law, rest_m: f64, from: State, step_s: f64, drive: Drive) -> State {
    let share = step_s / law.creep_s;
    let opening = law.relaxed(from.gap_m, rest_m, drive).value
        + law.creeping(from.gap_m, rest_m, from.creep_m, share).value;
    let damping = 1.0 + step_s * law.film(from.gap_m).value / law.inertia_kg_m2;
    let speed_m_s = (from.speed_m_s + step_s * opening / law.inertia_kg_m2) / damping;
    settled(rest_m, from.creep_m, share, from.gap_m + step_s * speed_m_s, speed_m_s)
}

/// Where it would close the gap, it has overshot: then implicit Euler, for a start from closed
/// throws the patch open again.
fn trapezoid(law: &Law, rest_m: f64, from: State, step_s: f64, drive: &Stages) -> State {
    let base = ahead(from, law.rates(from, rest_m, drive.start), 0.5 * step_s);
    let to = stage(law, rest_m, base, from, 0.5 * step_s, drive.end);
    if to.gap_m > 0.0 { to } else { stage(law, rest_m, from, from, step_s, drive.end) }
}

/// The trapezoid over γ of the step, then a backward difference over the whole, both with the same
/// θ; closed, as above.
fn tr_bdf2(law: &Law, rest_m: f64, from: State, step_s: f64, drive: &Stages) -> State {
    const MIDDLE: f64 = 1.0 / (GAMMA * (2.0 - GAMMA));
    let theta = 0.5 * GAMMA * step_s;
    let base = ahead(from, law.rates(from, rest_m, drive.start), theta);
    let middle = stage(law, rest_m, base, from, theta, drive.middle);
    let mix = |middle: f64, from: f64| MIDDLE * middle + (1.0 - MIDDLE) * from;
    let base = State {
        gap_m: mix(middle.gap_m, from.gap_m),
        speed_m_s: mix(middle.speed_m_s, from.speed_m_s),
        creep_m: mix(middle.creep_m, from.creep_m),
    };
    let to = stage(law, rest_m, base, middle, theta, drive.end);
    if middle.gap_m.min(to.gap_m) > 0.0 {
        to
    } else {
        stage(law, rest_m, from, from, step_s, drive.end)
    }
}

/// Explicitly ahead by θ.
#[inline]
fn ahead(from: State, (acceleration, creep_m_s): (f64, f64), theta_s: f64) -> State {
    State {
        gap_m: from.gap_m + theta_s * from.speed_m_s,
        speed_m_s: from.speed_m_s + theta_s * acceleration,
        creep_m: from.creep_m + theta_s * creep_m_s,
    }
}

/// An implicit stage of length θ from `base`, sought from `near` on.
#[inline(always)]
fn stage(law: &Law, rest_m: f64, base: State, near: State, theta_s: f64, drive: Drive) -> State {
    let share = theta_s / law.creep_s;
    let inertia = law.inertia_kg_m2 / theta_s;
    let excess = |gap_m: f64| {
        let speed = (gap_m - base.gap_m) / theta_s;
        let (film, opening) = (law.film(gap_m), law.relaxed(gap_m, rest_m, drive));
        let creeping = law.creeping(gap_m, rest_m, base.creep_m, share);
        Sloped {
            value: opening.value + creeping.value
                - film.value * speed
                - inertia * (speed - base.speed_m_s),
            slope: opening.slope + creeping.slope
                - film.slope * speed
                - (film.value + inertia) / theta_s,
        }
    };
    let top =
        2.0 * (rest_m + law.insulator_m) + base.gap_m.abs() + law.contact_pa / law.spring_pa_per_m;
    let gap_m = root(0.0, top, near.gap_m, excess);
    let speed_m_s = (gap_m - base.gap_m) / theta_s;
    settled(rest_m, base.creep_m, share, gap_m, speed_m_s)
}

/// The state at a gap, its creep brought along implicitly; a gap that would be negative is closed,
/// and still.
#[inline]
fn settled(rest_m: f64, crept_m: f64, share: f64, gap_m: f64, speed_m_s: f64) -> State {
    let creep_m = (crept_m + share * (rest_m - gap_m)) / (1.0 + share);
    if gap_m > f64::EPSILON * rest_m {
        State { gap_m, speed_m_s, creep_m }
    } else {
        State { gap_m: 0.0, speed_m_s: 0.0, creep_m }
    }
}
