// SPDX-License-Identifier: MIT OR Apache-2.0
//! A wall that holds a hand: scene `fig15`, rule A with split drive, profile `fast`, fidelity `fixed`.

use hapticore_contract::control::Drive;
use hapticore_scene::Truth;

use super::scenes;
use crate::stability::Outcome;

/// When the lines fail, and come back: the hand stays 1.28 mm within the wall until 0.95 s.
const LOST_S: [f64; 2] = [0.85, 0.88];

/// A drive word of the pad, and what was true in its slot.
struct Driven {
    truth: Truth,
    drive: Drive,
}

/// The drive words of the scene; slots within [`LOST_S`] reach the core as zeros. And how many invalid
/// frames are a fault.
fn run() -> (Vec<Driven>, u64) {
    let scene = scenes::scene("fig15", &[]);
    let case = scenes::case(&scene, "rule A, split drive", "fast");
    let lost_s = LOST_S[0]..LOST_S[1];
    let slots = scenes::run(&case, &case, |_, truth| lost_s.contains(&truth.time_s));
    let driven = slots.into_iter().filter_map(|slot| Some((slot.truth, slot.drive?)));
    let most = case.profile.control.as_ref().expect("a controller").invalid_frames;
    (driven.map(|(truth, drive)| Driven { truth, drive }).collect(), most)
}

/// The sensor's lines fail while a hand stays in the wall.
pub fn sensor_invalid_in_mid_wall() -> Outcome {
    let (driven, most) = run();
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
    Outcome::of(format!("force of the wall before: {held_n:.2} N"))
        .at_most("until nothing holds the hand", gone_ms, 20.0, "ms")
        .equal((driven.len() - first) as u64)
}
