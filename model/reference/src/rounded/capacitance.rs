// SPDX-License-Identifier: MIT OR Apache-2.0
//! Capacitance, with the sheet's resistance taken out (docs/physics.md §2, the √ form), or by eq. 6
//! alone (R taken for zero).
//!
//! ```text
//! drop = [a · R],   left = max(v² − drop², 0),   invalid where v² ≤ drop²
//! admittance = [a / [√left]],   C = [admittance · gain]
//! ```

use super::{Exact, round, round_quotient, round_sqrt};
use hapticore_contract::format::Format;
use hapticore_contract::profile::Profile;

/// Capacitance of a slot, exactly rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capacitance {
    /// Capacitance, pF.
    pub capacitance: Exact,
    /// Whether there is none.
    pub invalid: bool,
    /// The result is saturated.
    pub saturated: bool,
}

/// The format of an amplitude: of the square root of two squares of a total's word, one more bit
/// than the word without its sign and one for the square root's rounding.
fn amplitude(profile: &Profile) -> Format {
    let total = profile.formats.total;
    Format { signed: false, width: total.width + 1, frac: total.frac }
}

/// The capacitance for amplitudes of current and sensing voltage, and the sheet's resistance.
pub fn capacitance(
    profile: &Profile,
    total: Exact,
    sense: Exact,
    sheet: Exact,
    gain: Exact,
) -> Capacitance {
    let f = &profile.formats;
    let sheet = if profile.capacitance.sheet_correction { sheet } else { Exact::ZERO };
    let drop = round(total * sheet, amplitude(profile));
    let left = sense * sense - drop.value * drop.value;
    let invalid = left <= Exact::ZERO;
    let sqrt = round_sqrt(if invalid { Exact::ZERO } else { left }, f.total.frac);
    let admittance = round_quotient(total, sqrt, f.admittance);
    let capacitance = round(admittance.value * gain, f.capacitance);
    let saturated = drop.held | admittance.held | capacitance.held;
    Capacitance { capacitance: capacitance.value, invalid, saturated }
}
