// SPDX-License-Identifier: MIT OR Apache-2.0
//! A wall that holds a hand: scene `fig15`, rule A with split drive, profile `fast`, fidelity `fixed`.

use hapticore_contract::control::Drive;
use hapticore_model::fidelity::force_loop::FixedLoop;
use hapticore_run::case::Case;
use hapticore_run::inputs;
use hapticore_run::maker::Maker;
use hapticore_scene::{Scene, Truth, gallery};

use crate::stability::Outcome;

/// When the lines fail, and come back: the hand rests 1.28 mm within the wall until 0.95 s.
const LOST_S: [f64; 2] = [0.85, 0.88];

/// A drive word of the pad, and what was true in its slot.
struct Driven {
    truth: Truth,
    drive: Drive,
}

/// The drive words of the scene; slots within [`LOST_S`] reach the core as zeros.
fn run(scene: &Scene) -> (Vec<Driven>, u64) {
    let profile = inputs::profile("fast").expect("bundled");
    let profile = inputs::windowed(profile, scene).expect("a window");
    let case = Case::new(scene, 0, &profile, &[]).expect("a case");
    let plant = case.plant().expect("a plant");
    let tuning = case.tuning(&plant).expect("gains that fit").expect("a controller");
    let calibration = case.calibration().expect("a calibration");
    let mut core = FixedLoop::new(&case.profile, calibration, &tuning).expect("a force loop");
    let maker = Maker::new(plant, &case.profile, true, false);
    let mut plant = case.loop_plant(maker).expect("a loop");
    let mut driven = Vec::new();
    for number in 0..case.slots {
        let made = plant.slot(number);
        core.set_target(made.slot.pad, made.target_n);
        if let Some(surface_mm) = made.surface_mm {
            core.set_surface(made.slot.pad, surface_mm);
        }
        let zeros = vec![0; made.slot.window().len()];
        let is_lost = (LOST_S[0]..LOST_S[1]).contains(&made.truth.time_s);
        let codes = if is_lost { &zeros[..] } else { made.slot.window() };
        let (_, drive) = core.slot(|core| core.slot(made.slot.pad, codes));
        plant.drive(&made, drive).expect("a drive that the plant takes");
        driven.extend(drive.map(|drive| Driven { truth: made.truth.clone(), drive }));
    }
    (driven, case.profile.control.as_ref().expect("a controller").invalid_frames)
}

/// The sensor's lines fail while a hand rests in the wall.
pub fn sensor_invalid_in_mid_wall() -> Outcome {
    let toml = gallery::find("fig15").expect("bundled");
    let scene = Scene::parse(toml, "fig15.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    let (driven, most) = run(&scene);
    let first = driven
        .iter()
        .position(|driven| driven.truth.time_s >= LOST_S[0])
        .expect("a frame without lines");
    let before = &driven[first - 1];
    let (held, held_n) = (before.drive.fraction, before.truth.force_n);
    assert!(held > 0.1 && held_n > 0.5, "the wall holds: {held}, {held_n} N");
    for (frame, now) in (1..).zip(&driven[first..]) {
        let expected = if frame < most { held } else { 0.0 };
        assert_eq!(now.drive.fraction, expected, "frame {frame}");
        assert_eq!(now.drive.faults.sensor, frame >= most, "frame {frame}");
    }
    let gone = driven[first..].iter().find(|driven| driven.truth.force_n < 0.01);
    let gone_ms = gone.map_or(f64::INFINITY, |gone| 1e3 * (gone.truth.time_s - LOST_S[0]));
    Outcome::new(format!(
        "the wall of {held_n:.2} N is held for {} frames, then lets go, and stays away until the fault is cleared",
        most - 1
    ))
    .at_most("until nothing holds the hand", gone_ms, 20.0, "ms")
    .equal((driven.len() - first) as u64)
}
