// SPDX-License-Identifier: MIT OR Apache-2.0
//! White noise, and the least variance that any estimator can have.
//!
//! ```text
//! var Â ≥ 2σ²/N      amplitude of a tone in white noise of variance σ², N samples (Rife and Boorstyn, 1974)
//! ```

use fastrand::Rng;

use super::amplitude::gaussian;
use crate::stability::Outcome;
use crate::stability::bench::Bench;
use crate::stability::rivals::measure_with_idsp;

const SLOTS: usize = 600;
/// Noise of every terminal, of full scale: more than any word of the chain rounds.
const NOISE: f64 = 0.02;

/// Variance of the total current against the bound.
pub fn cramer_rao_bound() -> Outcome {
    let mut outcome = Outcome::of("variance above the bound");
    let mut rivals = String::new();
    for bench in Bench::all() {
        let found = excess_db(&bench);
        outcome = outcome.at_most(format!("`{}`", bench.profile.name), found[0], 1.76 + 0.5, "dB");
        if bench.profile.name == "standard" {
            rivals =
                format!("`standard`: floating point {:.2} dB, idsp {:.1} dB", found[1], found[2]);
        }
    }
    outcome.rivals(rivals)
}

/// Of the core, of floating point and of idsp.
fn excess_db(bench: &Bench) -> [f64; 3] {
    let mut rng = Rng::with_seed(7);
    let (pad, terminals) = (bench.pad(0.5), bench.terminals());
    let clean: Vec<f64> = (0..bench.profile.slot.integrate as usize * bench.profile.channels())
        .map(|k| {
            let (n, channel) = (k / bench.profile.channels(), k % bench.profile.channels());
            bench.signal(&pad, n + bench.profile.slot.blanking() as usize, channel)
        })
        .collect();
    let channels = bench.profile.channels();
    let (mut core, mut float) = (bench.fixed(), bench.reference());
    let mut sums = [[0.0; 2]; 3];
    for _ in 0..SLOTS {
        let codes: Vec<i32> = clean
            .iter()
            .enumerate()
            .map(|(k, &x)| {
                bench.code(if k % channels < terminals {
                    x + NOISE * gaussian(&mut rng)
                } else {
                    x
                })
            })
            .collect();
        let found = [
            core.slot(0, &codes).measurement(&bench.profile).capacitance_pf,
            float.slot(0, &codes).capacitance_pf,
            measure_with_idsp(bench, &codes).capacitance_pf,
        ];
        for (sum, of) in sums.iter_mut().zip(found) {
            *sum = [sum[0] + of, sum[1] + of * of];
        }
    }
    let bound = relative_bound(bench, terminals, pad.currents.iter().sum());
    sums.map(|[sum, squares]| {
        let (mean, count) = (sum / SLOTS as f64, SLOTS as f64);
        let relative = (squares / count - mean * mean) / (mean * mean);
        10.0 * (relative / bound).log10()
    })
}

/// The bound for the sum of all terminals' currents, relative to it, squared.
fn relative_bound(bench: &Bench, terminals: usize, total: f64) -> f64 {
    let samples = bench.profile.slot.integrate as f64;
    terminals as f64 * 2.0 * NOISE * NOISE / samples / (total * total)
}
