// SPDX-License-Identifier: MIT OR Apache-2.0
//! The controller's block alone around a plant: rest, rails, faults.

use hapticore_contract::control::Law;

use super::rig::{Given, Rig};
use crate::stability::Outcome;

/// Targets at rest, N.
const TARGETS_N: [f64; 5] = [0.011, 0.051, 0.093, 0.171, 0.244];

/// The words of a loop at rest.
pub fn limit_cycle() -> Outcome {
    let mut outcome = Outcome::new("the drive word at rest, for ever");
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
    Outcome::new("the state after three frames is that after any number").equal(frames)
}

/// Estimates that are invalid for long, once it is at rest.
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
    Outcome::new("held for 7 frames, then zero until the fault is cleared; then as before")
        .equal(frames)
}
