// SPDX-License-Identifier: MIT OR Apache-2.0
//! How a force loop follows its target: scene `fig9` with an ideal amplifier at fidelity `fixed` under other laws and
//! loads.

use std::sync::Arc;

use hapticore_run::case::{Case, Settings};
use hapticore_run::control::bode;
use hapticore_run::control::stability::OpenLoop;
use hapticore_run::engine::Fidelity;
use hapticore_run::inputs;
use hapticore_run::record::{Bode, Row, Stability};
use hapticore_scene::{Scene, gallery};
use rayon::prelude::*;

/// The targets of `fig9`, as its cases call them.
pub const TARGETS: [&str; 4] = ["square 0.3 N", "square 0.6 N", "sine 0.3 N", "sine 0.6 N"];

/// A case with a closed loop: its targets do not matter where a force is asked for.
const CLOSED: &str = "square 0.6 N, closed loop";

/// A law with its gains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    /// What the table calls it.
    pub name: &'static str,
    /// Keys and values of `[control]`.
    pub set: &'static [(&'static str, &'static str)],
}

/// The laws, with the gains that the table is of.
pub const LAWS: [Law; 7] = [
    Law { name: "open, K = 600 (eq. 9)", set: &[("law", "open")] },
    Law {
        name: "proportional, K_p = 1000 V/N (Fig. 8b)",
        set: &[("law", "proportional"), ("proportional_v", "1000")],
    },
    Law {
        name: "the same, α = 0.35",
        set: &[("law", "proportional"), ("proportional_v", "1000"), ("filter", "0.35")],
    },
    Law {
        name: "integral, K = 64 V/√N, K_i = 740 kV/(√N·s)",
        set: &[("law", "integral"), ("proportional_v", "64"), ("integral_v", "740000")],
    },
    Law {
        name: "integral, the same, force table",
        set: &[
            ("law", "integral"),
            ("proportional_v", "64"),
            ("integral_v", "740000"),
            ("force", "table"),
        ],
    },
    Law { name: "inverse, no trim", set: &[("law", "inverse"), ("trim_s", "0")] },
    Law {
        name: "inverse, force table",
        set: &[("law", "inverse"), ("force", "table"), ("curve_factor", "1.2")],
    },
];

/// How a core divides its time, in samples of 1 µs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Division {
    /// What the table calls it.
    pub name: &'static str,
    /// Bundled profile.
    pub profile: &'static str,
    /// Pads, the first of which is followed.
    pub pads: usize,
    /// `settle_samples` and `window_samples` of the scene.
    pub samples: [u64; 2],
}

/// That of `fig9`: a pad, slots of 1 ms.
pub const OWN: Division =
    Division { name: "1 pad, 1 ms", profile: "standard", pads: 1, samples: [390, 600] };
/// Four pads in the same time.
pub const FOUR_SHORT: Division =
    Division { name: "4 pads, 250 µs", profile: "fast", pads: 4, samples: [112, 128] };
/// As short as slots are.
pub const SHORT: Division = Division { name: "1 pad, 250 µs", pads: 1, ..FOUR_SHORT };

/// A slot of a loop.
#[derive(Clone, Copy, Debug)]
pub struct Followed {
    /// Middle of the slot's window, s.
    pub time_s: f64,
    /// Target in the slot, N.
    pub target_n: f64,
    /// Target that the drive of the slot was made for: that of the slot before, N.
    pub asked_n: f64,
    /// True force, N.
    pub force_n: f64,
}

/// The slots of a law that follows a target, the pad under `load_g` grams.
///
/// # Panics
/// Where the scene has no such case.
pub fn follow(law: &Law, target: &str, load_g: f64) -> Vec<Followed> {
    follow_in(&OWN, law, target, load_g)
}

/// The first pad's slots of a law that follows a target, all pads under `load_g` grams.
///
/// # Panics
/// Where the scene has no such case.
pub fn follow_in(division: &Division, law: &Law, target: &str, load_g: f64) -> Vec<Followed> {
    let open = law.set.contains(&("law", "open"));
    let name = format!("{target}, {} loop", if open { "open" } else { "closed" });
    let scene = scene(division, law.set, load_g);
    slots(&case(division, &scene, &name))
}

/// The first pad's slots.
fn slots(case: &Case) -> Vec<Followed> {
    let outcome = case.run(&FIXED, None, &|| ()).expect("a run");
    let rows: Vec<_> = outcome.rows.iter().filter(|row| row.pad == 0).collect();
    let asked = std::iter::once(0.0).chain(rows.iter().map(|row| asked_n(row)));
    rows.iter().zip(asked).map(|(row, asked_n)| followed(row, asked_n)).collect()
}

const FIXED: Settings = Settings { fidelity: Fidelity::Fixed, errors: false };

fn case(division: &Division, scene: &Arc<Scene>, name: &str) -> Case {
    let index = scene.cases.iter().position(|found| found.name == name).expect("a case");
    let profile = inputs::profile(division.profile).expect("bundled");
    let profile = inputs::windowed(profile, scene).expect("a window");
    Case::new(scene, index, &profile, &[]).expect("a case")
}

/// An integral law with its gains, V/√N and V/(√N·s), and the force table.
fn integral(gains: &[String; 2]) -> [(&str, &str); 4] {
    let [proportional, integral] = gains;
    [
        ("law", "integral"),
        ("proportional_v", proportional),
        ("integral_v", integral),
        ("force", "table"),
    ]
}

