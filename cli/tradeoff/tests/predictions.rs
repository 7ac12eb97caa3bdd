// SPDX-License-Identifier: MIT OR Apache-2.0
//! Predicted errors of random profiles beside those measured, on bundled scenes and on a stranger's device.
//!
//! `PROFILES=100 SEED=2 cargo test --release -p hapticore-tradeoff --test predictions -- --nocapture` draws more, and
//! others.

use hapticore_contract::profile::{Method, Profile};
use hapticore_run::engine::Fidelity;
use hapticore_run::inputs;
use hapticore_scene::Scene;
use hapticore_tradeoff::bench::Bench;
use hapticore_tradeoff::errors::{Errors, Quantity, errors, results};
use hapticore_tradeoff::forecast::{Forecast, forecast, mean};
use hapticore_tradeoff::knobs::Knob;
use hapticore_tradeoff::points::{Which, unrounded};
use rayon::prelude::*;
use std::sync::Arc;

/// Another sheet, other terminals, another insulation and pad than the paper's.
const STRANGER: &str = r#"
title = "a stranger's device"
seed = 11
dwell_slots = 1

[device]
width_mm = 520
height_mm = 330
pad_diameter_mm = 44
mu = 0.3

[[pad]]
name = "pad"
position_mm = { raster = { nx = 13, ny = 9, margin_mm = 30 } }
load_g = 35
haptic_v_rms = { sweep = [60, 120, 180] }

[sheet]
rung = "bicubic"
ohm_per_square = 320
terminal_ohm = 220

[gap]
rung = "static"
insulator_permittivity = 4.4

[friction]
rung = "coulomb"

[carrier]
rung = "samples"

[sensor]
haptic_full_scale_v = 400
noise_ppm_rms = 25
quantisation_bits = 16
"#;

/// Slots of each scene that are measured; of these the command's number is predicted.
const SLOTS: usize = 192;
/// How far the median of predicted over measured may be off one, and the largest without a mark.
const MEDIAN: f64 = 0.05;
const MOST: f64 = 1.5;

fn given(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).map_or(otherwise, |text| text.parse().expect("a number"))
}

/// A scene whose sensors leave the rounding to the core's ADC.
fn finer(parse: impl Fn(&[(String, String)]) -> Scene) -> Arc<Scene> {
    let rounded = parse(&[]);
    Arc::new(parse(&unrounded(&rounded.cases[0]).expect("a document")))
}

fn scenes() -> Vec<Arc<Scene>> {
    let bundled = |name| finer(|set| inputs::scene(name, set).expect("bundled"));
    let stranger = finer(|set| Scene::parse(STRANGER, "stranger.toml", set).expect("a scene"));
    ["fig3", "fig6", "hockey"].map(bundled).into_iter().chain([stranger]).collect()
}

/// A bundled profile with every knob turned, as far as a core can be built.
fn random_profile(random: &mut fastrand::Rng) -> Profile {
    let bundled = Profile::of_distinct_words();
    let mut profile = bundled[random.usize(..bundled.len())].clone();
    if random.bool() {
        let shift = random.u64(0..13);
        profile = Knob::BlockShift.set(&profile, shift).unwrap_or(profile);
    }
    for knob in Knob::words() {
        let [least, most] = match knob {
            Knob::Adc | Knob::Oscillator => [-6, 1],
            Knob::Table | Knob::Force => [-2, 2],
            _ => [-5, 2],
        };
        let bits = knob.value(&profile).saturating_add_signed(random.i64(least..=most));
        profile = knob.set(&profile, bits).unwrap_or(profile);
    }
    if random.bool() {
        let window = Knob::Window.value(&profile) * random.u64(1..9) / 4;
        profile = Knob::Window.set(&profile, window / 20 * 20).unwrap_or(profile);
    }
    if profile.carrier.method == Method::Products && random.bool() {
        let mut turned = profile.clone();
        turned.carrier.periods = turned.carrier.periods.saturating_add_signed(random.i64(-4..5));
        if hapticore_model::check(&turned).is_ok() {
            profile = turned;
        }
    }
    profile
}

/// A profile on a scene, or on all.
struct Row {
    what: String,
    forecast: Forecast,
    measured: Errors,
}

