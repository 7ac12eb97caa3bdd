// SPDX-License-Identifier: MIT OR Apache-2.0
//! The plant as its users see it: what is asked for once is the same when asked again, samples
//! agree with phasors, and an effect that the scene leaves out is not there.

use std::f64::consts::TAU;

use hapticore_scene::{Complex, Plant, Scene, Timing, gallery};

/// Terminals, channels, and the voltages' channels of the default device.
const TERMINALS: usize = 6;
const CHANNELS: usize = 8;
const SENSE: usize = 6;
const HAPTIC: usize = 7;

const BARE: &str =
    "title = \"t\"\ndwell_slots = 50\n[[pad]]\nposition_mm = [120, -60]\nhaptic_v_rms = 150\n";
const NOISY: &str = "[sheet]\n[gap]\n[sensor]\nnoise_ppm_rms = 18\nhaptic_leakage = true\ngain_mismatch_percent = 1\noffset_percent = 0.1\n";

fn timing() -> Timing {
    Timing {
        pads: 4,
        slot_samples: 500,
        window_start: 100,
        window_samples: 400,
        samples_per_period: 10.0,
        signs: None,
    }
}

fn scene(effects: &str) -> Scene {
    Scene::parse(&format!("{BARE}{effects}"), "s.toml", &[])
        .unwrap_or_else(|error| panic!("{error}"))
}

fn plant(effects: &str) -> Plant {
    Plant::new(&scene(effects), 0, &timing()).unwrap().metered()
}

fn window(plant: &mut Plant, slot: usize) -> Vec<[f64; CHANNELS]> {
    let mut samples = Vec::new();
    plant.samples(slot, 100..500, &mut samples);
    samples.as_chunks().0.to_vec()
}

/// Amplitude at `turns` turns per sample, over a whole number of periods, rectangular.
fn lock_in(rows: &[[f64; CHANNELS]], channel: usize, turns: f64) -> Complex {
    let turned = rows
        .iter()
        .enumerate()
        .map(|(n, row)| Complex::cis(-TAU * n as f64 * turns) * row[channel]);
    turned.sum::<Complex>() * (2.0 / rows.len() as f64)
}

fn evaluations(plant: &Plant) -> Vec<(&'static str, u64)> {
    plant.effects().into_iter().map(|cost| (cost.name, cost.evaluations)).collect()
}

#[test]
fn an_effect_without_a_table_is_never_evaluated() {
    let mut bare = plant("");
    let mut noisy = plant(NOISY);
    for slot in 0..10 {
        for plant in [&mut bare, &mut noisy] {
            plant.truth(slot);
            window(plant, slot);
        }
    }
    assert_eq!(evaluations(&bare), [("carrier", 10)]);
    let all = [
        "gap",
        "sheet",
        "carrier",
        "sensor.leakage",
        "sensor.gain",
        "sensor.offset",
        "sensor.noise",
    ];
    assert_eq!(evaluations(&noisy), all.map(|name| (name, 10)));
}

#[test]
fn an_override_switches_an_effect_off_and_on() {
    let set = |key: &str, value: &str| {
        let scene =
            Scene::parse(&format!("{BARE}{NOISY}"), "s.toml", &[(key.into(), value.into())])
                .unwrap();
        scene.cases[0]
            .effects()
            .into_iter()
            .map(|(name, level)| format!("{name} {level}"))
            .collect::<Vec<_>>()
            .join(", ")
    };
    assert!(
        !set("gap", "false").contains("gap")
            && !set("sensor.noise_ppm_rms", "false").contains("noise")
    );
    assert!(set("friction.rung", "coulomb").contains("friction coulomb"));
    assert!(set("sheet.rung", "analytic").contains("sheet analytic"));
}

#[test]
fn the_same_scene_gives_the_same_samples_and_another_seed_others() {
    let samples = |seed: &str| {
        let scene = Scene::parse(&format!("seed = {seed}\n{BARE}{NOISY}"), "s.toml", &[]).unwrap();
        window(&mut Plant::new(&scene, 0, &timing()).unwrap(), 7)
    };
    assert_eq!(samples("3"), samples("3"));
    assert_ne!(samples("3"), samples("4"));
}

