// SPDX-License-Identifier: MIT OR Apache-2.0
//! Predicted stability of a force loop: its open loop from drive to drive, frame by frame, for small
//! changes about a steady force.
//!
//! ```text
//! L(z) = C(z)·G(z),   G(z) = Σ (s_n − s_(n−1))·z^−n        s_n: what a step of the drive has done after n frames
//! integral       C = K_p + K_i·T/(1 − 1/z)     s of √F̂
//! proportional   C = α·K_p/(1 − (1−α)/z)       s of F̂
//! inverse        C = V                         s of ln C′;   its trim adds V·K_i/(1 − 1/z) times the G of √F̂
//! ```
//!
//! s is that of the simulated pad alone, without core, noise or words, after the law in floating point has settled
//! it. Latency of the drive word and the middle of the window are the loop's. The force F̂ is by eq. 8, or true
//! where the core has a force table. What follows of a factor on the gains (gain margin) and of the phase at |L| =
//! 1 (phase margin) is read on a grid up to half the frame rate. The time constants of a force table's filters are
//! no part of it. Beside it stands a step of the same loop from zero: pull-in is no small change. Where charge
//! makes a turn of the wave change the force, both are between turns. Source: docs/physics.md §6.

use std::f64::consts::PI;

use anyhow::{Context, Result};
use hapticore_contract::control::{Control, Tuning};
use hapticore_contract::profile::ForceLaw;
use hapticore_reference::control::{Controller, Prompt};
use hapticore_scene::{Complex, ControlLaw, ControlPlan, HapticWave, Plant, Truth};

use super::gains::Gains;
use crate::case::Case;
use crate::interrupt;
use crate::record::{Stability, Step};

/// How long the loop is closed, how long its drive is held before a step, and how long that is
/// followed, s. A film near its pull-in goes on moving under a drive that is held, which a loop would
/// have corrected: that is left out.
const CLOSED_S: f64 = 0.3;
const REST_S: f64 = 0.003;
const FOLLOWED_S: f64 = 0.03;
/// Frames that are followed at least.
const FOLLOWED: usize = 20;
/// Drives whose mean is held.
const MEAN: usize = 20;
/// Fewest frames of a step; their last third shows whether it settles.
const STEPPED: usize = 60;
/// By how much of its target the force of a settled loop may swing.
const MOST_SWING_PERCENT: f64 = 10.0;
/// Frames from one turn of the wave to the next, between which a loop can be followed.
const LEAST_TURN: f64 = 4.0;
/// A step, of the voltage.
const STEP: f64 = 1e-3;
/// Frequencies of the grid.
const GRID: usize = 600;
/// A phase margin below this leads to a warning, degrees.
pub const LEAST_PHASE_DEG: f64 = 45.0;

/// The open loop about a steady force.
pub struct OpenLoop {
    law: ControlLaw,
    /// K_p and K_i·T, or α·K_p and 1 − α, or V.
    gains: [f64; 2],
    /// What a step of 1 V has done to the law's quantity and to √F̂, frame by frame; nothing in the first.
    response: Vec<[f64; 2]>,
    /// V·K_i of the inverse law's trim.
    trim: f64,
    /// From a pad's slot to its next, s.
    pub frame_s: f64,
    /// From the middle of a window to the middle of the time for which its drive is held, s.
    pub delay_s: f64,
    /// Steady drive, V rms.
    pub rest_v: f64,
}

impl OpenLoop {
    /// That of a case at a force; none where it has no loop, or its pads are served part by part.
    ///
    /// # Errors
    /// A plant that cannot be, a force that no drive gives.
    pub fn of(case: &Case, force_n: f64) -> Result<Option<OpenLoop>> {
        let Some(bench) = Bench::of(case, force_n)? else { return Ok(None) };
        let open = OpenLoop::about(&bench, &case.gains()?, Rest::Closed)?;
        Ok(Some(open))
    }

    /// That of a law before its gains are known, about a drive that is held.
    ///
    /// # Errors
    /// As [`OpenLoop::of`].
    pub(super) fn held(bench: &Bench, drive_v: f64) -> Result<OpenLoop> {
        OpenLoop::about(bench, &Gains::default(), Rest::Held(drive_v))
    }

