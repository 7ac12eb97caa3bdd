// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the plant costs: nanoseconds per sample instant of eight channels, and per slot, effect by effect.
//!
//! `cargo run --release -p hapticore-scene --example speed`

use std::time::Instant;

use hapticore_scene::{Complex, Plant, Scene, Timing, gallery};

const SLOTS: usize = 2000;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let timing =
        Timing { pads: 4, slot_samples: 500, window_start: 100, window_samples: 400, samples_per_period: 10.0 };
    let scene = Scene::parse(gallery::find("hockey").ok_or("no hockey")?, "hockey.toml", &[])?;
    let build = Instant::now();
    let mut plant = Plant::new(&scene, 0, &timing)?;
    println!("build {:.1} ms", build.elapsed().as_secs_f64() * 1e3);

    let (start, mut samples) = (Instant::now(), Vec::new());
    for slot in 0..SLOTS {
        samples.clear();
        plant.samples(slot, 0..timing.window_start, &mut samples);
        plant.samples(slot, timing.window_start..timing.slot_samples, &mut samples);
    }
    let instants = (SLOTS * timing.slot_samples) as f64;
    println!(
        "samples {:.1} ns per instant of {} channels",
        start.elapsed().as_secs_f64() * 1e9 / instants,
        plant.channels()
    );
    print(&plant, instants);

    let mut plant = Plant::new(&scene, 0, &timing)?;
    let (start, mut phasors) = (Instant::now(), vec![Complex::default(); plant.channels() - 1]);
    for slot in 0..SLOTS {
        plant.phasors(slot, &mut phasors);
    }
    println!("phasors {:.0} ns per slot", start.elapsed().as_secs_f64() * 1e9 / SLOTS as f64);
    print(&plant, SLOTS as f64);
    Ok(())
}

fn print(plant: &Plant, per: f64) {
    for cost in plant.effects() {
        println!("  {:20} {:18} {:8.2} ns", cost.name, cost.rung, cost.seconds * 1e9 / per);
    }
}
