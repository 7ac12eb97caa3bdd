// SPDX-License-Identifier: MIT OR Apache-2.0
//! What an error budget costs: seconds to choose the levels of a scene, all of them open, and to run
//! it then, beside those of a run whose scene names the same levels. What is built to choose, the
//! run does not build again, so that choosing costs the difference. Float core, phasors, best of
//! three.
//!
//! `cargo run --release -p hapticore --example budget_speed [-- SCENE…]`

use std::sync::Arc;
use std::time::Instant;

use anyhow::Result;
use hapticore_contract::profile::Profile;
use hapticore_run::case::{Case, Settings};
use hapticore_run::engine::Fidelity;
use hapticore_run::inputs;
use hapticore_scene::Scene;

/// Keys of a scene, and what they are set to.
type Set = [(&'static str, &'static str)];

/// Scenes, their budgets in percent, and what opens their levels.
const SCENES: [(&str, &str, &Set); 7] = [
    ("fig3", "0.1", &[("sheet.rung", "false")]),
    ("fig7", "1", &[("sheet.rung", "false"), ("gap.rung", "moving")]),
    ("hockey", "1", &[("sheet.rung", "false"), ("gap.rung", "moving")]),
    ("minimal-sheet", "0.01", &[]),
    ("shunt-panel", "0.1", &[]),
    ("four-pads", "0.1", &[]),
    ("non-uniform-sheet", "1", &[("sheet.rung", "false")]),
];

/// Effects that have levels here.
const LEVELLED: [&str; 4] = ["sheet", "shunt", "coupling", "gap"];

const BEST_OF: usize = 3;

fn main() -> Result<()> {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    println!(
        "{:18} {:>9} {:>9} {:>7} {:>14} {:>10}  levels",
        "scene", "budget, %", "choose, s", "run, s", "named alone, s", "costs, run"
    );
    for (name, percent, open) in SCENES {
        if wanted.is_empty() || wanted.iter().any(|wanted| wanted == name) {
            print(name, percent, open)?;
        }
    }
    Ok(())
}

fn print(name: &str, percent: &str, open: &Set) -> Result<()> {
    let (mut least, mut levels) = ([f64::INFINITY; 3], String::new());
    for _ in 0..BEST_OF {
        let (times, chosen) = once(name, percent, open)?;
        least = [0, 1, 2].map(|n| least[n].min(times[n]));
        levels = chosen;
    }
    let [choose, run, named] = least;
    let costs = (choose + run - named) / named;
    println!("{name:18} {percent:>9} {choose:9.4} {run:7.4} {named:14.4} {costs:10.2}  {levels}");
    Ok(())
}

/// Seconds to choose, to run, and to run with the levels named; and the levels of each case.
fn once(name: &str, percent: &str, open: &Set) -> Result<([f64; 3], String)> {
    let more = [("error_budget_percent", percent), ("carrier.rung", "phasor")];
    let scene = inputs::scene(name, &owned(open.iter().chain(&more)))?;
    let profile = inputs::windowed(inputs::profile(&scene.profile)?, &scene)?;
    let start = Instant::now();
    let scene = scene.within_budget(&inputs::timing(&profile))?;
    let choose = start.elapsed().as_secs_f64();
    let scene = Arc::new(scene);
    let together = run(std::slice::from_ref(&scene), &profile)?;
    let named = scene.cases.iter().map(named).collect::<Result<Vec<_>>>()?;
    let alone = run(&named.into_iter().map(Arc::new).collect::<Vec<_>>(), &profile)?;
    let levels: Vec<_> = scene.cases.iter().map(|case| words(case).join(", ")).collect();
    Ok(([choose, together, alone], levels.join("; ")))
}

/// Seconds of all cases.
fn run(scenes: &[Arc<Scene>], profile: &Profile) -> Result<f64> {
    let start = Instant::now();
    for scene in scenes {
        for index in 0..scene.cases.len() {
            let case = Case::new(scene, index, profile, &[])?;
            case.run(&Settings { fidelity: Fidelity::Float, errors: false }, None, &|| ())?;
        }
    }
    Ok(start.elapsed().as_secs_f64())
}

/// A case by itself, which names its levels.
fn named(case: &hapticore_scene::Case) -> Result<Scene> {
    let levels = words(case).into_iter().map(|words| {
        let (effect, level) = words.split_once(' ').unwrap_or_default();
        (format!("{effect}.rung"), level.to_string())
    });
    let no_budget = ("error_budget_percent".to_string(), "false".to_string());
    let set: Vec<_> = levels.chain([no_budget]).collect();
    Ok(Scene::parse(&case.document, "named.toml", &set)?)
}

/// Effect and level, as a scene writes it.
fn words(case: &hapticore_scene::Case) -> Vec<String> {
    let effects = case.effects().into_iter().filter(|(name, _)| LEVELLED.contains(name));
    let word = |label: &str| label.split(' ').next().unwrap_or_default().to_string();
    effects.map(|(name, label)| format!("{name} {}", word(label))).collect()
}

fn owned<'a>(set: impl Iterator<Item = &'a (&'a str, &'a str)>) -> Vec<(String, String)> {
    set.map(|(key, to)| (key.to_string(), to.to_string())).collect()
}