    fn about(bench: &Bench, gains: &Gains, rest: Rest) -> Result<OpenLoop> {
        let shifts = bench.shifts()?;
        let (mut rest_v, mut response) = (0.0, Vec::<[f64; 2]>::new());
        for shift in 0..shifts {
            let (held_v, before) = bench.followed(rest, 0.0, shift)?;
            let (_, after) = bench.followed(rest, STEP, shift)?;
            rest_v = held_v;
            response.resize(before.len(), [0.0; 2]);
            for (response, (after, before)) in response.iter_mut().zip(after.iter().zip(&before)) {
                for of in 0..2 {
                    response[of] += (after[of] - before[of]) / (STEP * rest_v * shifts as f64);
                }
            }
        }
        let delay_s = bench.window_s / 2.0 + bench.latency_s + bench.frame_s / 2.0;
        let open = OpenLoop {
            law: bench.plan.law,
            gains: [rest_v, 0.0],
            response,
            trim: rest_v * bench.trim_per_root(),
            frame_s: bench.frame_s,
            delay_s,
            rest_v,
        };
        Ok(open.with(bench.plan, gains))
    }

    /// The same with other gains.
    pub(super) fn with(&self, plan: &ControlPlan, of: &Gains) -> OpenLoop {
        let gains = match plan.law {
            ControlLaw::Integral => [of.proportional_v, of.integral_v * self.frame_s],
            ControlLaw::Proportional => [plan.filter * of.proportional_v, 1.0 - plan.filter],
            _ => [self.rest_v, 0.0],
        };
        OpenLoop { gains, response: self.response.clone(), ..*self }
    }

    /// The gain per frame with which the law corrects a step in one frame.
    pub(super) fn unit_gain(&self) -> f64 {
        1.0 / self.response.iter().fold(0.0, |most: f64, [step, _]| most.max(*step))
    }

    /// L at a frequency.
    pub fn at(&self, hz: f64) -> Complex {
        let one = Complex::new(1.0, 0.0);
        let back = Complex::from_polar(1.0, -2.0 * PI * hz * self.frame_s);
        let [first, second] = self.gains;
        let law = match self.law {
            ControlLaw::Integral => first + second / (one - back),
            ControlLaw::Proportional => first / (one - back * second),
            _ => Complex::new(first, 0.0),
        };
        let trim = self.trim / (one - back);
        let (mut loops, mut power, mut last) = (Complex::default(), one, [0.0; 2]);
        for &step in &self.response {
            loops += power * (law * (step[0] - last[0]) + trim * (step[1] - last[1]));
            (power, last) = (power * back, step);
        }
        loops
    }

    /// Margins of the loop, for a case at a force.
    pub fn margins(&self, force_n: f64) -> Stability {
        let top = 0.5 / self.frame_s;
        let bottom = top / 500.0;
        let hz = |n: usize| bottom * (top / bottom).powf(n as f64 / (GRID - 1) as f64);
        let grid: Vec<(f64, Complex)> = (0..GRID).map(|n| (hz(n), self.at(hz(n)))).collect();
        Stability { force_n, frame_s: self.frame_s, delay_s: self.delay_s, ..margins(&grid) }
    }
}

/// Gain and phase margin of an open loop that is known at these frequencies.
pub fn margins(grid: &[(f64, Complex)]) -> Stability {
    let mut found = Stability::default();
    let degrees = |of: Complex| (-of).arg().to_degrees();
    for pair in grid.windows(2) {
        let [(low_hz, low), (high_hz, high)] = [pair[0], pair[1]];
        if low.norm() >= 1.0 && high.norm() < 1.0 {
            let part = low.norm().ln() / (low.norm() / high.norm()).ln();
            let crossover = low + (high - low) * part;
            let margin = degrees(crossover);
            if found.phase_margin_deg.is_none_or(|known| margin < known) {
                found.phase_margin_deg = Some(margin);
                found.crossover_hz = Some(low_hz * (high_hz / low_hz).powf(part));
            }
        }
        let turns = low.im.signum() != high.im.signum() && low.re < 0.0 && high.re < 0.0;
        if turns {
            let part = low.im / (low.im - high.im);
            found.limit(-(low.re + (high.re - low.re) * part));
        }
    }
    // At half the frame rate an open loop is real.
    if let Some((_, last)) = grid.last().filter(|(_, last)| last.re < 0.0) {
        found.limit(last.norm());
    }
    found
}

/// What a step of a case's loop from zero to a force does; none where it has no loop.
///
/// # Errors
/// As [`OpenLoop::of`].
pub fn step(case: &Case, force_n: f64) -> Result<Option<Step>> {
    Bench::of(case, force_n)?.map(|bench| bench.step()).transpose()
}

impl Step {
    /// Whether the loop settles.
    pub fn settles(&self) -> bool {
        self.swing_percent <= MOST_SWING_PERCENT
    }
}

