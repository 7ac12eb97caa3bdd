// SPDX-License-Identifier: MIT OR Apache-2.0
//! How fast scenes run: wall seconds beside seconds of device time, the best of three runs, and how
//! many of them went into choosing levels within an error budget.
//!
//! `cargo run --release -p hapticore --example scene_speed [-- SCENE…]`, `fig7` unless said
//! otherwise; `taskset -c 0` before it keeps all of it on one processor.

use std::sync::Arc;
use std::time::Instant;

use anyhow::Result;
use hapticore_run::case::{Case, Settings};
use hapticore_run::engine::Fidelity;
use hapticore_run::inputs;

/// The carrier's level and the core's fidelity.
const WAYS: [(&str, Fidelity); 4] = [
    ("phasor", Fidelity::Float),
    ("phasor", Fidelity::Fixed),
    ("samples", Fidelity::Fixed),
    ("samples", Fidelity::Clock),
];

const BEST_OF: usize = 3;

fn main() -> Result<()> {
    let named: Vec<String> = std::env::args().skip(1).collect();
    let scenes = if named.is_empty() { vec!["fig7".into()] } else { named };
    println!(
        "{:20} {:8} {:6} {:>9} {:>9} {:>9} {:>7}",
        "scene", "carrier", "core", "device, s", "levels, s", "wall, s", "ratio"
    );
    for scene in scenes {
        for (carrier, fidelity) in WAYS {
            let [device, levels, wall] = best(&scene, carrier, fidelity)?;
            println!(
                "{scene:20} {carrier:8} {:6} {device:9.3} {levels:9.4} {wall:9.4} {:7.3}",
                fidelity.name(),
                wall / device
            );
        }
    }
    Ok(())
}

/// Seconds of device time, those of choosing levels, and the least of wall time, from the scene's
/// text to the last row.
fn best(name: &str, carrier: &str, fidelity: Fidelity) -> Result<[f64; 3]> {
    let runs = (0..BEST_OF).map(|_| once(name, carrier, fidelity)).collect::<Result<Vec<_>>>()?;
    Ok(runs.into_iter().min_by(|a, b| a[2].total_cmp(&b[2])).expect("at least one run"))
}

fn once(name: &str, carrier: &str, fidelity: Fidelity) -> Result<[f64; 3]> {
    let start = Instant::now();
    let scene = inputs::scene(name, &[("carrier.rung".into(), carrier.into())])?;
    let profile = inputs::windowed(inputs::profile(&scene.profile)?, &scene)?;
    let choosing = Instant::now();
    let scene = Arc::new(scene.within_budget(&inputs::timing(&profile))?);
    let levels = choosing.elapsed().as_secs_f64();
    let mut cases: Vec<Case> = Vec::new();
    for index in 0..scene.cases.len() {
        let case = Case::new(&scene, index, &profile, &cases)?;
        case.run(&Settings { fidelity, errors: false }, None, &|| ())?;
        cases.push(case);
    }
    let device_s = cases.iter().map(Case::seconds).sum();
    Ok([device_s, levels, start.elapsed().as_secs_f64()])
}
