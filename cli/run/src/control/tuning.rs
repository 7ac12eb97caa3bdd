// SPDX-License-Identifier: MIT OR Apache-2.0
//! A scene's controller, in volts and newtons, as words of a core.

use anyhow::{Context, Result, ensure};
use hapticore_contract::control::{Control, Law, Tuning, Walls};
use hapticore_contract::profile::{Force, ForceLaw, Profile, Release, Wall};
use hapticore_scene::{
    ControlLaw, ControlPlan, DriveCurve, ForceEstimate, Plant, WallPlan, WallRule,
};

use super::gains::Gains;
use crate::case::Case;

/// Voltages at which the steady curve is measured.
const MEASURED: usize = 401;

/// The profile with the controller that a scene asks for; formats are those of the profile's own,
/// where it has one.
/// Those of the walls are for the time from a pad's slot to its next, where the profile has none of
/// its own; `parts` are the slots of each pad.
///
/// # Errors
/// A profile whose walls are of pads with another number of parts.
pub fn controlled(
    profile: &Profile,
    plan: &ControlPlan,
    (parts, frame_s): (usize, f64),
) -> Result<Profile> {
    let law = match plan.law {
        ControlLaw::Open => Law::Open,
        ControlLaw::Proportional => Law::Proportional,
        ControlLaw::Integral => Law::Integral,
        ControlLaw::Inverse => Law::Inverse,
    };
    let control = profile.control.clone().unwrap_or_else(|| Control::of(profile, law));
    let force = plan.force.map_or(profile.force.law, |force| match force {
        ForceEstimate::Eq8 => ForceLaw::Eq8,
        ForceEstimate::Table => ForceLaw::Table,
    });
    let usual = match parts {
        2 => Wall::B,
        4 => Wall::QUADRANTS,
        _ => Wall::A,
    };
    let own = profile.wall.unwrap_or(usual.at_frames_of(1e3 * frame_s));
    ensure!(
        plan.wall.is_none() || own.parts as usize == parts,
        "{}: wall.parts: expected {parts}, the parts of the scene's pads, got {}",
        profile.name,
        own.parts
    );
    Ok(Profile {
        wall: plan.wall.as_ref().map(|wall| walled(own, wall)),
        control: Some(Control { law, ..control }),
        force: Force { law: force, ..profile.force },
        ..profile.clone()
    })
}

/// The rule of a profile's walls as a scene asks for it.
fn walled(wall: Wall, plan: &WallPlan) -> Wall {
    let rule = match plan.rule {
        WallRule::Sequential => Release::Sequential,
        WallRule::Direct => Release::Direct,
        WallRule::Never => Release::Never,
    };
    // Nothing moves so fast that it would be learnt from.
    let learn_um = if plan.calibrated { wall.learn_um } else { 10_000 };
    let play_um = plan.play_mm.map_or(wall.play_um, |mm| (1e3 * mm).round() as u64);
    // Both are to be beyond the noise of the place.
    let slip_um = (wall.slip_um * play_um).div_ceil(wall.play_um);
    Wall { rule, learn_um, play_um, slip_um, ..wall }
}

/// The walls, as the factory calibrates them.
fn walls(plan: &WallPlan, load_g: f64, plant: &Plant) -> Walls {
    let read = plant.parts_at_rest_pf(load_g).filter(|_| plan.calibrated);
    Walls {
        stiffness_n_per_mm: plan.stiffness_n_per_mm,
        most_n: plan.force_n,
        factory: read.map_or(0.0, |[left, right]| (right - left) / (right + left)),
        right: plan.right,
    }
}

/// Gains and tuning of a case's controller, for the device as it was calibrated.
///
/// # Errors
/// A gain that its word does not hold: its key, and what would; a device that no gain suits.
pub fn tuning(case: &Case, plan: &ControlPlan, plant: &Plant) -> Result<(Gains, Tuning)> {
    let steady = steady(plan, plant);
    let gains = Gains::of(case, plan, (plant, &steady))?;
    let tuning = of_gains(case, plan, plant, (&gains, &steady))?;
    Ok((gains, tuning))
}

/// The tuning with gains that are known.
///
/// # Errors
/// A gain that its word does not hold: its key, and what would.
pub(super) fn of_gains(
    case: &Case,
    plan: &ControlPlan,
    plant: &Plant,
    (gains, steady): (&Gains, &[[f64; 2]]),
) -> Result<Tuning> {
    let (profile, device) = (&case.profile, &case.device);
    let control = profile.control.as_ref().context("a profile with a controller")?;
    let frame_s = case.clock.seconds(plant.served());
    let part = |volt: f64| volt / plan.full_scale_v;
    let root = control.root_full_scale();
    let adc = part(device.device.haptic_full_scale_v);
    let (proportional, correction) = match control.law {
        Law::Integral => {
            (part(gains.proportional_v) * root, part(gains.integral_v) * root * frame_s)
        }
        Law::Inverse => (part(gains.proportional_v), trim_step(plan.trim_s, root, frame_s)),
        _ => (part(gains.proportional_v), plan.filter),
    };
    let share = pad_share(plan, steady);
    let full_drive = adc * adc / profile.square_gain() / (share * share);
    let most = control.gain.real(control.gain.max_code() as i64);
    ensure!(
        full_drive <= most,
        "control.full_scale_v: expected at least {:.0} V with sensor.haptic_full_scale_v = {}, got {}",
        (plan.full_scale_v * (full_drive / most).sqrt()).ceil(),
        device.device.haptic_full_scale_v,
        plan.full_scale_v
    );
    for (key, given, asked, gain) in [
        ("proportional_v", plan.proportional_v, gains.proportional_v, proportional),
        ("integral_v", plan.integral_v, gains.integral_v, correction),
    ] {
        let limit = asked * most / gain;
        ensure!(gain <= most, "control.{key}: expected at most {limit:.0}, {}", got(given, asked));
    }
    Ok(Tuning {
        curve: curve(plan, control, (gains, steady))
            .into_iter()
            .map(|volt| part(volt).min(1.0))
            .collect(),
        full_drive,
        proportional,
        correction,
        rail: part(plan.rail_v),
        slew: part(plan.slew_v),
        force_cap: plan.force_cap_n,
        walls: plan.wall.as_ref().map(|wall| walls(wall, nominal_load_g(plan, plant), plant)),
    })
}

