// SPDX-License-Identifier: MIT OR Apache-2.0
//! The haptic voltage as its own sine, on the eight patches of a pad under 50 g.

use std::f64::consts::{SQRT_2, TAU};

use super::*;

const STEP_S: f64 = 1e-5;
const PRESSURE_PA: f64 = 707.4;

/// The pad's capacitance and force over the last tenth of a second, without μ.
fn tail(volt: f64, sine_hz: Option<f64>) -> [Vec<f64>; 2] {
    const STEPS: usize = 50_000;
    const TAIL: usize = 10_000;
    let pad = pad("");
    let now = |time_s: f64| sine_hz.map_or(volt, |hz| volt * SQRT_2 * (TAU * hz * time_s).sin());
    let drive = |time_s: f64| Drive::new(now(time_s), PRESSURE_PA);
    let rest = pad.equilibrium_m(Drive::new(volt, PRESSURE_PA)).zip(&pad.patches);
    let mut states: Vec<State> =
        rest.map(|(gap_m, patch)| at_rest(&pad.law, *patch, gap_m)).collect();
    let mut tail = [Vec::new(), Vec::new()];
    for n in 0..STEPS {
        let stages = Method::TrBdf2.stages(|fraction| drive((n as f64 + fraction) * STEP_S));
        Method::TrBdf2.step(&pad.law, &pad.patches, &mut states, STEP_S, &stages);
        if n >= STEPS - TAIL {
            let gaps = || states.iter().map(|state| state.gap_m);
            let pull_n = drive((n + 1) as f64 * STEP_S).pull_n;
            tail[0].push(pad.capacitance_f(gaps()));
            tail[1].push(pad.attraction_n(gaps(), pull_n));
        }
    }
    tail
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn peak(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

#[test]
fn at_200_hz_and_above_capacitance_follows_the_mean_square_within_0_2_percent() {
    for (sine_hz, volt) in [(200.0, 350.0), (200.0, 250.0), (1000.0, 350.0)] {
        let off = mean(&tail(volt, Some(sine_hz))[0]) / mean(&tail(volt, None)[0]) - 1.0;
        println!("{sine_hz} Hz, {volt} V: {off:e}");
        assert!(off.abs() < 2e-3, "{sine_hz} Hz, {volt} V: {off:e}");
    }
}

/// The peaks: of C over its value under the mean square, of F over twice its own, in percent of it.
/// The limits were set after measuring: the prototype has no figures of this device, but C +3 %, F +6 %
/// of the superseded one, whose springs are ten times as stiff.
#[test]
fn at_50_hz_and_350_v_peaks_rise_by_some_percent() {
    let ([c, f], [steady_c, steady_f]) = (tail(350.0, Some(50.0)), tail(350.0, None));
    let c_percent = 100.0 * (peak(&c) / mean(&steady_c) - 1.0);
    let f_percent = 100.0 * (peak(&f) / mean(&steady_f) - 2.0);
    println!("50 Hz, 350 V: C {c_percent:+.1} %, F {f_percent:+.1} %");
    assert!(
        (c_percent - 4.7).abs() < 0.2 && (f_percent - 10.6).abs() < 0.3,
        "C {c_percent} %, F {f_percent} %"
    );
}

#[test]
fn force_ripples_at_twice_the_haptic_frequency() {
    let force = &tail(350.0, Some(200.0))[1];
    let middle = mean(force);
    let rises = force.windows(2).filter(|pair| pair[0] < middle && pair[1] >= middle).count();
    assert_eq!(rises, 40, "in a tenth of a second");
    assert!(peak(force) > 1.9 * middle && force.iter().any(|force| *force < 1e-3 * middle));
}
