// SPDX-License-Identifier: MIT OR Apache-2.0
//! Friction that lets go late, and a coefficient of friction that drifts.

use crate::common::{assert_near, scene, standard_timing};
use hapticore_scene::{Plant, Truth};

fn plant(text: &str) -> Plant {
    Plant::new(&scene(text), 0, &standard_timing()).unwrap_or_else(|error| panic!("{error}"))
}

fn truths(text: &str) -> Vec<Truth> {
    let mut plant = plant(text);
    (0..plant.slots()).map(|slot| plant.truth(slot)).collect()
}

const PAD: &str = "[[pad]]\nposition_mm = [0, 0]\nload_g = 50\n";
const COULOMB: &str = "[friction]\nrung = \"coulomb\"\n";

fn force_n(volt: f64) -> f64 {
    plant(PAD).device().force_k * (318e-12 * volt).powi(2)
}

/// Steps up, down by half, up again before that is let go, and off, at times that are no multiples
/// of a step.
#[test]
fn a_force_falls_with_the_time_constant_and_rises_at_once() {
    const STEPS: [[f64; 2]; 5] =
        [[0.0, 0.0], [0.01003, 300.0], [0.03337, 200.0], [0.03441, 260.0], [0.06219, 0.0]];
    let points: Vec<_> =
        STEPS.windows(2).flat_map(|pair| [[pair[1][0], pair[0][1]], pair[1]]).collect();
    for (time_ms, written) in [(0.15, ""), (3.0, "time_constant_ms = 3\n")] {
        let see = |slot_us: usize| {
            let text = format!(
                "duration_s = 0.08\n{PAD}haptic_v_rms = {{ timeline = {points:?} }}\n{COULOMB}[release]\n{written}"
            );
            let timing = hapticore_scene::Timing {
                slot_samples: slot_us,
                window_start: 0,
                window_samples: slot_us,
                ..standard_timing()
            };
            let mut plant = Plant::new(&scene(&text), 0, &timing).unwrap();
            (0..plant.slots()).map(|slot| plant.truth(slot)).collect::<Vec<_>>()
        };
        for truth in see(170).into_iter().chain(see(1700)) {
            let mut held_n = 0.0f64;
            for (n, [on_s, volt]) in STEPS.into_iter().enumerate() {
                let until_s = STEPS.get(n + 1).map_or(f64::INFINITY, |next| next[0]);
                if on_s <= truth.time_s {
                    let span_s = until_s.min(truth.time_s) - on_s;
                    let left_n = (held_n - force_n(volt)).max(0.0);
                    held_n = force_n(volt) + left_n * (-1e3 * span_s / time_ms).exp();
                }
            }
            assert!(
                (truth.force_n - held_n).abs() < 1e-9 * force_n(300.0),
                "{} s: {} N, {held_n} N",
                truth.time_s,
                truth.force_n
            );
            let load_n = 0.12 * 0.05 * 9.80665;
            assert!((truth.friction_n - load_n - held_n).abs() < 1e-9);
        }
    }
}

/// The 90 % fall that Rauf and Follmer read on a load cell of 18,018 N/m with 4.3 g on it (docs/physics.md §7), and what it
/// reads of a force that vanishes immediately.
#[test]
fn a_load_cell_reads_the_release_that_was_measured() {
    const STEP_S: f64 = 1e-6;
    let falls_ms = |time_constant_ms: f64| {
        let left = |time_s: f64| (-1e3 * time_s / time_constant_ms).exp();
        let square = 18_018.0 / 4.3e-3;
        let (mut read, mut speed, mut time_s) = (1.0, 0.0, 0.0);
        while read > 0.1 {
            speed += STEP_S * square * (left(time_s) - read);
            read += STEP_S * speed;
            time_s += STEP_S;
        }
        1e3 * time_s
    };
    let text = format!(
        "duration_s = 0.1\n{PAD}haptic_v_rms = {{ timeline = [[0.05, 300], [0.05, 0]] }}\n{COULOMB}[release]\n"
    );
    let after = truths(&text).into_iter().find(|truth| truth.time_s > 0.05).unwrap();
    let time_constant_ms = 1e3 * (after.time_s - 0.05) / (force_n(300.0) / after.force_n).ln();
    let read_ms = falls_ms(time_constant_ms);
    assert!((read_ms - 0.85).abs() < 0.05, "{time_constant_ms} ms: {read_ms} ms");
    assert!(falls_ms(1e-6) < 0.75, "the cell itself");
}

