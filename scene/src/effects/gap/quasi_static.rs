// SPDX-License-Identifier: MIT OR Apache-2.0
//! A patch without inertia, c(g)·ġ = the pressure that opens it: the film's resistance is some 10⁴
//! times the inertia's.
//!
//! Linearly implicit (Rosenbrock's first): δ = h·F/(c − h·F′), one evaluation a step and no
//! iteration. Where attraction wins, F′ > 0, or where the film changes within the step, the step is
//! cut: a gap changes by at most a share of itself. That is what passes the fold and the closure.
//! Source: docs/physics.md §3.

use super::law::{Drive, Law, Patch, Sloped, State};

/// The most that a step changes the film's thickness, as a share of it.
const MOST_CHANGE: f64 = 1.0 / 64.0;

/// The state after `span_s` at one drive.
pub(super) fn advance(law: &Law, patch: Patch, mut at: State, span_s: f64, drive: Drive) -> State {
    let mut left_s = span_s;
    while left_s > 0.0 {
        let opening = law.creeping(at.gap_m, patch, drive, at.crept_pa, left_s / law.creep_s);
        let step_s = longest(law, at.gap_m, opening).min(left_s);
        at = step(law, patch, at, step_s, opening);
        left_s -= step_s;
    }
    at
}

/// The step over which the film changes by [`MOST_CHANGE`]: δ = h·F/(c − h·F′) solved for h.
fn longest(law: &Law, gap_m: f64, opening: Sloped) -> f64 {
    let most = MOST_CHANGE * (gap_m + law.film_rest_m);
    let speed = opening.value.abs() + most * opening.slope;
    if speed > 0.0 { most * law.film(gap_m).value / speed } else { f64::INFINITY }
}

fn step(law: &Law, patch: Patch, from: State, step_s: f64, opening: Sloped) -> State {
    let change = step_s * opening.value / (law.film(from.gap_m).value - step_s * opening.slope);
    let gap_m = (from.gap_m + change).max(0.0);
    let crept_pa = law.crept(gap_m, patch.rest_m, from.crept_pa, step_s / law.creep_s);
    State { gap_m, speed_m_s: change / step_s, crept_pa }
}