impl Stability {
    fn limit(&mut self, gain: f64) {
        let margin = 1.0 / gain;
        if self.gain_margin.is_none_or(|known| margin < known) {
            self.gain_margin = Some(margin);
        }
    }

    /// Whether no disturbance grows.
    pub fn stable(&self) -> bool {
        self.gain_margin.is_none_or(|margin| margin > 1.0)
            && self.phase_margin_deg.is_none_or(|margin| margin > 0.0)
    }
}

/// A pad whose loop is closed in floating point, without a core, until it settles. Then its drive
/// is held, so that the film has the history that it has in the loop.
pub(super) struct Bench<'a> {
    case: &'a Case,
    plan: &'a ControlPlan,
    tuning: Tuning,
    force_n: f64,
    frame_s: f64,
    window_s: f64,
    latency_s: f64,
    /// The pad is that of the device when it was calibrated.
    as_calibrated: bool,
}

/// What settles a pad.
#[derive(Clone, Copy, Debug)]
enum Rest {
    /// The law.
    Closed,
    /// A drive, V rms.
    Held(f64),
}

impl<'a> Bench<'a> {
    /// That of a case whose loop is closed; none of pads that are served part by part.
    fn of(case: &'a Case, force_n: f64) -> Result<Option<Self>> {
        let closes = |plan: &&ControlPlan| plan.law != ControlLaw::Open && case.device.parts == 1;
        let Some(plan) = case.plan().filter(closes) else { return Ok(None) };
        let tuning = case.tuning(&case.plant()?)?.context("a case with a controller")?;
        let bench = Bench::new(case, plan, tuning, force_n)?;
        Ok(Some(Bench { as_calibrated: false, ..bench }))
    }

    /// A bench for the device as it was calibrated.
    ///
    /// # Errors
    /// A profile without a controller.
    pub(super) fn new(
        case: &'a Case,
        plan: &'a ControlPlan,
        tuning: Tuning,
        force_n: f64,
    ) -> Result<Self> {
        let frame_s = case.clock.seconds(case.profile.pads as usize);
        let window_s = case.profile.slot.integrate as f64 / case.clock.sample_rate_hz();
        let latency_s = case.drive_latency_s()?;
        let as_calibrated = true;
        Ok(Bench { case, plan, tuning, force_n, frame_s, window_s, latency_s, as_calibrated })
    }

    fn frames(&self, seconds: f64) -> usize {
        (seconds / self.frame_s).ceil() as usize
    }

    /// The steady drive, and the law's quantity, frame by frame, from the slot on after which the
    /// drive has risen by `part` of it. The rise is `shift` frames later than usual.
    fn followed(&self, by: Rest, part: f64, shift: usize) -> Result<(f64, Vec<[f64; 2]>)> {
        let (mut plant, pads) = (self.idle_plant()?, self.case.profile.pads as usize);
        let mut controller = self.controller()?;
        let closed = self.frames(CLOSED_S);
        let [rest, end] = self.between_turns(&plant, closed + self.frames(REST_S));
        let [rest, end] = [rest + shift, end + shift];
        let (mut drives, mut quantities) = (Vec::new(), Vec::new());
        let mut held_v = 0.0;
        for frame in 0..=end {
            interrupt::check()?;
            let truth = plant.truth(frame * pads);
            let start_s = self.start_s(frame);
            if frame < closed {
                let drive_v = match by {
                    Rest::Closed => self.asked_v(&mut controller, &truth),
                    Rest::Held(drive_v) => drive_v,
                };
                drives.push(drive_v);
                plant.set_drive(0, start_s, drives[frame])?;
                let last = &drives[drives.len().saturating_sub(MEAN)..];
                held_v = last.iter().sum::<f64>() / last.len() as f64;
            } else if frame == closed {
                plant.set_drive(0, start_s, held_v)?;
            } else if frame == rest {
                plant.set_drive(0, start_s, held_v * (1.0 + part))?;
            }
            if frame >= rest {
                quantities.push([self.quantity(&truth), self.measured_n(&truth).sqrt()]);
            }
        }
        Ok((held_v, quantities))
    }

