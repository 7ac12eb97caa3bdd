// SPDX-License-Identifier: MIT OR Apache-2.0
//! The paper's Fig. 7 by the plant alone: 50 g, 350 V behind the limiting resistor, two jumps. The values were
//! integrated apart (docs/physics.md §3).

use hapticore_scene::{Plant, Timing, Truth};

use crate::common::scene;

/// A period of the haptic voltage, so that each slot meets the sine at the same phase.
const SLOT_S: f64 = 5e-3;

/// Slots whose window is so short that the truth in its middle is the slot's start.
fn timing() -> Timing {
    Timing {
        pads: 1,
        slot_samples: 5000,
        window_start: 0,
        window_samples: 2,
        samples_per_period: 10.0,
        signs: None,
    }
}

/// Every 5 ms from 0 on; off after `off_s`.
fn truths(drive: &str, volt: f64, off_s: f64, until_s: f64) -> Vec<Truth> {
    let text = format!(
        "duration_s = {until_s}\n[[pad]]\nposition_mm = [0, 0]\nload_g = 50\n\
         haptic_v_rms = {{ timeline = [[0, {volt}], [{off_s}, {volt}], [{off_s}, 0]] }}\n[supply]\n\
         [carrier]\nhaptic_hz = 200\n[friction]\n[gap]\nrung = \"tr-bdf2\"\ndrive = \"{drive}\"\n"
    );
    let mut plant = Plant::new(&scene(&text), 0, &timing()).expect("a plant");
    (0..plant.slots()).map(|slot| plant.truth(slot)).collect()
}

/// When the capacitance rises fastest between two times: where a parabola through three rises is highest.
fn jump_s(truths: &[Truth], [from_s, to_s]: [f64; 2]) -> f64 {
    let slot = |time_s: f64| (time_s / SLOT_S).round() as usize;
    let rise = |n: usize| truths[n + 1].capacitance_pf - truths[n].capacitance_pf;
    let steepest = (slot(from_s)..slot(to_s)).max_by(|a, b| rise(*a).total_cmp(&rise(*b)));
    let n = steepest.expect("slots");
    let [before, now, after] = [rise(n - 1), rise(n), rise(n + 1)];
    (n as f64 + 0.5 + 0.5 * (after - before) / (2.0 * now - before - after)) * SLOT_S
}

fn jumps_s(truths: &[Truth]) -> [f64; 2] {
    [[0.5, 1.9], [1.9, 3.4]].map(|between_s| jump_s(truths, between_s))
}

#[test]
fn voltage_capacitance_and_force_creep_and_jump_as_integrated_apart() {
    let truths = truths("rms", 350.0, 4.5, 7.1);
    for (time_s, volt, picofarad, newton) in [
        (0.005, 344.507, 375.57, 0.2132),
        (0.02, 343.184, 431.30, 0.2687),
        (0.2, 342.811, 446.07, 0.2855),
        (0.9, 342.492, 458.47, 0.2977),
        (1.1, 341.610, 491.50, 0.3269),
        (2.0, 341.340, 501.28, 0.3382),
        (2.7, 341.132, 508.77, 0.3453),
        (2.9, 340.228, 540.30, 0.3725),
        (4.4, 339.984, 548.60, 0.3832),
    ] {
        let truth = &truths[(time_s / SLOT_S).round() as usize];
        for (got, expected) in
            [(truth.haptic_v_rms, volt), (truth.capacitance_pf, picofarad), (truth.force_n, newton)]
        {
            assert!((got / expected - 1.0).abs() < 5e-3, "{time_s} s: {got}, expected {expected}");
        }
    }
    let jumps_s = jumps_s(&truths);
    println!("jumps at {jumps_s:.3?} s");
    for (jump_s, expected_s) in jumps_s.into_iter().zip([1.0, 2.8]) {
        assert!((jump_s - expected_s).abs() < 0.01, "{jump_s} s, expected {expected_s} s");
    }
    for (after_s, picofarad) in [(0.1, 456.0), (2.5, 377.0)] {
        let truth = &truths[((4.5 + after_s) / SLOT_S).round() as usize];
        assert!((truth.capacitance_pf - picofarad).abs() < 0.5, "{} pF", truth.capacitance_pf);
        assert_eq!(truth.force_n, 0.0);
    }
}

/// One set of heights serves both drives, and 0.1 % of voltage moves the jumps by hundredths of a second.
#[test]
fn a_sine_and_a_thousandth_of_voltage_move_the_jumps_by_hundredths_of_a_second() {
    let of = |drive: &str, volt: f64| jumps_s(&truths(drive, volt, 3.5, 3.5));
    let usual = of("rms", 350.0);
    let moved = |drive: &str, volt: f64| {
        let jumps = of(drive, volt);
        [jumps[0] - usual[0], jumps[1] - usual[1]]
    };
    for (drive, volt, expected_s) in [
        ("rms", 350.35, [-0.018, -0.040]),
        ("rms", 349.65, [0.018, 0.040]),
        ("sine", 350.0, [-0.01, -0.03]),
    ] {
        let moved_s = moved(drive, volt);
        println!("{drive}, {volt} V: {moved_s:.4?} s");
        for (moved_s, expected_s) in moved_s.into_iter().zip(expected_s) {
            assert!((moved_s - expected_s).abs() < 0.006, "{drive}, {volt} V: {moved_s} s");
        }
    }
}
