// SPDX-License-Identifier: MIT OR Apache-2.0
//! The search for the cheapest profile, beside exhaustive search, an integer program, and other
//! searches with as many evaluations, on targets drawn at random.
//!
//! `TARGETS=12 EVALUATIONS=3000 cargo test --release -p hapticore-tradeoff --test search -- --nocapture`
//! prints more.

mod rivals;

use hapticore_contract::profile::Profile;
use hapticore_run::inputs;
use hapticore_synth::target::Family;
use hapticore_tradeoff::knobs::Knob;
use hapticore_tradeoff::model::Model;
use hapticore_tradeoff::sweep::Trial;
use rivals::{Limits, annealed, by_tpe, exhaustive, integer_program, min_plus_one};
use std::sync::OnceLock;
use std::time::Instant;

/// A number that the environment may have.
fn given(name: &str, otherwise: usize) -> usize {
    std::env::var(name).map_or(otherwise, |text| text.parse().expect("a number"))
}

/// LUT4 that two sums of the same terms may differ by.
const SAME: f64 = 1e-6;

/// The model of a bundled profile on a few slots of `fig6`.
fn model() -> &'static Model {
    static MODEL: OnceLock<Model> = OnceLock::new();
    MODEL.get_or_init(|| {
        let profile = Profile::bundled("standard").expect("bundled");
        let scene = inputs::scene("fig6", &[]).expect("bundled");
        let trial = Trial::new(vec![scene], profile.clone(), 6);
        let mut plan = trial.plan();
        plan.retain(|(knob, of)| {
            knob.is_none_or(|knob| knob.value(of) + 2 == knob.value(&profile))
        });
        let points = trial.run(&plan, &|| ()).expect("a sweep");
        Model::new(&profile, Family::Ecp5, &points)
    })
}

/// Targets between half and thirty times the profile's own errors; some ask nothing of a quantity.
fn limits(model: &Model, count: usize) -> Vec<Limits> {
    let mut random = fastrand::Rng::with_seed(3);
    let least = model.squares(&model.longest()).map(|square| square.max(0.0).sqrt());
    let mut of =
        |least: f64| (random.u8(0..4) > 0).then(|| least * 10f64.powf(2.0 * random.f64()) * 1.2);
    let drawn = std::iter::repeat_with(|| least.map(&mut of));
    drawn.filter(|limits| limits.iter().any(Option::is_some)).take(count).collect()
}

#[test]
fn nothing_on_a_grid_of_five_words_is_cheaper() {
    let knobs = [Knob::Adc, Knob::Words, Knob::Admittance, Knob::Capacitance, Knob::Force];
    let model = model().only(&knobs);
    assert_eq!(model.ranges().len(), knobs.len());
    let combinations: u64 = model.ranges().iter().map(|[low, high]| high - low + 1).product();
    for limits in limits(&model, 10) {
        let found = model.cheapest(&limits);
        let begun = Instant::now();
        let best = exhaustive(&model, &limits).expect("the longest words hold");
        let rate = combinations as f64 / begun.elapsed().as_secs_f64();
        println!("{combinations} combinations, {:.1} M predicted per second", rate / 1e6);
        let (found, best) = (model.luts(&found), model.luts(&best));
        assert!(found <= best + SAME, "{limits:?}: {found:.1} instead of {best:.1} LUT4");
    }
}

#[test]
fn an_integer_program_and_other_searches_find_little_that_is_cheaper() {
    let (model, evaluations) = (model(), given("EVALUATIONS", 300));
    let mut worst = 0f64;
    println!(
        "LUT4: ours | integer program | min+1 | annealing | TPE, {evaluations} evaluations each"
    );
    for limits in limits(model, given("TARGETS", 3)) {
        let begun = Instant::now();
        let found = model.cheapest(&limits);
        let took = begun.elapsed();
        assert!(model.holds(&found, &limits), "{limits:?}");
        let ours = model.luts(&found);
        let bound = integer_program(model, &limits).expect("solved");
        let others = [
            min_plus_one(model, &limits),
            annealed(model, &limits, evaluations),
            by_tpe(model, &limits, evaluations),
        ];
        let others = others.map(|bits| bits.map_or(f64::NAN, |bits| model.luts(&bits)));
        println!(
            "{ours:.1} ({took:.1?}) | {bound:.1} | {}",
            others.map(|luts| format!("{luts:.1}")).join(" | ")
        );
        worst = worst.max(ours / bound - 1.0);
        for other in others.into_iter().filter(|luts| luts.is_finite()) {
            assert!(ours <= other + SAME, "{limits:?}: {ours} instead of {other} LUT4");
        }
    }
    println!("above the integer program by {:.3} % at most", 100.0 * worst);
    assert!(worst < 0.03, "{worst}");
}
