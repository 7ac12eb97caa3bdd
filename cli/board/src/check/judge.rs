// SPDX-License-Identifier: MIT OR Apache-2.0
//! What explains the measurements best: a sound board, or one with one or two faults.
//!
//! ```text
//!   χ²(faults) = Σ ((r_x − r̂_x)/σ_r)² + ((r_y − r̂_y)/σ_r)² + (ln(C/Ĉ)/σ_C)² + PENALTY · faults,  each term at most MOST
//!   â_k = g_k·s_π(k)(place),   r̂ = Σ ±|â| / Σ|â|,   Ĉ = c_pad · |Σ â|,   c_pad from the pad's own readings
//! ```
//!
//! σ_C is wide, for a hand does not press the same everywhere. At a terminal's place its share is large, so that a
//! reversed wire shows nevertheless.

use super::expected::Expected;
use super::report::{Compared, Finding, Report};
use super::{Datum, noise};

/// Errors of ratios, and of the logarithm of a capacitance, that a sound board may show.
const SIGMA: [f64; 3] = [0.012, 0.012, 0.15];
/// What an additional fault must explain at least.
const PENALTY: f64 = 60.0;
/// One term at most.
const MOST: f64 = 400.0;
/// A mean term above this is explained by nothing that is known.
const UNCLEAR: f64 = 12.0;
/// A pad with less capacitance than this share of the median pad's is missing.
const MISSING: f64 = 0.02;

/// One fault of wires or pads.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    Open(usize),
    Reversed(usize),
    Swapped(usize, usize),
    Pads(usize, usize),
}

impl Fault {
    fn finding(self) -> Finding {
        match self {
            Fault::Open(terminal) => Finding::Open { terminal },
            Fault::Reversed(terminal) => Finding::Reversed { terminal },
            Fault::Swapped(a, b) => Finding::Swapped { terminals: [a, b] },
            Fault::Pads(a, b) => Finding::PadsSwapped { pads: [a, b] },
        }
    }
}

/// Judges data of all places.
pub(super) fn judge(expected: &Expected, data: Vec<Datum>, clipped: Vec<usize>) -> Report {
    let mut findings = clipped_findings(&clipped, expected.terminals());
    // The gain of a channel that clips is not the device's: what else is wrong shows once it is.
    if !findings.is_empty() {
        return Report { findings, compared: Vec::new() };
    }
    if data.iter().all(|datum| !datum.is_valid()) {
        findings.push(Finding::NoSense);
        return Report { findings, compared: Vec::new() };
    }
    let missing = missing(expected, &data);
    findings.extend(missing.iter().map(|pad| Finding::PadMissing { pad: *pad }));
    let of_pad = |datum: &&Datum| !missing.contains(&datum.pad);
    let there: Vec<Datum> = data.iter().filter(of_pad).copied().collect();
    if there.is_empty() {
        return Report { findings: vec![Finding::NoSense], compared: Vec::new() };
    }
    // Noise moves the means of amplitudes, too: wires are judged once it is gone.
    if let Some(noisy) = noise::findings(expected, &there) {
        findings.push(noisy);
        return Report { findings, compared: compared(expected, &there) };
    }
    let (faults, cost) = best(expected, &there, 2 - findings.len().min(2));
    let terms = 3.0 * there.len() as f64;
    if (cost - PENALTY * faults.len() as f64) / terms > UNCLEAR {
        findings.push(Finding::Unclear);
    } else {
        findings.extend(faults.iter().map(|fault| fault.finding()));
    }
    Report { findings, compared: compared(expected, &there) }
}

fn clipped_findings(clipped: &[usize], terminals: usize) -> Vec<Finding> {
    // All of them: those that clip do so at ±12.5 V, too.
    match clipped.len() > terminals {
        true => vec![Finding::AllClipped],
        false => clipped.iter().map(|channel| Finding::Clipped { channel: *channel }).collect(),
    }
}

/// Pads through which nothing flows at any place.
fn missing(expected: &Expected, data: &[Datum]) -> Vec<usize> {
    let mut all: Vec<f64> = data.iter().map(|datum| datum.mean[2]).collect();
    all.sort_by(f64::total_cmp);
    let usual = all[all.len() * 3 / 4];
    let is_missing = |pad: &usize| {
        let mut of_pad = data.iter().filter(|datum| datum.pad == *pad);
        of_pad.all(|datum| !datum.is_valid() || datum.mean[2] < MISSING * usual)
    };
    (0..expected.selects()).filter(is_missing).collect()
}

