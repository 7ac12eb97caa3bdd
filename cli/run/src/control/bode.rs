// SPDX-License-Identifier: MIT OR Apache-2.0
//! A force loop measured: a sine of small amplitude on the drive of the first pad, or on its target,
//! at one frequency after the other.
//!
//! ```text
//! v = u + d,   L = −U/(U + D)          u: what the controller asks for, d: what is added, v: what the pad is given
//! ```
//!
//! From target to true force, a sine of the target is added instead; the force is that of the pad's
//! slots, held from each to the next. U and D are amplitudes at the frequency, over whole periods
//! under a Hann window, after the loop has settled. Core, noise, words and estimates are those of
//! the run; `clock` is measured by `fixed`, whose words are its own.

use std::f64::consts::TAU;

use anyhow::{Context, Result, ensure};
use hapticore_scene::Complex;

use super::plant::Excitation;
use super::stability::{OpenLoop, margins};
use crate::case::{Case, Settings};
use crate::engine::Fidelity;
use crate::interrupt;
use crate::maker::Maker;
use crate::record::{Bode, BodePoint};
use crate::session::{Options, Session};

/// Frames that are measured, and the time before them, s.
const FRAMES: usize = 400;
const REST_S: f64 = 0.3;
/// Periods within them, one frequency each.
const PERIODS: [usize; 16] = [6, 9, 13, 18, 25, 34, 45, 58, 72, 87, 103, 119, 135, 151, 167, 183];
/// Amplitudes of the sines, as parts of the steady drive and of the target.
const OF_DRIVE: f64 = 0.01;
const OF_TARGET: f64 = 0.05;

/// A slot of the first pad.
struct Sample {
    end_s: f64,
    drive_v: f64,
    force_n: f64,
}

impl Sample {
    /// What a sine has made of a slot.
    fn beyond((excited, idle): (&Sample, &Sample)) -> Sample {
        let [drive_v, force_n] = [excited.drive_v - idle.drive_v, excited.force_n - idle.force_n];
        Sample { end_s: excited.end_s, drive_v, force_n }
    }
}

/// Measures the loop of a case about a force; none where it has no loop. `run` runs the frequencies.
///
/// # Errors
/// A case that cannot be run; a force at which the loop does not follow.
pub fn measure(
    case: &Case,
    settings: &Settings,
    force_n: f64,
    run: impl Fn(&(dyn Fn(usize) -> Result<BodePoint> + Sync)) -> Result<Vec<BodePoint>>,
) -> Result<Option<Bode>> {
    let Some(open) = OpenLoop::of(case, force_n)? else { return Ok(None) };
    let frequency = |index: usize| PERIODS[index] as f64 / (FRAMES as f64 * open.frame_s);
    // What the loop does without a sine: turns of the wave, and what is left of its settling.
    let still = Excitation { hold_n: force_n, ..Excitation::default() };
    let idle = follow(case, settings, still)?;
    let point = |index: usize| {
        let hz = frequency(index);
        let drive_v = OF_DRIVE * open.rest_v;
        let at = |target_n: f64, drive_v: f64| {
            let excitation = Excitation { hold_n: force_n, target_n, drive_v, hz };
            let excited = follow(case, settings, excitation)?;
            anyhow::Ok(excited.iter().zip(&idle).map(Sample::beyond).collect::<Vec<_>>())
        };
        let on_drive = at(0.0, drive_v)?;
        let on_target = at(OF_TARGET * force_n, 0.0)?;
        let asked = amplitude(&on_drive, hz, |sample| sample.drive_v);
        let added = amplitude(&on_drive, hz, |sample| drive_v * (TAU * hz * sample.end_s).sin());
        let force = amplitude(&on_target, hz, |sample| sample.force_n);
        let target = amplitude(&on_target, hz, |sample| {
            OF_TARGET * force_n * (TAU * hz * sample.end_s).sin()
        });
        let closed_db = 20.0 * (hold(hz * open.frame_s) * force.norm() / target.norm()).log10();
        let measured = -asked / (asked + added);
        let point =
            BodePoint { hz, open: polar(measured), predicted: polar(open.at(hz)), closed_db };
        ensure!(
            follows(&point),
            "--bode: expected a force that the loop of case \"{}\" can follow, from its drive's smallest step up to what its \
             rail gives; at {force_n} N a sine of {hz:.1} Hz moves nothing",
            case.name()
        );
        Ok(point)
    };
    let points = run(&point)?;
    let of = |point: &BodePoint| (point.hz, complex(point.open));
    let measured = margins(&points.iter().map(of).collect::<Vec<_>>());
    let predicted = open.margins(force_n);
    Ok(Some(Bode {
        case: case.name().into(),
        measured: crate::record::Stability {
            force_n,
            frame_s: predicted.frame_s,
            delay_s: predicted.delay_s,
            ..measured
        },
        predicted,
        bandwidth_hz: bandwidth_hz(&points),
        points,
    }))
}

