// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sensor chain against the check values of docs/physics.md §5, over windows of 200 µs.

use crate::common::{
    CHANNELS, PAD, SENSE, TERMINALS, assert_near, capacitance_f, demodulate, deviation_percent,
    force_noise_percent, hann, plant, rectangle,
};
use hapticore_scene::{Complex, Plant};

const SLOTS: usize = 400;

/// The haptic voltage's own current: 200 Hz at 350 V, into sensors that the currents nearly fill.
const LEAK: &str =
    "current_full_scale_ma = 0.5\nhaptic_leakage = true\n[carrier]\nhaptic_hz = 200\n";

/// A pad on a sheet, with these keys of `[sensor]`, and tables after them.
fn with(sensor: &str) -> String {
    let pad = PAD.replace("haptic_v_rms = 150", "haptic_v_rms = 350");
    format!("{pad}[sheet]\n[sensor]\n{sensor}")
}

fn total(phasors: &[Complex]) -> Complex {
    phasors[..TERMINALS].iter().sum()
}

/// The prototype has 0.031 and 1.6e-5 % at an unknown voltage (docs/physics.md §5); 0.106 and
/// 2.8e-4 % were measured here, and the limits hold that.
#[test]
fn a_hann_window_keeps_out_what_a_rectangular_one_lets_in() {
    let spread = |window| force_noise_percent(&mut plant(&with(LEAK)), SLOTS, window);
    assert_near("rectangle", spread(rectangle), 0.106, 0.02);
    assert_near("Hann", spread(hann), 2.8e-4, 0.02);
}

/// The prototype's percentages (docs/physics.md §5); the lower limit, a tenth of them, was set
/// after measuring.
#[test]
fn codes_dithered_by_the_leakage_cost_less_than_physics_allows() {
    for (bits, percent) in [(8, 0.28), (10, 0.074), (12, 0.005), (14, 0.002), (16, 0.0006)] {
        let codes = format!("quantisation_bits = {bits}\n{LEAK}");
        let noise = force_noise_percent(&mut plant(&with(&codes)), SLOTS, hann);
        assert!(noise < percent && noise > percent / 10.0, "{bits} bits: {noise} %");
    }
}

/// Mean of the force's error over slots, percent.
fn bias_percent(plant: &mut Plant) -> f64 {
    let exact = plant.truth(0).capacitance_pf * 1e-12;
    let error = |slot| {
        let phasors = demodulate(plant, slot, hann);
        100.0 * ((capacitance_f(plant, &phasors) / exact).powi(2) - 1.0)
    };
    (0..SLOTS).map(error).sum::<f64>() / SLOTS as f64
}

/// The prototype has 0.27 % at 10 bits, 0.015 % at 12 (docs/physics.md §5). 0.14 and −0.054 % were
/// measured here, then the limits set.
#[test]
fn without_dither_ten_samples_a_cycle_leave_a_bias_that_only_dither_averages_out() {
    for bits in [10, 12] {
        let bias = |dither: &str| {
            bias_percent(&mut plant(&with(&format!("{dither}quantisation_bits = {bits}\n"))))
        };
        let (bare, dithered) = (bias(""), bias("dither_lsb_rms = 0.5\n"));
        println!("{bits} bits: {bare} %, dithered {dithered} %");
        assert!(
            bare.abs() > 0.05 && dithered.abs() < bare.abs() / 3.0,
            "{bits} bits: {bare} %, dithered {dithered} %"
        );
    }
}

/// The 0.0037 % of docs/physics.md §5 is the amplitude's. A force is the square of current over
/// voltage, both of which the clock moves.
#[test]
fn a_nanosecond_of_jitter_costs_37_ppm_of_the_amplitude() {
    let mut plant = plant(&with("jitter_ns_rms = 1\n"));
    let sampled: Vec<_> =
        (0..SLOTS).map(|slot| total(&demodulate(&mut plant, slot, hann)).norm()).collect();
    assert_near("sampled", deviation_percent(&sampled), 0.0037, 0.1);
    let mut phasors = [Complex::default(); SENSE + 1];
    let mut amplitude = |slot| {
        plant.phasors(slot, &mut phasors);
        total(&phasors).norm()
    };
    let direct: Vec<_> = (0..SLOTS).map(&mut amplitude).collect();
    assert_near("phasors", deviation_percent(&direct), 0.0037, 0.1);
    assert_near("force", force_noise_percent(&mut plant, SLOTS, hann), 4.0 * 0.0037, 0.1);
}

