// SPDX-License-Identifier: MIT OR Apache-2.0
//! What block-floating words do for `small`, whose currents are a small part of full scale, is seen in the
//! prediction of the same profile without them, and a search that begins there finds them.

use hapticore_contract::profile::Profile;
use hapticore_run::inputs;
use hapticore_tradeoff::cost;
use hapticore_tradeoff::errors::Quantity;
use hapticore_tradeoff::knobs::Knob;
use hapticore_tradeoff::model::Model;
use hapticore_tradeoff::search::{models, search};
use hapticore_tradeoff::sweep::Trial;
use hapticore_tradeoff::target::Target;

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

/// On an iCE40, whose adders take LUTs, longer words of one point cost more than moving short words up does.
#[test]
fn a_search_finds_block_floating_words() {
    let profile = without_blocks();
    let trial = trial(&profile);
    let mut plan = trial.plan();
    plan.retain(|(knob, of)| knob.is_none_or(|knob| knob.value(of) + 2 == knob.value(&profile)));
    let swept = trial.run(&plan, &|| ()).expect("a sweep");
    let models = models(&trial, cost::family(&profile), &swept).expect("models");
    for position_um in [150.0, 50.0] {
        let mut target = Target::default();
        target.0[Quantity::Position as usize] = Some(position_um);
        let of = |models: &[Model]| search(&trial, &swept, models, &target).expect("a search");
        let [with, without] = [of(&models), of(&models[..1])];
        println!("{}\nwithout blocks:\n{}\n", with.text(), without.text());
        assert!(with.holds() && without.holds(), "{position_um} µm");
        assert!(Knob::BlockShift.value(&with.profile) > 0, "{position_um} µm");
        assert_eq!(Knob::BlockShift.value(&without.profile), 0);
        assert!(with.cost.luts_ice40 < 0.98 * without.cost.luts_ice40, "{position_um} µm");
    }
}
