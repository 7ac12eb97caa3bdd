// SPDX-License-Identifier: MIT OR Apache-2.0
//! The one place where fractions of full scale meet codes.

use hapticore_hdl::format::Format;

/// Adding and taking away 1.5·2^52 rounds an f64 of up to 2^51 to an integer, half to even, in two
/// additions: a call for each sample would cost as much as all else.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// Samples that are rounded side by side.
const LANES: usize = 8;

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

    /// The codes of some fractions in place of others; the largest magnitude among them, as a fraction.
    pub fn codes(&self, fractions: &[f64], into: &mut Vec<i32>) -> f64 {
        into.resize(fractions.len(), 0);
        let (groups, rest) = fractions.as_chunks::<LANES>();
        let (codes, of_rest) = into.as_chunks_mut::<LANES>();
        let mut peak = self.codes_of_groups(groups, codes);
        for (fraction, code) in rest.iter().zip(of_rest) {
            *code = low_bits(self.raise(*fraction, &mut peak));
        }
        peak / self.scale
    }

    /// The codes of groups of fractions, and the peak in codes.
    fn codes_of_groups(&self, groups: &[[f64; LANES]], codes: &mut [[i32; LANES]]) -> f64 {
        // Lanes of their own for the peak: a single one would wait for the sample before.
        let mut peaks = [0f64; LANES];
        for (group, codes) in groups.iter().zip(codes) {
            let mut raised = [0f64; LANES];
            for lane in 0..LANES {
                raised[lane] = self.raise(group[lane], &mut peaks[lane]);
            }
            // In a loop of its own: the one above is of instructions that act on several lanes.
            for lane in 0..LANES {
                codes[lane] = low_bits(raised[lane]);
            }
        }
        peaks.into_iter().fold(0.0, larger)
    }

    /// The code of a fraction, with [`ROUNDER`] added; its magnitude counts for the peak.
    #[inline(always)]
    fn raise(&self, fraction: f64, peak: &mut f64) -> f64 {
        let raised = lesser(larger(fraction * self.scale, self.low), self.high) + ROUNDER;
        *peak = larger(*peak, (raised - ROUNDER).abs());
        raised
    }
}

/// The integer that [`ROUNDER`] was added to: above it the low bits of the mantissa are the integer, in two's
/// complement.
#[inline(always)]
fn low_bits(raised: f64) -> i32 {
    raised.to_bits() as i32
}

/// The larger of two numbers; the second, where the first is none. Without the cases of `f64::max`
/// this is one instruction for two lanes.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The lesser of two numbers, as [`larger`].
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ties, rails and what lies beyond, in whole groups and in the remainder.
    #[test]
    fn codes_of_many_are_those_of_each() {
        for bits in [8, 16, 18, 24, 31] {
            let adc = Format::signed(bits, bits as i8 - 1);
            let digitiser = Digitiser::new(adc);
            let fraction = |k: i32| f64::from(k) / 2.0 * adc.lsb();
            let most = adc.max_code() as f64 * adc.lsb();
            let special =
                [0.0, -0.0, most, -1.0, 1.0, 7.0, -7.0, f64::INFINITY, most + 0.6 * adc.lsb()];
            for count in 0..40 {
                let fractions: Vec<_> =
                    (-20..).map(fraction).take(count).chain(special).chain([0.3, -0.4]).collect();
                let mut codes = vec![5; 20];
                let peak = digitiser.codes(&fractions, &mut codes);
                let each: Vec<_> = fractions.iter().map(|&x| digitiser.code(x).0).collect();
                assert_eq!(codes, each, "{bits} bits");
                assert_eq!(peak, 1.0, "the most negative code");
            }
        }
    }

    #[test]
    fn the_peak_is_that_of_the_codes() {
        let digitiser = Digitiser::new(Format::signed(16, 15));
        for count in 1..30 {
            for at in 0..count {
                let mut fractions = vec![0.0; count];
                fractions[at] = -0.25;
                assert_eq!(digitiser.codes(&fractions, &mut Vec::new()), 0.25, "{at} of {count}");
            }
        }
        assert_eq!(digitiser.codes(&[], &mut Vec::new()), 0.0);
    }
}
