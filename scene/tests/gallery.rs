// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bundled scenes load, run and stay on the sheet.

use hapticore_scene::{Plant, Scene, Timing, gallery};

fn timing() -> Timing {
    Timing { pads: 4, slot_samples: 256, window_start: 56, window_samples: 200, samples_per_period: 10.0 }
}

#[test]
fn every_bundled_scene_runs() {
    for (name, text) in gallery::all() {
        let scene = Scene::parse(text, &format!("{name}.toml"), &[]).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.name, *name);
        assert!(!scene.criteria.is_empty() && scene.figure.is_some());
        for case in 0..scene.cases.len() {
            let mut plant = Plant::new(&scene, case, &timing()).unwrap();
            let last = plant.slots() - 1;
            for slot in [0, last / 2, last] {
                let truth = plant.truth(slot);
                println!("{name} {} {truth:?}", scene.cases[case].name);
                assert!(truth.force_n.is_finite() && truth.capacitance_pf > 100.0);
                let mut samples = Vec::new();
                plant.samples(slot, 56..256, &mut samples);
                assert_eq!(samples.len(), 200 * plant.channels());
                assert!(samples.iter().all(|sample| sample.abs() < 0.99), "{name} clips");
            }
        }
    }
}