/// Where a gain that no word holds comes from.
fn got(given: Option<f64>, asked: f64) -> String {
    match given {
        Some(_) => format!("got {asked}"),
        None => format!("and {asked:.0} follows from device, profile and target: give the key"),
    }
}

/// The voltages of the curve, at the roots of forces 0 … the largest target.
fn curve(
    plan: &ControlPlan,
    control: &Control,
    (gains, steady): (&Gains, &[[f64; 2]]),
) -> Vec<f64> {
    let root = |cell: u64| cell as f64 / control.cells as f64 * control.root_full_scale();
    let roots = (0..=control.cells).map(root);
    match plan.curve {
        DriveCurve::SquareRoot => {
            roots.map(|root| plan.curve_factor * gains.feed_forward_v * root).collect()
        }
        DriveCurve::Linear => {
            roots.map(|root| plan.curve_factor * gains.feed_forward_v * root * root).collect()
        }
        DriveCurve::Steady => {
            let volt = |root: f64| plan.curve_factor * voltage_of(steady, root * root);
            roots.map(volt).collect()
        }
    }
}

/// The load of the calibration, g: as the plan says, else that of the case's pads.
fn nominal_load_g(plan: &ControlPlan, plant: &Plant) -> f64 {
    plan.nominal_load_g.unwrap_or_else(|| plant.mean_load_g())
}

/// Voltages of the source, from zero to the rail, and the steady forces that they give under the nominal load; those of
/// even steps of the voltage at the pad.
fn steady(plan: &ControlPlan, plant: &Plant) -> Vec<[f64; 2]> {
    let step_v = plan.rail_v / (MEASURED - 1) as f64;
    let volts: Vec<f64> = (0..MEASURED).map(|n| step_v * n as f64).collect();
    let points = plant.friction_calibration(&[nominal_load_g(plan, plant)], &volts);
    let steady: Vec<_> =
        points.into_iter().map(|point| [point.source_v_rms, point.force_n]).collect();
    let within = steady.partition_point(|[volt, _]| *volt <= plan.rail_v * (1.0 + 1e-9));
    // Two at least: a share follows from the second.
    steady.into_iter().take(within.max(2)).collect()
}

/// K_i of the trim: with F = 1 N its error decays with the time constant.
fn trim_step(trim_s: f64, root_full_scale: f64, frame_s: f64) -> f64 {
    if trim_s > 0.0 {
        (root_full_scale * frame_s / trim_s).min(Control::MOST_TRIM_STEP)
    } else {
        0.0
    }
}

/// The voltage at the pad by that of its source, where half of the rail's force is held: whatever the targets are, so that
/// a recording of other targets has the same tuning.
fn pad_share(plan: &ControlPlan, steady: &[[f64; 2]]) -> f64 {
    let step_v = plan.rail_v / (MEASURED - 1) as f64;
    let half_n = 0.5 * steady.last().map_or(0.0, |[_, force]| *force);
    let held = steady.partition_point(|[_, force]| *force < half_n).clamp(1, steady.len() - 1);
    step_v * held as f64 / steady[held][0]
}

/// The least voltage that gives a force, linear between those measured; beyond them the last.
pub(super) fn voltage_of(steady: &[[f64; 2]], force_n: f64) -> f64 {
    let next = steady.partition_point(|[_, force]| *force < force_n);
    match (next.checked_sub(1), steady.get(next)) {
        (Some(before), Some([high_v, high_n])) => {
            let [low_v, low_n] = steady[before];
            low_v + (high_v - low_v) * (force_n - low_n) / (high_n - low_n)
        }
        (None, _) => 0.0,
        (_, None) => steady.last().map_or(0.0, |[volt, _]| *volt),
    }
}

#[cfg(test)]
mod tests {
    use super::voltage_of;

    #[test]
    fn the_voltage_of_a_force_lies_between_those_measured() {
        let steady = [[0.0, 0.0], [100.0, 0.1], [200.0, 0.5]];
        let volts = [0.0, 0.05, 0.1, 0.3, 0.5, 9.0].map(|force| voltage_of(&steady, force));
        assert_eq!(volts, [0.0, 50.0, 100.0, 150.0, 200.0, 200.0]);
    }
}
