// SPDX-License-Identifier: MIT OR Apache-2.0
//! The controller's block alone around a plant: rounding, rails, faults, gains.

use hapticore_contract::control::{Law, Tuning};

use super::rig::{Given, Rig};
use super::rivals::Rival;
use crate::rivals::laws::{Gains, Law as _, Linien, PyRpl, Seen, SuServo};
use crate::stability::Outcome;

/// Steady targets, N.
const TARGETS_N: [f64; 5] = [0.011, 0.051, 0.093, 0.171, 0.244];

/// The permanent error of the steady force that narrowing leaves.
pub fn rounding_bias() -> Outcome {
    let mut outcome = Outcome::default();
    let (mut frames, mut step_n) = (0, 0.0);
    for law in [Law::Proportional, Law::Integral] {
        let mut worst = 0f64;
        for target_n in TARGETS_N {
            let mut rig = Rig::new(law, |_| ());
            let cycle = rig.cycle(target_n);
            frames += cycle.len() as u64;
            step_n = rig.force_step_n();
            let mean_n = cycle.iter().map(|given| given.force_n).sum::<f64>() / cycle.len() as f64;
            let expected_n = rig.at_rest(rig.target_n(target_n));
            worst = worst.max((mean_n - expected_n).abs() / step_n);
        }
        let name = if law == Law::Integral { "integral" } else { "proportional" };
        outcome =
            outcome.at_most(format!("mean force, law {name}"), worst, 0.5, "steps of its word");
    }
    // Half a volt per newton and frame; from a drive at either end.
    let off_n = |target_n: f64, start: f64| {
        let forces = Rival::new(SuServo::new(0.5, start)).forces(target_n, 200_000);
        let last = &forces[forces.len() - 1000..];
        (last.iter().sum::<f64>() / last.len() as f64 - target_n).abs()
    };
    let [above, below] = [1.0, 0.0]
        .map(|start| TARGETS_N.map(|n| off_n(n, start)).into_iter().fold(0.0, f64::max) / step_n);
    outcome.equal(frames).rivals(format!(
        "SUServo's integrator, ½ V/N a frame: up to {above:.0} steps off when it comes from above, {below:.0} from below"
    ))
}

/// The words of a settled loop.
pub fn limit_cycle() -> Outcome {
    let mut outcome = Outcome::default();
    let mut frames = 0;
    for law in Law::ALL {
        let mut most = 0;
        for target_n in TARGETS_N {
            let cycle = Rig::new(law, |_| ()).cycle(target_n);
            frames += cycle.len() as u64;
            most = most.max(spread(&cycle));
        }
        outcome = outcome.at_most(format!("law {}", law.name()), most as f64, 1.0, "LSB");
    }
    let mut raw =
        Rig::new(Law::Proportional, |tuning| (tuning.proportional, tuning.correction) = (7.9, 1.0));
    raw.frames(0.25, 2000);
    let words: Vec<Given> = (0..1000).map(|_| raw.frame(0.25)).collect();
    outcome.equal(frames).rivals(format!(
        "law proportional with a gain of 7.9 and no filter (paper, Fig. 8b): {} LSB",
        spread(&words)
    ))
}

fn spread(frames: &[Given]) -> i64 {
    let words = || frames.iter().map(|given| given.drive);
    words().max().unwrap_or(0) - words().min().unwrap_or(0)
}

/// Frames until the force stays within 1 % of its target.
fn frames_to(forces: &[f64], target_n: f64) -> usize {
    forces
        .iter()
        .rposition(|force| (force / target_n - 1.0).abs() > 0.01)
        .map_or(0, |last| last + 1)
}

/// A target that no drive gives, and back.
pub fn one_sided_rail() -> Outcome {
    let mut outcome =
        Outcome::of("frames until within 1 % of 0.1 N, after 1,000 frames at the rail");
    for law in [Law::Proportional, Law::Integral, Law::Inverse] {
        let mut rig = Rig::new(law, |tuning| tuning.rail = 0.7);
        rig.frames(1.5, 1000);
        let after: Vec<f64> = (0..2000).map(|_| rig.frame(0.1).force_n).collect();
        let rest_n = *after.last().expect("frames");
        let mut calm = Rig::new(law, |tuning| tuning.rail = 0.7);
        let fresh: Vec<f64> = (0..2000).map(|_| calm.frame(0.1).force_n).collect();
        let [back, start] = [&after, &fresh].map(|forces| frames_to(forces, rest_n));
        outcome = outcome.at_most(
            format!("law {} (from rest {start})", law.name()),
            back as f64,
            start as f64 + 20.0,
            "frames",
        );
    }
    // At 0.1 N as fast as the integral law.
    let mut rival = Rival::new(PyRpl::new(Gains { proportional: 0.0, integral: 80.0 }));
    rival.forces(1.5, 1000);
    outcome.rivals(format!(
        "PyRPL's integrator with the integral law's gain: {} frames",
        frames_to(&rival.forces(0.1, 4000), 0.1)
    ))
}

