// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is not the carrier.

use std::f64::consts::TAU;

use crate::stability::Outcome;
use crate::stability::bench::{Bench, PROFILES, Pad, percent};
use crate::stability::case::Number;
use crate::stability::rivals::measure_with_idsp;

/// Sample rate of a profile's board, Hz.
pub fn sample_rate_hz(name: &str) -> f64 {
    if name == "small" { 500e3 } else { 1e6 }
}

/// A constant in every channel.
pub fn offset_of_half_scale() -> Outcome {
    let mut outcome = Outcome::of("change of the capacitance");
    let mut idsp = 0.0;
    for bench in Bench::all() {
        let pad = Pad { sense: 0.4, ..bench.pad(0.3) };
        let haptic = bench.terminals() + 1;
        let with = |offset: f64| {
            bench.window(|n, channel| {
                bench.signal(&pad, n, channel) + if channel == haptic { 0.0 } else { offset }
            })
        };
        let moved =
            |measure: &dyn Fn(&[i32]) -> f64| percent(measure(&with(0.5)), measure(&with(0.0)));
        let core = moved(&|codes| bench.measure(codes).capacitance_pf).abs();
        outcome = outcome.at_most(format!("`{}`", bench.profile.name), core, 0.02, "%");
        idsp =
            f64::max(idsp, moved(&|codes| measure_with_idsp(&bench, codes).capacitance_pf).abs());
    }
    outcome.rivals(format!("idsp: {idsp:.2} %"))
}

/// Haptic leakage far above the carrier.
pub fn leakage_above_the_carrier() -> Outcome {
    let mut outcome = Outcome::of("change of the capacitance");
    let mut rivals = Vec::new();
    for decibels in [11.0, 40.0] {
        let ratio = 10f64.powf(decibels / 20.0);
        for name in PROFILES {
            let bench = Bench::of(name);
            let amplitude = 0.9 / (1.0 + ratio);
            let pad = bench.pad(amplitude);
            let turns = 1e3 / sample_rate_hz(name);
            let of = |leakage: f64| interfered(&bench, &pad, leakage, turns, 0.13);
            let moved = |measure: &dyn Fn(&[i32]) -> f64| {
                percent(measure(&of(amplitude * ratio)), measure(&of(0.0))).abs()
            };
            let core = moved(&|codes| bench.measure(codes).capacitance_pf);
            let float = moved(&|codes| bench.measure_in_float(codes).capacitance_pf);
            // One step of the capacitance's word.
            let step = bench.profile.formats.capacitance.lsb() / bench.ideal(&pad).capacitance_pf;
            outcome = outcome.at_most(
                format!("{decibels} dB, `{name}`"),
                core,
                float + 100.0 * step + 0.01,
                "%",
            );
            if name == "standard" {
                let idsp = moved(&|codes| measure_with_idsp(&bench, codes).capacitance_pf);
                rivals.push(format!(
                    "{decibels} dB: floating point {} %, idsp {idsp:.1} %",
                    Number(float)
                ));
            }
        }
    }
    outcome.rivals(rivals.join("; "))
}

/// Codes of a pad with a tone more in every terminal.
fn interfered(bench: &Bench, pad: &Pad, amplitude: f64, turns: f64, phase: f64) -> Vec<i32> {
    bench.window(|n, channel| {
        let tone = amplitude * (TAU * (turns * n as f64 + phase)).cos();
        bench.signal(pad, n, channel) + if channel < pad.currents.len() { tone } else { 0.0 }
    })
}

/// How far above the carrier a tone may be for 1 % of force, half of that of an amplitude, dB: least
/// over its phases.
fn reserve_db(bench: &Bench, turns: f64, measure: &dyn Fn(&[i32]) -> f64) -> f64 {
    const CARRIER: f64 = 1.0 / 256.0;
    const INTERFERER: f64 = 0.9;
    let pad = Pad { currents: vec![CARRIER; bench.terminals()], ..bench.pad(CARRIER) };
    let quiet = measure(&interfered(bench, &pad, 0.0, turns, 0.0));
    let worst = (0..8)
        .map(|phase| measure(&interfered(bench, &pad, INTERFERER, turns, f64::from(phase) / 8.0)))
        .map(|found| percent(found, quiet).abs())
        .fold(1e-9, f64::max);
    20.0 * (INTERFERER / CARRIER * 0.5 / worst).log10()
}

/// Reserve over the frequency.
pub fn dynamic_reserve() -> Outcome {
    let mut outcome = Outcome::of("reserve, least over the frequencies");
    let mut rivals = Vec::new();
    for name in PROFILES {
        let bench = Bench::of(name);
        let least = |measure: &dyn Fn(&[i32]) -> f64| {
            [50.0, 200.0, 1e3, 3e3, 20e3]
                .map(|hz| reserve_db(&bench, hz / sample_rate_hz(name), measure))
                .into_iter()
                .fold(f64::INFINITY, f64::min)
        };
        // Of the sums, which are finer than the words of a capacitance as small as this.
        let core = least(&|codes| {
            let sums = bench.fixed().sums(codes);
            sums[0].hypot(sums[1])
        });
        let float = least(&|codes| bench.measure_in_float(codes).capacitance_pf);
        let idsp = least(&|codes| measure_with_idsp(&bench, codes).capacitance_pf);
        outcome = outcome.at_least(format!("`{name}`"), core, float - 4.0, "dB");
        rivals.push(format!("`{name}`: floating point {float:.0} dB, idsp {idsp:.0} dB"));
    }
    outcome.rivals(rivals.join("; "))
}

/// A carrier that is not the oscillator's.
pub fn carrier_detuned() -> Outcome {
    let mut outcome = Outcome::of("error of the capacitance");
    let mut float = [0.0; 2];
    for bench in Bench::all() {
        let pad = bench.pad(0.3);
        let ideal = bench.ideal(&pad).capacitance_pf;
        for (n, (off, text)) in [(1e-4, "100 ppm"), (1e-2, "1 %")].into_iter().enumerate() {
            let turns = bench.profile.turns_per_sample() * (1.0 + off);
            let codes = bench.window(|n, channel| bench.signal_at(&pad, turns, n as f64, channel));
            let core = percent(bench.measure(&codes).capacitance_pf, ideal).abs();
            let limit = if n == 0 { 0.1 } else { 0.5 };
            outcome =
                outcome.at_most(format!("{text}, `{}`", bench.profile.name), core, limit, "%");
            float[n] = f64::max(
                float[n],
                percent(bench.measure_in_float(&codes).capacitance_pf, ideal).abs(),
            );
        }
    }
    outcome.rivals(format!("floating point: {} % and {} %", Number(float[0]), Number(float[1])))
}
