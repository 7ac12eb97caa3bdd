// SPDX-License-Identifier: MIT OR Apache-2.0
//! The whole loop around a simulated device: scene `fig9`, profile `standard`, fidelity `fixed`.
//!
//! The core is calibrated and tuned to the scene's own device; the plant may be another.

use hapticore_contract::control::Drive;
use rayon::prelude::*;

use super::scenes;
use crate::stability::Outcome;
use crate::tracking::{LAWS, TARGETS, follow, overshoot_n};

/// A case with a closed loop: 0.3 N from 50 to 350 ms.
const CASE: &str = "square 0.3 N, closed loop";

/// Steps of the drive's word.
const DRIVE_STEPS: f64 = 131_072.0;

/// Laws that feed back, as [`LAWS`] numbers them, with short names.
const CLOSED: [(usize, &str); 2] = [(4, "integral"), (6, "inverse")];

/// A slot of a loop.
#[derive(Clone, Copy, Debug)]
struct Slot {
    force_n: f64,
    /// The drive word behind it.
    drive: Drive,
}

type Setting = (&'static str, &'static str);

fn settings(law: usize, of: &[Setting]) -> Vec<(String, String)> {
    let quoted = |value: &str| match value.parse::<f64>() {
        Ok(_) => value.to_string(),
        Err(_) => format!("\"{value}\""),
    };
    let law = LAWS[law].set.iter().map(|(key, value)| (format!("control.{key}"), quoted(value)));
    let others = of.iter().map(|(key, value)| (key.to_string(), quoted(value)));
    let fixed = [("supply", "false"), ("control.force", "\"eq8\""), ("sensor.noise_ppm_rms", "0")];
    fixed
        .map(|(key, value)| (key.to_string(), value.to_string()))
        .into_iter()
        .chain(law)
        .chain(others)
        .collect()
}

/// The slots of a law around a plant with these settings; `invalid` slots reach the core as zeros.
fn run(law: usize, plant: &[Setting], invalid: impl Fn(usize) -> bool) -> Vec<Slot> {
    let [nominal, other] = [&[], plant].map(|set| scenes::scene("fig9", &settings(law, set)));
    let [tuned, driven] = [&nominal, &other].map(|scene| scenes::case(scene, CASE, "standard"));
    let slots = scenes::run(&tuned, &driven, |number, _| invalid(number)).into_iter();
    slots
        .map(|slot| Slot { force_n: slot.truth.force_n, drive: slot.drive.expect("a drive word") })
        .collect()
}

/// Drive words' spread, and mean of the true force, over the last 50 ms of the target.
fn at_rest(slots: &[Slot]) -> (f64, f64) {
    let last = &slots[295..345];
    let words = || last.iter().map(|slot| DRIVE_STEPS * slot.drive.fraction);
    let spread = words().fold(0.0, f64::max) - words().fold(f64::INFINITY, f64::min);
    (spread, last.iter().map(|slot| slot.force_n).sum::<f64>() / last.len() as f64)
}

/// The plant differs from the plant that the loop was tuned for.
pub fn plant_half_off() -> Outcome {
    const PLANTS: [(&str, Setting); 8] = [
        ("friction +50 %", ("device.mu", "0.18")),
        ("friction −50 %", ("device.mu", "0.06")),
        ("spring +50 %", ("gap.spring_pa_per_m", "6.75e7")),
        ("spring −50 %", ("gap.spring_pa_per_m", "2.25e7")),
        ("insulator +50 %", ("gap.insulator_um", "24")),
        ("insulator −50 %", ("gap.insulator_um", "8")),
        ("load +50 %", ("pad.0.load_g", "75")),
        ("load −50 %", ("pad.0.load_g", "25")),
    ];
    let all: Vec<_> = CLOSED.iter().flat_map(|law| PLANTS.map(|plant| (*law, plant))).collect();
    let found: Vec<_> = all
        .par_iter()
        .map(|((law, _), (_, plant))| at_rest(&run(*law, &[*plant], |_| false)))
        .collect();
    let mut outcome = Outcome::default();
    let mut errors = Vec::new();
    for (law, name) in CLOSED {
        let of_law = || all.iter().zip(&found).filter(|(((of, _), _), _)| *of == law);
        let spread = of_law().map(|(_, (spread, _))| *spread).fold(0.0, f64::max);
        let texts: Vec<_> = of_law()
            .map(|((_, (plant, _)), (_, force_n))| {
                format!("{plant} {:+.1}", 100.0 * (force_n / 0.3 - 1.0))
            })
            .collect();
        errors.push(format!("{name}: {}", texts.join(", ")));
        outcome = outcome.at_most(format!("drive at rest, law {name}"), spread, 200.0, "LSB");
    }
    outcome.about = format!("true force off 0.3 N, %: {}", errors.join("; "));
    outcome
}

/// Through the pull-in, up and down.
pub fn pull_in_under_control() -> Outcome {
    let targets = [TARGETS[0], TARGETS[1]];
    let [closed, open] = [6, 0].map(|law| {
        let over = targets.par_iter().map(|target| overshoot_n(&follow(&LAWS[law], target, 50.0)));
        1e3 * over.reduce(|| 0.0, f64::max)
    });
    Outcome::of("overshoot of the true force")
        .at_most("law inverse with force table", closed, 50.0, "mN")
        .rivals(format!("open loop (eq. 9): {open:.0} mN"))
}

/// The sensor's line fails while a force is asked for.
pub fn line_lost_under_load() -> Outcome {
    let mut frames = 0;
    for (law, name) in CLOSED {
        let slots = run(law, &[], |slot| (200..230).contains(&slot));
        let held = slots[199].drive.fraction;
        assert!(held > 0.1, "{name}: {held}");
        for (n, slot) in slots.iter().enumerate().skip(200) {
            let expected = if n < 207 { held } else { 0.0 };
            assert_eq!(slot.drive.fraction, expected, "{name}, slot {n}");
            frames += 1;
        }
        assert!(slots[340].drive.faults.sensor && slots[340].force_n < 1e-3, "{name}");
    }
    Outcome::default().equal(frames)
}
