// SPDX-License-Identifier: MIT OR Apache-2.0
//! Eqs. 2 and 3.
//!
//! ```text
//! r_x = [x / corners],   r_y = [y / corners],   share = [least / corners]        (by zero: saturated on the numerator's side, and invalid)
//! ```

use super::{Currents, Exact, round_quotient};
use hapticore_contract::format::Format;
use hapticore_contract::profile::Profile;

/// Both ratios of a slot, exactly rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ratio {
    /// Ratio r_x of eq. 2.
    pub r_x: Exact,
    /// Ratio r_y of eq. 3.
    pub r_y: Exact,
    /// The least current's share of the denominator.
    pub share: Exact,
    /// The denominator is zero.
    pub invalid: bool,
}

/// The ratios of the currents.
pub fn ratio(profile: &Profile, currents: &Currents) -> Ratio {
    let ratio = profile.formats.ratio;
    let magnitude = Format { signed: false, width: ratio.width - 1, frac: ratio.frac };
    let of = |numerator: Exact| {
        let quotient = round_quotient(numerator.magnitude(), currents.corners, magnitude).value;
        if numerator < Exact::ZERO { -quotient } else { quotient }
    };
    let [r_x, r_y, share] = [currents.x, currents.y, currents.least].map(of);
    Ratio { r_x, r_y, share, invalid: currents.corners == Exact::ZERO }
}
