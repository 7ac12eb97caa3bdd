// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore scenes`: the bundled scenes.

use anyhow::{Result, bail};
use hapticore_scene::{Scene, gallery};
use serde::Serialize;

use crate::args::ScenesArgs;
use crate::{console, print, say};
use hapticore_run::inputs;

#[derive(Serialize)]
struct Listed {
    name: String,
    title: String,
    summary: String,
    cases: Vec<String>,
    pads: Vec<String>,
    effects: Vec<String>,
    criteria: Vec<String>,
}

/// Lists the bundled scenes.
///
/// # Errors
/// No such scene.
pub fn run(args: &ScenesArgs) -> Result<bool> {
    let named = |name: &&str| args.show.as_deref().is_none_or(|show| show == *name);
    let names: Vec<_> = gallery::all().iter().map(|(name, _)| *name).filter(named).collect();
    let listed = names
        .iter()
        .map(|name| Ok(list(&inputs::scene(name, &[])?)))
        .collect::<Result<Vec<_>>>()?;
    if let (Some(show), true) = (&args.show, listed.is_empty()) {
        let names: Vec<_> = gallery::all().iter().map(|(name, _)| *name).collect();
        bail!("--show: expected a bundled scene, one of {}, got {show:?}", names.join(", "));
    }
    match &args.show {
        _ if args.json => say!("{}", serde_json::to_string_pretty(&listed)?),
        Some(_) => listed.iter().for_each(show),
        None => console::print(format_args!("{}\n{MORE}\n", overview(&listed))),
    }
    Ok(true)
}

const MORE: &str =
    "hapticore scenes --show NAME tells what a scene is about, its cases, effects and criteria.";

/// A line for each scene, at most 100 columns.
fn overview(listed: &[Listed]) -> String {
    let row = |scene: &Listed| {
        let counts = [scene.cases.len(), scene.pads.len(), scene.criteria.len()];
        let counts = counts.map(|count| count.to_string());
        [vec![scene.name.clone(), scene.title.clone()], counts.to_vec()].concat()
    };
    let rows: Vec<_> = listed.iter().map(row).collect();
    print::table(&["scene", "title", "cases", "pads", "criteria"], &rows)
}

/// All of a scene.
fn show(scene: &Listed) {
    say!("{}: {}", scene.name, scene.title);
    if !scene.summary.is_empty() {
        say!("\n{}", scene.summary.trim());
    }
    let lists = [
        ("cases", &scene.cases),
        ("pads", &scene.pads),
        ("effects", &scene.effects),
        ("criteria", &scene.criteria),
    ];
    for (name, list) in lists {
        say!("\n{name}:");
        list.iter().for_each(|item| say!("  {item}"));
    }
}

fn list(scene: &Scene) -> Listed {
    let effects = print::effects_line(scene.cases.iter().flat_map(|case| case.effects()));
    Listed {
        name: scene.name.clone(),
        title: scene.title.clone(),
        summary: scene.summary.clone(),
        cases: scene.cases.iter().map(|case| case.name.clone()).collect(),
        pads: scene.cases[0].pad_names().iter().map(ToString::to_string).collect(),
        effects: effects.split(" · ").map(ToString::to_string).collect(),
        criteria: scene.criteria.iter().map(|criterion| criterion.name.clone()).collect(),
    }
}
