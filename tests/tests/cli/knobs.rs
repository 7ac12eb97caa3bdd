// SPDX-License-Identifier: MIT OR Apache-2.0
//! A bundled scene that passes has shown what its title says: if a knob that matters is turned, a
//! criterion fails.

use hapticore_scene::gallery;
use rayon::prelude::*;
use serde_json::Value;

use crate::command;

/// A change of the device that a scene must notice.
struct Knob {
    name: &'static str,
    set: &'static [&'static str],
    /// The table that a scene must have for the knob to be there.
    of: &'static str,
}

const KNOBS: [Knob; 6] = [
    Knob { name: "a tenth of the friction", set: &["device.mu=0.012"], of: "[[pad]]" },
    Knob { name: "2.5 times the friction", set: &["device.mu=0.3"], of: "[[pad]]" },
    Knob { name: "5 % more gain", set: &["sensor.gain_error_percent=5"], of: "[[pad]]" },
    Knob { name: "ten times the spring", set: &["gap.spring_pa_per_m=4.5e8"], of: "[gap]" },
    Knob {
        name: "a terminal that opens after calibration",
        set: &["sheet.open=[1]", "calibration.set={\"sheet.open\"=false}"],
        of: "[sheet]",
    },
    Knob {
        name: "the map of a sheet with other terminals",
        set: &["calibration.set={\"sheet.terminal_ohm\"=[500, 500, 0, 0, 0, 0]}"],
        of: "[sheet]",
    },
];

/// Scenes without a claim about a force: to them friction does not matter.
const WITHOUT_FORCE: [&str; 3] = ["fig4", "fig13", "minimal-halves"];

/// Whether a scene has what the knob turns.
fn matters(scene: &str, text: &str, knob: &Knob) -> bool {
    let of_force = !knob.set[0].starts_with("device.mu") || !WITHOUT_FORCE.contains(&scene);
    of_force && text.lines().any(|line| line.starts_with(knob.of))
}

/// The case that all criteria of a scene are of, where there is one: the others need not be run.
fn only_case(text: &str) -> Option<String> {
    let scene: toml::Table = text.parse().expect("a bundled scene");
    let criteria = scene["criterion"].as_array().expect("criteria").iter();
    let mut cases = criteria.map(|criterion| Some(criterion.get("case")?.as_str()?.to_string()));
    let first = cases.next()??;
    cases.all(|case| case.as_ref() == Some(&first)).then_some(first)
}

/// The criteria of a scene that fail, as the summary names them.
fn failing(scene: &str, set: &[&str]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let case = gallery::find(scene).and_then(only_case);
    let case = case.iter().flat_map(|case| ["--case", case.as_str()]);
    let set = set.iter().chain(&["carrier.rung=phasor"]).flat_map(|set| ["--set", set]);
    let args: Vec<_> = ["simulate", scene, "--core", "float", "--out", "run", "--json"]
        .into_iter()
        .chain(set)
        .chain(case)
        .collect();
    let output = command(folder.path(), &args).output().unwrap();
    let log = String::from_utf8_lossy(&output.stderr);
    let summary: Value = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|error| panic!("{args:?}: {error}: {log}"));
    let criteria = summary["criteria"].as_array().expect("criteria").iter();
    criteria.filter(|one| one["pass"] == false).map(|one| one["name"].to_string()).collect()
}

#[test]
#[cfg_attr(not(optimised), ignore = "whole scenes: run with --release")]
fn every_knob_that_matters_makes_a_criterion_of_every_scene_fail() {
    let turned = gallery::all()
        .iter()
        .flat_map(|(scene, text)| KNOBS.iter().map(move |knob| (*scene, *text, knob)))
        .filter(|(scene, text, knob)| matters(scene, text, knob));
    gallery::all().par_iter().for_each(|(scene, _)| {
        assert_eq!(failing(scene, &[]), [""; 0], "{scene} as it is");
    });
    let unnoticed: Vec<_> = turned
        .collect::<Vec<_>>()
        .into_par_iter()
        .filter_map(|(scene, _, knob)| {
            let failing = failing(scene, knob.set);
            println!("{scene}, {}: {}", knob.name, failing.join(", "));
            failing.is_empty().then(|| format!("{scene}, {}", knob.name))
        })
        .collect();
    assert!(unnoticed.is_empty(), "no criterion fails:\n{}", unnoticed.join("\n"));
}
