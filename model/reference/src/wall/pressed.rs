// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pushes of rule B that may have ended.
//!
//! Halves that brake cannot read the level of a push that has pulled patches in, but its change. Where the pad has not slipped inwards for a while and the push reads weaker than at its last
//! slip, the force falls, until the pad slips or the direction can be read:
//!
//! ```text
//! ū += (u − ū)/8;   r, d: ū and the deepest x̄ of the push, taken where PUSH is entered
//! PUSH, last F > 0.75 N               y = min(y, 0)
//! x̄ < d − 25 µm (slips inwards)       gain += 4/40 per ms;   r = ū,   d += (x̄ − d)/2,   q = 0
//! otherwise                           ū < r: r += (ū − r)/4;   d < x̄ − 25 µm: d += (x̄ − 25 µm − d)/16;   q counts
//!   q > 100 ms and ū − r > σ           gain −= 1/40 per ms
//!   otherwise                         gain += 1/40 per ms
//! ```
//!
//! F, x̄, u, gain, PUSH and σ are those of `sequential.rs`. Source: docs/physics.md §6.

/// How a push that has pulled patches in is doubted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fade {
    /// Time without a slip inwards after which the force may fall, ms.
    pub quiet_ms: f64,
    /// What counts as a slip, mm.
    pub slip_mm: f64,
    /// The force beyond which no reading lets go, N.
    pub latch_n: f64,
}

/// What is known of a push from its last slip inwards on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pressed {
    /// Filtered u, at least, r.
    u: f64,
    /// The place to which it has slipped, d, mm.
    deep_mm: f64,
    /// The time since then, q, ms.
    quiet_ms: f64,
}

impl Pressed {
    /// A push that begins at a place, reading this.
    pub fn at(u: f64, deep_mm: f64) -> Self {
        Pressed { u, deep_mm, quiet_ms: 0.0 }
    }

    /// By how many steps of its ramp the force rises in a frame; it falls where the push may have ended.
    pub fn steps(
        &mut self,
        fade: &Fade,
        (slow_u, sigma): (f64, f64),
        filtered_mm: f64,
        frame_ms: f64,
    ) -> f64 {
        if filtered_mm < self.deep_mm - fade.slip_mm {
            *self = Pressed::at(slow_u, (self.deep_mm + filtered_mm) / 2.0);
            return 4.0;
        }
        self.quiet_ms += frame_ms;
        self.deep_mm += (filtered_mm - fade.slip_mm - self.deep_mm).max(0.0) / 16.0;
        self.u += (slow_u - self.u).min(0.0) / 4.0;
        let is_weaker = slow_u - self.u > sigma;
        if is_weaker && self.quiet_ms > fade.quiet_ms { -1.0 } else { 1.0 }
    }
}
