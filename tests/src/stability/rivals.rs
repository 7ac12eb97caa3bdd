// SPDX-License-Identifier: MIT OR Apache-2.0
//! Other lock-ins and filters on the same samples.

use std::f64::consts::{SQRT_2, TAU};
use std::num::Wrapping;
use std::panic;

use dsp_process::SplitProcess;
use hapticore_contract::frame::Measurement;
use idsp::{Lockin, Lowpass, Lowpass2, LowpassState};

use super::bench::Bench;

/// Gains of idsp's second-order low-pass with a corner of this many radians per sample.
fn lowpass2(corner: f64) -> Lowpass2 {
    let gain = (corner * 2f64.powi(31)) as i64;
    Lowpass([((gain * gain) >> 32) as i32, (-(gain as f64) * SQRT_2) as i32])
}

/// idsp 0.23's lock-in on one channel of a window, in phase and quadrature, fractions of full scale:
/// the last output of a low-pass that settles within the window.
pub fn idsp_phasor(bench: &Bench, window: &[i32], channel: usize) -> (f64, f64) {
    let profile = &bench.profile;
    let lockin = Lockin(lowpass2(TAU * 4.0 / profile.slot.integrate as f64));
    let mut state: [LowpassState<2>; 2] = Default::default();
    let step = (2f64.powi(32) * profile.turns_per_sample()).round() as i64 as i32;
    let shift = 31 - u32::from(profile.formats.adc.width);
    let (mut phase, mut last) = (Wrapping(0i32), (0, 0));
    for codes in window.chunks_exact(profile.channels()) {
        let iq = lockin.process(&mut state, (codes[channel] << shift, phase));
        phase += step;
        last = (iq.re(), iq.im());
    }
    (f64::from(last.0) / 2f64.powi(29), f64::from(last.1) / 2f64.powi(29))
}

/// idsp's lock-ins with the estimator in floating point behind them. idsp has no mean square; this
/// takes that of floating point.
pub fn measure_with_idsp(bench: &Bench, window: &[i32]) -> Measurement {
    let phasors: Vec<_> =
        (0..=bench.terminals()).map(|channel| idsp_phasor(bench, window, channel)).collect();
    let square = bench.measure_in_float(window).mean_square / bench.profile.square_gain();
    bench.reference().phasors(0, &phasors, square)
}

/// What is left of idsp's second-order low-pass, in steps of its word, after a step from this
/// fraction of full scale to zero and `samples` of zero: largest over the last tenth. None where a sum
/// within it overflows, which a build with overflow checks tells and another one does not.
pub fn idsp_lowpass_residue(fraction: f64, samples: usize) -> Option<i64> {
    panic::catch_unwind(|| lowpass_residue(fraction, samples)).ok()
}

fn lowpass_residue(fraction: f64, samples: usize) -> i64 {
    let lowpass = lowpass2(1e-2 * TAU);
    let mut state = LowpassState::<2>::default();
    let input = (fraction * f64::from(i32::MAX)) as i32;
    (0..samples).for_each(|_| {
        lowpass.process(&mut state, input);
    });
    let mut left = (0..samples).map(|_| i64::from(lowpass.process(&mut state, 0)).abs());
    left.by_ref().take(samples - samples / 10).for_each(drop);
    left.max().unwrap_or(0)
}