    /// The frame whose drive is stepped, and the last that is followed. Both are between two turns of the wave,
    /// where a turn changes the measured force and there are frames enough from turn to turn.
    fn between_turns(&self, plant: &Plant, rest: usize) -> [usize; 2] {
        let end = rest + self.frames(FOLLOWED_S).max(FOLLOWED);
        let turn_s = self.turn_s(plant).filter(|turn_s| *turn_s >= LEAST_TURN * self.frame_s);
        let Some(turn_s) = turn_s else { return [rest, end] };
        let turn = (self.start_s(rest) / turn_s).floor() + 1.0;
        let frame_after = |time_s: f64| (time_s / self.frame_s).ceil() as usize;
        let rest = frame_after(turn * turn_s);
        [
            rest,
            frame_after((turn + 1.0) * turn_s).saturating_sub(2).clamp(rest + 1, end.max(rest + 1)),
        ]
    }

    /// Frames of a round of the wave from which a step is followed, where turns come too often to follow it between two.
    fn shifts(&self) -> Result<usize> {
        let turn_s = self.turn_s(&self.case.plant()?);
        let often = turn_s.filter(|turn_s| *turn_s < LEAST_TURN * self.frame_s);
        Ok(often.map_or(1, |turn_s| ((2.0 * turn_s / self.frame_s).ceil() as usize).max(2)))
    }

    /// From one turn of the haptic voltage to the next, where charge makes it change the force.
    fn turn_s(&self, plant: &Plant) -> Option<f64> {
        let charges = self.case.scene.cases[self.case.index].effects();
        let charges = charges.iter().any(|(name, _)| *name == "charge");
        match plant.device().haptic_wave {
            HapticWave::Square { turn_s } if charges => turn_s,
            _ => None,
        }
    }

    /// What the loop makes of a step of its target from zero to the force.
    ///
    /// # Errors
    /// A plant that cannot be.
    pub(super) fn step(&self) -> Result<Step> {
        let (mut plant, pads) = (self.idle_plant()?, self.case.profile.pads as usize);
        let mut controller = self.controller()?;
        let frames = self.frames(CLOSED_S).max(STEPPED);
        let mut forces_n = Vec::with_capacity(frames);
        for frame in 0..frames {
            interrupt::check()?;
            let truth = plant.truth(frame * pads);
            forces_n.push(self.measured_n(&truth));
            let drive_v = self.asked_v(&mut controller, &truth);
            plant.set_drive(0, self.start_s(frame), drive_v)?;
        }
        let last = frames * 2 / 3..frames;
        let spread = |forces_n: &[f64]| {
            let most = forces_n.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            most - forces_n.iter().copied().fold(f64::INFINITY, f64::min)
        };
        let swing_n = match self.turn_s(&plant) {
            None => spread(&forces_n[last.clone()]),
            // A turn of the wave is no swing of the loop: frames of one polarity, where turns come too often.
            Some(turn_s) if turn_s < LEAST_TURN * self.frame_s => {
                let frames: Vec<usize> = last.clone().collect();
                let polarity = |frame: &usize| (self.start_s(*frame) / turn_s).floor() as usize % 2;
                let of = |side: usize| {
                    let frames = frames.iter().filter(|frame| polarity(frame) == side);
                    spread(&frames.map(|n| forces_n[*n]).collect::<Vec<_>>())
                };
                of(0).max(of(1))
            }
            Some(turn_s) => {
                let turn = |frame: usize| (self.start_s(frame) / turn_s).floor() as usize;
                let frames: Vec<usize> = last.clone().collect();
                let between = frames.chunk_by(|a, b| turn(*a) == turn(*b));
                between
                    .filter_map(|run| run.get(2..))
                    .map(|run| spread(&run.iter().map(|n| forces_n[*n]).collect::<Vec<_>>()))
                    .fold(0.0, f64::max)
            }
        };
        let most_n = forces_n.iter().copied().fold(0.0, f64::max);
        let rest_n = forces_n[last.clone()].iter().sum::<f64>() / last.len() as f64;
        let percent = |newtons: f64| 100.0 * newtons / self.force_n;
        Ok(Step {
            overshoot_percent: percent(most_n - self.force_n).max(0.0),
            swing_percent: percent(swing_n),
            rest_n,
        })
    }

    /// When the drive begins that a frame leads to.
    fn start_s(&self, frame: usize) -> f64 {
        self.case.clock.seconds(frame * self.case.profile.pads as usize + 1) + self.latency_s
    }

    fn controller(&self) -> Result<Controller> {
        let control = self.case.profile.control.as_ref().context("a profile with a controller")?;
        Ok(Controller::new(control, &self.tuning, 1))
    }

