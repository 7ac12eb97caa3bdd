// SPDX-License-Identifier: MIT OR Apache-2.0
//! The haptic voltage's mean square, and eq. 8.
//!
//! ```text
//! m = [Σ w h² / 2^s],   F = [[[C²] · m] · gain]
//! ```

use super::currents::{growth, power_above};
use super::{Exact, Rounded, round};
use crate::profile::Profile;

/// The force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Force {
    /// In newtons.
    pub force: Exact,
    /// Whether a word is held at a rail.
    pub saturated: bool,
}

/// The mean square from a window's sum of squares.
pub fn mean_square(profile: &Profile, sum: Exact) -> Rounded {
    round(sum.scaled(-power_above(growth(profile, 1.0))), profile.formats.mean_square)
}

/// The force from capacitance and mean square.
pub fn force(profile: &Profile, capacitance: Exact, mean_square: Exact, gain: Exact) -> Force {
    let f = &profile.formats;
    let square = round(capacitance * capacitance, f.square);
    let energy = round(square.value * mean_square, f.square);
    let force = round(energy.value * gain, f.force);
    Force { force: force.value, saturated: square.held | energy.held | force.held }
}
