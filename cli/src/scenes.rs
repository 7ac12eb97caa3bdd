// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore scenes`: the bundled scenes.

use anyhow::Result;
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
/// None, but for a scene that is broken.
pub fn run(args: &ScenesArgs) -> Result<bool> {
    let listed = gallery::all()
        .iter()
        .map(|(name, _)| Ok(list(&inputs::scene(name, &[])?)))
        .collect::<Result<Vec<_>>>()?;
    if args.json {
        say!("{}", serde_json::to_string_pretty(&listed)?);
    } else {
        let row = |scene: &Listed| {
            let cases = if scene.cases.len() > 1 { scene.cases.join(", ") } else { String::new() };
            vec![scene.name.clone(), scene.title.clone(), cases, scene.effects.join(" · ")]
        };
        console::print(format_args!(
            "{}",
            print::table(
                &["scene", "title", "cases", "effects"],
                &listed.iter().map(row).collect::<Vec<_>>()
            )
        ));
    }
    Ok(true)
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
