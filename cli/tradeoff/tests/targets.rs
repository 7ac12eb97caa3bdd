// SPDX-License-Identifier: MIT OR Apache-2.0
//! Targets that a random profile meets, and targets that none does.
//!
//! `TARGETS=20 cargo test --release -p hapticore-tradeoff --test targets -- --nocapture` draws more.

use std::sync::OnceLock;

use hapticore_contract::profile::Profile;
use hapticore_run::inputs;
use hapticore_synth::target::Family;
use hapticore_tradeoff::cost::cost;
use hapticore_tradeoff::knobs::Knob;
use hapticore_tradeoff::model::Model;
use hapticore_tradeoff::search::{Found, models, search};
use hapticore_tradeoff::sweep::{Point, Trial};
use hapticore_tradeoff::target::Target;

const SCENES: [&str; 2] = ["fig3", "hockey"];
const SLOTS: usize = 8;

/// How much more than a random profile's errors is asked for.
const SLACK: f64 = 1.02;

/// A sweep about `standard`.
struct Swept {
    trial: Trial,
    points: Vec<Point>,
    models: Vec<Model>,
}

fn swept() -> &'static Swept {
    static SWEPT: OnceLock<Swept> = OnceLock::new();
    SWEPT.get_or_init(|| {
        let profile = Profile::bundled("standard").expect("bundled");
        let scenes = SCENES.map(|name| inputs::scene(name, &[]).expect("bundled"));
        let trial = Trial::new(scenes.into(), profile.clone(), SLOTS);
        let mut plan = trial.plan();
        plan.retain(|(knob, of)| {
            knob.is_none_or(|knob| knob.value(of) + 2 == knob.value(&profile))
        });
        let points = trial.run(&plan, &|| ()).expect("a sweep");
        let models = models(&trial, Family::Ecp5, &points).expect("models");
        Swept { trial, points, models }
    })
}

fn found(target: &Target) -> Found {
    let Swept { trial, points, models } = swept();
    search(trial, points, models, target).expect("a search")
}

/// The profile with words up to five bits shorter.
fn shorter(random: &mut fastrand::Rng) -> Profile {
    let profile = swept().trial.profile().clone();
    // A word that must not be longer than another's keeps its length.
    Knob::searched().fold(profile, |profile, knob| {
        let bits = knob.value(&profile) - random.u64(0..6);
        knob.set(&profile, bits).unwrap_or(profile)
    })
}

#[test]
fn what_a_random_profile_meets_is_met_on_unseen_slots_and_no_larger() {
    let count = std::env::var("TARGETS").map_or(2, |text| text.parse().expect("a number"));
    let mut random = fastrand::Rng::with_seed(49);
    let mut met = 0;
    for _ in 0..count {
        let known = shorter(&mut random);
        let errors = swept().trial.judge(&known).expect("judged").errors;
        let asked = 1 << random.usize(0..3) | random.usize(0..8);
        let of = |n: usize| (asked >> n & 1 == 1).then(|| SLACK * errors[n].rms);
        let found = found(&Target([0, 1, 2].map(of)));
        let known = cost(&known).expect("a core").luts;
        println!("{}\n{:.0} LUT4, {known:.0} of a random profile\n", found.text(), found.cost.luts);
        met += usize::from(found.holds());
        assert!(!found.holds() || found.cost.luts <= SLACK * known, "{}", found.text());
    }
    assert!(10 * met >= 9 * count, "{met} of {count} met");
}

#[test]
fn of_a_target_that_nothing_meets_the_reason_is_given_and_nothing_larger() {
    let found = found(&Target([Some(1e-6), None, Some(1e-3)]));
    let text = found.text();
    assert!(!found.holds(), "{text}");
    assert!(found.cost.luts <= found.before.luts, "{text}");
    assert!(text.contains("no word length meets the target"), "{text}");
    assert!(text.contains("nothing that was tried"), "{text}");
}

#[test]
fn a_finer_adc_is_never_found() {
    let position_um = swept().points[0].measured[2].rms;
    let found = found(&Target([None, None, Some(0.9 * position_um)]));
    let adc = |profile: &Profile| Knob::Adc.value(profile);
    assert!(adc(&found.profile) <= adc(swept().trial.profile()), "{}", found.text());
}
