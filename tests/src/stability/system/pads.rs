// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pads that are not there, at their limits, dropped, or beside others.

use fastrand::Rng;
use hapticore_contract::frame::{Field, Flags, Frame};
use hapticore_contract::profile::Profile;
use hapticore_model::fidelity::clock::ClockSimulation;

use crate::stability::Outcome;
use crate::stability::bench::{Bench, Pad, percent};

/// No pad on the sheet.
pub fn no_pad() -> Outcome {
    let (mut compared, mut largest, mut invalid) = (0, 0f64, 0);
    for bench in Bench::all() {
        let (lsb, mut rng) = (bench.profile.formats.adc.lsb(), Rng::with_seed(1));
        let (pad, mut fixed) = (bench.pad(0.0), bench.fixed());
        for _ in 0..200 {
            let codes = bench.window(|n, channel| {
                let noise = if channel < bench.terminals() { rng.f64() - 0.5 } else { 0.0 };
                bench.signal(&pad, n, channel) + 2.0 * lsb * noise
            });
            let found = fixed.slot(0, &codes).measurement(&bench.profile);
            compared += 1;
            match found.flags.invalid || found.flags.lost {
                true => invalid += 1,
                false => largest = largest.max(found.capacitance_pf),
            }
        }
    }
    Outcome::of(format!("{invalid} of {compared} frames flagged")).at_most(
        "capacitance where no flag is set",
        largest,
        0.1,
        "pF",
    )
}

/// A pad that is lifted: half the current with every step.
pub fn vanishing_capacitance() -> Outcome {
    let mut outcome = Outcome::default();
    for bench in Bench::all() {
        let (mut worst, mut fixed, mut flagged) = (0f64, bench.fixed(), None);
        for step in 0..48 {
            let pad = bench.pad(0.5 * 2f64.powf(-f64::from(step) / 2.0));
            let ideal = bench.ideal(&pad).capacitance_pf;
            let found = fixed.slot(0, &bench.codes(&pad)).measurement(&bench.profile);
            if found.flags != Flags::default() {
                flagged.get_or_insert(ideal);
                continue;
            }
            worst = worst.max((found.capacitance_pf - ideal).abs() - 1e-3 * ideal);
        }
        assert!(flagged.is_some(), "{}: nothing is flagged", bench.profile.name);
        outcome = outcome.at_most(
            format!(
                "`{}`, first flagged at {:.3} pF, error beyond 0.1 %",
                bench.profile.name,
                flagged.unwrap_or(0.0)
            ),
            worst,
            0.1,
            "pF",
        );
    }
    outcome
}

/// Currents of a pad with these ratios: shares e^(αx + βy), which are never negative.
fn of_ratios(bench: &Bench, ratios: [f64; 2]) -> Vec<f64> {
    let (x, y) = (&bench.profile.terminals.x, &bench.profile.terminals.y);
    let place = |k: usize| [f64::from(x[k]), f64::from(y[k])];
    let mut exponent = [0f64; 2];
    loop {
        let shares: Vec<f64> = (0..x.len())
            .map(|k| (exponent[0] * place(k)[0] + exponent[1] * place(k)[1]).exp())
            .collect();
        let sum: f64 = shares.iter().sum();
        let ratio = |axis: usize| {
            shares.iter().enumerate().map(|(k, s)| s * place(k)[axis]).sum::<f64>() / sum
        };
        let off = [ratios[0] - ratio(0), ratios[1] - ratio(1)];
        if off[0].abs().max(off[1].abs()) < 1e-12 {
            let most = shares.iter().copied().fold(0.0, f64::max);
            return shares.into_iter().map(|share| 0.5 * share / most).collect();
        }
        (exponent[0], exponent[1]) = (exponent[0] + off[0], exponent[1] + off[1]);
    }
}

/// How far a pad is from the middle towards a terminal: farther out the map of this device folds.
const NEAR: f64 = 0.75;

/// Towards the corners of the sheet, and the middles of its long edges.
pub fn pad_near_each_terminal() -> Outcome {
    let mut outcome = Outcome::of("departure from floating point's place");
    for bench in Bench::all() {
        let mut worst = 0f64;
        for (u, v) in
            [(-NEAR, NEAR), (-NEAR, -NEAR), (NEAR, -NEAR), (NEAR, NEAR), (0., -NEAR), (0., NEAR)]
        {
            let r_x = 0.78 * (1.3f64 * u).sin() / 1.3f64.sin() * (1.0 - 0.15 * v * v);
            let r_y = 0.7 * (1.2f64 * v).sin() / 1.2f64.sin() * (1.0 - 0.3 * u * u);
            let pad = Pad { currents: of_ratios(&bench, [r_x, r_y]), ..bench.pad(0.5) };
            let codes = bench.codes(&pad);
            let (found, float) = (bench.measure(&codes), bench.measure_in_float(&codes));
            assert!(!found.flags.invalid && !found.flags.lost, "{}: {found:?}", bench.profile.name);
            assert!(
                (found.x_mm - 400.0 * u).abs() < 2.0,
                "{} at {u}, {v}: {found:?}",
                bench.profile.name
            );
            worst = worst.max((found.x_mm - float.x_mm).hypot(found.y_mm - float.y_mm));
        }
        outcome = outcome.at_most(format!("`{}`", bench.profile.name), worst, 0.5, "mm");
    }
    outcome
}

