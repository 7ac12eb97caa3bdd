// SPDX-License-Identifier: MIT OR Apache-2.0
//! The gains of a controller that a scene does not give: they follow from the device and the profile.
//!
//! ```text
//! K     of √F or F: that of the steady curve at the case's largest force   V = K·√F,  V = K·F
//! gain  the largest with these margins about each force, then halved until a step settles
//! ```
//!
//! The steady curve rises less than √F, so that K drives smaller forces too little, and none too much.
//! The margins are those of `stability`: of the gap that moves, the frame and the delay of this profile. A step
//! shows what they cannot: pull-in is no small signal.

use anyhow::{Context, Result, ensure};
use hapticore_scene::{ControlLaw, ControlPlan, DriveCurve, Plant};
use serde::Serialize;

use super::stability::{Bench, OpenLoop};
use super::tuning::{of_gains, voltage_of};
use crate::case::Case;
use crate::record::Stability;

/// Margins that a computed gain has at least.
const GAIN_MARGIN: f64 = 2.5;
const PHASE_MARGIN_DEG: f64 = 55.0;
/// Forces about which they are, as parts of the largest that the case asks for.
const PARTS: [f64; 3] = [0.25, 0.5, 1.0];
/// The largest force of a case that asks for none, N.
const USUAL_N: f64 = 0.3;
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
        let most_n = largest_n(plan, plant, steady);
        let feed_forward_v =
            plan.feed_forward_v.unwrap_or_else(|| feed_forward(plan.curve, steady, most_n));
        let given = Gains {
            feed_forward_v,
            proportional_v: plan.proportional_v.unwrap_or_default(),
            integral_v: plan.integral_v.unwrap_or_default(),
        };
        let is_open = match plan.law {
            ControlLaw::Proportional => plan.proportional_v.is_none(),
            ControlLaw::Integral => plan.proportional_v.is_none() && plan.integral_v.is_none(),
            ControlLaw::Open | ControlLaw::Inverse => false,
        };
        if is_open { computed(case, plan, (given, most_n), (plant, steady)) } else { Ok(given) }
    }
}

/// The largest force that pads or walls ask for, as far as the rail gives it, N.
fn largest_n(plan: &ControlPlan, plant: &Plant, steady: &[[f64; 2]]) -> f64 {
    let targets_n = plant.largest_targets_n().into_iter();
    let asked_n = targets_n.chain(plan.wall.as_ref().map(|wall| wall.force_n)).fold(0.0, f64::max);
    let asked_n = if asked_n > 0.0 { asked_n } else { USUAL_N };
    steady.last().map_or(0.0, |[_, force]| force.min(asked_n))
}

/// K of the steady curve at a force; none where the device gives none.
fn feed_forward(curve: DriveCurve, steady: &[[f64; 2]], most_n: f64) -> f64 {
    let of_force = match curve {
        DriveCurve::Linear => most_n,
        _ => most_n.sqrt(),
    };
    if most_n > 0.0 { voltage_of(steady, most_n) / of_force } else { 0.0 }
}

fn computed(
    case: &Case,
    plan: &ControlPlan,
    (given, most_n): (Gains, f64),
    (plant, steady): (&Plant, &[[f64; 2]]),
) -> Result<Gains> {
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
    let mut gain = tried.into_iter().find(has_margins).with_context(|| {
        format!(
            "control.law: no gain has margins of {GAIN_MARGIN} and {PHASE_MARGIN_DEG}° about {forces_n:?} N; give \
             control.proportional_v or control.integral_v"
        )
    })?;
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
    fn a_curve_gives_the_largest_force_and_no_smaller_one_too_much() {
        let steady = [[0.0, 0.0], [100.0, 0.01], [200.0, 0.06], [300.0, 0.4]];
        let k_v = feed_forward(DriveCurve::SquareRoot, &steady, 0.4);
        assert!((k_v * 0.4f64.sqrt() - 300.0).abs() < 1e-9);
        assert!(steady.iter().all(|[volt, force]| k_v * force.sqrt() <= volt + 1e-9));
        assert_eq!(feed_forward(DriveCurve::Linear, &steady, 0.4), 750.0);
        let none = [[0.0, 0.0], [100.0, 0.0]];
        assert_eq!(feed_forward(DriveCurve::Linear, &none, 0.0), 0.0);
    }
}
