// SPDX-License-Identifier: MIT OR Apache-2.0
//! Eqs. 11 and 12 as the paper has them.
//!
//! ```text
//! V = K_w·x̃  where x̃ < 0                          (eq. 11; its magnitude drives the pad)
//! V = K_w·x̃  where x̃ < 0 and x̃·Δx̃ ≤ 0            (eq. 12)
//! ```
//!
//! The paper's x̃ is a ratio of currents and its K_w a voltage per ratio, so `v_per_mm` is K_w over the millimetres of
//! a ratio of one. The sign of Δx̃ for a push into the wall depends on the order of the terminals and on how the pad is
//! held. As the paper writes it, x̃·Δx̃ ≤ 0 with x̃ < 0 asks for Δx̃ ≥ 0, `inwards` = +1. A pad pushed from above tips
//! forward: a push into this wall then gives Δx̃ < 0, `inwards` = −1. A pad without current keeps the last direction.

use super::{Direction, Frame, Rule, Target};

/// Eq. 11: the voltage by the place alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eq11 {
    /// K_w, V rms per mm of depth.
    pub v_per_mm: f64,
    /// What the amplifier gives at most, V rms.
    pub most_v: f64,
}

impl Eq11 {
    fn voltage(&self, x_mm: f64) -> f64 {
        (self.v_per_mm * (-x_mm).max(0.0)).min(self.most_v)
    }
}

impl Rule for Eq11 {
    fn frame(&mut self, frame: &Frame) -> (Target, Direction) {
        (Target::Voltage(self.voltage(frame.x_mm)), Direction::Push)
    }
}

/// Eq. 12: as eq. 11, only while the push does not lead out, as read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eq12 {
    /// Eq. 11.
    pub wall: Eq11,
    /// The sign, +1 or −1, with which a push into the wall reads.
    pub inwards: f64,
    /// The last direction that could be read.
    pub last: f64,
}

impl Rule for Eq12 {
    fn frame(&mut self, frame: &Frame) -> (Target, Direction) {
        self.last = frame.direction().unwrap_or(self.last);
        let into = frame.x_mm >= 0.0 || self.last * self.inwards >= 0.0;
        let volts = if into { self.wall.voltage(frame.x_mm) } else { 0.0 };
        (Target::Voltage(volts), if into { Direction::Push } else { Direction::Free })
    }
}
