// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bundled scenes load, run and stay on the sheet.

use std::collections::BTreeMap;

use hapticore_scene::{Complex, Measure, Plant, Scene, Timing, Truth, gallery};

/// Terminals of the bundled scenes' devices.
const TERMINALS: usize = 6;

fn timing() -> Timing {
    Timing {
        pads: 4,
        slot_samples: 1700,
        window_start: 700,
        window_samples: 1000,
        samples_per_period: 10.0,
        signs: None,
    }
}

#[test]
fn every_bundled_scene_runs() {
    for (name, text) in gallery::all() {
        let scene = Scene::parse(text, &format!("{name}.toml"), &[])
            .unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.name, *name);
        assert!(!scene.criteria.is_empty());
        let scene = scene.within_budget(&timing()).unwrap();
        for case in 0..scene.cases.len() {
            let mut plant = Plant::new(&scene, case, &timing()).unwrap();
            let last = plant.slots() - 1;
            for slot in [0, last / 2, last] {
                let truth = plant.truth(slot);
                assert!(truth.force_n.is_finite() && truth.capacitance_pf > 30.0);
                let mut samples = Vec::new();
                plant.samples(slot, 700..1700, &mut samples);
                assert_eq!(samples.len(), 1000 * plant.channels());
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

/// docs/physics.md §3: eq. 8 within 0.025 N to 350 V; the paper: within 0.1 N for 20 g and 100 g
/// with one k.
#[test]
fn fig6_eq_8_holds_at_both_loads_with_one_k_from_a_friction_calibration() {
    let scene = Scene::parse(gallery::find("fig6").unwrap(), "fig6", &[]).unwrap();
    let mut plant = Plant::new(&scene, 0, &timing()).unwrap();
    let volts: Vec<f64> = (0..=35).map(|step| 10.0 * f64::from(step)).collect();
    let calibration = plant.friction_calibration(&[20.0, 100.0], &volts);
    let square = |capacitance_pf: f64, volt: f64| (capacitance_pf * 1e-12 * volt).powi(2);
    let pairs = || {
        calibration
            .iter()
            .map(|point| (square(point.capacitance_pf, point.haptic_v_rms), point.force_n))
    };
    let k =
        pairs().map(|(s, force)| s * force).sum::<f64>() / pairs().map(|(s, _)| s * s).sum::<f64>();
    for slot in 0..plant.slots() {
        let truth = plant.truth(slot);
        let error = truth.force_n - k * square(truth.capacitance_pf, truth.haptic_v_rms);
        assert!(error.abs() < 0.026, "{error} N at {truth:?}");
    }
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

/// Force by eq. 8 with the exact inversion of docs/physics.md §2, C = |I|²/(ωVq), from what the
/// plant's sensors show.
fn ideal_force(plant: &mut Plant, slot: usize) -> f64 {
    let device = plant.device();
    let mut phasors = [Complex::default(); TERMINALS + 1];
    let haptic_square = plant.phasors(slot, &mut phasors) * device.haptic_full_scale_v.powi(2);
    let total: Complex =
        phasors[..TERMINALS].iter().map(|current| current * device.current_full_scale_a).sum();
    let volt = phasors[TERMINALS].re * device.sense_full_scale_v;
    let capacitance_f = total.norm_sqr() / (device.carrier_rad_s * volt * total.im);
    device.force_k * capacitance_f.powi(2) * haptic_square
}

#[test]
fn fig3_leaves_an_ideal_core_a_force_spread_below_a_third_of_the_tightest_criterion() {
    let scene = Scene::parse(gallery::find("fig3").unwrap(), "fig3", &[]).unwrap();
    let tightest = scene
        .criteria
        .iter()
        .filter(|c| c.of.name() == "force_n" && c.measure == Measure::SpreadPercent)
        .map(|c| c.limit)
        .fold(f64::MAX, f64::min);
    for case in 0..scene.cases.len() {
        let (mut plant, mut groups) =
            (Plant::new(&scene, case, &timing()).unwrap(), BTreeMap::<usize, Vec<f64>>::new());
        for slot in 0..plant.slots() {
            let group = plant.truth(slot).group;
            groups.entry(group).or_default().push(ideal_force(&mut plant, slot));
        }
        for forces in groups.values() {
            let (least, most) =
                forces.iter().fold((f64::MAX, f64::MIN), |(l, m), f| (l.min(*f), m.max(*f)));
            let spread_percent = 200.0 * (most - least) / (most + least);
            assert!(
                spread_percent < tightest / 3.0,
                "{}: {spread_percent} %",
                scene.cases[case].name
            );
        }
    }
}
