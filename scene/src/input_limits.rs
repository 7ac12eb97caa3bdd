// SPDX-License-Identifier: MIT OR Apache-2.0
//! What inputs of a plant may be, as in scenes, and why one is refused.

use crate::format::Limits;

/// What the voltage of a source, V rms, the load on a pad, g, and a push on it, N, may be, as in scenes.
pub(crate) const VOLTAGE: Limits = Limits::within(0.0, 1e5);
pub(crate) const LOAD: Limits = Limits::within(0.0, 1e5);
pub(crate) const PUSH: Limits = Limits::within(-1e4, 1e4);

/// An input of the plant that cannot be set.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DriveError {
    /// The plant has no such pad.
    #[error("expected a pad below {pads}, got {pad}")]
    NoPad {
        /// Which was asked for.
        pad: usize,
        /// Pads of the plant.
        pads: usize,
    },
    /// The plant has been evaluated at a later time, or the pad has the same input set for one.
    #[error("expected a time of {earliest_s} s or later, got {time_s} s")]
    Past {
        /// When it should have been set.
        time_s: f64,
        /// The earliest time that is left.
        earliest_s: f64,
    },
    /// The voltage is negative, too high, or no number.
    #[error("expected 0 to 100000 V rms, got {0}")]
    Voltage(f64),
    /// The load is negative, too high, or no number.
    #[error("expected a load of 0 to 100000 g, got {0}")]
    Load(f64),
    /// A push is too high, or no number.
    #[error("expected a push of -10000 to 10000 N, got {0}")]
    Push(f64),
    /// Nothing moves the pad but its trajectory.
    #[error("expected no push: it acts on pads that a [hand] moves, and the scene has none")]
    NoHand,
    /// The pad's centre would be where the pad does not lie on the sheet.
    #[error("expected a place within ±{} × ±{} mm, got [{}, {}]", reach_mm[0], reach_mm[1], place_mm[0], place_mm[1])]
    Place {
        /// Where it should go, mm from the sheet's centre.
        place_mm: [f64; 2],
        /// How far it may, mm.
        reach_mm: [f64; 2],
    },
    /// A place that should be reached before the finger leaves for it.
    #[error("expected to arrive after {from_s} s, got {at_s} s")]
    Arrival {
        /// When the finger leaves.
        from_s: f64,
        /// When it should arrive.
        at_s: f64,
    },
}
