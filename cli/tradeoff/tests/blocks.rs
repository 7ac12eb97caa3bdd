// SPDX-License-Identifier: MIT OR Apache-2.0
//! What block-floating words do for `small`, whose currents are a small part of full scale, is seen in the
//! prediction of the same profile without them.

use hapticore_contract::profile::Profile;
use hapticore_run::inputs;
use hapticore_tradeoff::knobs::Knob;
use hapticore_tradeoff::sweep::Trial;

/// Slots of the scene.
const SLOTS: usize = 24;

fn small() -> Profile {
    Profile::bundled("small").expect("bundled")
}

/// `small` with words that all have one point.
fn without_blocks() -> Profile {
    let profile = Knob::BlockShift.set(&small(), 0).expect("a core");
    Profile { name: "small-one-point".into(), ..profile }
}

fn trial(profile: &Profile) -> Trial {
    let scene = inputs::scene("hockey", &[]).expect("bundled");
    Trial::new(vec![scene], profile.clone(), SLOTS)
}

#[test]
fn the_words_of_small_currents_are_the_largest_source_without_blocks() {
    for (profile, is_largest) in [(without_blocks(), true), (small(), false)] {
        let point =
            trial(&profile).run(&[(None, profile.clone())], &|| ()).expect("a run").remove(0);
        let position = &point.sources[2];
        let (largest, rms) = position.iter().max_by(|a, b| a.1.total_cmp(b.1)).expect("a source");
        println!("{}: {largest} adds {rms:.1} of {:.1} µm", profile.name, point.predicted[2].rms);
        assert_eq!(largest.contains("currents"), is_largest, "{}: {position:?}", profile.name);
    }
}