/// The predicted stability of an integral law about a force.
///
/// # Panics
/// Where the scene cannot be run so.
pub fn stability(division: &Division, gains: [f64; 2], force_n: f64) -> Stability {
    let scene = scene(division, &integral(&gains.map(|gain| gain.to_string())), 50.0);
    let case = case(division, &scene, CLOSED);
    let open = OpenLoop::of(&case, force_n).expect("a plant").expect("a loop");
    open.margins(force_n)
}

/// The same, and what is measured at every second frequency.
///
/// # Panics
/// As [`stability`].
pub fn measured(division: &Division, gains: [f64; 2], force_n: f64) -> Bode {
    let scene = scene(division, &integral(&gains.map(|gain| gain.to_string())), 50.0);
    let case = case(division, &scene, CLOSED);
    let all = |point: &(dyn Fn(usize) -> _ + Sync)| {
        (0..bode::frequencies() / 2).into_par_iter().map(|k| point(2 * k + 1)).collect()
    };
    bode::measure(&case, &FIXED, force_n, all).expect("a run").expect("a loop")
}

/// The slots of an integral law after a target, as [`follow_in`].
///
/// # Panics
/// As [`stability`].
pub fn follow_integral(division: &Division, gains: [f64; 2], target: &str) -> Vec<Followed> {
    let scene = scene(division, &integral(&gains.map(|gain| gain.to_string())), 50.0);
    slots(&case(division, &scene, &format!("{target}, closed loop")))
}

/// `fig9` in other slots; further pads have a target of zero.
fn scene(division: &Division, control: &[(&str, &str)], load_g: f64) -> Arc<Scene> {
    let text = |(key, value): &(&str, &str)| (format!("control.{key}"), quoted(value));
    let mut set = vec![("supply".into(), "false".into())];
    let estimate = ("force", "eq8");
    set.extend(std::iter::once(&estimate).chain(control).map(text));
    set.push(("pad.0.load_g".into(), load_g.to_string()));
    set.push(("control.nominal_load_g".into(), load_g.to_string()));
    let others: String = (1..division.pads)
        .map(|pad| {
            format!("[[pad]]\nposition_mm = [{}, 90]\nload_g = {load_g}\ntarget_n = 0\n", 80 * pad)
        })
        .collect();
    let [settle, window] = division.samples;
    let scene = gallery::find("fig9").expect("bundled");
    let scene = scene
        .replacen("[sheet]", &format!("{others}[sheet]"), 1)
        .replace("settle_samples = 390", &format!("settle_samples = {settle}"))
        .replace("window_samples = 600", &format!("window_samples = {window}"));
    let scene = Scene::parse(&scene, "fig9.toml", &set);
    Arc::new(scene.unwrap_or_else(|error| panic!("{error}")))
}

fn quoted(value: &str) -> String {
    if value.parse::<f64>().is_ok() { value.to_string() } else { format!("\"{value}\"") }
}

fn asked_n(row: &Row) -> f64 {
    row.driven.expect("a controller").target_n
}

fn followed(row: &Row, asked_n: f64) -> Followed {
    let truth = row.truth.expect("a simulated pad");
    let (target_n, force_n) = (truth.set.target_n, truth.quantities.force_n);
    Followed { time_s: row.time_s, target_n, asked_n, force_n }
}

fn rms(errors: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) =
        errors.fold((0.0, 0), |(sum, count), error| (sum + error * error, count + 1));
    (sum / f64::from(count)).sqrt()
}

/// Root mean square of true force − target at the same time, N.
pub fn rms_n(slots: &[Followed]) -> f64 {
    rms(slots.iter().map(|slot| slot.force_n - slot.target_n))
}

/// Root mean square of true force − the target that the drive was made for, from 50 ms after each
/// step of the target on, N.
pub fn rms_after_edges_n(slots: &[Followed]) -> f64 {
    let (mut edge_s, mut before) = (slots[0].time_s, slots[0].asked_n);
    let mut error = |slot: &Followed| {
        if (slot.asked_n - before).abs() > 0.05 {
            edge_s = slot.time_s;
        }
        before = slot.asked_n;
        (slot.time_s > edge_s + 0.05).then_some(slot.force_n - slot.asked_n)
    };
    rms(slots.iter().filter_map(&mut error))
}

/// The largest true force above its target and above the target that its drive was made for, N: a
/// pad that waits for its next slot while its target falls does not overshoot.
pub fn overshoot_n(slots: &[Followed]) -> f64 {
    let above = |slot: &Followed| slot.force_n - slot.target_n.max(slot.asked_n);
    slots.iter().map(above).fold(0.0, f64::max)
}

/// From the target's first step to 90 % of it for good, s.
pub fn rise_s(slots: &[Followed]) -> f64 {
    let most = slots.iter().map(|slot| slot.target_n).fold(0.0, f64::max);
    let on = slots.iter().filter(|slot| slot.target_n == most);
    let (mut first, mut last) = (None, 0.0);
    for slot in on {
        let first = *first.get_or_insert(slot.time_s);
        if slot.force_n < 0.9 * most {
            last = slot.time_s - first;
        }
    }
    last
}
