// SPDX-License-Identifier: MIT OR Apache-2.0
//! The real interpretation: a value is an `f64` that is never rounded to a word length.
//!
//! What is meant stays: a phase wraps, a table address is a floor, a comparison decides. What word
//! length costs goes: no rounding, no saturation, tables as their ideal functions.

use crate::block::{Block, Inputs, Interpretation, Outputs, State};
use crate::format::Format;
use crate::memory::{Memory, Storage, Write};
use crate::signal::{Overflow, Rounding, Signal, Value};

/// The value of the real interpretation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Real(pub f64);

/// A memory of the real interpretation.
#[derive(Debug, Clone)]
pub struct Reals {
    pub(super) words: Vec<f64>,
    pub(super) data: f64,
}

fn flag(set: bool) -> Real {
    Real(f64::from(u8::from(set)))
}

/// The number modulo the span of a format.
pub(super) fn wrap(real: f64, to: Format) -> f64 {
    let span = 2f64.powi(i32::from(to.width) - i32::from(to.frac));
    let low = if to.signed { -span / 2.0 } else { 0.0 };
    real - span * ((real - low) / span).floor()
}

impl Value for Real {
    const DECIDES: bool = true;
    const HAS_REAL: bool = true;

    fn literal(real: f64, _format: Format) -> Self {
        Real(real)
    }

    fn add(a: Signal<Self>, b: Signal<Self>, _to: Format) -> Self {
        Real(a.value.0 + b.value.0)
    }

    fn sub(a: Signal<Self>, b: Signal<Self>, _to: Format) -> Self {
        Real(a.value.0 - b.value.0)
    }

    fn mul(a: Signal<Self>, b: Signal<Self>, _to: Format) -> Self {
        Real(a.value.0 * b.value.0)
    }

    fn abs(a: Signal<Self>, _to: Format) -> Self {
        Real(a.value.0.abs())
    }

    fn quantize(a: Signal<Self>, to: Format, rounding: Rounding, overflow: Overflow) -> Self {
        let lsb = to.lsb();
        let real =
            if rounding == Rounding::Floor { (a.value.0 / lsb).floor() * lsb } else { a.value.0 };
        // Saturation of an unsigned word to zero from below is a decision that the circuit needs,
        // not a word length's.
        let floor = overflow == Overflow::Saturate && !to.signed && a.format.signed;
        match overflow {
            Overflow::Wrap => Real(wrap(real, to)),
            _ if floor => Real(real.max(0.0)),
            _ => Real(real),
        }
    }

    fn scale(a: Self, by: i8) -> Self {
        Real(a.0 * 2f64.powi(i32::from(by)))
    }

    fn bits(a: Signal<Self>, low: u8, to: Format) -> Self {
        let code = (a.value.0 / a.format.lsb() * 2f64.powi(-i32::from(low))).floor();
        Real(wrap(code, to))
    }

    fn concat(high: Signal<Self>, low: Signal<Self>, _to: Format) -> Self {
        Real(high.value.0 * 2f64.powi(i32::from(low.format.width)) + low.value.0)
    }

    fn less(a: Signal<Self>, b: Signal<Self>) -> Self {
        flag(a.value.0 < b.value.0)
    }

    fn equal(a: Signal<Self>, b: Signal<Self>) -> Self {
        flag(a.value.0 == b.value.0)
    }

    fn and(a: Self, b: Self) -> Self {
        Real(a.0 * b.0)
    }

    fn or(a: Self, b: Self) -> Self {
        Real(a.0.max(b.0))
    }

    fn not(a: Self) -> Self {
        Real(1.0 - a.0)
    }

    fn select(bit: Self, a: Signal<Self>, b: Signal<Self>, _to: Format) -> Self {
        if bit.0 != 0.0 { a.value } else { b.value }
    }

    fn code(a: Signal<Self>) -> i64 {
        a.format.code_saturating(a.value.0)
    }

    fn real(a: Signal<Self>) -> f64 {
        a.value.0
    }

    fn with_unrounded(_a: Signal<Self>, real: f64) -> Self {
        Real(real)
    }

    fn known_bit(bit: Self) -> Option<bool> {
        Some(bit.0 != 0.0)
    }

    fn golden(_a: Signal<Self>, operands: &[Signal<Self>], ideal: fn(&[f64]) -> f64) -> Self {
        let mut reals = [0.0; 4];
        for (real, operand) in reals.iter_mut().zip(operands) {
            *real = operand.value.0;
        }
        Real(ideal(&reals[..operands.len()]))
    }
}

impl Storage for Real {
    type Words = Reals;

    fn words(memory: &Memory) -> Reals {
        Reals { words: memory.reals(), data: 0.0 }
    }

    fn data(_memory: &Memory, words: &mut Reals) -> Self {
        Real(words.data)
    }

    fn access(
        _memory: &Memory,
        words: &mut Reals,
        address: Signal<Self>,
        write: Option<Write<Self>>,
    ) {
        words.data = words.words.get(address.value.0 as usize).copied().unwrap_or(0.0);
        if let Some(write) = write
            && write.enable.value.0 != 0.0
        {
            words.words[write.address.value.0 as usize] = write.data.value.0;
        }
    }
}

impl Interpretation for Real {
    /// Out of line: who asks for numbers without rounding waits for them, and a core in one piece takes long to compile.
    #[inline(never)]
    fn instance<B: Block>(
        block: &B,
        _name: &'static str,
        state: &mut State<B, Self>,
        inputs: Inputs<B, Signal<Self>>,
    ) -> Outputs<B, Signal<Self>> {
        block.clock(state, inputs)
    }
}

#[cfg(test)]
mod tests;
