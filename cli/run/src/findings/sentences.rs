// SPDX-License-Identifier: MIT OR Apache-2.0
//! Findings as sentences: lines for the end of a run, and warnings of what makes results wrong.

use super::{Findings, Flagged, Tracking};
use crate::number::number;

/// Flagged frames of a pad beyond this part of all are worth a warning.
const FLAGGED: f64 = 0.01;
/// Flags of where pads lie, which leave results as they are.
const PLACES: [&str; 2] = ["at_edge", "touching"];
/// A settled force is off its target, or what is read of it off the true one, by more than this part and this many N.
const OFF: f64 = 0.1;
const OFF_N: f64 = 0.03;
/// The reading of a core is off that of the host by more than this, percent.
const CORE_PERCENT: f64 = 0.1;
/// More mean friction against a hand that leaves a wall than the rules may leave (docs/results.md) is worth a warning, N.
const STICKING_N: f64 = 0.06;

/// One line each.
pub fn lines(of: &Findings) -> Vec<String> {
    of.flagged.iter().map(flagged).chain(of.tracking.iter().map(tracking)).collect()
}

/// What makes results wrong: kind, case and pad, and how much.
pub fn warnings(of: &Findings) -> Vec<String> {
    let is_often = |of: &&Flagged| of.frames as f64 > FLAGGED * of.of as f64;
    let of_results = |of: &&Flagged| !PLACES.contains(&of.flag.as_str());
    let flags = of.flagged.iter().filter(of_results).filter(is_often);
    let flags = flags.map(|of| format!("{}{}", flagged(of), remedy(&of.flag)));
    let changed = of.changed.iter().map(|(case, keys)| {
        format!(
            "calibration: case \"{case}\" has another device than was calibrated: {}",
            keys.join(", ")
        )
    });
    changed.chain(flags).chain(of.tracking.iter().flat_map(doubts)).collect()
}

fn signed_percent(percent: f64) -> String {
    format!("{}{} %", if percent < 0.0 { "−" } else { "+" }, number(percent.abs()))
}

fn flagged(of: &Flagged) -> String {
    let force = of.force_percent.map_or(String::new(), |percent| {
        format!("; in them the force reads {} of the true one", signed_percent(percent))
    });
    let Flagged { flag, case, pad, frames, of, .. } = of;
    format!("flag {flag}: case \"{case}\", pad \"{pad}\": {frames} of {of} frames{force}")
}

fn remedy(flag: &str) -> &'static str {
    match flag {
        "clipped" => "; raise the full scale that is too small (sensor.*_full_scale_*)",
        "at_rail" => "; the rail limits the force (control.rail_v)",
        "at_curve" => "; the curve limits the force: calibrate anew, or raise control.curve_factor",
        "at_slew" => "; the slew limits the drive (control.slew_v)",
        "swings" => "; the loop swings: lower gains, or a moving gap",
        _ => "",
    }
}

fn tracking(of: &Tracking) -> String {
    let settled = of.settled.map_or(String::new(), |at| {
        format!(
            "; settled at {} N: reads {} N, true {} N",
            number(at.target_n),
            number(at.read_n),
            number(at.true_n)
        )
    });
    let sticking = of.sticking_n.map_or(String::new(), |newtons| {
        format!("; sticking {} N while the hand leaves the wall", number(newtons))
    });
    let faults = match of.faults {
        0 => String::new(),
        faults => format!("; a fault kept {faults} of {} drives at zero", of.frames),
    };
    format!(
        "tracking: case \"{}\", pad \"{}\": up to {} N, {} N RMS off target, overshoot {} N{settled}{sticking}{faults}",
        of.case,
        of.pad,
        number(of.target_n),
        number(of.rms_n),
        number(of.overshoot_n)
    )
}

/// What of a controlled pad makes its results wrong.
fn doubts(of: &Tracking) -> Vec<String> {
    let at = format!("case \"{}\", pad \"{}\"", of.case, of.pad);
    let is_off = |value: f64, from: f64| (value - from).abs() > (OFF * from).max(OFF_N);
    let settled = of.settled;
    let missed = settled.filter(|at| is_off(at.read_n, at.target_n)).map(|settled| {
        format!(
            "target: {at}: the force reads {} N of {} N where the target stays",
            number(settled.read_n),
            number(settled.target_n)
        )
    });
    let misread = settled.filter(|at| is_off(at.read_n, at.true_n)).map(|settled| {
        let percent = 100.0 * (settled.read_n / settled.true_n - 1.0);
        format!(
            "force: {at}: the core reads {} N where the true force is {} N ({})",
            number(settled.read_n),
            number(settled.true_n),
            signed_percent(percent)
        )
    });
    let uncoupled = of.core_percent.filter(|percent| percent.abs() > CORE_PERCENT).map(|percent| {
        format!(
            "uncouple: {at}: crosstalk is cancelled in the host and not in the core, whose controller acts on a force that \
             is {} of the host's",
            signed_percent(percent)
        )
    });
    let sticks = of.sticking_n.filter(|newtons| *newtons > STICKING_N).map(|newtons| {
        format!("wall: {at}: sticks with {} N while the hand leaves it", number(newtons))
    });
    let faults = (of.faults > 0).then(|| {
        format!("fault: {at}: a fault kept {} of {} drives at zero", of.faults, of.frames)
    });
    [missed, misread, uncoupled, sticks, faults].into_iter().flatten().collect()
}
