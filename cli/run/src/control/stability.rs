// SPDX-License-Identifier: MIT OR Apache-2.0
//! How stable a force loop is, predicted: its open loop from drive to drive, frame by frame, for small
//! changes about a force at rest.
//!
//! ```text
//! L(z) = C(z)·G(z),   G(z) = Σ (s_n − s_(n−1))·z^−n        s_n: what a step of the drive has done after n frames
//! integral       C = K_p + K_i·T/(1 − 1/z)     s of √F̂
//! proportional   C = α·K_p/(1 − (1−α)/z)       s of F̂
//! inverse        C = V                         s of ln C′
//! ```
//!
//! s is that of the simulated pad alone, without core, noise or words, after the law in floating point
//! has brought it to rest: latency of the drive word and the middle of the window are the loop's. The force F̂ is by eq. 8, or true where the core
//! has a force table. What follows of a factor on the gains (gain margin) and of the phase at |L| = 1
//! (phase margin) is read on a grid up to half the frame rate. The time constants of a force table's
//! filters are no part of it. Source: docs/physics.md §6.

use std::f64::consts::PI;

use anyhow::{Context, Result};
use hapticore_contract::control::Tuning;
use hapticore_contract::profile::ForceLaw;
use hapticore_reference::control::{Controller, Prompt};
use hapticore_scene::{Complex, ControlLaw, ControlPlan, Truth};

use crate::case::Case;
use crate::interrupt;
use crate::record::Stability;

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
/// A step, of the voltage.
const STEP: f64 = 1e-3;
/// Frequencies that are looked at.
const GRID: usize = 600;
/// Below this a warning is given, degrees.
pub const LEAST_PHASE_DEG: f64 = 45.0;

/// The open loop about a force at rest.
pub struct OpenLoop {
    law: ControlLaw,
    /// K_p and K_i·T, or α·K_p and 1 − α, or V.
    gains: [f64; 2],
    /// What a step of 1 V has done to the law's quantity, frame by frame; nothing in the first.
    response: Vec<f64>,
    /// From a pad's slot to its next, s.
    pub frame_s: f64,
    /// From the middle of a window to the middle of the time for which its drive is given, s.
    pub delay_s: f64,
    /// Drive at rest, V rms.
    pub rest_v: f64,
}

impl OpenLoop {
    /// That of a case at a force; none where it has no loop, or its pads are served part by part.
    ///
    /// # Errors
    /// A plant that cannot be, a force that no drive gives.
    pub fn of(case: &Case, force_n: f64) -> Result<Option<OpenLoop>> {
        let closes = |plan: &&ControlPlan| plan.law != ControlLaw::Open && case.device.parts == 1;
        let Some(plan) = case.plan().filter(closes) else { return Ok(None) };
        let frame_s = case.clock.seconds(case.profile.pads as usize);
        let window_s = case.profile.slot.integrate as f64 / case.device.device.sample_rate_hz;
        let bench = Bench::new(case, plan, force_n)?;
        let (rest_v, before) = bench.followed(0.0)?;
        let (_, after) = bench.followed(STEP)?;
        let change = after.iter().zip(&before).map(|(after, before)| after - before);
        let gains = match plan.law {
            ControlLaw::Integral => [plan.proportional_v, plan.integral_v * frame_s],
            ControlLaw::Proportional => [plan.filter * plan.proportional_v, 1.0 - plan.filter],
            _ => [rest_v, 0.0],
        };
        let response = change.map(|change| change / (STEP * rest_v)).collect();
        let delay_s = window_s / 2.0 + bench.latency_s + frame_s / 2.0;
        Ok(Some(OpenLoop { law: plan.law, gains, response, frame_s, delay_s, rest_v }))
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
        let (mut plant, mut power, mut last) = (Complex::default(), one, 0.0);
        for &step in &self.response {
            plant += power * (step - last);
            (power, last) = (power * back, step);
        }
        law * plant
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

/// A pad whose loop is closed in floating point, without a core, until it rests; then its drive is
/// held: what the film has been through is as in the loop.
struct Bench<'a> {
    case: &'a Case<'a>,
    plan: &'a ControlPlan,
    tuning: Tuning,
    force_n: f64,
    frame_s: f64,
    latency_s: f64,
}

impl<'a> Bench<'a> {
    fn new(case: &'a Case<'a>, plan: &'a ControlPlan, force_n: f64) -> Result<Self> {
        let tuning = case.tuning(&case.plant()?)?.context("a case with a controller")?;
        let frame_s = case.clock.seconds(case.profile.pads as usize);
        Ok(Bench { case, plan, tuning, force_n, frame_s, latency_s: case.drive_latency_s()? })
    }

