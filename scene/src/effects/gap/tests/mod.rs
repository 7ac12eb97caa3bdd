// SPDX-License-Identifier: MIT OR Apache-2.0
//! Closed forms, orders of convergence, hard cases, and the check values of docs/physics.md §3.

mod closed_forms;
mod devices;
mod equilibria;
mod measured;
mod methods;
mod sine;

use super::dynamic::{Method, Stages};
use super::equilibrium::equilibrium;
use super::law::{Drive, Law, Patch, State};
use super::quasi_static;
use super::read_rubber::read_rubber;
use super::rubber::{Rubber, at_rest};
use crate::device::Device;

/// ε₀ rounded to four digits, F/m.
const ROUNDED_EPSILON_0: f64 = 8.854e-12;

/// The single stiff patch that the prototype's table of methods is of: h₀ = 19.66 µm.
const PATCH: Patch = Patch { rest_m: 14.66e-6, load_share: 1.0 };

/// Its rubber without creep, an eighth of the pad over a film of this viscosity.
fn law(film_pa_s: f64) -> Law {
    Law {
        spring_pa_per_m: 5e8,
        contact_pa: 2e5,
        contact_decay_m: 0.5e-6,
        creep_share: 0.0,
        creep_s: 1.5,
        insulator_m: 5e-6,
        haptic_insulator_m: 5e-6,
        contact_hardness_pa: f64::INFINITY,
        film_n_s: film_pa_s * 1.5 * 0.015 * 0.015 / 8.0,
        film_rest_m: 0.7e-6,
        inertia_kg_m2: 7.0,
    }
}

/// The film of air under the patch.
const AIR_PA_S: f64 = 1.8e-5;

/// The pad that a scene with this `[gap]` has.
fn pad(gap: &str) -> Rubber {
    let root = crate::format::parse(&format!("[gap]\n{gap}\n")).unwrap();
    let device = Device::read(&root).unwrap();
    read_rubber(root.table("gap").unwrap().unwrap(), &device).unwrap()
}

/// Pull-in voltage of relaxed rubber, without contact and load: V_PI = √(8κh₀³/27ε₀).
fn pull_in_v(law: &Law, patch: Patch, epsilon_0: f64) -> f64 {
    let height = patch.rest_m + law.insulator_m;
    (8.0 * law.spring_pa_per_m * height.powi(3) / (27.0 * epsilon_0)).sqrt()
}

/// The explicit method for comparison (docs/physics.md §3).
fn rk4(law: &Law, from: State, step_s: f64, drive: Drive) -> State {
    let slope = |at: State| {
        let (acceleration, creep) = law.rates(at, PATCH, drive);
        [at.speed_m_s, acceleration, creep]
    };
    let ahead = |slope: [f64; 3], step: f64| State {
        gap_m: from.gap_m + step * slope[0],
        speed_m_s: from.speed_m_s + step * slope[1],
        crept_pa: from.crept_pa + step * slope[2],
    };
    let a = slope(from);
    let b = slope(ahead(a, 0.5 * step_s));
    let c = slope(ahead(b, 0.5 * step_s));
    let d = slope(ahead(c, step_s));
    ahead(std::array::from_fn(|n| (a[n] + 2.0 * b[n] + 2.0 * c[n] + d[n]) / 6.0), step_s)
}

/// How a patch is moved, for comparison.
#[derive(Clone, Copy, Debug)]
enum By {
    Rk4,
    QuasiStatic,
    Dynamic(Method),
}

/// A step of a patch that is computed alone.
fn step_alone(
    method: Method,
    law: &Law,
    patch: Patch,
    mut at: State,
    step_s: f64,
    stages: &Stages,
) -> State {
    method.step(law, &[patch], std::slice::from_mut(&mut at), step_s, stages);
    at
}

impl By {
    fn is(self, method: Method) -> bool {
        matches!(self, By::Dynamic(same) if same == method)
    }

    fn step(self, law: &Law, from: State, step_s: f64, drive: impl Fn(f64) -> Drive) -> State {
        match self {
            By::Rk4 => rk4(law, from, step_s, drive(0.5)),
            By::QuasiStatic => quasi_static::advance(law, PATCH, from, step_s, drive(1.0)),
            By::Dynamic(method) => {
                step_alone(method, law, PATCH, from, step_s, &method.stages(drive))
            }
        }
    }
}

/// The relaxed patch without voltage.
fn undriven(law: &Law) -> State {
    at_rest(law, PATCH, equilibrium(law, PATCH, Drive::new(0.0, 0.0)))
}

/// The patch's states every `every_s`, its voltage given over time.
fn run(
    by: By,
    law: &Law,
    volt: impl Fn(f64) -> f64,
    step_s: f64,
    every_s: f64,
    until_s: f64,
) -> Vec<State> {
    const INSIDE: f64 = 1e-6; // so that a step of the voltage on the grid falls between two steps of time
    let steps_each = (every_s / step_s).round() as usize;
    let mut at = undriven(law);
    let step = |n: usize| {
        let drive = |fraction: f64| {
            Drive::new(volt((n as f64 + fraction.clamp(INSIDE, 1.0 - INSIDE)) * step_s), 0.0)
        };
        at = by.step(law, at, step_s, drive);
        (n + 1).is_multiple_of(steps_each).then_some(at)
    };
    (0..(until_s / step_s).round() as usize).filter_map(step).collect()
}

/// The largest relative difference of capacitance.
fn capacitance_error(got: &[State], exact: &[State]) -> f64 {
    let height = |state: &State| state.gap_m + 5e-6;
    got.iter()
        .zip(exact)
        .map(|(got, exact)| (height(exact) / height(got) - 1.0).abs())
        .fold(0.0, f64::max)
}