#[test]
fn skipping_blanking_or_slots_changes_no_bit_of_a_window() {
    let (mut all, mut some) = (plant(NOISY), plant(NOISY));
    for slot in 0..8 {
        all.samples(slot, 0..100, &mut Vec::new());
        all.phasors(slot, &mut [Complex::default(); CHANNELS - 1]);
        let window_of_all = window(&mut all, slot);
        assert!(slot % 3 != 0 || window_of_all == window(&mut some, slot));
    }
}

#[test]
fn samples_are_the_phasors_in_time() {
    let mut plant = plant("[sheet]\nterminal_ohm = 500\n[sensor]\ngain_mismatch_percent = 1\n");
    let mut phasors = [Complex::default(); CHANNELS - 1];
    let haptic_mean_square = plant.phasors(3, &mut phasors);
    let rows = window(&mut plant, 3);
    for (channel, phasor) in phasors.iter().enumerate() {
        assert!((lock_in(&rows, channel, 0.1) - phasor).norm() < 1e-13);
    }
    assert!((haptic_mean_square - (150.0f64 / 600.0).powi(2)).abs() < 1e-15);
}

#[test]
fn recurrences_stay_within_1e_9_of_full_scale() {
    let mut plant = plant("");
    let rate = plant.device().sample_rate_hz;
    for (n, row) in window(&mut plant, 49).into_iter().enumerate() {
        let carrier = 5.0 / 8.0 * (TAU * (n + 100) as f64 / 10.0).cos();
        let haptic =
            150.0 * 2f64.sqrt() / 600.0 * (TAU * 1000.0 * (49 * 500 + 100 + n) as f64 / rate).sin();
        assert!((row[SENSE] - carrier).abs() < 1e-12 && (row[HAPTIC] - haptic).abs() < 1e-12);
    }
}

#[test]
fn currents_follow_equations_1_and_4() {
    let mut plant = plant("[sheet]\nterminal_ohm = 500\n");
    let (truth, device) = (plant.truth(0), plant.device());
    let mut phasors = [Complex::default(); CHANNELS - 1];
    plant.phasors(0, &mut phasors);
    let total: Complex =
        phasors[..TERMINALS].iter().map(|current| current * device.current_full_scale_a).sum();
    // docs/physics.md §2: C = (p² + q²)/(ωVq), R_p = Vp/(p² + q²), exactly
    let capacitance_pf =
        1e12 * total.norm_sqr() / (device.carrier_rad_s * device.carrier_v * total.im);
    let sheet_ohm = device.carrier_v * total.re / total.norm_sqr();
    assert!(
        (capacitance_pf - truth.capacitance_pf).abs() < 1e-9
            && (sheet_ohm - truth.sheet_ohm).abs() < 1e-8
    );
    let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(|terminal| phasors[terminal].norm());
    let all = a + b + c + d + e + f;
    let (r_x, r_y) = ((c + d - a - b) / all, (a + d + f - b - c - e) / all);
    assert!(
        (r_x - truth.r_x).abs() < 1e-12
            && (r_y - truth.r_y).abs() < 1e-12
            && r_x > 0.0
            && r_y < 0.0
    );
    let corners = [vec![-1, -1, 1, 1, 0, 0], vec![1, -1, -1, 1, 0, 0]];
    let timing = Timing { signs: Some(corners), ..timing() };
    let paper = Plant::new(&scene("[sheet]\nterminal_ohm = 500\n"), 0, &timing).unwrap().truth(0);
    let (r_x, r_y) = ((c + d - a - b) / (a + b + c + d), (a + d - b - c) / (a + b + c + d)); // eqs. 2 and 3
    assert!((r_x - paper.r_x).abs() < 1e-12 && (r_y - paper.r_y).abs() < 1e-12);
}

