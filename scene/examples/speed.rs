// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the plant costs: nanoseconds per sample instant of eight channels, and per slot, effect by effect and rung by rung.
//!
//! `cargo run --release -p hapticore-scene --example speed`

use std::time::Instant;

use hapticore_scene::{Complex, Plant, Scene, SceneError, Timing, gallery};

const SLOTS: usize = 2000;

fn main() -> Result<(), SceneError> {
    samples()?;
    ["distance", "bicubic", "analytic"].into_iter().try_for_each(phasors)
}

fn hockey(rung: &str) -> Result<(Plant, Timing), SceneError> {
    let timing =
        Timing { pads: 4, slot_samples: 1700, window_start: 700, window_samples: 1000, samples_per_period: 10.0 };
    let text = gallery::find("hockey").unwrap_or_default();
    let scene = Scene::parse(text, "hockey.toml", &[("sheet.rung".to_string(), rung.to_string())])?;
    let start = Instant::now();
    let plant = Plant::new(&scene, 0, &timing)?.metered();
    println!("{rung}: built in {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
    Ok((plant, timing))
}

fn samples() -> Result<(), SceneError> {
    let (mut plant, timing) = hockey("bicubic")?;
    let (start, mut samples) = (Instant::now(), Vec::new());
    for slot in 0..SLOTS {
        samples.clear();
        plant.samples(slot, 0..timing.window_start, &mut samples);
        plant.samples(slot, timing.window_start..timing.slot_samples, &mut samples);
    }
    let instants = (SLOTS * timing.slot_samples) as f64;
    let each_ns = start.elapsed().as_secs_f64() * 1e9 / instants;
    println!("samples: {each_ns:.1} ns per instant of {} channels", plant.channels());
    print(&plant, instants);
    Ok(())
}

fn phasors(rung: &str) -> Result<(), SceneError> {
    let (mut plant, _) = hockey(rung)?;
    let (start, mut phasors) = (Instant::now(), vec![Complex::default(); plant.channels() - 1]);
    for slot in 0..SLOTS {
        plant.phasors(slot, &mut phasors);
    }
    println!("phasors: {:.0} ns per slot", start.elapsed().as_secs_f64() * 1e9 / SLOTS as f64);
    print(&plant, SLOTS as f64);
    Ok(())
}

fn print(plant: &Plant, per: f64) {
    for cost in plant.effects() {
        println!("  {:20} {:18} {:8.2} ns", cost.name, cost.rung, cost.seconds * 1e9 / per);
    }
}