/// Errors and gains from end to end, so that a product that wrapped would drive the wrong way.
pub fn largest_error_and_gain() -> Outcome {
    let mut frames = 0;
    for law in Law::ALL {
        for proportional in [0.5, 2.0, 7.99] {
            let mut rig = Rig::new(law, |tuning| tuning.proportional = proportional);
            let (rail, most_n) = (rig.control.drive.max_code() as i64, rig.largest_target_n());
            for force_n in [0.0, 0.05, 1.0, 1.9] {
                for target_n in [most_n, 1.5, 0.5] {
                    rig.plant.capacitance_pf = 300.0;
                    let given = rig.measured(target_n, force_n, false);
                    let wants_more = target_n > force_n + 0.4;
                    assert!((0..=rail).contains(&given.drive), "{law:?}: {}", given.drive);
                    assert!(!wants_more || given.drive > rail / 2, "{law:?}: {}", given.drive);
                    frames += 1;
                }
            }
        }
    }
    let volts = |target_n: f64| {
        let seen = Seen { target_n, force_n: 0.0, capacitance_pf: 300.0 };
        Linien::new(Gains { proportional: 900.0, integral: 0.0 }).volts(&seen)
    };
    Outcome::default().holds(frames).rivals(format!(
        "Linien's proportional part wraps: {:+.0} V of 500 V for an error of 0.5 N, {:+.0} V for 0.6 N",
        volts(0.5),
        volts(0.6)
    ))
}

/// The same target for so long that anything that winds up has.
pub fn rail_for_a_million_frames() -> Outcome {
    let mut frames = 0;
    for law in Law::ALL {
        let mut rig = Rig::new(law, |tuning| tuning.rail = 0.4);
        let rail = rig.inputs.tuning.rail;
        let frame = |rig: &mut Rig| {
            assert_eq!(rig.measured(1.5, 0.02, false).drive, rail, "{law:?}");
            rig.state()
        };
        let first: Vec<_> = (0..4).map(|_| frame(&mut rig)).collect();
        assert_eq!(first[2], first[3], "{law:?}");
        // What proves any number; some are run all the same.
        for _ in 0..10_000 {
            rig.measured(1.5, 0.02, false);
        }
        assert_eq!(rig.state(), first[3], "{law:?}");
        frames += 10_004;
    }
    Outcome::default().equal(frames)
}

/// Estimates that are invalid for long, once the loop has settled.
pub fn sensor_invalid() -> Outcome {
    let mut frames = 0;
    for law in Law::ALL {
        let mut rig = Rig::new(law, |_| ());
        let held = rig.frames(0.1, 2000).drive;
        let most = rig.control.invalid_frames;
        for frame in 1..=most + 20 {
            let given = rig.invalid_frame(0.1);
            let expected = if frame < most { (held, false) } else { (0, true) };
            assert_eq!((given.drive, given.faults[1]), expected, "{law:?}, frame {frame}");
            frames += 1;
        }
        assert_eq!(rig.frame(0.1).drive, 0, "{law:?}: latched");
        rig.clear();
        let after = rig.frames(0.1, 2000).drive;
        assert!((after - held).abs() as f64 <= 2e-3 * held as f64, "{law:?}: {after} of {held}");
    }
    Outcome::default().equal(frames)
}

/// The host is silent: it asks for no force.
pub fn host_silent() -> Outcome {
    let mut frames = 0;
    for law in Law::ALL {
        let mut rig = Rig::new(law, |_| ());
        rig.frames(0.1, 1000);
        rig.alive = false;
        let most = rig.control.silent_ms;
        for ms in 1..=most + 10 {
            rig.tick();
            let given = rig.frame(0.1);
            let silent = ms >= most;
            assert_eq!((given.faults[0], given.drive == 0), (silent, silent), "{law:?}, {ms} ms");
            frames += 1;
        }
        rig.alive = true;
        assert_eq!(rig.frame(0.1).drive, 0, "{law:?}: latched");
    }
    Outcome::default().holds(frames)
}

/// Other gains in each clock of a frame, although their words should be stable then.
pub fn gains_changed_in_mid_frame() -> Outcome {
    let mut frames = 0;
    let mut worst = 0f64;
    for law in Law::ALL {
        let change = |tuning: &mut Tuning| {
            (tuning.proportional, tuning.correction) = (0.25, 0.05);
            (tuning.rail, tuning.slew) = (0.8, 0.2);
        };
        let expected = Rig::new(law, change).frames(0.1, 3000);
        let latency = Rig::new(law, change).latency();
        for at in (0..=latency).step_by(4) {
            let mut rig = Rig::new(law, |_| ());
            let before = rig.frames(0.1, 300).drive;
            rig.retune = Some((at, rig.tuning(change)));
            let mixed = rig.frame(0.1).drive;
            rig.retune = None;
            let rail = rig.control.drive.max_code() as i64;
            assert!(mixed >= 0 && mixed <= rail && before >= 0, "{law:?}: {mixed}");
            let after = rig.frames(0.1, 1500);
            worst = worst.max((after.force_n - expected.force_n).abs() / rig.force_step_n());
            frames += 1;
        }
    }
    Outcome::default().at_most("force at rest", worst, 2.0, "steps of its word").holds(frames)
}
