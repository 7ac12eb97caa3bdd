// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the plant costs for a second of device time, effect by effect and level by level, alone and
//! together: slots as amplitudes and as samples, and how long the effect takes to build.
//!
//! `cargo run --release -p hapticore-scene --example speed`

use std::time::Instant;

use hapticore_scene::{Complex, Plant, Scene, SceneError, Timing};

/// Slots of a measurement as amplitudes, and of one as samples; the best of `BEST_OF` measurements
/// counts.
const SLOTS: [usize; 2] = [2000, 100];
const BEST_OF: usize = 5;

/// Four pads that move, one of them selected per slot.
const PADS: &str = "title = \"speed\"\nduration_s = 10\n\
    [[pad]]\nposition_mm = { circle = { centre_mm = [280, 20], radius_mm = 110, period_s = 0.9 } }\nhaptic_v_rms = 150\n\
    [[pad]]\nposition_mm = { circle = { centre_mm = [-280, 20], radius_mm = 110, period_s = 0.7 } }\n\
    [[pad]]\nposition_mm = { line = { from_mm = [-100, -180], to_mm = [100, 200], period_s = 0.8 } }\n\
    [[pad]]\nposition_mm = [-60, 205]\n";

/// What is measured: its name, what it is added to, what it adds, and what the prototype of
/// docs/physics.md took. The prototype's times are in milliseconds, to build or for a second, with
/// one patch of a gap; here there are 32.
const EFFECTS: &[(&str, &str, &str, &str)] = &[
    ("sheet distance", "", "[sheet]\nrung = \"distance\"\n", "10 ns a look-up: 0.006"),
    ("sheet bilinear", "", "[sheet]\nrung = \"bilinear\"\n", "0.9; 12 ns: 0.007"),
    ("sheet bicubic", "", "[sheet]\nrung = \"bicubic\"\n", "3.7; 30 ns: 0.018"),
    ("sheet bicubic-fine", "", "[sheet]\nrung = \"bicubic-fine\"\n", "60; 37 ns: 0.022"),
    ("sheet analytic", "", "[sheet]\nrung = \"analytic\"\n", "395 ns: 0.23"),
    ("sheet grid-20-mm", "", "[sheet]\nrung = \"grid-20-mm\"\n", "0.8"),
    ("sheet grid-10-mm", "", "[sheet]\nrung = \"grid-10-mm\"\n", "4.3"),
    ("sheet grid-5-mm", "", "[sheet]\nrung = \"grid-5-mm\"\n", "30"),
    ("sheet grid-2.5-mm", "", "[sheet]\nrung = \"grid-2.5-mm\"\n", "75"),
    ("sheet grid-1.25-mm", "", "[sheet]\nrung = \"grid-1.25-mm\"\n", "646"),
    ("temperature", "[sheet]\n", "[temperature]\ntempco_ppm_per_k = 400\nrise_k = 20\n", ""),
    ("shunt table", "[sheet]\n", "[shunt]\nnanofarad_per_m2 = 9\n", ""),
    ("shunt series", "[sheet]\n", "[shunt]\nnanofarad_per_m2 = 9\nrung = \"series\"\n", ""),
    ("coupling once", "[sheet]\n", "[coupling]\nrung = \"once\"\n", ""),
    ("coupling full", "[sheet]\n", "[coupling]\n", ""),
    ("switching rc-1", "[sheet]\n", "[switching]\nrung = \"rc-1\"\n", "22 ns a step: 22"),
    ("switching rc-4", "[sheet]\n", "[switching]\nrung = \"rc-4\"\n", "88"),
    ("switching rc-8", "[sheet]\n", "[switching]\nrung = \"rc-8\"\n", "176"),
    ("switching rc-16", "[sheet]\n", "[switching]\nrung = \"rc-16\"\n", "352"),
    ("switching rc-64", "[sheet]\n", "[switching]\nrung = \"rc-64\"\n", "1408"),
    ("switching euler-64", "[sheet]\n", "[switching]\nrung = \"euler-64\"\n", ""),
    ("switching settling", "[sheet]\n", "[switching]\n", "small"),
    ("supply steady", "", "[supply]\n", ""),
    ("gap static", "", "[gap]\nrung = \"static\"\n", ""),
    ("gap quasi-static", "", "[gap]\nrung = \"quasi-static\"\n", "32 patches: 0.34"),
    ("gap semi-implicit", "", "[gap]\nrung = \"semi-implicit\"\n", "11"),
    ("gap implicit-euler", "", "[gap]\nrung = \"implicit-euler\"\n", "74"),
    ("gap trapezoid", "", "[gap]\nrung = \"trapezoid\"\n", "80"),
    ("gap tr-bdf2", "", "[gap]\nrung = \"tr-bdf2\"\n", "144"),
    ("halves gaps", "[gap]\n", "[halves]\n", ""),
    ("friction coulomb", "[gap]\n", "[friction]\nrung = \"coulomb\"\n", ""),
    ("friction stiction", "[gap]\n", "[friction]\nrung = \"stiction\"\n", ""),
    ("friction dahl", "[gap]\n", "[friction]\nrung = \"dahl\"\n", ""),
    ("friction lugre", "[gap]\n", "[friction]\nrung = \"lugre\"\n", ""),
    ("hand, lugre", "[gap]\n", "[friction]\nrung = \"lugre\"\n[hand]\n", ""),
    ("sensor leakage", "", "[sensor]\nhaptic_leakage = true\n", ""),
    ("sensor bandwidth", "", "[sensor]\nbandwidth_khz = 900\n", ""),
    ("sensor jitter", "", "[sensor]\njitter_ns_rms = 0.1\n", ""),
    ("sensor crosstalk", "", "[sensor]\ncrosstalk_percent = 0.1\n", ""),
    ("sensor scale", "", "[sensor]\ngain_error_percent = 1\n", ""),
    ("sensor gain", "", "[sensor]\ngain_mismatch_percent = 1\n", ""),
    ("sensor offset", "", "[sensor]\noffset_percent = 0.01\n", ""),
    ("sensor noise", "", "[sensor]\nnoise_ppm_rms = 18\n", ""),
    ("sensor noise density", "", "[sensor]\nnoise_density_na_per_rthz = 1\n", ""),
    ("sensor quantisation", "", "[sensor]\nquantisation_bits = 16\n", ""),
    ("sensor dither", "[sensor]\nquantisation_bits = 16\n", "dither_lsb_rms = 0.5\n", ""),
    (
        "together",
        "",
        "[supply]\n[gap]\nrung = \"tr-bdf2\"\n[halves]\n[hand]\n[friction]\nrung = \"lugre\"\n[sheet]\n[shunt]\nnanofarad_per_m2 = 9\n[coupling]\n[switching]\n[sensor]\nhaptic_leakage = true\n\
         bandwidth_khz = 900\njitter_ns_rms = 0.1\ncrosstalk_percent = 0.1\ngain_mismatch_percent = 1\n\
         offset_percent = 0.01\nnoise_ppm_rms = 18\nnoise_density_na_per_rthz = 1\nquantisation_bits = 16\n\
         dither_lsb_rms = 0.5\ngain_error_percent = 1\n",
        "",
    ),
];

