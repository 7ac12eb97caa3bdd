// SPDX-License-Identifier: MIT OR Apache-2.0
//! The haptic voltage's mean square, and eq. 8.
//!
//! ```text
//! m = [Σ w h² / 2^s],   M = [Σ m / N] over the pad's last N,   F = [[[C²] · M] · gain]
//! ```

use super::currents::{growth, power_above};
use super::{Exact, Rounded, round};
use hapticore_contract::profile::Profile;

/// Haptic force of a slot, exactly rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Force {
    /// Haptic force, N.
    pub force: Exact,
    /// What (C·V)² is multiplied by.
    pub gain: Exact,
    /// The result is saturated.
    pub saturated: bool,
}

/// The mean square from a window's sum of squares.
pub fn mean_square(profile: &Profile, sum: Exact) -> Rounded {
    round(sum.scaled(-power_above(growth(profile, 1.0))), profile.formats.mean_square)
}

/// The last mean squares of every pad.
#[derive(Debug, Clone)]
pub struct Squares {
    windows: usize,
    pads: Vec<Vec<Exact>>,
}

impl Squares {
    /// Those of a profile's pads, none yet.
    pub fn new(profile: &Profile) -> Self {
        Squares {
            windows: profile.haptic.windows as usize,
            pads: vec![Vec::new(); profile.pads as usize],
        }
    }

    /// The mean over the pad's last windows with this one, which alone counts until there are as
    /// many; of several windows each at full scale counts as saturated.
    pub fn mean(&mut self, profile: &Profile, pad: usize, newest: Rounded) -> Rounded {
        let last = &mut self.pads[pad];
        if last.len() == self.windows {
            last.remove(0);
        }
        last.push(newest.value);
        if self.windows == 1 {
            return newest;
        }
        let format = profile.formats.mean_square;
        let counted = if last.len() == self.windows { &last[..] } else { &[newest.value] };
        let held = counted.iter().any(|square| square.code(format) == format.max_code() as i64);
        let sum = counted.iter().fold(Exact::ZERO, |sum, &square| sum + square);
        let mean = round(sum.scaled(-(counted.len().ilog2() as i8)), format);
        Rounded { held, ..mean }
    }
}

/// The force from capacitance, mean square and gain.
pub fn force(profile: &Profile, [capacitance, mean_square, gain]: [Exact; 3]) -> Force {
    let f = &profile.formats;
    let square = round(capacitance * capacitance, f.square);
    let energy = round(square.value * mean_square, f.square);
    let force = round(energy.value * gain, f.force);
    Force { force: force.value, gain, saturated: square.held | energy.held | force.held }
}
