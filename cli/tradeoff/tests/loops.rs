// SPDX-License-Identifier: MIT OR Apache-2.0
//! What words change of force loops and of split pads.

use hapticore_contract::profile::Profile;
use hapticore_run::engine::Fidelity;
use hapticore_run::inputs;
use hapticore_scene::Scene;
use hapticore_tradeoff::knobs::Knob;
use hapticore_tradeoff::loops::{LoopBench, LoopErrors, case_of, controlled, is_loop};
use hapticore_tradeoff::points::unrounded;
use std::sync::Arc;

/// A scene whose sensors round nothing, and `standard` with the controller that it needs.
fn scene(name: &str) -> (Arc<Scene>, Profile) {
    let rounded = inputs::scene(name, &[]).expect("bundled");
    let mut finer = unrounded(&rounded.cases[case_of(&rounded)]).expect("a document");
    if rounded.cases[case_of(&rounded)].control.is_some() {
        // At its limit a drive is a word of the curve, whatever the others are; a trim takes their errors away.
        finer.push(("control.curve_factor".into(), "1.5".into()));
        finer.push(("control.trim_s".into(), "0".into()));
    }
    let scene = inputs::scene(name, &finer).expect("bundled");
    let profile = Profile::bundled("standard").expect("bundled");
    let profile = controlled(profile, [&scene.cases[case_of(&scene)]]);
    (Arc::new(scene), profile)
}

fn bench(scene: &Arc<Scene>, words: &Profile, profile: &Profile, slots: usize) -> LoopBench {
    LoopBench::new((scene, case_of(scene)), words, profile, slots).expect("a case")
}

fn errors(bench: &LoopBench, profile: &Profile) -> LoopErrors {
    bench.errors(&bench.run(profile, Fidelity::Fixed).expect("a core"))
}

fn turned(profile: &Profile, knob: Knob, bits: u64) -> Profile {
    knob.set(profile, bits).expect("a core")
}

/// The square of 0.3 N is on from 0.05 s on: 50 of the slots.
#[test]
fn a_bit_of_the_drive_word_halves_the_errors_of_drive_and_force() {
    let (scene, profile) = scene("fig9");
    assert!(is_loop(&scene.cases[case_of(&scene)]));
    assert_eq!(scene.cases[case_of(&scene)].name, "square 0.3 N, closed loop");
    let bench = bench(&scene, &profile, &profile, 160);
    let of = |bits| errors(&bench, &turned(&profile, Knob::Drive, bits));
    let (coarse, fine, whole) = (of(11), of(13), errors(&bench, &profile));
    let ratio = |a: &LoopErrors, b: &LoopErrors| {
        let rms = |of: &LoopErrors| [of.drive, of.force].map(|error| error.expect("a loop").rms);
        let (a, b) = (rms(a), rms(b));
        [a[0] / b[0], a[1] / b[1]]
    };
    let two_bits = ratio(&coarse, &fine);
    assert!(two_bits.iter().all(|by| (3.0..5.5).contains(by)), "{two_bits:?}");
    // Words of constants, which are off by 2.4e-5 together at most (full drive 1.4e-5, two gains 5e-6 each), move all drives
    // alike: that is the mean of the error, of some 275 V.
    assert!(whole.drive.expect("a loop").mean.abs() < 2.4e-5 * 275.0, "{whole:?}");
    let spread = |of: &LoopErrors| {
        let of = [of.drive, of.force].map(|error| error.expect("a loop"));
        of.map(|error| (error.rms * error.rms - error.mean * error.mean).sqrt())
    };
    let by = [0, 1].map(|n| spread(&coarse)[n] / spread(&whole)[n]);
    assert!(by.iter().all(|by| *by > 20.0), "{coarse:?}, {whole:?}");
    assert!(ratio(&whole, &LoopErrors::pooled(&[whole])) == [1.0; 2]);
    assert_eq!(coarse.direction, None, "whole pads");
    // What the scene asks for is missed by far more, by the gap's own time.
    let truth = bench.errors_of_truth(&bench.run(&profile, Fidelity::Fixed).expect("a core"));
    assert!(truth.force.expect("a target").rms > 100.0 * whole.force.expect("a loop").rms);
}

#[test]
fn short_words_of_the_currents_show_in_the_direction() {
    let (scene, profile) = scene("fig13");
    let bench = bench(&scene, &profile, &profile, 60);
    let direction = |profile: &Profile| {
        let of = errors(&bench, profile);
        assert_eq!((of.drive, of.force), (None, None), "nothing drives the pad");
        of.direction.expect("halves").rms
    };
    let (short, whole) = (direction(&turned(&profile, Knob::Words, 18)), direction(&profile));
    assert!(short > 5.0 * whole && whole > 0.0, "{short}, {whole}");
}

#[test]
fn the_ideal_core_does_not_depend_on_which_profile_is_the_first() {
    let (scene, profile) = scene("fig9");
    for (knob, bits) in [(Knob::Oscillator, 14), (Knob::Table, 15), (Knob::Drive, 12)] {
        let other = turned(&profile, knob, bits);
        let [first, second] = [&profile, &other].map(|of| bench(&scene, &profile, of, 70));
        assert!(first.suits(&other) && second.suits(&profile), "{}", knob.key());
        let drive = errors(&first, &other).drive.expect("a loop");
        assert_eq!(errors(&second, &other).drive, Some(drive), "{}", knob.key());
        assert!(drive.rms > 0.0);
    }
    // The scene asks for its own slot; the carrier's window is the profile's.
    let mut rectangular = profile.clone();
    rectangular.carrier.window = hapticore_contract::profile::Window::Rectangular;
    assert!(!bench(&scene, &profile, &profile, 1).suits(&rectangular));
}

#[test]
fn a_profile_keeps_its_controller_and_gets_one_where_a_case_needs_it() {
    let (scene, with) = scene("fig9");
    let plain = Profile::bundled("standard").expect("bundled");
    assert_eq!(controlled(plain.clone(), []), plain);
    let own = turned(&with, Knob::Drive, 12);
    assert_eq!(controlled(own.clone(), &scene.cases), own);
    assert_eq!(Knob::Drive.set(&plain, 12), None, "there is no controller");
    assert_eq!(Knob::Gain.value(&plain), 0);
}