/// Whether all of a point is a number: drive and force move with the sine. At a rail, and below the smallest step of a
/// drive, they do not.
fn follows(point: &BodePoint) -> bool {
    let numbers = [point.open, point.predicted].concat();
    numbers.iter().chain([&point.closed_db]).all(|number| number.is_finite())
}

/// The amplitude that is left of a sine in steps, each held for `periods` of its periods: true
/// forces are sampled once a frame.
fn hold(periods: f64) -> f64 {
    let angle = std::f64::consts::PI * periods;
    angle.sin() / angle
}

/// How many frequencies there are.
pub fn frequencies() -> usize {
    PERIODS.len()
}

/// dB, and degrees from −360 to 0: a loop's phase falls.
fn polar(of: Complex) -> [f64; 2] {
    let degrees = of.arg().to_degrees();
    [20.0 * of.norm().log10(), if degrees > 0.0 { degrees - 360.0 } else { degrees }]
}

fn complex([db, degrees]: [f64; 2]) -> Complex {
    Complex::from_polar(10f64.powf(db / 20.0), degrees.to_radians())
}

/// Where the force first follows with 3 dB less than at the lowest frequency.
fn bandwidth_hz(points: &[BodePoint]) -> Option<f64> {
    let limit = points.first()?.closed_db - 3.0;
    let pair = points.windows(2).find(|pair| pair[1].closed_db < limit)?;
    let [low, high] = [pair[0], pair[1]];
    let part = (low.closed_db - limit) / (low.closed_db - high.closed_db);
    Some(low.hz * (high.hz / low.hz).powf(part))
}

/// The amplitude of a quantity of the last frames.
fn amplitude(samples: &[Sample], hz: f64, of: impl Fn(&Sample) -> f64) -> Complex {
    let samples = &samples[samples.len() - FRAMES..];
    let mean = samples.iter().map(&of).sum::<f64>() / FRAMES as f64;
    let term = |(n, sample): (usize, &Sample)| {
        let hann = 1.0 - (TAU * n as f64 / FRAMES as f64).cos();
        Complex::from_polar(hann * (of(sample) - mean), -TAU * hz * sample.end_s)
    };
    samples.iter().enumerate().map(term).sum::<Complex>() * (2.0 / FRAMES as f64)
}

/// The quickest fidelity with the same frames and drive words.
fn alike(fidelity: Fidelity) -> Fidelity {
    if fidelity == Fidelity::Clock { Fidelity::Fixed } else { fidelity }
}

/// The first pad's slots under an excitation.
fn follow(case: &Case, settings: &Settings, excitation: Excitation) -> Result<Vec<Sample>> {
    let plant = case.plant()?;
    let tuning = case.tuning(&plant)?.context("a case with a controller")?;
    let device = (&**case.device, case.calibration()?);
    let options = Options { fidelity: alike(settings.fidelity), errors: false, reference: false };
    let at = (case.number, case.clock);
    let mut session = Session::new(&case.profile, device, (options, Some(&tuning)), at)?;
    let sampled = case.scene.cases[case.index].sampled();
    let maker = Maker::new(plant, &case.profile, sampled, false);
    let mut plant = case.loop_plant(maker)?.with_excitation(excitation);
    let pads = case.profile.pads as usize;
    let rest = (REST_S / case.clock.seconds(pads)).ceil() as usize;
    let mut samples = Vec::with_capacity(rest + FRAMES);
    for number in 0..(rest + FRAMES) * pads {
        interrupt::check()?;
        let made = plant.slot(number);
        session.set_target(made.slot.pad, made.target_n)?;
        session.slot(&made.slot, None)?;
        let driven = plant.drive(&made, session.take_drive())?;
        if let Some(driven) = driven.filter(|_| made.slot.pad == 0) {
            let (end_s, force_n) = (made.end_s, made.truth.force_n);
            samples.push(Sample { end_s, drive_v: driven.drive_v_rms, force_n });
        }
    }
    Ok(samples)
}