/// A gap that opens: half a step late at most.
#[test]
fn a_gap_that_opens_is_followed_to_the_first_order_of_the_step() {
    let see = |release: &str| {
        truths(&format!(
            "duration_s = 0.15\n{PAD}haptic_v_rms = {{ timeline = [[0, 350], [0.1034, 350], [0.1134, 0]] }}\n\
             {COULOMB}[gap]\nrung = \"tr-bdf2\"\nstep_us = 10\n{release}"
        ))
    };
    let step = |us: u32| see(&format!("[release]\ntime_constant_ms = 3\nstep_us = {us}\n"));
    let off = |a: &[Truth], b: &[Truth]| {
        a.iter().zip(b).map(|(a, b)| (a.force_n - b.force_n).abs()).fold(0.0, f64::max)
    };
    let exact = step(1);
    let [coarse, fine] = [off(&step(100), &exact), off(&step(50), &exact)];
    let late = off(&see(""), &exact);
    println!("{coarse:.5} N at 100 µs, {fine:.5} N at 50 µs, of {late:.4} N that are held");
    assert!(fine < 0.6 * coarse && coarse < 0.02 * late && late > 0.05);
}

#[test]
fn the_truth_has_a_coefficient_that_drifts_and_the_calibration_the_nominal_one() {
    let scene = |friction: &str| {
        format!("duration_s = 0.2\n{PAD}haptic_v_rms = 300\n[gap]\n[friction]\n{friction}")
    };
    let drift = "drift = { timeline = [[0.05, 1], [0.1, 1.2], [0.15, 1.2], [0.15, 0.7]] }\n";
    let factor = |time_s: f64| match time_s {
        t if t < 0.05 => 1.0,
        t if t < 0.1 => 1.0 + 0.2 * (t - 0.05) / 0.05,
        t if t < 0.15 => 1.2,
        _ => 0.7,
    };
    for rung in ["coulomb", "stiction", "lugre"] {
        let rung = format!("rung = \"{rung}\"\n");
        let (steady, drifting) = (truths(&scene(&rung)), truths(&scene(&format!("{rung}{drift}"))));
        for (steady, drifting) in steady.iter().zip(&drifting) {
            let factor = factor(steady.time_s);
            assert_near(&rung, drifting.force_n, steady.force_n * factor, 1e-12);
            if rung.contains("coulomb") {
                assert_near(&rung, drifting.friction_n, steady.friction_n * factor, 1e-12);
            }
        }
        let points = |text: &str| plant(text).friction_calibration(&[20.0, 50.0], &[100.0, 300.0]);
        assert_eq!(points(&scene(&rung)), points(&scene(&format!("{rung}{drift}"))));
        assert_eq!(plant(&scene(&format!("{rung}{drift}"))).device().mu, 0.12);
        let bits = |text: &str| {
            truths(text)
                .iter()
                .map(|t| [t.force_n, t.friction_n].map(f64::to_bits))
                .collect::<Vec<_>>()
        };
        assert!(bits(&scene(&rung)) == bits(&scene(&format!("{rung}drift = 1\n"))));
    }
}

/// ± 20 % of μ is ± 0.14 N at 0.7 N (docs/physics.md §4).
#[test]
fn a_fifth_of_the_coefficient_is_0_14_n_at_0_7_n() {
    let see = |drift: f64| {
        truths(&format!(
            "{PAD}haptic_v_rms = 420\n[gap]\n[friction]\nrung = \"coulomb\"\ndrift = {drift}\n"
        ))[0]
            .force_n
    };
    let nominal = see(1.0);
    println!("{nominal} N");
    assert!((nominal - 0.7).abs() < 0.05);
    assert_near("more", see(1.2) - nominal, 0.2 * nominal, 1e-9);
}

/// A pad that 1 N pushes against friction which ends 50 µs later is slower by what it braked.
#[test]
fn a_step_of_the_coefficient_is_met_exactly() {
    let speed_mm_s = |off_s: f64| {
        let truths = truths(&format!(
            "duration_s = 0.1\n[[pad]]\nposition_mm = [0, 0]\nload_g = 50\npush_x_n = 1\n\
             [hand]\nstiffness_n_per_m = 0\ndamping_n_s_per_m = 0\n\
             [friction]\nrung = \"stiction\"\nstiction = 1\ndrift = {{ timeline = [[0, 1], [{off_s}, 1], [{off_s}, 0]] }}\n"
        ));
        let [first, .., last] = &truths[10..] else { panic!("slots") };
        (last.x_mm - first.x_mm) / (last.time_s - first.time_s)
    };
    let braked = speed_mm_s(0.003) - speed_mm_s(0.00305);
    assert_near("speed", braked, 1e3 * 0.12 * 0.05 * 9.80665 * 50e-6 / 0.05, 1e-3);
}