/// A terminal whose wire breaks, and is mended.
pub fn terminal_dropped() -> Outcome {
    let mut compared = 0;
    for bench in Bench::all() {
        let pad = bench.pad(0.3);
        let good = bench.slot(|n, channel| bench.signal(&pad, n, channel));
        let middle = (bench.profile.slot.blanking() + bench.profile.slot.integrate / 2) as usize;
        let mut everyone = bench.everyone();
        let first = everyone.slot(&good);
        for terminal in 0..bench.terminals() {
            let broken = |from: usize| {
                bench.slot(|n, channel| match channel == terminal && n >= from {
                    true => 0.0,
                    false => bench.signal(&pad, n, channel),
                })
            };
            everyone.slot(&broken(middle));
            let lost = everyone.slot(&broken(0));
            assert!(lost.flags.lost, "{}: terminal {terminal}", bench.profile.name);
            assert_eq!(everyone.slot(&good), first, "{}: mended", bench.profile.name);
            compared += 3;
        }
    }
    Outcome::default().equal(compared)
}

/// No haptic voltage.
pub fn no_haptic_voltage() -> Outcome {
    let mut compared = 0;
    for bench in Bench::all() {
        for amplitude in [0.9, 0.3, 0.01, 1e-3] {
            let pad = Pad { haptic: 0.0, ..bench.pad(amplitude) };
            let frame = bench.fixed().slot(0, &bench.codes(&pad));
            assert_eq!((frame.codes[Field::Force as usize], frame.flags.saturated), (0, false));
            compared += 1;
        }
    }
    Outcome::default().equal(compared)
}

/// The frames of three rounds of pads, of both fidelities, which are the same.
fn rounds(bench: &Bench, of: &[Vec<i32>]) -> Vec<Frame> {
    let profile = Profile { pads: of.len() as u64, ..bench.profile.clone() };
    let blanked = profile.slot.blanking() as usize * profile.channels();
    let bench = Bench { profile, calibration: bench.calibration.clone() };
    let mut fixed = bench.fixed();
    let mut clock = ClockSimulation::new(&bench.profile, &bench.calibration);
    let mut frames = Vec::new();
    for slot in 0..3 * of.len() {
        let (pad, codes) = (slot % of.len(), &of[slot % of.len()]);
        let frame = fixed.slot(pad, &codes[blanked..]);
        clock.samples(codes);
        assert_eq!(clock.finish_slot(), Some(frame), "{}: slot {slot}", bench.profile.name);
        frames.push(frame);
    }
    frames.split_off(2 * of.len())
}

/// A pad between slots at full scale.
pub fn neighbours_at_full_swing() -> Outcome {
    let mut compared = 0;
    for bench in Bench::all() {
        let quiet = bench.slot(|n, channel| bench.signal(&bench.pad(1e-2), n, channel));
        let loud = bench.slot(|n, _| if n % 2 == 0 { 2.0 } else { -2.0 });
        let with = |neighbour: &Vec<i32>| {
            rounds(&bench, &[quiet.clone(), neighbour.clone(), quiet.clone()])
        };
        let (alone, beside) = (with(&quiet), with(&loud));
        assert!(beside[1].flags.clipped);
        for pad in [0, 2] {
            assert_eq!(alone[pad], beside[pad], "{}: pad {pad}", bench.profile.name);
            compared += 1;
        }
    }
    Outcome::default().equal(compared)
}

/// Two pads that change places.
pub fn pads_swapped() -> Outcome {
    let mut compared = 0;
    for bench in Bench::all() {
        let mut other = bench.pad(0.5);
        other.currents.reverse();
        (other.haptic, other.phase) = (0.4, 0.3);
        let [a, b] = [bench.pad(0.2), other]
            .map(|pad| bench.slot(|n, channel| bench.signal(&pad, n, channel)));
        let (before, after) = (rounds(&bench, &[a.clone(), b.clone()]), rounds(&bench, &[b, a]));
        for pad in 0..2 {
            assert_eq!(before[pad].codes, after[1 - pad].codes, "{}", bench.profile.name);
            compared += 1;
        }
        assert_ne!(before[0].codes, before[1].codes);
    }
    Outcome::default().equal(compared)
}

