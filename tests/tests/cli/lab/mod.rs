// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore calibrate`: from what a lab measures to a calibration that is right, or to a word on
//! what is missing.

mod coverage;
mod gap;
mod refusals;
mod replayed;
mod wiring;

use std::fmt::Write;
use std::fs;
use std::path::Path;

use hapticore_scene::{Complex, ForcePoint, Plant, Scene, Timing};

use crate::refuse;

/// A sheet with a terminal at each corner.
pub const SHEET: [&str; 4] = [
    "device.width_mm=300",
    "device.height_mm=200",
    "device.pad_diameter_mm=20",
    "sheet.terminals=4",
];

/// Full scales and rates of the scenes' device under `standard`, and where the terminals of
/// [`SHEET`] are.
pub const SETUP: &str = "pads = 1
sample_rate_hz = 1e6
carrier_hz = 101e3
current_full_scale_a = 0.004
sense_full_scale_v = 8.0
haptic_full_scale_v = 600.0
gravity_m_s2 = 9.80665
";
pub const TERMINALS: &str = "[terminals]
places_mm = [[-150, 100], [-150, -100], [150, -100], [150, 100]]
[sheet]
width_mm = 300
height_mm = 200
pad_diameter_mm = 20
";

/// A place and what is read there.
#[derive(Clone)]
pub struct Measurement {
    pub at_mm: [f64; 2],
    pub currents_a: Vec<Complex>,
    pub sense_v: f64,
}

/// Numbers of a normal distribution.
pub struct Noise(pub fastrand::Rng);

impl Noise {
    pub fn of(seed: u64) -> Noise {
        Noise(fastrand::Rng::with_seed(seed))
    }

    /// Box and Muller's.
    pub fn normal(&mut self) -> f64 {
        let (a, b) = (1.0 - self.0.f64(), self.0.f64());
        (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
    }
}

/// The device of a bundled scene with keys set.
pub fn plant(scene: &str, set: &[&str]) -> Plant {
    let set: Vec<_> = set
        .iter()
        .map(|key| key.split_once('=').unwrap())
        .map(|(a, b)| (a.into(), b.into()))
        .collect();
    let text = hapticore_scene::gallery::find(scene).unwrap();
    let scene = Scene::parse(text, scene, &set).unwrap();
    let profile = hapticore_contract::profile::Profile::bundled("standard").unwrap();
    let timing = Timing { signs: None, ..hapticore_run::inputs::timing(&profile) };
    Plant::new(&scene.within_budget(&timing).unwrap(), 0, &timing).unwrap()
}

/// A raster of `columns` × `rows` places over a sheet, as far as a pad of 20 mm goes.
pub fn raster([columns, rows]: [usize; 2], half_mm: [f64; 2]) -> Vec<[f64; 2]> {
    let along =
        |k: usize, count: usize, half: f64| half * (2.0 * k as f64 / (count - 1) as f64 - 1.0);
    let place =
        |k: usize| [along(k % columns, columns, half_mm[0]), along(k / columns, rows, half_mm[1])];
    (0..columns * rows).map(place).collect()
}

/// What a plant's terminals read at places, each with noise of `parts` of itself.
pub fn measurements(
    plant: &Plant,
    places: &[[f64; 2]],
    parts: f64,
    noise: &mut Noise,
) -> Vec<Measurement> {
    let sense_v = plant.device().carrier_v;
    let mut noisy = |current: Complex| current * (1.0 + parts * noise.normal());
    let of = |(read, place): (hapticore_scene::PadMeasurement, &[f64; 2])| Measurement {
        at_mm: *place,
        currents_a: read.siemens.iter().map(|siemens| noisy(siemens * sense_v)).collect(),
        sense_v,
    };
    plant.measurements(places).into_iter().zip(places).map(of).collect()
}

/// Currents by amplitude and phase, or by amplitude alone.
pub fn places_csv(measurements: &[Measurement], phases: bool) -> String {
    let terminals = measurements.first().map_or(4, |measurement| measurement.currents_a.len());
    let mut text = String::from("# measured in a test\nx_mm, y_mm, v_sense");
    (1..=terminals).for_each(|k| {
        write!(text, ", i{k}{}", if phases { format!(", i{k}_deg") } else { String::new() })
            .unwrap()
    });
    for Measurement { at_mm: [x, y], currents_a, sense_v } in measurements {
        write!(text, "\n{x}, {y}, {sense_v}").unwrap();
        for current in currents_a {
            write!(text, ", {:e}", current.norm()).unwrap();
            if phases {
                write!(text, ", {}", current.arg().to_degrees()).unwrap();
            }
        }
    }
    text + "\n"
}

pub fn loads_csv(points: &[ForcePoint]) -> String {
    let mut text = String::from("load_g,haptic_v_rms,capacitance_pf,force_n\n");
    for ForcePoint { load_g, haptic_v_rms, capacitance_pf, force_n, .. } in points {
        writeln!(text, "{load_g},{haptic_v_rms},{capacitance_pf},{force_n}").unwrap();
    }
    text
}

/// Forces of a law with noise, N.
pub fn forces(k: f64, noise_n: f64, noise: &mut Noise) -> Vec<ForcePoint> {
    let mut points = Vec::new();
    for load_g in [20.0, 100.0] {
        for step in 0..8 {
            let haptic_v_rms = 50.0 * f64::from(step);
            let capacitance_pf = 320.0 + 0.5 * load_g + 0.1 * haptic_v_rms;
            let force_n =
                k * (1e-12 * capacitance_pf * haptic_v_rms).powi(2) + noise_n * noise.normal();
            points.push(ForcePoint {
                load_g,
                haptic_v_rms,
                source_v_rms: haptic_v_rms,
                capacitance_pf,
                force_n,
            });
        }
    }
    points
}

/// A lab's files in a folder.
pub struct Files<'a> {
    pub places: String,
    pub loads: String,
    pub setup: String,
    pub folder: &'a Path,
}

impl Files<'_> {
    /// Those of [`SHEET`], measured at a raster, without noise.
    pub fn new(folder: &Path) -> Files<'_> {
        let plant = plant("minimal-sheet", &SHEET);
        let measurements =
            measurements(&plant, &raster([13, 9], [140.0, 90.0]), 0.0, &mut Noise::of(1));
        Files {
            places: places_csv(&measurements, true),
            loads: loads_csv(&forces(9.6e12, 2e-3, &mut Noise::of(2))),
            setup: format!("{SETUP}{TERMINALS}"),
            folder,
        }
    }

    pub fn write(&self) {
        for (name, text) in
            [("places.csv", &self.places), ("loads.csv", &self.loads), ("device.toml", &self.setup)]
        {
            fs::write(self.folder.join(name), text).unwrap();
        }
    }

    /// Writes the files and expects a refusal that says all of `words`.
    pub fn refused(&self, words: &[&str]) {
        self.write();
        refuse(self.folder, &["calibrate", "places.csv", "loads.csv", "device.toml"], words);
    }
}
