// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bundled scenes load, run and stay on the sheet.

use hapticore_scene::{Plant, Scene, Timing, Truth, gallery};

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
                assert!(truth.force_n.is_finite() && truth.capacitance_pf > 100.0);
                let mut samples = Vec::new();
                plant.samples(slot, 56..256, &mut samples);
                assert_eq!(samples.len(), 200 * plant.channels());
                assert!(samples.iter().all(|sample| sample.abs() < 0.99), "{name} clips");
            }
        }
    }
}

fn truths(name: &str) -> Vec<Truth> {
    let scene = Scene::parse(gallery::find(name).unwrap(), name, &[]).unwrap();
    let mut plant = Plant::new(&scene, 0, &timing()).unwrap();
    (0..plant.slots()).map(|slot| plant.truth(slot)).collect()
}

#[test]
fn fig6_eq_8_holds_within_0_1_n_at_both_loads_with_one_k() {
    let points: Vec<_> =
        truths("fig6").iter().map(|t| ((t.capacitance_pf * t.haptic_v_rms * 1e-9).powi(2), t.force_n)).collect();
    let k = points.iter().map(|(square, force)| square * force).sum::<f64>()
        / points.iter().map(|(s, _)| s * s).sum::<f64>();
    let worst = points.iter().map(|(square, force)| (force - k * square).abs()).fold(0.0, f64::max);
    println!("{worst} N, k {}", k * 1e6);
    assert!(worst < 0.1, "{worst} N");
}

#[test]
fn fig4_capacitance_rises_with_load_and_with_voltage() {
    let all = truths("fig4");
    let rises = |from: &Truth, to: &Truth| {
        let higher = (from.load_g < to.load_g && from.haptic_v_rms == to.haptic_v_rms)
            || (from.load_g == to.load_g && from.haptic_v_rms < to.haptic_v_rms);
        !higher || from.capacitance_pf < to.capacitance_pf
    };
    assert!(all.iter().all(|from| all.iter().all(|to| rises(from, to))));
}
