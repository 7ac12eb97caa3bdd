// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whole slots at the ends of what an ADC can give.

use std::f64::consts::TAU;

use fastrand::Rng;
use hapticore_contract::frame::Frame;

use crate::stability::Outcome;
use crate::stability::bench::{Bench, Everyone, Pad, percent};
use crate::stability::case::Number;

/// Runs slots of every profile through the core by every way, and sums up what was compared.
fn compare(mut slots: impl FnMut(&Bench, &mut Everyone)) -> u64 {
    Bench::all()
        .iter()
        .map(|bench| {
            let mut everyone = bench.everyone();
            slots(bench, &mut everyone);
            everyone.slots
        })
        .sum()
}

/// Most negative codes.
pub fn most_negative_code() -> Outcome {
    let compared = compare(|bench, everyone| {
        let channels = bench.profile.channels();
        for alone in (0..channels).map(Some).chain([None]) {
            let codes = bench
                .slot(|_, channel| if alone.is_none_or(|of| of == channel) { -2.0 } else { 0.0 });
            let frame = everyone.slot(&codes);
            assert!(frame.flags.clipped, "{alone:?}");
        }
    });
    Outcome::default().equal(compared)
}

/// Rectangular waves between the rails.
pub fn full_scale_square_wave() -> Outcome {
    const PHASES: usize = 16;
    let compared = compare(|bench, everyone| {
        let turns = bench.profile.turns_per_sample();
        for slot in 0..PHASES {
            let wave = |n: usize, channel: usize| {
                let phase = (slot * (channel + 1)) as f64 / PHASES as f64;
                2.0 * (TAU * (turns * n as f64 + phase)).cos().signum()
            };
            let frame = everyone.slot(&bench.slot(wave));
            assert!(frame.flags.clipped);
        }
    });
    Outcome::default().equal(compared)
}

/// A good slot, then one without a result.
pub fn zero_and_negative_denominators() -> Outcome {
    let compared = compare(|bench, everyone| {
        let good = bench.pad(0.2);
        let of = |pad: &Pad| bench.slot(|n, channel| bench.signal(pad, n, channel));
        let silent = Pad { currents: vec![0.0; bench.terminals()], ..good.clone() };
        let without_voltage = Pad { sense: 0.0, ..good.clone() };
        let lost_in_the_sheet = Pad { sense: 1e-3, ..bench.pad(0.9) };
        let mut last_valid = everyone.slot(&of(&good));
        assert!(!last_valid.flags.invalid);
        for bad in [silent, without_voltage, lost_in_the_sheet] {
            let frame = everyone.slot(&of(&bad));
            if !frame.flags.invalid {
                // Rounding within `small` leaves a step of its sums: a pad of no capacitance.
                let pf = frame.measurement(&bench.profile).capacitance_pf;
                assert!(bad.sense > 0.1 && pf < 0.1, "{bad:?}: {pf} pF");
                last_valid = frame;
                continue;
            }
            let held = |frame: &Frame| frame.codes[..5].to_vec();
            assert_eq!(held(&frame), held(&last_valid), "{bad:?}: last valid results held");
            last_valid = everyone.slot(&of(&good));
            assert!(!last_valid.flags.invalid, "right again in the next slot");
        }
    });
    Outcome::default().equal(compared)
}

/// Ratios to the rails.
pub fn table_edges_and_corners() -> Outcome {
    let (mut invalid, mut all) = (0, 0);
    let mut beyond = 0f64;
    for bench in Bench::all() {
        let mut everyone = bench.everyone();
        let mut rng = Rng::with_seed(15);
        let sets = 2 * bench.terminals() + 60;
        for set in 0..sets {
            let terminals = bench.terminals();
            let currents = (0..terminals)
                .map(|k| match set {
                    _ if set < terminals => {
                        if k == set {
                            0.5
                        } else {
                            0.0
                        }
                    }
                    _ if set < 2 * terminals => {
                        if k == set - terminals || k == (set + 1) % terminals { 0.5 } else { 1e-4 }
                    }
                    _ => 0.5 * rng.f64() * f64::from(rng.u8(0..2)),
                })
                .collect();
            let pad = Pad { currents, ..bench.pad(0.5) };
            let frame = everyone.slot(&bench.slot(|n, channel| bench.signal(&pad, n, channel)));
            let found = frame.measurement(&bench.profile);
            if !frame.flags.invalid {
                beyond = beyond.max(found.x_mm.abs() - 400.0).max(found.y_mm.abs() - 220.0);
            }
            invalid += u64::from(frame.flags.invalid);
            all += 1;
        }
    }
    Outcome::of(format!("{invalid} of {all} are invalid")).equal(all).at_most(
        "place beyond the edge",
        beyond.max(0.0),
        0.01,
        "mm",
    )
}

/// Many slots, one after the other.
pub fn phase_wrap() -> Outcome {
    let compared = compare(|bench, everyone| {
        let pad = bench.pad(0.4);
        let codes = bench.slot(|n, channel| bench.signal(&pad, n, channel));
        let first = everyone.slot(&codes);
        for slot in 1..100 {
            assert_eq!(everyone.slot(&codes), first, "slot {slot}");
        }
    });
    Outcome::default().equal(compared)
}

/// A pad in the middle.
pub fn negative_zero() -> Outcome {
    let mut compared = 0;
    for bench in Bench::all() {
        let middle = Pad { currents: vec![0.3; bench.terminals()], haptic: 0.0, ..bench.pad(0.3) };
        let codes = bench.codes(&middle);
        let found = bench.measure(&codes);
        let results =
            [found.r_x, found.r_y, found.x_mm, found.y_mm, found.force_n, found.mean_square];
        assert!(found.force_n == 0.0 && found.r_x == 0.0, "zeros to be written: {found:?}");
        for number in results {
            assert!(!format!("{number}").starts_with("-0"), "{results:?}");
            compared += 1;
        }
    }
    Outcome::default().holds(compared)
}

/// Amplitude over the phase.
pub fn rounding_seen_as_phase() -> Outcome {
    const PHASES: usize = 64;
    let bench = Bench::of("standard");
    let amplitude = 512.0 * bench.profile.formats.adc.lsb();
    let found = |core: bool| {
        let errors: Vec<f64> = (0..PHASES)
            .map(|k| {
                let pad = Pad { phase: k as f64 / PHASES as f64, ..bench.pad(amplitude) };
                let codes = bench.codes(&pad);
                let (core_pf, float_pf) = (
                    bench.measure(&codes).capacitance_pf,
                    bench.measure_in_float(&codes).capacitance_pf,
                );
                if core {
                    percent(core_pf, float_pf)
                } else {
                    percent(float_pf, bench.ideal(&pad).capacitance_pf)
                }
            })
            .collect();
        let [low, high] =
            [f64::min, f64::max].map(|of| errors.iter().copied().reduce(of).expect("phases"));
        (high - low) / 2.0
    };
    Outcome::of("profile `standard`")
        .at_most("change with the phase", found(true), 0.05, "%")
        .rivals(format!(
            "what the ADC's rounding alone does in floating point: {} %",
            Number(found(false))
        ))
}
