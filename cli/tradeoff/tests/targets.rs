// SPDX-License-Identifier: MIT OR Apache-2.0
//! Targets that a random profile meets, and targets that none does.
//!
//! `TARGETS=20 RIVALS=4000 cargo test --release -p hapticore-tradeoff --test targets -- --nocapture` draws more.

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
use rayon::prelude::*;

const SCENES: [&str; 2] = ["fig3", "hockey"];
/// Of few slots one random profile in thousands is lucky.
const SLOTS: usize = 48;

/// How much more than a random profile's errors is asked for.
const SLACK: f64 = 1.02;

/// By how much more than what is found no other profile may save.
const CHEAPER: f64 = 0.98;

/// A number that the environment may have.
fn given(name: &str, otherwise: usize) -> usize {
    std::env::var(name).map_or(otherwise, |text| text.parse().expect("a number"))
}

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
    let count = given("TARGETS", 2);
    let mut random = fastrand::Rng::with_seed(49);
    let (mut met, mut larger) = (0, Vec::new());
    for _ in 0..count {
        let known = shorter(&mut random);
        let errors = swept().trial.judge(&known).expect("judged").errors;
        let asked = 1 << random.usize(0..3) | random.usize(0..8);
        let of = |n: usize| (asked >> n & 1 == 1).then(|| SLACK * errors[n].rms);
        let found = found(&Target([0, 1, 2].map(of)));
        let known = cost(&known).expect("a core").luts;
        println!("{}\n{:.0} LUT4, {known:.0} of a random profile\n", found.text(), found.cost.luts);
        met += usize::from(found.holds());
        if found.holds() && found.cost.luts > SLACK * known {
            larger.push(format!(
                "{:.3} of a random profile\n{}",
                found.cost.luts / known,
                found.text()
            ));
        }
        assert!(found.cost.luts <= found.before.luts || found.holds(), "{}", found.text());
    }
    println!("{met} of {count} met, {} larger than a random profile", larger.len());
    assert!(larger.is_empty(), "{}", larger.join("\n"));
    assert!(10 * met >= 9 * count, "{met} of {count} met");
}

/// A profile with words at random: about the start, or within two bits of one that was found.
fn rival(random: &mut fastrand::Rng, found: &Profile) -> Profile {
    let near = random.bool();
    let profile = if near { found } else { swept().trial.profile() }.clone();
    let blocks = Knob::other_blocks(&profile).filter(|_| random.u8(0..4) == 0).last();
    let by = if near { -2..=1 } else { -8..=0 };
    Knob::searched().fold(blocks.unwrap_or(profile), |profile, knob| {
        let bits = knob.value(&profile).saturating_add_signed(random.i64(by.clone()));
        knob.set(&profile, bits).unwrap_or(profile)
    })
}

#[test]
fn no_random_profile_that_meets_a_target_is_much_cheaper_than_what_is_found() {
    let mut random = fastrand::Rng::with_seed(7);
    for target in ["force=1mN,position=0.1mm", "capacitance=0.002%,position=0.03mm"] {
        let target: Target = target.parse().expect("a target");
        let found = found(&target);
        assert!(found.holds(), "{}", found.text());
        let rivals: Vec<_> =
            (0..given("RIVALS", 40)).map(|_| rival(&mut random, &found.profile)).collect();
        let holds = |rival: &Profile| {
            let errors = swept().trial.judge(rival).expect("judged").errors;
            (0..3).all(|n| target.0[n].is_none_or(|most| errors[n].rms <= most))
        };
        let cheaper = rivals.par_iter().filter_map(|rival| {
            let luts = cost(rival).expect("a core").luts / found.cost.luts;
            (luts < 1.0).then(|| (luts, luts < CHEAPER && holds(rival)))
        });
        let cheaper: Vec<(f64, bool)> = cheaper.collect();
        let least = cheaper.iter().filter(|(_, holds)| *holds).map(|(luts, _)| *luts);
        let least = least.fold(1.0, f64::min);
        println!(
            "{}\n{} of {} random profiles smaller, the smallest that holds {least:.3} of it\n",
            found.text(),
            cheaper.len(),
            rivals.len()
        );
        assert!(least >= CHEAPER, "{least}");
    }
}

#[test]
fn of_targets_that_nothing_meets_the_reason_is_given_and_nothing_larger() {
    let targets = [
        [Some(1e-6), None, Some(1e-3)],
        [Some(1e-5), None, None],
        [None, Some(1e-6), None],
        [None, None, Some(0.01)],
        [Some(1e-4), Some(1e-5), Some(0.1)],
    ];
    for target in targets {
        let found = found(&Target(target));
        let text = found.text();
        assert!(!found.holds(), "{text}");
        assert!(found.cost.luts <= found.before.luts, "{text}");
        assert!(text.contains("no word length meets the target"), "{text}");
        assert!(text.contains("nothing that was tried"), "{text}");
    }
}

#[test]
fn a_finer_adc_is_never_found() {
    let position_um = swept().points[0].measured[2].rms;
    let found = found(&Target([None, None, Some(0.9 * position_um)]));
    let adc = |profile: &Profile| Knob::Adc.value(profile);
    assert!(adc(&found.profile) <= adc(swept().trial.profile()), "{}", found.text());
}
