// SPDX-License-Identifier: MIT OR Apache-2.0
//! How far the force of a controlled pad is off its target, and off what the core reads.

use hapticore_scene::WallPlan;
use serde::Serialize;

use crate::control::plant::surface_of;
use crate::record::{Driven, Row, Truth};

/// A target has stayed for so long where a force is taken for settled, s.
const SETTLED_S: f64 = 0.05;
/// Least target, and least pull of a hand that leaves, N.
const LEAST_N: f64 = 0.01;

/// A pad that a controller drives, in a case. Forces are in N.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Tracking {
    /// Name of the case.
    pub case: String,
    /// Name of the pad, or of the part that brakes.
    pub pad: String,
    /// Largest target.
    pub target_n: f64,
    /// Root mean square of true force less target.
    pub rms_n: f64,
    /// The most by which the true force exceeds its target.
    pub overshoot_n: f64,
    /// Where a target above zero has stayed for 50 ms: mean target, mean force that the core reads, and mean true force;
    /// none where no target stays.
    pub settled: Option<Settled>,
    /// The force in the core, where the host's crosstalk cancellation finds another: mean of the core's by mean of the
    /// host's, less one, percent.
    pub core_percent: Option<f64>,
    /// Frames whose drive a fault keeps at zero.
    pub faults: usize,
    /// Frames.
    pub frames: usize,
    /// Mean friction that the haptic force makes while a hand pulls the pad out of its wall; none without such frames.
    pub sticking_n: Option<f64>,
}

/// A pad whose target stays.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Settled {
    /// Mean target.
    pub target_n: f64,
    /// Mean force that the core reads.
    pub read_n: f64,
    /// Mean true force.
    pub true_n: f64,
}

/// A row of a pad with what its controller and the plant make of it.
type Frame<'a> = (&'a Row, Driven, Truth);

/// The driven pads of a case: of each the part that brakes.
pub fn of_case(
    (case, pads): (&str, &[String]),
    rows: &[Row],
    (start_s, parts_mm): (f64, &[[f64; 2]]),
    wall: Option<&WallPlan>,
) -> Vec<Tracking> {
    let brakes = (0..pads.len()).filter(|pad| pad % parts_mm.len() == parts_mm.len() - 1);
    let of_pad = |pad: usize| {
        let frames = rows.iter().filter(|row| row.pad == pad);
        let frames: Vec<Frame> =
            frames.filter_map(|row| Some((row, row.driven?, row.truth?))).collect();
        if frames.is_empty() {
            return None;
        }
        let leaving = |(row, _, truth): &&Frame| {
            wall.is_some_and(|wall| leaves(wall, parts_mm, pad, row.time_s - start_s, truth))
        };
        let sticking = frames.iter().filter(leaving).map(|(_, _, truth)| truth.haptic_friction_n);
        Some(Tracking {
            case: case.into(),
            pad: pads[pad].clone(),
            target_n: frames.iter().map(|(_, driven, _)| driven.target_n).fold(0.0, f64::max),
            rms_n: mean(frames.iter().map(|frame| off_n(frame).powi(2))).unwrap_or_default().sqrt(),
            overshoot_n: frames.iter().map(off_n).fold(0.0, f64::max),
            settled: settled(&frames),
            core_percent: core_percent(&frames),
            faults: frames.iter().filter(|(_, driven, _)| driven.fault).count(),
            frames: frames.len(),
            sticking_n: mean(sticking),
        })
    };
    brakes.filter_map(of_pad).collect()
}

/// True force less its target: that of a wall, or of the scene at the time.
fn off_n((_, driven, truth): &Frame) -> f64 {
    match driven.free {
        Some(_) => truth.quantities.force_n - driven.target_n,
        None => truth.off_target_n(),
    }
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0usize), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / count as f64)
}

/// Whether a hand pulls a pad out of the wall along x in which it lies.
fn leaves(wall: &WallPlan, parts_mm: &[[f64; 2]], pad: usize, time_s: f64, truth: &Truth) -> bool {
    let surface = surface_of(wall, parts_mm, pad, time_s);
    let side = if surface.right { 1.0 } else { -1.0 };
    side * (truth.quantities.x_mm - surface.mm) > 0.0 && -side * truth.hand_x_n > LEAST_N
}

fn settled(frames: &[Frame]) -> Option<Settled> {
    let mut since_s = f64::INFINITY;
    let mut target_n = f64::NAN;
    let mut kept: Vec<&Frame> = Vec::new();
    for frame in frames {
        let (row, driven, _) = frame;
        if driven.target_n != target_n {
            (target_n, since_s) = (driven.target_n, row.time_s);
        }
        if driven.free.is_none() && target_n > LEAST_N && row.time_s - since_s >= SETTLED_S {
            kept.push(frame);
        }
    }
    let of = |value: fn(&Frame) -> f64| mean(kept.iter().map(|frame| value(frame)));
    Some(Settled {
        target_n: of(|(_, driven, _)| driven.target_n)?,
        read_n: of(|(row, _, _)| row.measured.force_n)?,
        true_n: of(|(_, _, truth)| truth.quantities.force_n)?,
    })
}

fn core_percent(frames: &[Frame]) -> Option<f64> {
    let pairs = || {
        frames.iter().filter_map(|(row, driven, _)| Some((driven.core_n?, row.measured.force_n)))
    };
    let core_n = mean(pairs().map(|(core_n, _)| core_n))?;
    let host_n = mean(pairs().map(|(_, host_n)| host_n))?;
    (host_n > LEAST_N).then(|| 100.0 * (core_n / host_n - 1.0))
}