/// docs/physics.md §5, with V_h in V rms and V_s in V peak: f_h·V_h/(f_s·V_s).
#[test]
fn leakage_is_as_far_below_the_carrier_as_physics_says() {
    for (haptic_hz, db) in [(200.0, -17.1), (1000.0, -3.1)] {
        let text = format!("[carrier]\nhaptic_hz = {haptic_hz}\n[sensor]\nhaptic_leakage = true\n");
        let scene = Scene::parse(
            &format!("{BARE}{text}"),
            "s.toml",
            &[("pad.0.haptic_v_rms".into(), "350".into())],
        )
        .unwrap();
        let (mut plant, mut samples) = (Plant::new(&scene, 0, &timing()).unwrap(), Vec::new());
        (0..50).for_each(|slot| plant.samples(slot, 0..500, &mut samples));
        let rows: &[[f64; CHANNELS]] = samples.as_chunks().0;
        let leak_rms = lock_in(rows, 2, haptic_hz / 1e6).norm() / 2f64.sqrt();
        let measured = 20.0 * (leak_rms / lock_in(rows, 2, 0.1).norm()).log10();
        assert!((measured - db).abs() < 0.1, "{haptic_hz} Hz: {measured} dB");
    }
}

#[test]
fn noise_has_its_stated_size_in_samples_and_phasors() {
    let mut noisy = plant("[sensor]\nnoise_ppm_rms = 100\n");
    let mut quiet = plant("");
    let (mut square, mut count, mut phasor_square) = (0.0, 0.0, 0.0);
    let (mut with, mut without) =
        ([Complex::default(); CHANNELS - 1], [Complex::default(); CHANNELS - 1]);
    for slot in 0..50 {
        let (a, b) = (window(&mut noisy, slot), window(&mut quiet, slot));
        square += a
            .as_flattened()
            .iter()
            .zip(b.as_flattened())
            .map(|(a, b)| (a - b).powi(2))
            .sum::<f64>();
        count += a.as_flattened().len() as f64;
        noisy.phasors(slot, &mut with);
        quiet.phasors(slot, &mut without);
        phasor_square +=
            with.iter().zip(&without).map(|(a, b)| (a - b).norm_sqr()).sum::<f64>() / 2.0;
    }
    assert!(((square / count).sqrt() / 100e-6 - 1.0).abs() < 0.01);
    let predicted = 100e-6 * (2.0 * 1.5 / 400.0f64).sqrt();
    assert!(((phasor_square / (50.0 * 7.0)).sqrt() / predicted - 1.0).abs() < 0.1);
}

#[test]
fn quantised_samples_are_codes_half_a_step_from_the_truth_and_stop_at_full_scale() {
    let (mut exact, mut coded) = (plant(""), plant("[sensor]\nquantisation_bits = 12\n"));
    for (a, b) in
        window(&mut exact, 5).as_flattened().iter().zip(window(&mut coded, 5).as_flattened())
    {
        assert!((b * 2048.0).fract() == 0.0 && (a - b).abs() <= 0.5 / 2048.0);
    }
    let mut clipped = plant("[sensor]\nquantisation_bits = 12\nsense_full_scale_v = 2\n");
    let sense: Vec<f64> = window(&mut clipped, 0).iter().map(|row| row[SENSE]).collect();
    assert!(
        sense.contains(&-1.0)
            && sense.contains(&(2047.0 / 2048.0))
            && sense.iter().all(|s| s.abs() <= 1.0)
    );
}

