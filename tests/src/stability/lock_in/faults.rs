// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lines and samples that fail.

use fastrand::Rng;
use hapticore_contract::frame::Frame;

use crate::stability::Outcome;
use crate::stability::bench::{Bench, Pad, percent};
use crate::stability::case::Number;
use crate::stability::rivals::idsp_lowpass_residue;

/// Zeros for ever.
pub fn zero_input() -> Outcome {
    let (mut compared, mut largest) = (0, 0f64);
    for bench in Bench::all() {
        let mut fixed = bench.fixed();
        fixed.slot(0, &bench.window(|_, _| 2.0));
        let zeros = bench.window(|_, _| 0.0);
        let sums = fixed.sums(&zeros).into_iter().map(f64::abs).fold(0.0, f64::max);
        largest = largest.max(sums / bench.profile.formats.adc.lsb());
        let first = fixed.slot(0, &zeros);
        assert!(first.flags.invalid);
        for _ in 0..200 {
            assert_eq!(fixed.slot(0, &zeros), first);
            compared += 1;
        }
    }
    let residue = [0.9, 0.97].map(|step| match idsp_lowpass_residue(step, 100_000) {
        Some(left) => format!("{left} steps of its word left"),
        None => "overflow of a sum of 32 bits".into(),
    });
    Outcome::default()
        .equal(compared)
        .at_most("sums", largest, 1e-3, "LSB of the ADC")
        .rivals(format!(
            "idsp's second-order low-pass, 100,000 zeros after a step of 0.9 of full scale: {}; of 0.97: {}",
            residue[0], residue[1]
        ))
}

/// Loud and quiet slots in turn.
pub fn full_scale_steps() -> Outcome {
    let mut compared = 0;
    for bench in Bench::all() {
        let quiet = bench.slot(|n, channel| bench.signal(&bench.pad(1e-3), n, channel));
        let loud = bench.slot(|_, channel| if channel % 2 == 0 { 2.0 } else { -2.0 });
        let mut everyone = bench.everyone();
        let alone = everyone.slot(&quiet);
        for _ in 0..10 {
            everyone.slot(&loud);
            assert_eq!(everyone.slot(&quiet), alone);
            compared += 1;
        }
    }
    Outcome::default().equal(compared)
}

/// A window with one set of codes less, or more.
pub fn missing_and_repeated_samples() -> Outcome {
    let mut outcome = Outcome::of("error of the capacitance");
    let (mut compared, mut float) = (0, 0f64);
    for bench in Bench::all() {
        let (pad, middle) = (
            bench.pad(0.3),
            bench.profile.slot.blanking() as usize + bench.profile.slot.integrate as usize / 2,
        );
        let ideal = bench.ideal(&pad).capacitance_pf;
        let whole = bench.slot(|n, channel| bench.signal(&pad, n, channel));
        let mut everyone = bench.everyone();
        let first = everyone.slot(&whole);
        let mut worst = 0f64;
        for shift in [1isize, -1] {
            let disturbed = bench.slot(|n, channel| {
                let of = if n < middle { n } else { n.saturating_add_signed(shift) };
                bench.signal(&pad, of, channel)
            });
            let frame = everyone.slot(&disturbed);
            worst =
                worst.max(percent(frame.measurement(&bench.profile).capacitance_pf, ideal).abs());
            let window =
                &disturbed[bench.profile.slot.blanking() as usize * bench.profile.channels()..];
            float = float.max(percent(bench.measure_in_float(window).capacitance_pf, ideal).abs());
            assert_eq!(everyone.slot(&whole), first, "the next frame is right");
            compared += 1;
        }
        let limit = float + 0.05;
        outcome = outcome.at_most(format!("`{}`", bench.profile.name), worst, limit, "%");
    }
    outcome.equal(compared).rivals(format!("floating point: {} %", Number(float)))
}

/// One terminal beyond full scale.
pub fn clipping_in_one_channel() -> Outcome {
    let mut outcome = Outcome::of("error of the clipped current");
    for bench in Bench::all() {
        let plain = bench.measure(&bench.codes(&bench.pad(0.96)));
        assert!(!plain.flags.clipped);
        // A phase at which one of five samples per period is at the peak.
        let pad = Pad { phase: 0.15, ..bench.pad(1.04) };
        let clipped = bench.measure(&bench.codes(&pad));
        assert!(clipped.flags.clipped);
        let float = bench.measure_in_float(&bench.codes(&pad));
        let error = percent(clipped.capacitance_pf, bench.ideal(&pad).capacitance_pf);
        assert!(error < 0.0, "clipping takes current away: {error} %");
        outcome = outcome.at_most(
            format!("against floating point, `{}`", bench.profile.name),
            percent(clipped.capacitance_pf, float.capacitance_pf).abs(),
            1.0,
            "%",
        );
    }
    outcome
}

/// Lines that give nothing.
pub fn line_faults() -> Outcome {
    let mut compared = 0;
    for bench in Bench::all() {
        let (pad, terminals) = (bench.pad(0.3), bench.terminals());
        let lsb = bench.profile.formats.adc.lsb();
        let mut rng = Rng::with_seed(3);
        let mut faulty = |kind: usize, of: Option<usize>| {
            let codes = bench.window(|n, channel| {
                if channel >= terminals || of.is_some_and(|of| of != channel) {
                    return bench.signal(&pad, n, channel);
                }
                match kind {
                    0 => -lsb,
                    1 => 0.0,
                    _ => lsb * f64::from(rng.i8(-1..=1)),
                }
            });
            bench.measure(&codes)
        };
        for kind in 0..3 {
            for terminal in 0..terminals {
                assert!(
                    faulty(kind, Some(terminal)).flags.lost,
                    "{} terminal {terminal}, kind {kind}",
                    bench.profile.name
                );
                compared += 1;
            }
            let all = faulty(kind, None);
            let nothing = all.flags.invalid || all.capacitance_pf < 0.1;
            assert!(nothing, "{}: all lines, kind {kind}: {all:?}", bench.profile.name);
            compared += 1;
        }
    }
    Outcome::default().holds(compared)
}

/// Bits that do not move.
pub fn stuck_bit() -> Outcome {
    let mut outcome = Outcome::of("departure from floating point on the same codes");
    let (mut compared, mut worst) = (0, 0f64);
    for bench in Bench::all() {
        let (pad, channels) = (bench.pad(0.3), bench.profile.channels());
        let good = bench.codes(&pad);
        let ideal = bench.ideal(&pad).capacitance_pf;
        let (mut fixed, mut apart) = (bench.fixed(), 0f64);
        let first: Frame = fixed.slot(0, &good);
        for (bit, one) in
            (0..bench.profile.formats.adc.width - 1).flat_map(|bit| [(bit, false), (bit, true)])
        {
            let stuck: Vec<i32> = good
                .iter()
                .enumerate()
                .map(|(n, &code)| match n % channels {
                    2 if one => code | 1 << bit,
                    2 => code & !(1 << bit),
                    _ => code,
                })
                .collect();
            let found = fixed.slot(0, &stuck).measurement(&bench.profile).capacitance_pf;
            apart = apart.max(percent(found, bench.measure_in_float(&stuck).capacitance_pf).abs());
            worst = worst.max(percent(found, ideal).abs());
            assert_eq!(fixed.slot(0, &good), first, "right again");
            compared += 1;
        }
        outcome = outcome.at_most(format!("`{}`", bench.profile.name), apart, 0.1, "%");
    }
    outcome.equal(compared).rivals(format!(
        "what the highest bit does to the capacitance: {worst:.0} %; no flag tells"
    ))
}