impl Row {
    fn new(profile: &Profile, benches: &[Bench]) -> Self {
        let measured = |bench: &Bench| {
            let (served, slots) = (bench.serve(profile).expect("a calibration"), bench.slots());
            let found = results(Fidelity::Fixed, &served, bench.calibration(), slots);
            errors(&found.values, slots.iter().map(|slot| &slot.ideal))
        };
        let bits: Vec<_> = Knob::ALL.iter().map(|knob| knob.value(profile)).collect();
        let names: Vec<_> = benches.iter().map(Bench::scene).collect();
        Row {
            what: format!("{} on {}, {bits:?}", profile.name, names.join(", ")),
            measured: mean(&benches.iter().map(measured).collect::<Vec<_>>()),
            forecast: forecast(profile, benches).expect("a core"),
        }
    }

    /// A row of each scene, then that of all, as the command has it.
    fn of_scenes(profile: &Profile, scenes: &[Arc<Scene>]) -> (Vec<Row>, Row) {
        let bench = |scene| Bench::new((scene, 0), profile, Which::Every(SLOTS), true);
        let benches: Vec<Bench> =
            scenes.iter().map(|scene| bench(scene).expect("a case")).collect();
        let of_each = benches.chunks(1).map(|bench| Row::new(profile, bench));
        (of_each.collect(), Row::new(profile, &benches))
    }

    /// Predicted over measured.
    fn ratio(&self, quantity: usize) -> f64 {
        self.forecast.predicted[quantity].rms / self.measured[quantity].rms
    }

    fn is_marked(&self, quantity: usize) -> bool {
        self.forecast.is_of_one[quantity]
    }

    /// Bound over the largest that was measured.
    fn bound(&self, quantity: usize) -> f64 {
        self.forecast.predicted[quantity].largest / self.measured[quantity].largest
    }
}

/// The ratios of rows without a mark, and how many have one.
struct Agreement {
    rms: Vec<f64>,
    bounds: Vec<f64>,
    marked: f64,
}

impl Agreement {
    fn of(rows: &[&Row], quantity: usize) -> Self {
        let open: Vec<_> = rows.iter().filter(|row| !row.is_marked(quantity)).collect();
        let sorted = |ratio: fn(&Row, usize) -> f64| {
            let mut ratios: Vec<f64> = open.iter().map(|row| ratio(row, quantity)).collect();
            ratios.sort_by(f64::total_cmp);
            ratios
        };
        let marked = (rows.len() - open.len()) as f64 / rows.len() as f64;
        Agreement { rms: sorted(Row::ratio), bounds: sorted(Row::bound), marked }
    }

    fn text(&self) -> String {
        let parts = [0.0, 0.05, 0.5, 0.95, 1.0];
        format!(
            "predicted over measured {:.3?}; bound over largest {:.2?}; marked {:.1} %",
            parts.map(|part| at(&self.rms, part)),
            parts.map(|part| at(&self.bounds, part)),
            100.0 * self.marked
        )
    }
}

/// What this part of the ratios is below.
fn at(ratios: &[f64], part: f64) -> f64 {
    ratios[((ratios.len() - 1) as f64 * part).round() as usize]
}

#[test]
fn predicted_errors_of_random_profiles_are_those_measured_on_any_device() {
    let (count, mut random) = (given("PROFILES", 6), fastrand::Rng::with_seed(given("SEED", 1)));
    let scenes = scenes();
    let profiles: Vec<Profile> = (0..count).map(|_| random_profile(&mut random)).collect();
    let rows = profiles.par_iter().map(|profile| Row::of_scenes(profile, &scenes));
    let (of_each, of_all): (Vec<Vec<Row>>, Vec<Row>) = rows.collect::<Vec<_>>().into_iter().unzip();
    let mut misses = Vec::new();
    for (n, quantity) in Quantity::ALL.iter().enumerate() {
        for (k, scene) in scenes.iter().enumerate() {
            let rows: Vec<_> = of_each.iter().map(|rows| &rows[k]).collect();
            println!("{} on {}: {}", quantity.name(), scene.name, Agreement::of(&rows, n).text());
        }
        let rows: Vec<_> = of_all.iter().collect();
        let agreement = Agreement::of(&rows, n);
        println!("{}: {}", quantity.name(), agreement.text());
        for row in rows.iter().filter(|row| !(0.8..1.25).contains(&row.ratio(n))) {
            println!("  {:.3}, marked {}: {}", row.ratio(n), row.is_marked(n), row.what);
        }
        let (rms, bounds) = (&agreement.rms, &agreement.bounds);
        let holds = (at(rms, 0.5) - 1.0).abs() < MEDIAN
            && at(rms, 0.0) > 1.0 / MOST
            && at(rms, 1.0) < MOST
            && at(bounds, 0.0) >= 1.0;
        misses.extend((!holds).then(|| format!("{}: {}", quantity.name(), agreement.text())));
    }
    assert!(misses.is_empty(), "{}", misses.join("\n"));
}
