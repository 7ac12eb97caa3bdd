// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core's lock-in beside idsp's, on the same samples of scenes' slots: errors against the ideal
//! estimator, and time per channel sample: `lockins [PROFILE]…`.
//!
//! Behind idsp's lock-in, and behind `f32`, the estimator is in floating point. idsp has no mean square
//! of the haptic voltage; this program supplies the ideal one.

use anyhow::Result;
use dsp_process::SplitProcess;
use hapticore_contract::frame::Measurement;
use hapticore_contract::profile::Profile;
use hapticore_model::fidelity::fixed::FixedSimulation;
use hapticore_reference::Reference;
use hapticore_run::digitiser::Digitiser;
use hapticore_run::inputs;
use hapticore_tradeoff::bench::Bench;
use hapticore_tradeoff::points::{Signals, Values, Which, unrounded};
use idsp::{Lockin, Lowpass, Lowpass2, LowpassState};
use std::f64::consts::{SQRT_2, TAU};
use std::num::Wrapping;
use std::sync::Arc;
use std::time::Instant;

const SCENES: [&str; 3] = ["fig3", "fig6", "hockey"];
const SLOTS: usize = 96;

fn main() -> Result<()> {
    let named: Vec<String> = std::env::args().skip(1).collect();
    let names = if named.is_empty() { vec!["standard".into(), "small".into()] } else { named };
    println!(
        "scene, profile, lock-in: force mN, capacitance %, position µm: RMS (mean); ns per channel sample"
    );
    for name in names {
        let profile = inputs::profile(&name)?;
        for scene in SCENES {
            compare(scene, &profile)?;
        }
    }
    Ok(())
}

fn compare(name: &str, profile: &Profile) -> Result<()> {
    let scene = inputs::scene(name, &[])?;
    let scene = Arc::new(inputs::scene(name, &unrounded(&scene.cases[0])?)?);
    let bench = Bench::new((&scene, 0), profile, Which::Every(SLOTS), true)?;
    let served = bench.serve(profile)?;
    let calibration = bench.calibration();
    let mut fixed = FixedSimulation::<i64>::new(&served, calibration);
    let core = errors(&bench, &served, |pad, codes| fixed.slot(pad, codes).measurement(&served));
    let mut single = Reference::<f32>::with_precision(&served, calibration);
    let single = errors(&bench, &served, |pad, codes| single.slot(pad, codes).map(f64::from));
    let mut double = Reference::new(&served, calibration);
    let idsp = errors(&bench, &served, |pad, codes| {
        let phasors: Vec<_> = (0..served.channels() - 1)
            .map(|channel| idsp_phasor(&served, codes, channel))
            .collect();
        double.phasors(pad, &phasors, mean_square(&served, codes))
    });
    for (lockin, text) in [("core", core), ("f32", single), ("idsp", idsp)] {
        println!("{name}, {}, {lockin}: {text}", profile.name);
    }
    Ok(())
}

/// Errors of what makes measurements of codes, and its time.
fn errors(
    bench: &Bench,
    profile: &Profile,
    mut measure: impl FnMut(usize, &[i32]) -> Measurement,
) -> String {
    let (mut sums, mut seconds, mut samples) = ([[0.0; 2]; 3], 0.0, 0);
    for slot in bench.slots() {
        let Signals::Samples(given) = &slot.signals else { unreachable!("asked for samples") };
        let mut codes = Vec::new();
        Digitiser::new(profile.formats.adc).codes(given, &mut codes);
        let start = Instant::now();
        let measured = measure(slot.pad, &codes);
        seconds += start.elapsed().as_secs_f64();
        samples += codes.len();
        let (found, ideal) = (Values::of(&measured), slot.ideal);
        let [dx, dy] = [0, 1].map(|n| 1e3 * (found.position_mm[n] - ideal.position_mm[n]));
        let relative = 100.0 * (found.capacitance_pf / ideal.capacitance_pf - 1.0);
        let force = 1e3 * (found.force_n - ideal.force_n);
        for (sum, [mean, square]) in sums.iter_mut().zip([
            [force, force * force],
            [relative, relative * relative],
            [dx, dx * dx + dy * dy],
        ]) {
            *sum = [sum[0] + mean, sum[1] + square];
        }
    }
    let count = bench.slots().len() as f64;
    let [force, capacitance, position] = sums
        .map(|[mean, square]| format!("{:.2e} ({:+.1e})", (square / count).sqrt(), mean / count));
    format!("{force}, {capacitance}, {position}; {:.2} ns", 1e9 * seconds / samples as f64)
}

/// The haptic voltage's mean square, of full scale².
fn mean_square(profile: &Profile, codes: &[i32]) -> f64 {
    let (count, lsb) = (profile.slot.integrate as f64, profile.formats.adc.lsb());
    let samples = codes.chunks_exact(profile.channels());
    let share = |n: usize| (1.0 - (TAU * n as f64 / count).cos()) / 2.0;
    let (mut sum, mut weight) = (0.0, 0.0);
    for (n, codes) in samples.enumerate() {
        let haptic = f64::from(codes[codes.len() - 1]) * lsb;
        sum += share(n) * haptic * haptic;
        weight += share(n);
    }
    sum / weight
}

/// idsp's lock-in on one channel: a second-order low-pass that settles within the window; its last
/// output, of full scale.
fn idsp_phasor(profile: &Profile, codes: &[i32], channel: usize) -> (f64, f64) {
    let k = TAU * 4.0 / profile.slot.integrate as f64;
    let gain = (k * 2f64.powi(31)) as i64;
    let lowpass: Lowpass2 =
        Lowpass([((gain * gain) >> 32) as i32, (-(gain as f64) * SQRT_2) as i32]);
    let lockin = Lockin(lowpass);
    let mut state: [LowpassState<2>; 2] = Default::default();
    let step = (2f64.powi(32) * profile.turns_per_sample()).round() as i64 as i32;
    let shift = 32 - u32::from(profile.formats.adc.width);
    let (mut phase, mut last) = (Wrapping(0i32), (0, 0));
    for codes in codes.chunks_exact(profile.channels()) {
        let iq = lockin.process(&mut state, (codes[channel] << (shift - 1), phase));
        phase += step;
        last = (iq.re(), iq.im());
    }
    (f64::from(last.0) / 2f64.powi(29), f64::from(last.1) / 2f64.powi(29))
}