    /// The plant, before its first slot, none of whose pads is driven.
    fn idle_plant(&self) -> Result<Plant> {
        let now = self.case.plant()?;
        let then = if self.as_calibrated { now.as_calibrated()? } else { None };
        let mut plant = then.unwrap_or(now);
        for pad in 0..self.case.profile.pads as usize {
            plant.set_drive(pad, 0.0, 0.0)?;
        }
        Ok(plant)
    }

    /// The drive that the law asks for, V rms.
    fn asked_v(&self, controller: &mut Controller, truth: &Truth) -> f64 {
        controller.hear();
        let drive = controller.drive(&self.prompt(truth), self.force_n);
        self.plan.full_scale_v * drive.fraction
    }

    /// K_i of the inverse law's trim, for √N and frame; other laws have none.
    fn trim_per_root(&self) -> f64 {
        let control = self.case.profile.control.as_ref();
        let root = control.map_or(1.0, Control::root_full_scale);
        if self.plan.law == ControlLaw::Inverse { self.tuning.correction / root } else { 0.0 }
    }

    fn quantity(&self, truth: &Truth) -> f64 {
        match self.plan.law {
            ControlLaw::Integral => self.measured_n(truth).sqrt(),
            ControlLaw::Proportional => self.measured_n(truth),
            _ => truth.capacitance_pf.ln(),
        }
    }

    /// What a core without errors finds.
    fn prompt(&self, truth: &Truth) -> Prompt {
        let part = truth.haptic_v_rms / self.plan.full_scale_v;
        let (capacitance_pf, force_n) = (truth.capacitance_pf, self.measured_n(truth));
        // Of eq. 8, in the words of a core; by a table in proportion.
        let full_v = self.plan.full_scale_v * 1e-12;
        let eq8 = self.case.device.device.force_k * full_v * full_v;
        let by_eq8 = eq8 * (capacitance_pf * part).powi(2);
        let ratio = if by_eq8 > 1e-4 { force_n / by_eq8 } else { 1.0 };
        let force_gain = ratio * eq8 * self.tuning.full_drive;
        Prompt { pad: 0, capacitance_pf, force_n, force_gain, invalid: false, lifted: false }
    }

    fn measured_n(&self, truth: &Truth) -> f64 {
        // A part's capacitance is not the pad's.
        if self.case.profile.force.law == ForceLaw::Table || self.case.device.parts > 1 {
            return truth.force_n;
        }
        let charge = truth.capacitance_pf * 1e-12 * truth.haptic_v_rms;
        self.case.device.device.force_k * charge * charge
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integral laws over a plant that follows within a frame: stable where i < 2·(1 − p) (Jury).
    #[test]
    fn a_loop_without_dynamics_has_the_margins_of_its_polynomial() {
        for (p, i) in [(0.1, 0.5), (0.1, 1.7), (0.1, 1.9), (0.0, 1.0)] {
            let (law, gains) = (ControlLaw::Integral, [p, i]);
            let response = vec![[0.0; 2], [1.0, 0.0]];
            let of = OpenLoop {
                law,
                gains,
                response,
                trim: 0.0,
                frame_s: 1e-3,
                delay_s: 0.0,
                rest_v: 1.0,
            };
            let margins = of.margins(0.3);
            let expected = 1.0 / (p + i / 2.0);
            assert!((margins.gain_margin.unwrap() / expected - 1.0).abs() < 1e-6, "{p} {i}");
            assert_eq!(margins.stable(), i < 2.0 * (1.0 - p), "{p} {i}");
        }
        // i alone: |L| = 1 where 2·sin(π f T) = i; its phase is −90° − 180°·f·T.
        let of = OpenLoop {
            law: ControlLaw::Integral,
            gains: [0.0, 0.5],
            response: vec![[0.0; 2], [1.0, 0.0]],
            trim: 0.0,
            frame_s: 1e-3,
            delay_s: 0.0,
            rest_v: 1.0,
        };
        let margins = of.margins(0.3);
        let crossover = 0.25f64.asin() / (PI * 1e-3);
        assert!((margins.crossover_hz.unwrap() / crossover - 1.0).abs() < 1e-3);
        let phase = 90.0 - 180.0 * crossover * 1e-3;
        assert!((margins.phase_margin_deg.unwrap() - phase).abs() < 0.1, "{margins:?}");
        // A trim alone is the same loop, of the root of the force.
        let law = ControlLaw::Inverse;
        let trimmed = OpenLoop {
            law,
            gains: [0.0; 2],
            response: vec![[0.0; 2], [0.0, 1.0]],
            trim: 0.5,
            ..of
        };
        assert_eq!(trimmed.margins(0.3), margins);
    }
}
