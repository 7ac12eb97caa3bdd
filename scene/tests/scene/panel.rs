// SPDX-License-Identifier: MIT OR Apache-2.0
//! The panel's noise through the shunt: its size, one source for all terminals, and the same in
//! amplitudes and in samples.

use crate::common::{CHANNELS, SENSE, TERMINALS, assert_near, demodulate, hann, plant};
use hapticore_scene::{Complex, Plant};

const SLOTS: usize = 4000;

fn scene(khz: f64) -> Plant {
    plant(&format!(
        "dwell_slots = {SLOTS}\n[[pad]]\nposition_mm = [120, -60]\n[sheet]\n\
         [shunt]\nnanofarad_per_m2 = 9\npanel_noise_mv = 10\npanel_noise_khz = {khz}\n"
    ))
}

/// What the noise adds to the terminals' amplitudes, A, slot by slot.
fn noise(khz: f64, read: impl Fn(&mut Plant, usize) -> Vec<Complex>) -> Vec<Vec<Complex>> {
    let mut plant = scene(khz);
    let full_scale_a = plant.device().current_full_scale_a;
    let all: Vec<Vec<Complex>> = (0..SLOTS).map(|slot| read(&mut plant, slot)).collect();
    let mean = |n: usize| all.iter().map(|slot| slot[n]).sum::<Complex>() / SLOTS as f64;
    let means: Vec<Complex> = (0..TERMINALS).map(mean).collect();
    let off = |slot: &Vec<Complex>| {
        slot[..TERMINALS].iter().zip(&means).map(|(a, b)| (a - b) * full_scale_a).collect()
    };
    all.iter().map(off).collect()
}

fn amplitudes(plant: &mut Plant, slot: usize) -> Vec<Complex> {
    let mut phasors = vec![Complex::default(); SENSE + 1];
    plant.phasors(slot, &mut phasors);
    phasors
}

fn sampled(plant: &mut Plant, slot: usize) -> Vec<Complex> {
    demodulate(plant, slot, hann)
}

/// RMS of the current that an amplitude means.
fn rms(values: impl Iterator<Item = Complex>) -> f64 {
    (values.map(|value| value.norm_sqr()).sum::<f64>() / SLOTS as f64 / 2.0).sqrt()
}

/// docs/physics.md §7: 10 mV through 9 nF/m² is 24 µA.
#[test]
fn ten_millivolts_through_nine_nanofarads_are_24_microamperes() {
    let noise = noise(0.01, amplitudes);
    let total_a = rms(noise.iter().map(|slot| slot.iter().sum()));
    println!("{:.2} µA", 1e6 * total_a);
    assert_near("total", total_a, 24e-6, 0.04);
}

#[test]
fn all_terminals_have_the_noise_of_one_source() {
    for read in [amplitudes, sampled] {
        let noise = noise(0.01, read);
        for i in 0..TERMINALS {
            for j in 0..i {
                let product = noise.iter().map(|slot| slot[i] * slot[j].conj()).sum::<Complex>()
                    / SLOTS as f64;
                let sizes = [i, j].map(|n| rms(noise.iter().map(|slot| slot[n])));
                let correlation = product.norm() / (2.0 * sizes[0] * sizes[1]);
                assert!((correlation - 1.0).abs() < 1e-3, "{i} and {j}: {correlation}");
            }
        }
    }
}

/// A window of 200 µs, and lines from a thousandth of its width to more than that.
#[test]
fn amplitudes_have_the_noise_that_a_window_passes_of_the_samples() {
    for khz in [0.01, 1.0, 5.0] {
        let size = |read| rms(noise(khz, read).iter().map(|slot| slot.iter().sum()));
        let (of_amplitudes, of_samples) =
            (size(amplitudes as fn(&mut Plant, usize) -> _), size(sampled));
        println!("{khz} kHz: {:.2} and {:.2} µA", 1e6 * of_amplitudes, 1e6 * of_samples);
        assert_near("a window", of_amplitudes, of_samples, 0.04);
    }
}

#[test]
fn every_sample_has_the_whole_line() {
    let read = |text: &str| {
        let mut plant = plant(text);
        let mut samples = Vec::new();
        (0..SLOTS).for_each(|slot| plant.samples(slot, 0..20, &mut samples));
        samples
            .chunks_exact(CHANNELS)
            .map(|row| row[..TERMINALS].iter().sum())
            .collect::<Vec<f64>>()
    };
    let text = |noise: &str| {
        format!(
            "dwell_slots = {SLOTS}\n[[pad]]\nposition_mm = [120, -60]\n[sheet]\n\
             [shunt]\nnanofarad_per_m2 = 9\n{noise}"
        )
    };
    let (with, without) = (read(&text("panel_noise_mv = 10\n")), read(&text("")));
    let off = with.iter().zip(&without).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    let rms_a = 4e-3 * (off / with.len() as f64).sqrt();
    assert_near("a sample", rms_a, 24e-6, 0.04);
}