    /// The drive at rest, and the law's quantity, frame by frame, from the slot on after which the
    /// drive has risen by a part of it.
    fn followed(&self, part: f64) -> Result<(f64, Vec<f64>)> {
        let (mut plant, pads) = (self.case.plant()?, self.case.profile.pads as usize);
        let control = self.case.profile.control.as_ref().context("a profile with a controller")?;
        let mut controller = Controller::new(control, &self.tuning, 1);
        for pad in 0..pads {
            plant.set_drive(pad, 0.0, 0.0)?;
        }
        let frames = |seconds: f64| (seconds / self.frame_s).ceil() as usize;
        let closed = frames(CLOSED_S);
        let rest = closed + frames(REST_S);
        let (mut drives, mut quantities) = (Vec::new(), Vec::new());
        let mut held_v = 0.0;
        for frame in 0..=rest + frames(FOLLOWED_S).max(FOLLOWED) {
            interrupt::check()?;
            let truth = plant.truth(frame * pads);
            let start_s = self.case.clock.seconds(frame * pads + 1) + self.latency_s;
            if frame < closed {
                controller.hear();
                let drive = controller.drive(&self.prompt(&truth), self.force_n);
                drives.push(self.plan.full_scale_v * drive.fraction);
                plant.set_drive(0, start_s, drives[frame])?;
                let last = &drives[drives.len().saturating_sub(MEAN)..];
                held_v = last.iter().sum::<f64>() / last.len() as f64;
            } else if frame == closed {
                plant.set_drive(0, start_s, held_v)?;
            } else if frame == rest {
                plant.set_drive(0, start_s, held_v * (1.0 + part))?;
            }
            if frame >= rest {
                quantities.push(self.quantity(&truth));
            }
        }
        Ok((held_v, quantities))
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
        if self.case.profile.force.law == ForceLaw::Table {
            return truth.force_n;
        }
        let charge = truth.capacitance_pf * 1e-12 * truth.haptic_v_rms;
        self.case.device.device.force_k * charge * charge
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integral laws over a plant that follows at once: stable where i < 2·(1 − p) (Jury).
    #[test]
    fn a_loop_without_dynamics_has_the_margins_of_its_polynomial() {
        for (p, i) in [(0.1, 0.5), (0.1, 1.7), (0.1, 1.9), (0.0, 1.0)] {
            let (law, gains, response) = (ControlLaw::Integral, [p, i], vec![0.0, 1.0]);
            let of = OpenLoop { law, gains, response, frame_s: 1e-3, delay_s: 0.0, rest_v: 1.0 };
            let margins = of.margins(0.3);
            let expected = 1.0 / (p + i / 2.0);
            assert!((margins.gain_margin.unwrap() / expected - 1.0).abs() < 1e-6, "{p} {i}");
            assert_eq!(margins.stable(), i < 2.0 * (1.0 - p), "{p} {i}");
        }
        // i alone: |L| = 1 where 2·sin(π f T) = i; its phase is −90° − 180°·f·T.
        let of = OpenLoop {
            law: ControlLaw::Integral,
            gains: [0.0, 0.5],
            response: vec![0.0, 1.0],
            frame_s: 1e-3,
            delay_s: 0.0,
            rest_v: 1.0,
        };
        let margins = of.margins(0.3);
        let crossover = 0.25f64.asin() / (PI * 1e-3);
        assert!((margins.crossover_hz.unwrap() / crossover - 1.0).abs() < 1e-3);
        let phase = 90.0 - 180.0 * crossover * 1e-3;
        assert!((margins.phase_margin_deg.unwrap() - phase).abs() < 0.1, "{margins:?}");
    }
}
