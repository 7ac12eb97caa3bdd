// SPDX-License-Identifier: MIT OR Apache-2.0
//! The gains of a controller that a scene does not give: they follow from the device and the profile.
//!
//! ```text
//! K     of √F or F: least squares over the steady curve up to the rail     V = K·√F,  V = K·F
//! gain  the largest with these margins about each force, then halved until a step settles
//! ```
//!
//! The margins are those of `stability`: of the gap that moves, the frame and the delay of this profile. A step
//! shows what they cannot: pull-in is no small signal.

use anyhow::{Result, ensure};
use hapticore_scene::{ControlLaw, ControlPlan, DriveCurve, Plant};
use serde::Serialize;

use super::stability::{Bench, OpenLoop};
use super::tuning::{of_gains, voltage_of};
use crate::case::Case;
use crate::record::Stability;

/// Margins that a computed gain has at least.
const GAIN_MARGIN: f64 = 2.5;
const PHASE_MARGIN_DEG: f64 = 55.0;
/// Forces about which they are, as parts of the most that the rail gives, or of `MOST_N`.
const PARTS: [f64; 3] = [0.125, 0.375, 0.75];
const MOST_N: f64 = 0.8;
/// The most that a step to them may overshoot.
const OVERSHOOT_PERCENT: f64 = 25.0;
/// Gains that are tried, each by √2 less than the one before, and then halved.
const TRIED: i32 = 40;
const HALVED: usize = 6;

/// The numbers of a law that a scene may leave open, each in the unit of its key.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Gains {
    /// K of the curve.
    pub feed_forward_v: f64,
    /// Gain of the error.
    pub proportional_v: f64,
    /// Integral gain.
    pub integral_v: f64,
}

impl Gains {
    /// Those of a case, whose steady curve on this plant is known: V rms and N from 0 to the rail.
    ///
    /// # Errors
    /// A plant that cannot be, a device that no gain suits.
    pub fn of(
        case: &Case,
        plan: &ControlPlan,
        (plant, steady): (&Plant, &[[f64; 2]]),
    ) -> Result<Gains> {
        let given = Gains {
            feed_forward_v: plan.feed_forward_v.unwrap_or_else(|| feed_forward(plan.curve, steady)),
            proportional_v: plan.proportional_v.unwrap_or_default(),
            integral_v: plan.integral_v.unwrap_or_default(),
        };
        let is_open = match plan.law {
            ControlLaw::Proportional => plan.proportional_v.is_none(),
            ControlLaw::Integral => plan.proportional_v.is_none() && plan.integral_v.is_none(),
            ControlLaw::Open | ControlLaw::Inverse => false,
        };
        if is_open { computed(case, plan, given, (plant, steady)) } else { Ok(given) }
    }
}

/// K of least squares.
fn feed_forward(curve: DriveCurve, steady: &[[f64; 2]]) -> f64 {
    let of_force = |force_n: f64| match curve {
        DriveCurve::Linear => force_n,
        _ => force_n.sqrt(),
    };
    let sum = |of: fn(f64, f64) -> f64| -> f64 {
        steady.iter().map(|[volt, force]| of(*volt, of_force(*force))).sum()
    };
    let squares = sum(|_, force| force * force);
    if squares > 0.0 { sum(|volt, force| volt * force) / squares } else { 0.0 }
}

fn computed(
    case: &Case,
    plan: &ControlPlan,
    given: Gains,
    (plant, steady): (&Plant, &[[f64; 2]]),
) -> Result<Gains> {
    let most_n = steady.last().map_or(0.0, |[_, force]| force.min(MOST_N));
    let forces_n = PARTS.map(|part| part * most_n);
    let tuning = of_gains(case, plan, plant, (&given, steady))?;
    let open_loops = forces_n
        .iter()
        .map(|force_n| {
            let bench = Bench::new(case, plan, tuning.clone(), *force_n)?;
            OpenLoop::held(&bench, voltage_of(steady, *force_n))
        })
        .collect::<Result<Vec<_>>>()?;
    let first = open_loops.iter().map(OpenLoop::unit_gain).fold(f64::INFINITY, f64::min);
    ensure!(
        first.is_finite() && first > 0.0,
        "control.law: expected gains, since the device gives no force from which they would follow"
    );
    let frame_s = open_loops[0].frame_s;
    let with = |gain: f64| match plan.law {
        ControlLaw::Integral => Gains { integral_v: gain / frame_s, ..given },
        _ => Gains { proportional_v: gain / plan.filter, ..given },
    };
    let has_margins = |gain: &f64| {
        open_loops.iter().all(|open| {
            let found = open.with(plan, &with(*gain)).margins(0.0);
            enough(&found)
        })
    };
    let tried = (0..TRIED).map(|n| 2.0 * first * 0.5f64.powf(0.5 * f64::from(n)));
    let mut gain = tried.into_iter().find(has_margins).unwrap_or_default();
    for _ in 0..HALVED {
        let tuning = of_gains(case, plan, plant, (&with(gain), steady))?;
        let settles = |force_n: &f64| -> Result<bool> {
            let step = Bench::new(case, plan, tuning.clone(), *force_n)?.step()?;
            Ok(step.settles() && step.overshoot_percent <= OVERSHOOT_PERCENT)
        };
        let all = forces_n.iter().map(settles).collect::<Result<Vec<_>>>()?;
        if all.iter().all(|settles| *settles) {
            break;
        }
        gain *= 0.5;
    }
    Ok(with(gain))
}

fn enough(found: &Stability) -> bool {
    found.gain_margin.is_none_or(|margin| margin >= GAIN_MARGIN)
        && found.phase_margin_deg.is_none_or(|margin| margin >= PHASE_MARGIN_DEG)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_of_the_law_has_its_own_factor() {
        let steady: Vec<[f64; 2]> =
            (0..5).map(|n| [100.0 * f64::from(n), (f64::from(n) / 5.0).powi(2)]).collect();
        assert!((feed_forward(DriveCurve::SquareRoot, &steady) - 500.0).abs() < 1e-9);
        let none = [[0.0, 0.0], [100.0, 0.0]];
        assert_eq!(feed_forward(DriveCurve::Linear, &none), 0.0);
    }
}