/// δF/F = 2n·√(6·NENBW/T)/|I|
#[test]
fn white_noise_costs_what_the_formula_says() {
    let mut plant = plant(&with("noise_density_na_per_rthz = 10\n"));
    let amperes =
        total(&demodulate(&mut plant, 0, hann)).norm() * plant.device().current_full_scale_a;
    let percent = 100.0 * 2.0 * 10e-9 * (6.0 * 1.5 / 200e-6f64).sqrt() / amperes;
    assert_near("force", force_noise_percent(&mut plant, SLOTS, hann), percent, 0.08);
}

/// The prototype has 0.31 % rms for one draw of a 1 % mismatch (docs/physics.md §5); over 40 draws
/// 0.35 % was measured, which the limit holds.
#[test]
fn a_mismatch_of_one_percent_costs_a_third_of_a_percent_of_force_over_the_map() {
    let map = "[[pad]]\nposition_mm = { raster = { nx = 41, ny = 25, margin_mm = 20 } }\n[sheet]\n[sensor]\n";
    let spread = |seed: u64| {
        let mut plant = plant(&format!("seed = {seed}\n{map}gain_mismatch_percent = 1\n"));
        let mut phasors = [Complex::default(); SENSE + 1];
        let mut force = |slot| {
            plant.phasors(slot, &mut phasors);
            capacitance_f(&plant, &phasors).powi(2)
        };
        deviation_percent(&(0..41 * 25).map(&mut force).collect::<Vec<_>>())
    };
    let mean = (0..40).map(spread).sum::<f64>() / 40.0;
    assert_near("force", mean, 0.35, 0.01);
}

/// Amplitudes of the first slot, from phasors, with and without some keys.
fn amplitudes(sensor: &str) -> [Complex; SENSE + 1] {
    let mut phasors = [Complex::default(); SENSE + 1];
    plant(&with(sensor)).phasors(0, &mut phasors);
    phasors
}

#[test]
fn bandwidth_gain_and_crosstalk_change_amplitudes_as_they_say() {
    let bare = amplitudes("");
    let near = |a: Complex, b: Complex| assert!((a - b).norm() < 1e-12, "{a} {b}");
    for n in 0..TERMINALS {
        near(amplitudes("bandwidth_khz = 300\n")[n], bare[n] / Complex::new(1.0, 1.0 / 3.0));
        near(amplitudes("gain_error_percent = -2\n")[n], bare[n] * 0.98);
        let neighbours = if n > 0 { bare[n - 1] } else { Complex::default() };
        let neighbours =
            neighbours + if n + 1 < TERMINALS { bare[n + 1] } else { Complex::default() };
        near(amplitudes("crosstalk_percent = 0.5\n")[n], bare[n] + neighbours * 0.005);
    }
    for sensor in
        ["bandwidth_khz = 300\n", "gain_error_percent = -2\n", "crosstalk_percent = 0.5\n"]
    {
        near(amplitudes(sensor)[SENSE], bare[SENSE]);
    }
}

#[test]
fn samples_carry_the_same_amplitudes_as_phasors() {
    for sensor in
        ["bandwidth_khz = 300\n", "gain_error_percent = -2\n", "crosstalk_percent = 0.5\n"]
    {
        let sampled = demodulate(&mut plant(&with(sensor)), 0, hann);
        let pairs = sampled.into_iter().zip(amplitudes(sensor));
        assert!(pairs.into_iter().all(|(a, b)| (a - b).norm() < 1e-12), "{sensor}");
    }
}

#[test]
fn noises_are_independent_of_each_other() {
    let first = |sensor: &str| {
        let mut samples = Vec::new();
        plant(&with(sensor)).samples(0, 0..200, &mut samples);
        samples.as_chunks::<CHANNELS>().0.iter().map(|row| row[0]).collect::<Vec<_>>()
    };
    let bare = first("");
    let noise =
        |sensor: &str| first(sensor).iter().zip(&bare).map(|(a, b)| a - b).collect::<Vec<_>>();
    let adc = noise("noise_ppm_rms = 100\n");
    let jitter = noise("jitter_ns_rms = 100\n");
    let amplifier = noise("noise_density_na_per_rthz = 10\n");
    for (a, b) in [(&adc, &jitter), (&adc, &amplifier), (&jitter, &amplifier)] {
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let correlation = product(a, b) / (product(a, a) * product(b, b)).sqrt();
        assert!(correlation.abs() < 0.25, "{correlation}");
    }
}

