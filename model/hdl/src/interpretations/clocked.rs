// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clocked interpretation: a value is a raw code in an `i64`.

use crate::block::{Block, Inputs, Interpretation, Outputs, State};
use crate::format::{Format, MAX_WIDTH};
use crate::memory::{Collision, Memory, Storage, Write};
use crate::signal::{Overflow, Rounding, Signal, Value};

/// A memory of the clocked interpretation.
#[derive(Debug, Clone, Default)]
pub struct Codes {
    pub(super) words: Vec<i64>,
    data: i64,
}

impl Codes {
    /// The words.
    #[inline(always)]
    pub fn words(&self) -> &[i64] {
        &self.words
    }

    /// The words, for a caller that does in one step what takes several clocks.
    #[inline(always)]
    pub fn words_mut(&mut self) -> &mut [i64] {
        &mut self.words
    }
}

/// The code of `a` with the point where `to` has it, which is never further left than in `a`.
#[inline(always)]
fn align(a: Signal<i64>, to: Format) -> i64 {
    // Mostly there is nothing to move; a branch that a loop can be rid of is cheaper than a shift
    // that it cannot.
    if to.frac == a.format.frac {
        return a.value;
    }
    // Of no bits at all the point is further away than a code is wide, and the code is zero.
    a.value.wrapping_shl((to.frac - a.format.frac) as u32)
}

/// The code with `drop` fewer fractional bits.
#[inline(always)]
fn round(code: i64, drop: u32, rounding: Rounding) -> i64 {
    match rounding {
        // Adding just under a half, and one more where the result would be odd, makes every tie
        // even.
        Rounding::HalfEven => (code + (1 << (drop - 1)) - 1 + ((code >> drop) & 1)) >> drop,
        Rounding::Floor => code >> drop,
        Rounding::Exact => unreachable!("checked by Signal::fit"),
    }
}

/// The low bits of a code, read in the format `to`.
#[inline(always)]
pub(super) fn wrap(code: i64, to: Format) -> i64 {
    let unused = 64 - u32::from(to.width);
    if to.signed { (code << unused) >> unused } else { code & (-1i64 as u64 >> unused) as i64 }
}

/// Out of line: each of a block's many operations would carry the making of the message.
#[cold]
#[inline(never)]
fn does_not_fit(code: i64, to: Format) -> ! {
    panic!("{code} does not fit {to}, which is declared impossible")
}

/// In test builds, that a code is as wide as the format.
#[inline(always)]
fn check_width(to: Format) {
    if cfg!(debug_assertions) && to.width > MAX_WIDTH {
        is_too_wide(to);
    }
}

#[cold]
#[inline(never)]
fn is_too_wide(to: Format) -> ! {
    panic!("{to} is wider than a code")
}

#[inline(always)]
fn limit(code: i64, to: Format, overflow: Overflow) -> i64 {
    match overflow {
        Overflow::Saturate => code.clamp(min(to), max(to)),
        Overflow::Wrap => wrap(code, to),
        Overflow::Proved | Overflow::Assumed(_) => {
            if cfg!(debug_assertions) && !(min(to)..=max(to)).contains(&code) {
                does_not_fit(code, to);
            }
            code
        }
    }
}

#[inline(always)]
fn max(format: Format) -> i64 {
    // Of 63 bits without a sign it is the largest code: 2^63 is none.
    i64::MAX >> (63 - (format.width - u8::from(format.signed)))
}

#[inline(always)]
fn min(format: Format) -> i64 {
    if format.signed { -(1i64 << (format.width - 1)) } else { 0 }
}

impl Value for i64 {
    const DECIDES: bool = true;
    const HAS_CODE: bool = true;

    #[inline(always)]
    fn literal(real: f64, format: Format) -> Self {
        format.code_saturating(real)
    }

    #[inline(always)]
    fn add(a: Signal<i64>, b: Signal<i64>, to: Format) -> i64 {
        check_width(to);
        align(a, to) + align(b, to)
    }

    #[inline(always)]
    fn sub(a: Signal<i64>, b: Signal<i64>, to: Format) -> i64 {
        check_width(to);
        align(a, to) - align(b, to)
    }