#[test]
fn a_sweep_visits_every_combination_positions_first() {
    let text = "title = \"t\"\ndwell_slots = 2\n[[pad]]\nposition_mm = { raster = { nx = 3, ny = 2, margin_mm = 50 } }\n\
                load_g = { sweep = [20, 50] }\nhaptic_v_rms = { sweep = { from = 0, to = 300, points = 4 } }\n";
    let mut plant = Plant::new(&Scene::parse(text, "s.toml", &[]).unwrap(), 0, &timing()).unwrap();
    assert_eq!(plant.slots(), 3 * 2 * 2 * 4 * 2);
    let truths: Vec<_> = (0..plant.slots()).map(|slot| plant.truth(slot)).collect();
    let at = |slot: usize| {
        (
            truths[slot].x_mm,
            truths[slot].y_mm,
            truths[slot].load_g,
            truths[slot].haptic_v_rms,
            truths[slot].group,
        )
    };
    assert_eq!(at(0), (-380.0, -200.0, 20.0, 0.0, 0));
    assert_eq!(at(3), (0.0, -200.0, 20.0, 0.0, 0));
    assert_eq!(at(6), (-380.0, 200.0, 20.0, 0.0, 0));
    assert_eq!(at(12), (-380.0, -200.0, 50.0, 0.0, 1));
    assert_eq!(at(95), (380.0, 200.0, 50.0, 300.0, 7));
}

#[test]
fn pads_take_turns_and_time_runs_through_all_slots() {
    let text = "title = \"t\"\nduration_s = 0.01\n[[pad]]\nname = \"a\"\nposition_mm = [0, 0]\n\
                [[pad]]\nposition_mm = { line = { from_mm = [0, 0], to_mm = [100, 0], period_s = 0.02 } }\n";
    let mut plant = Plant::new(&Scene::parse(text, "s.toml", &[]).unwrap(), 0, &timing()).unwrap();
    assert_eq!((plant.slots(), plant.pad_names()), (20, vec!["a", "pad 1"]));
    let (still, moved) = (plant.truth(10), plant.truth(11));
    assert_eq!((still.pad, still.x_mm, moved.pad), (0, 0.0, 1));
    assert!((moved.time_s - (11.0 * 500.0 + 300.0) / 1e6).abs() < 1e-15);
    assert!((moved.x_mm - 100.0 * moved.time_s / 0.01).abs() < 1e-9);
}

#[test]
fn the_calibration_map_is_the_truth_without_mismatch_and_costs_the_run_nothing() {
    let middle = [("pad.0.position_mm".to_string(), "[0, 0]".to_string())];
    let scene = Scene::parse(&format!("{BARE}{NOISY}"), "s.toml", &middle).unwrap();
    let mut plant = Plant::new(&scene, 0, &timing()).unwrap().metered();
    let map = plant.calibration_map(3, 5, 50.0);
    assert_eq!((map.len(), map[0].x_mm, map[0].y_mm, map[5].y_mm), (15, -380.0, -200.0, -100.0));
    let (truth, here) = (plant.truth(0), &map[7]);
    assert_eq!(
        (here.x_mm, here.r_x, here.r_y, here.sheet_ohm),
        (0.0, truth.r_x, truth.r_y, truth.sheet_ohm)
    );
    assert_eq!(evaluations(&plant)[1], ("sheet", 1));
}

/// Of every scene that is bundled.
#[test]
fn samples_take_the_place_of_whatever_was_there() {
    for &(name, text) in gallery::all() {
        let set = [("carrier.rung".to_string(), "samples".to_string())];
        let scene = Scene::parse(text, name, &set).unwrap();
        let scene = scene.within_budget(&timing()).unwrap();
        let mut plant = Plant::new(&scene, 0, &timing()).unwrap();
        let slot = plant.slot(1);
        let [fresh, used] = [0.0, f64::NAN].map(|before| {
            let mut samples = vec![before; 200 * plant.channels()];
            plant.samples_of(&slot, 100..300, &mut samples);
            samples
        });
        assert_eq!(fresh, used, "{name}");
    }
}

#[test]
fn samples_are_within_full_scale_with_and_without_quantisation() {
    for bits in ["", "quantisation_bits = 12\n"] {
        let mut plant = plant(&format!("[sensor]\nnoise_ppm_rms = 900000\n{bits}"));
        let mut samples = Vec::new();
        plant.samples(0, 0..500, &mut samples);
        let most = samples.iter().fold(0.0, |most: f64, sample| most.max(sample.abs()));
        assert_eq!(most, 1.0, "{bits}");
    }
}
