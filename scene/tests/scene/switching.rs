// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pad switching: transients in closed form and integrated, each method with its exact error.

use std::f64::consts::PI;

use crate::common::{
    CHANNELS, PAD, SENSE, TERMINALS, capacitance_f, demodulate, hann, plant, scene, timing,
};
use hapticore_scene::{Complex, Plant, Timing};

/// Terminals of 1.7 kΩ give the paper's R_p of up to 500 Ω: τ is 0.16 µs.
fn with(switching: &str) -> String {
    format!("{PAD}[sheet]\nterminal_ohm = 1700\n{switching}")
}

/// Sum of the terminals' currents in the slot's first samples, as a fraction of full scale.
fn currents(switching: &str) -> Vec<f64> {
    let mut samples = Vec::new();
    plant(&with(switching)).samples(0, 0..200, &mut samples);
    samples.chunks_exact(CHANNELS).map(|row| row[..TERMINALS].iter().sum()).collect()
}

#[test]
fn the_first_current_is_all_across_the_sheet_and_the_rest_decays_with_tau() {
    let mut plant = plant(&with("[switching]\n"));
    let (device, truth) = (plant.device(), plant.truth(0));
    let (tau_s, full_scale_a) =
        (truth.sheet_ohm * truth.capacitance_pf * 1e-12, device.current_full_scale_a);
    let (settling, settled) = (currents("[switching]\n"), currents(""));
    assert!((settling[0] * full_scale_a - device.carrier_v / truth.sheet_ohm).abs() < 1e-9);
    let transient: Vec<_> = settling.iter().zip(&settled).map(|(a, b)| a - b).collect();
    let decay = (-1.0 / (device.sample_rate_hz * tau_s)).exp();
    assert!((transient[1] / transient[0] - decay).abs() < 1e-9 && decay < 3e-3);
    // docs/physics.md §5: 0.01 % in 5 µs.
    assert!(transient[5].abs() < 1e-4 * settled.iter().copied().fold(0.0, f64::max));
}

/// What the trapezoid rule takes for the carrier's frequency: tan(ωh/2)/(ωh/2) of it.
/// docs/physics.md §2 has the same percentages.
#[test]
fn trapezoids_read_a_capacitance_that_is_too_large_by_exactly_so_much() {
    for (steps, percent) in [(1, 3.4), (4, 0.21), (8, 0.051), (16, 0.013), (64, 0.0008)] {
        let angle = PI * 1e5 / (1e6 * f64::from(steps));
        let expected = 100.0 * (angle.tan() / angle - 1.0);
        assert!((expected / percent - 1.0).abs() < 0.05, "{steps}: {expected} %");
        let text = with(&format!("[switching]\nrung = \"rc-{steps}\"\n"));
        let timing = Timing { slot_samples: 1200, window_start: 1000, ..timing() };
        let mut plant = Plant::new(&scene(&text), 0, &timing).unwrap();
        let mut phasors = [Complex::default(); SENSE + 1];
        plant.phasors(0, &mut phasors);
        let truth = plant.truth(0).capacitance_pf * 1e-12;
        let measured = 100.0 * (capacitance_f(&plant, &phasors) / truth - 1.0);
        assert!(
            (measured - expected).abs() < 1e-6 + 1e-3 * expected,
            "{steps}: {measured} %, {expected} %"
        );
    }
}

#[test]
fn integrated_transients_converge_to_the_closed_form_at_their_methods_order() {
    let exact = currents("[switching]\n");
    let error = |level: &str| {
        let integrated = currents(&format!("[switching]\nrung = {level:?}\n"));
        integrated.iter().zip(&exact).skip(1).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let [eight, sixteen, sixty_four, euler] = ["rc-8", "rc-16", "rc-64", "euler-64"].map(error);
    assert!((3.0..6.0).contains(&(eight / sixteen)), "{eight} {sixteen}");
    assert!((12.0..20.0).contains(&(sixteen / sixty_four)), "{sixteen} {sixty_four}");
    assert!(euler > 20.0 * sixty_four, "{euler} {sixty_four}");
}

#[test]
fn samples_and_phasors_tell_of_the_same_transient() {
    for level in ["settling", "rc-8"] {
        let mut plant = plant(&with(&format!("[switching]\nrung = {level:?}\n")));
        let sampled = demodulate(&mut plant, 0, hann);
        let mut phasors = [Complex::default(); SENSE + 1];
        plant.phasors(0, &mut phasors);
        for (a, b) in sampled.iter().zip(phasors) {
            assert!((a - b).norm() < 1e-12, "{level}: {a} {b}");
        }
    }
}

/// τ = R_p·C is 40 ns here, so that Euler's steps of 15.6 ns are fine, and with a tenth of the
/// capacitance are not.
#[test]
fn euler_is_refused_where_a_step_is_longer_than_two_tau() {
    let text = |pf: f64| {
        format!(
            "[[pad]]\nposition_mm = [120, -60]\ncapacitance_pf = {pf}\n[sheet]\n[switching]\nrung = \"euler-64\"\n"
        )
    };
    assert!(Plant::new(&scene(&text(318.0)), 0, &timing()).is_ok());
    let error = Plant::new(&scene(&text(31.8)), 0, &timing()).map(|_| ()).unwrap_err().to_string();
    assert!(
        error.starts_with("s.toml: switching.rung: expected steps of at most 2·R_p·C = "),
        "{error}"
    );
    assert!(error.ends_with("got 15.6 ns"), "{error}");
}

#[test]
fn after_the_blanking_nothing_is_left_of_a_transient() {
    let window = |switching: &str| {
        let timing = Timing { slot_samples: 300, window_start: 100, ..timing() };
        let mut phasors = [Complex::default(); SENSE + 1];
        Plant::new(&scene(&with(switching)), 0, &timing).unwrap().phasors(0, &mut phasors);
        phasors
    };
    assert_eq!(window(""), window("[switching]\n"));
}