fn main() -> Result<(), SceneError> {
    println!(
        "{:22} {:>10} {:>16} {:>14}  prototype",
        "", "build, ms", "amplitudes, ms/s", "samples, ms/s"
    );
    print("carrier", measure("")?, "0.17; samples 21");
    for (name, under, added, physics) in EFFECTS {
        let (without, with) = (measure(under)?, measure(&format!("{under}{added}"))?);
        print(name, [0, 1, 2].map(|n| with[n] - without[n]), physics);
    }
    Ok(())
}

fn print(name: &str, [build, amplitudes, samples]: [f64; 3], physics: &str) {
    println!("{name:22} {build:10.2} {amplitudes:16.3} {samples:14.2}  {physics}");
}

/// The least milliseconds to build the plant, and for a second of device time as amplitudes and as
/// samples.
fn measure(effects: &str) -> Result<[f64; 3], SceneError> {
    let mut least = [f64::INFINITY; 3];
    for _ in 0..BEST_OF {
        // Read anew each time: the plants of a scene share what takes long to build.
        let scene = Scene::parse(&format!("{PADS}{effects}"), "speed.toml", &[])?;
        let times = once(&scene)?;
        least = [0, 1, 2].map(|n| least[n].min(times[n]));
    }
    Ok(least)
}

fn once(scene: &Scene) -> Result<[f64; 3], SceneError> {
    let timing = Timing {
        pads: 4,
        slot_samples: 1700,
        window_start: 700,
        window_samples: 1000,
        samples_per_period: 10.0,
        signs: None,
    };
    let start = Instant::now();
    let mut plant = Plant::new(scene, 0, &timing)?;
    let built = start.elapsed().as_secs_f64();
    let slots_per_second = plant.device().sample_rate_hz / timing.slot_samples as f64;
    let mut phasors = vec![Complex::default(); plant.channels() - 1];
    let amplitudes = seconds(SLOTS[0], |slot| {
        plant.phasors(slot, &mut phasors);
    });
    let mut plant = Plant::new(scene, 0, &timing)?; // from the start again, for effects with a state
    let mut samples = Vec::new();
    let sampled = seconds(SLOTS[1], |slot| {
        samples.clear();
        plant.samples(slot, 0..timing.window_start, &mut samples);
        plant.samples(slot, timing.window_start..timing.slot_samples, &mut samples);
    });
    Ok([built, amplitudes * slots_per_second, sampled * slots_per_second]
        .map(|seconds| 1e3 * seconds))
}

/// Seconds a slot.
fn seconds(slots: usize, mut slot: impl FnMut(usize)) -> f64 {
    let start = Instant::now();
    (0..slots).for_each(&mut slot);
    start.elapsed().as_secs_f64() / slots as f64
}
