// SPDX-License-Identifier: MIT OR Apache-2.0
//! The one place where fractions of full scale meet codes.

use hapticore_hdl::format::Format;

/// Adding and taking away 1.5·2^52 rounds an f64 of up to 2^51 to an integer, half to even, in two
/// additions: a call for each sample would cost as much as all else.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// An ADC: fractions of full scale to codes, rounded to nearest even, saturated.
#[derive(Debug, Clone, Copy)]
pub struct Digitiser {
    scale: f64,
    low: f64,
    high: f64,
}

impl Digitiser {
    /// An ADC with codes of this format.
    pub fn new(adc: Format) -> Self {
        Digitiser {
            scale: 1.0 / adc.lsb(),
            low: adc.min_code() as f64,
            high: adc.max_code() as f64,
        }
    }

    /// The code of a fraction, and whether it is exactly that.
    pub fn code(&self, fraction: f64) -> (i32, bool) {
        let code = (fraction * self.scale).round_ties_even().clamp(self.low, self.high);
        (code as i32, code == fraction * self.scale)
    }

    /// Appends the codes of some fractions; the largest magnitude among them, as a fraction.
    pub fn codes(&self, fractions: &[f64], into: &mut Vec<i32>) -> f64 {
        let mut peak = 0f64;
        into.extend(fractions.iter().map(|fraction| {
            let code = (fraction * self.scale + ROUNDER) - ROUNDER;
            let code = code.max(self.low).min(self.high);
            peak = peak.max(code.abs());
            code as i32
        }));
        peak / self.scale
    }
}