/// The faults, up to a number, that explain the data best, and their cost.
fn best(expected: &Expected, data: &[Datum], most: usize) -> (Vec<Fault>, f64) {
    let singles = singles(expected);
    let mut best = (Vec::new(), cost(expected, data, &[]));
    let mut consider = |faults: &[Fault]| {
        let cost = cost(expected, data, faults) + PENALTY * faults.len() as f64;
        if cost < best.1 {
            best = (faults.to_vec(), cost);
        }
    };
    if most >= 1 {
        singles.iter().for_each(|fault| consider(&[*fault]));
    }
    if most >= 2 {
        for (number, first) in singles.iter().enumerate() {
            singles[number + 1..].iter().for_each(|second| consider(&[*first, *second]));
        }
    }
    best
}

fn singles(expected: &Expected) -> Vec<Fault> {
    let terminals = expected.terminals();
    let pairs = |count: usize| (0..count).flat_map(move |b| (0..b).map(move |a| (a, b)));
    (0..terminals)
        .flat_map(|terminal| [Fault::Open(terminal), Fault::Reversed(terminal)])
        .chain(pairs(terminals).map(|(a, b)| Fault::Swapped(a, b)))
        .chain(pairs(expected.selects()).map(|(a, b)| Fault::Pads(a, b)))
        .collect()
}

/// What a pad reads at a place with these faults, its capacitance one.
fn predicted(expected: &Expected, datum: &Datum, faults: &[Fault]) -> ([f64; 3], usize) {
    let (parts, rounds) = (expected.parts(), expected.places.len());
    // Pads that are exchanged are at each other's places.
    let pad = faults.iter().fold(datum.pad, |pad, fault| match *fault {
        Fault::Pads(a, b) if pad == a => b,
        Fault::Pads(a, b) if pad == b => a,
        _ => pad,
    });
    let place = (datum.place + rounds + pad / parts - datum.pad / parts) % rounds;
    let mut amplitudes = expected.shares(place, pad % parts).to_vec();
    // Wires are exchanged before what acts on a channel.
    for fault in faults {
        if let Fault::Swapped(a, b) = *fault {
            amplitudes.swap(a, b);
        }
    }
    for fault in faults {
        match *fault {
            Fault::Open(terminal) => amplitudes[terminal] = 0.0,
            Fault::Reversed(terminal) => amplitudes[terminal] *= -1.0,
            _ => (),
        }
    }
    (expected.reading(&amplitudes), place)
}

fn cost(expected: &Expected, data: &[Datum], faults: &[Fault]) -> f64 {
    let pads = data.iter().map(|datum| datum.pad).max().map_or(0, |most| most + 1);
    (0..pads)
        .map(|pad| {
            let of_pad: Vec<_> = data.iter().filter(|datum| datum.pad == pad).collect();
            cost_of_pad(expected, &of_pad, faults)
        })
        .sum()
}

fn cost_of_pad(expected: &Expected, data: &[&Datum], faults: &[Fault]) -> f64 {
    let terms: Vec<([f64; 2], f64)> = data
        .iter()
        .map(|datum| {
            let (predicted, place) = predicted(expected, datum, faults);
            let [r_x, r_y, capacitance_pf] = datum.mean;
            let sheet = expected.through_sheet(place, capacitance_pf);
            let of = (capacitance_pf.max(1e-3) / (predicted[2] * sheet).max(1e-3)).ln();
            ([r_x - predicted[0], r_y - predicted[1]], of)
        })
        .collect();
    let mut logarithms: Vec<f64> = terms.iter().map(|(_, of)| *of).collect();
    logarithms.sort_by(f64::total_cmp);
    let usual = logarithms.get(logarithms.len() / 2).copied().unwrap_or(0.0);
    let square = |off: f64, sigma: f64| (off / sigma).powi(2).min(MOST);
    let cost = |(datum, (off, logarithm)): (&&Datum, &([f64; 2], f64))| {
        if !datum.is_valid() {
            return 3.0 * MOST / 4.0;
        }
        square(off[0], SIGMA[0]) + square(off[1], SIGMA[1]) + square(logarithm - usual, SIGMA[2])
    };
    data.iter().zip(&terms).map(cost).sum()
}

/// Expected and measured ratios at each place, of a sound board.
fn compared(expected: &Expected, data: &[Datum]) -> Vec<Compared> {
    let of = |datum: &Datum| {
        let ([r_x, r_y, _], place) = predicted(expected, datum, &[]);
        Compared {
            pad: datum.pad,
            at_mm: expected.places[place],
            expected: [r_x, r_y],
            measured: [datum.mean[0], datum.mean[1]],
            capacitance_pf: datum.mean[2],
        }
    };
    data.iter().map(of).collect()
}