/// Something that changes within a window, as the core and floating point see it.
fn within(bench: &Bench, codes: Vec<i32>, steady: &[i32]) -> (f64, f64) {
    let from = bench.profile.slot.blanking() as usize * bench.profile.channels();
    let mut everyone = bench.everyone();
    let before = everyone.slot(steady);
    let found = everyone.slot(&codes).measurement(&bench.profile);
    let float = bench.measure_in_float(&codes[from..]);
    assert_eq!(everyone.slot(steady), before, "{}: right again", bench.profile.name);
    (
        percent(found.capacitance_pf, float.capacitance_pf).abs(),
        percent(found.force_n, float.force_n).abs(),
    )
}

/// The haptic voltage and the capacitance change within a window, one early and one late.
pub fn haptic_voltage_skewed() -> Outcome {
    let mut outcome = Outcome::of("departure from floating point on the same codes");
    let (mut worst, mut compared) = (0f64, 0);
    for bench in Bench::all() {
        let pad = Pad { haptic: 0.5, ..bench.pad(0.5) };
        let blanked = bench.profile.slot.blanking() as f64;
        let steady = bench.slot(|n, channel| bench.signal(&pad, n, channel));
        let step = bench.profile.formats.force.lsb() / bench.ideal(&pad).force_n;
        let mut apart = 0f64;
        for skew in [-0.25, 0.0, 0.25] {
            let grown = |n: usize, late: f64| {
                let share = (n as f64 - blanked) / bench.profile.slot.integrate as f64;
                if share > 0.5 + late { 1.5 } else { 1.0 }
            };
            let codes = bench.slot(|n, channel| {
                let late = if channel < bench.terminals() { 0.0 } else { skew };
                let grown = if channel == bench.terminals() { 1.0 } else { grown(n, late) };
                grown * bench.signal(&pad, n, channel)
            });
            apart = apart.max(within(&bench, codes.clone(), &steady).1);
            let from = bench.profile.slot.blanking() as usize * bench.profile.channels();
            let force = bench.measure_in_float(&codes[from..]).force_n;
            // Mean of (C·V)² over the window, of which a single frame knows neither course.
            let both = 0.5 - f64::max(skew, 0.0);
            let one = f64::abs(skew);
            let truth = (1.0 - both - one) + one * 2.25 + both * 2.25 * 2.25;
            let calm = bench.measure_in_float(&steady[from..]).force_n;
            worst = worst.max(percent(force, truth * calm).abs());
            compared += 1;
        }
        outcome = outcome.at_most(
            format!("force, `{}`", bench.profile.name),
            apart,
            0.05 + 100.0 * step,
            "%",
        );
    }
    outcome
        .equal(compared)
        .rivals(format!("floating point: up to {worst:.1} % off the window's mean of (C·V)²"))
}

/// The gap closes: the current trebles in mid-window.
pub fn pull_in_inside_a_slot() -> Outcome {
    let mut outcome = Outcome::of("departure from floating point on the same codes");
    let mut compared = 0;
    for bench in Bench::all() {
        let pad = bench.pad(0.3);
        let steady = bench.slot(|n, channel| bench.signal(&pad, n, channel));
        let mut apart = 0f64;
        for part in [8, 4, 2] {
            let at = (bench.profile.slot.blanking() + bench.profile.slot.integrate / part) as usize;
            let codes = bench.slot(|n, channel| {
                let grown = if n >= at && channel < bench.terminals() { 3.0 } else { 1.0 };
                grown * bench.signal(&pad, n, channel)
            });
            apart = apart.max(within(&bench, codes, &steady).0);
            compared += 2;
        }
        outcome =
            outcome.at_most(format!("capacitance, `{}`", bench.profile.name), apart, 0.05, "%");
    }
    outcome.equal(compared)
}

/// The window begins before what switching left has gone.
pub fn switching_before_settling() -> Outcome {
    let mut outcome = Outcome::of("departure from floating point on the same codes");
    let (mut compared, mut float) = (0, 0f64);
    for bench in Bench::all() {
        let (pad, blanked) = (bench.pad(0.3), bench.profile.slot.blanking() as f64);
        let ideal = bench.ideal(&pad).capacitance_pf;
        let steady = bench.slot(|n, channel| bench.signal(&pad, n, channel));
        let mut apart = 0f64;
        for left in [0.01, 0.1, 0.4] {
            let codes = bench.slot(|n, channel| {
                let gone = (-(n as f64 - blanked) / (0.2 * blanked)).exp();
                let tail = if channel < bench.terminals() { left * gone } else { 0.0 };
                bench.signal(&pad, n, channel) + tail
            });
            apart = apart.max(within(&bench, codes.clone(), &steady).0);
            let from = bench.profile.slot.blanking() as usize * bench.profile.channels();
            float = float
                .max(percent(bench.measure_in_float(&codes[from..]).capacitance_pf, ideal).abs());
            compared += 2;
        }
        outcome =
            outcome.at_most(format!("capacitance, `{}`", bench.profile.name), apart, 0.05, "%");
    }
    outcome
        .equal(compared)
        .rivals(format!("floating point: up to {float:.2} % off the settled pad"))
}
