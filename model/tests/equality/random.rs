// SPDX-License-Identifier: MIT OR Apache-2.0
//! Random words that know where circuits break: at full scale, around zero, at powers of two, in
//! short words.

use hapticore_hdl::format::Format;

/// SplitMix64: a few lines, any seed, the same numbers everywhere.
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Random(seed)
    }

    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// One of `0 .. count`.
    pub fn below(&mut self, count: u64) -> u64 {
        self.bits() % count
    }

    /// One of 0 … 1.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * 2f64.powi(-53)
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A code of a format: one in eight a corner, one in four a short word, else any.
    pub fn word(&mut self, format: Format) -> i64 {
        let bits = format.width - u8::from(format.signed);
        let low = if format.signed { -(1i64 << bits) } else { 0 };
        let high = (1i64 << bits) - 1;
        let code = match self.below(8) {
            0 => [low, low + 1, -1, 0, 1, high / 2, high / 2 + 1, high - 1, high]
                [self.below(9) as usize],
            1 | 2 => {
                let length = self.below(u64::from(bits) + 1);
                let short = self.below(1 << length) as i64;
                if self.below(2) == 0 { short } else { -short }
            }
            _ => low + self.below(1 << format.width) as i64,
        };
        if code < low || code > high { code.rem_euclid(high + 1) } else { code }
    }
}