/// docs/physics.md §7, in full scales on one terminal: 0.25 of the pad's own haptic current, 0.87 of
/// the others', and 0.25 of the carrier. That is too much for the ADC, where the pad alone is well
/// within.
#[test]
fn haptic_currents_of_four_pads_in_a_corner_clip() {
    let pads: String = [[-415, 235], [-375, 235], [-415, 195], [-375, 195]]
        .map(|[x, y]| {
            format!("[[pad]]\nposition_mm = [{x}, {y}]\nhaptic_v_rms = 350\ncapacitance_pf = 760\n")
        })
        .concat();
    let peak = |sensor: &str| {
        let text = format!(
            "dwell_slots = 20\n{pads}[sheet]\n[sensor]\ncurrent_full_scale_ma = 4\n{sensor}"
        );
        let mut plant =
            Plant::new(&crate::common::scene(&text), 0, &crate::common::timing()).unwrap();
        let mut samples = Vec::new();
        (0..20).for_each(|round| plant.samples(4 * round + 1, 0..200, &mut samples));
        samples.chunks_exact(CHANNELS).map(|row| row[0].abs()).fold(0.0, f64::max)
    };
    let carrier = peak("");
    let own = peak("haptic_leakage = true\n") - carrier;
    let all = peak("haptic_leakage = true\nhaptic_leakage_of_others = true\n");
    println!("carrier {carrier:.3}, own {own:.3}, with all {all:.3} of full scale");
    assert_near("carrier", carrier, 0.25, 0.1);
    assert_near("own", own, 0.25, 0.1);
    assert_eq!(all, 1.0, "clipped");
    let one =
        "haptic_leakage = true\nhaptic_leakage_of_others = true\n[carrier]\nhaptic_hz = 100\n";
    let tenth = peak(one) - carrier;
    println!("a tenth of the haptic currents {tenth:.4}");
    assert_near("all haptic currents at a tenth of the frequency", tenth, 0.112, 0.1);
}

/// docs/physics.md §7: behind a pole at 300 kHz noise sampled at 1 MS/s has a lag-1 correlation of
/// 0.15, and 18 % more of it at the carrier.
#[test]
fn noise_of_sensors_with_a_pole_is_coloured() {
    let noisy = |bandwidth: &str| {
        plant(&format!(
            "dwell_slots = 2000\n[[pad]]\nposition_mm = [120, -60]\n[sheet]\n[sensor]\n\
             noise_density_na_per_rthz = 100\n{bandwidth}"
        ))
    };
    let (mut white, mut coloured) = (noisy(""), noisy("bandwidth_khz = 300\n"));
    let variance = |plant: &mut Plant| {
        let found: Vec<Complex> = (0..2000)
            .flat_map(|slot| demodulate(plant, slot, hann)[..TERMINALS].to_vec())
            .collect();
        let mean = |terminal: usize| {
            found.iter().skip(terminal).step_by(TERMINALS).sum::<Complex>() / 2000.0
        };
        let means: Vec<Complex> = (0..TERMINALS).map(mean).collect();
        let off =
            found.iter().enumerate().map(|(n, phasor)| (phasor - means[n % TERMINALS]).norm_sqr());
        off.sum::<f64>() / found.len() as f64
    };
    assert_near(
        "density at the carrier",
        variance(&mut coloured) / variance(&mut white),
        1.184,
        0.03,
    );
    let phasors = |plant: &mut Plant| {
        let amplitude = |slot| {
            let mut found = [Complex::default(); SENSE + 1];
            plant.phasors(slot, &mut found);
            found[0]
        };
        let all: Vec<Complex> = (0..2000).map(amplitude).collect();
        let mean = all.iter().sum::<Complex>() / 2000.0;
        all.iter().map(|one| (one - mean).norm_sqr()).sum::<f64>()
    };
    let ratio = phasors(&mut coloured) / phasors(&mut white);
    assert_near("the same of amplitudes", ratio, 1.184, 0.05);
}

/// docs/physics.md §7: 3.5 % of force between 318 and 760 pF.
#[test]
fn an_inductance_before_the_pad_makes_a_large_capacitance_larger() {
    let force = |sensor: &str, pf: f64| {
        let text = format!(
            "[[pad]]\nposition_mm = [0, 0]\ncapacitance_pf = {pf}\n[sheet]\n[sensor]\n{sensor}"
        );
        let mut phasors = [Complex::default(); SENSE + 1];
        plant(&text).phasors(0, &mut phasors);
        total(&phasors).norm_sqr()
    };
    let more = |pf| force("series_inductance_mh = 0.1\n", pf) / force("", pf);
    assert_near("from 318 to 760 pF", 100.0 * (more(760.0) / more(318.0) - 1.0), 3.5, 0.05);
}
