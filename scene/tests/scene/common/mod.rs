// SPDX-License-Identifier: MIT OR Apache-2.0
//! What several tests share: scenes of one pad, an ideal demodulator and the exact inversion of
//! docs/physics.md §2.

pub mod every;
pub mod ode;

use std::f64::consts::TAU;

use hapticore_scene::{Complex, Plant, Scene, Timing, Truth};

/// Terminals, channels, and the voltages' channels of the default device.
pub const TERMINALS: usize = 6;
pub const CHANNELS: usize = 8;
pub const SENSE: usize = 6;

/// A window of 200 µs, 20 periods of the carrier, from the slot's first sample on.
pub fn timing() -> Timing {
    Timing {
        pads: 4,
        slot_samples: 200,
        window_start: 0,
        window_samples: 200,
        samples_per_period: 10.0,
        signs: None,
    }
}

/// Slots of 1.7 ms, as profile `standard` has them: the window's middle is 1.2 ms after the start.
pub fn standard_timing() -> Timing {
    Timing { pads: 16, slot_samples: 1700, window_start: 700, window_samples: 1000, ..timing() }
}

pub fn scene(text: &str) -> Scene {
    Scene::parse(&format!("title = \"t\"\n{text}"), "s.toml", &[])
        .unwrap_or_else(|error| panic!("{error}"))
}

pub fn plant(text: &str) -> Plant {
    Plant::new(&scene(text), 0, &timing()).unwrap_or_else(|error| panic!("{error}")).metered()
}

/// All that a slot gives: the truth, the haptic voltage's mean square, amplitudes and samples.
#[derive(Debug, PartialEq)]
pub struct Seen(pub Truth, pub f64, pub [Complex; SENSE + 1], pub Vec<f64>);

pub fn see(plant: &mut Plant, slot: usize) -> Seen {
    let (mut phasors, mut samples) = ([Complex::default(); SENSE + 1], Vec::new());
    let truth = plant.truth(slot);
    let mean_square = plant.phasors(slot, &mut phasors);
    plant.samples(slot, 0..timing().window_samples, &mut samples);
    assert_eq!(samples.len(), timing().window_samples * CHANNELS);
    Seen(truth, mean_square, phasors, samples)
}

/// A pad of 318 pF that stays for 400 slots.
pub const PAD: &str = "dwell_slots = 400\n[[pad]]\nposition_mm = [120, -60]\nhaptic_v_rms = 150\n";

/// A window's weights, their sum one.
pub type Window = fn(usize, usize) -> f64;

pub fn hann(n: usize, of: usize) -> f64 {
    (1.0 - (TAU * n as f64 / of as f64).cos()) / of as f64
}

pub fn rectangle(_: usize, of: usize) -> f64 {
    1.0 / of as f64
}

/// Amplitudes of the terminals and the sensing voltage, from the samples of a slot's window.
pub fn demodulate(plant: &mut Plant, slot: usize, window: Window) -> Vec<Complex> {
    let (mut samples, timing) = (Vec::new(), timing());
    plant.samples(slot, 0..timing.window_samples, &mut samples);
    let mut phasors = vec![Complex::default(); plant.channels() - 1];
    for (n, row) in samples.chunks_exact(plant.channels()).enumerate() {
        let turned = Complex::cis(-TAU * n as f64 / timing.samples_per_period);
        let window = turned * (2.0 * window(n, timing.window_samples));
        phasors.iter_mut().zip(row).for_each(|(phasor, sample)| *phasor += window * sample);
    }
    phasors
}

/// C = |I|²/(ω·Im(I·V*)), the I/Q inversion of docs/physics.md §2 for any phase of V, in F.
pub fn capacitance_f(plant: &Plant, phasors: &[Complex]) -> f64 {
    let device = plant.device();
    let total: Complex =
        phasors[..TERMINALS].iter().map(|current| current * device.current_full_scale_a).sum();
    let volt = phasors[SENSE] * device.sense_full_scale_v;
    total.norm_sqr() / (device.carrier_rad_s * (total * volt.conj()).im)
}

/// Standard deviation of the force in percent of its mean, over `slots` slots; force goes with C².
pub fn force_noise_percent(plant: &mut Plant, slots: usize, window: Window) -> f64 {
    let forces: Vec<f64> = (0..slots)
        .map(|slot| {
            let phasors = demodulate(plant, slot, window);
            capacitance_f(plant, &phasors).powi(2)
        })
        .collect();
    deviation_percent(&forces)
}

pub fn deviation_percent(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let square =
        values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64;
    100.0 * square.sqrt() / mean
}

pub fn assert_near(what: &str, got: f64, expected: f64, relative: f64) {
    assert!(
        (got / expected - 1.0).abs() <= relative,
        "{what}: got {got:e}, expected {expected:e} ± {relative}"
    );
}
