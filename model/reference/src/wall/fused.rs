// SPDX-License-Identifier: MIT OR Apache-2.0
//! Walls that are linear in the depth: without release, released by eq. 12 on a calibrated
//! direction, and the fused rule.
//!
//! ```text
//! fused:  ū += (u − offset − ū)·α,   x̄ += (x − x̄)/4,   v += (Δx/T − v)/8
//!         PUSH → FREE where ū > threshold and v ≥ −speed
//!         FREE → PUSH where ū < −threshold, or v < −speed
//! ```
//!
//! The direction of motion engages the wall only, so that it does not vanish on entry; letting it
//! also release was worse (docs/physics.md §6).

use super::{Direction, Frame, Rule, Stiffness, Target};

/// A linear wall; with an offset for the direction it releases as eq. 12 does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    /// The wall's force.
    pub stiffness: Stiffness,
    /// What the direction reads without a push; the wall never releases where there is none.
    pub offset: Option<f64>,
}

impl Rule for Linear {
    fn frame(&mut self, frame: &Frame) -> (Target, Direction) {
        let out = match (self.offset, frame.direction()) {
            (Some(offset), Some(u)) => frame.x_mm < 0.0 && u > offset,
            _ => false,
        };
        let force_n = if out { 0.0 } else { self.stiffness.at(frame.x_mm) };
        (Target::Force(force_n), if out { Direction::Free } else { Direction::Push })
    }
}

/// The fused rule: offset-calibrated, filtered, with hysteresis; motion inwards engages.
#[derive(Clone, Debug)]
pub struct Fused {
    stiffness: Stiffness,
    offset: f64,
    /// α of the direction's low-pass.
    share: f64,
    threshold: f64,
    speed_mm_s: f64,
    frame_ms: f64,
    filtered: f64,
    last_mm: Option<f64>,
    speed: f64,
    direction: Direction,
}

impl Fused {
    /// A wall whose direction reads `offset` without a push, with frames of `frame_ms`; the low-pass
    /// has 10 ms, the hysteresis is ± 0.004 and motion engages from 5 mm/s.
    pub fn new(stiffness: Stiffness, offset: f64, frame_ms: f64) -> Self {
        Fused {
            stiffness,
            offset,
            share: 1.0 - (-frame_ms / 10.0).exp(),
            threshold: 0.004,
            speed_mm_s: 5.0,
            frame_ms,
            filtered: 0.0,
            last_mm: None,
            speed: 0.0,
            direction: Direction::Push,
        }
    }
}

impl Rule for Fused {
    fn frame(&mut self, frame: &Frame) -> (Target, Direction) {
        let moved_mm = frame.x_mm - self.last_mm.replace(frame.x_mm).unwrap_or(frame.x_mm);
        self.speed += (1e3 * moved_mm / self.frame_ms - self.speed) / 8.0;
        if let Some(u) = frame.direction() {
            self.filtered += (u - self.offset - self.filtered) * self.share;
        }
        let inwards = self.speed < -self.speed_mm_s;
        if frame.x_mm >= 0.0 || inwards || self.filtered < -self.threshold {
            self.direction = Direction::Push;
        } else if self.filtered > self.threshold {
            self.direction = Direction::Free;
        }
        let force_n = match self.direction {
            Direction::Push => self.stiffness.at(frame.x_mm),
            Direction::Free => 0.0,
        };
        (Target::Force(force_n), self.direction)
    }
}