    #[inline(always)]
    fn mul(a: Signal<i64>, b: Signal<i64>, to: Format) -> i64 {
        check_width(to);
        a.value * b.value
    }

    #[inline(always)]
    fn abs(a: Signal<i64>, _to: Format) -> i64 {
        a.value.abs()
    }

    #[inline(always)]
    fn quantize(a: Signal<i64>, to: Format, rounding: Rounding, overflow: Overflow) -> i64 {
        let drop = a.format.frac - to.frac;
        let exact = rounding == Rounding::Exact || drop <= 0;
        let code = if exact { align(a, to) } else { round(a.value, drop as u32, rounding) };
        limit(code, to, overflow)
    }

    #[inline(always)]
    fn scale(a: i64, _by: i8) -> i64 {
        a
    }

    #[inline(always)]
    fn bits(a: Signal<i64>, low: u8, to: Format) -> i64 {
        wrap(a.value >> low, to)
    }

    #[inline(always)]
    fn concat(high: Signal<i64>, low: Signal<i64>, _to: Format) -> i64 {
        high.value << low.format.width | low.value
    }

    #[inline(always)]
    fn less(a: Signal<i64>, b: Signal<i64>) -> i64 {
        let to = a.format.join(b.format);
        i64::from(align(a, to) < align(b, to))
    }

    #[inline(always)]
    fn equal(a: Signal<i64>, b: Signal<i64>) -> i64 {
        let to = a.format.join(b.format);
        i64::from(align(a, to) == align(b, to))
    }

    #[inline(always)]
    fn and(a: i64, b: i64) -> i64 {
        a & b
    }

    #[inline(always)]
    fn or(a: i64, b: i64) -> i64 {
        a | b
    }

    #[inline(always)]
    fn not(a: i64) -> i64 {
        a ^ 1
    }

    #[inline(always)]
    fn select(bit: i64, a: Signal<i64>, b: Signal<i64>, to: Format) -> i64 {
        if bit != 0 { align(a, to) } else { align(b, to) }
    }

    #[inline(always)]
    fn raw(code: i64, _format: Format) -> i64 {
        code
    }

    #[inline(always)]
    fn code(a: Signal<i64>) -> i64 {
        a.value
    }

    #[inline(always)]
    fn known_bit(bit: i64) -> Option<bool> {
        Some(bit != 0)
    }
}

impl Storage for i64 {
    type Words = Codes;

    fn words(memory: &Memory) -> Codes {
        Codes { words: memory.codes(), data: 0 }
    }

    #[inline(always)]
    fn data(_memory: &Memory, words: &mut Codes) -> i64 {
        words.data
    }

    #[inline(always)]
    fn take(words: &mut Codes) -> Codes {
        std::mem::take(words)
    }

    #[inline(always)]
    fn access(memory: &Memory, words: &mut Codes, address: Signal<i64>, write: Option<Write<i64>>) {
        words.data = words.words.get(address.value as usize).copied().unwrap_or(0);
        if let Some(write) = write
            && write.enable.value != 0
        {
            if cfg!(debug_assertions)
                && memory.collision == Collision::DontCare
                && write.address.value == address.value
            {
                // No block is to use this word: test builds read another, so that using it is
                // noticed.
                words.data = mirrored(words.data, memory.format);
            }
            words.words[write.address.value as usize] = align(write.data, memory.format);
        }
    }
}

impl Interpretation for i64 {
    #[inline(always)]
    fn step<B: Block>(
        block: &B,
        state: &mut State<B, i64>,
        inputs: Inputs<B, Signal<i64>>,
    ) -> Outputs<B, Signal<i64>> {
        block.step(state, inputs)
    }

    #[inline(always)]
    fn can_skip(busy: i64) -> bool {
        busy == 0
    }
}

/// Another code: as far from the one end of the format as this is from the other.
fn mirrored(code: i64, format: Format) -> i64 {
    (format.max_code() + format.min_code()) as i64 - code
}

#[cfg(test)]
mod tests;
