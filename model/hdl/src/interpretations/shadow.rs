// SPDX-License-Identifier: MIT OR Apache-2.0
//! The shadow interpretation: the clocked and the real value of every signal side by side. Control
//! follows the clocked one, so that both run through the same clocks, and their difference is the
//! rounding error of the signal.

use super::real::{Real, Reals};
use crate::block::{Block, Inputs, Interpretation, Outputs, State};
use crate::format::Format;
use crate::memory::{Memory, Storage, Write};
use crate::signal::{Overflow, Rounding, Signal, Value};

/// The value of the shadow interpretation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shadow {
    /// The raw code.
    pub code: i64,
    /// What it would be without rounding.
    pub real: f64,
}

/// A memory of the shadow interpretation.
#[derive(Debug, Clone)]
pub struct Shadows {
    codes: <i64 as Storage>::Words,
    reals: Reals,
}

fn code(a: Signal<Shadow>) -> Signal<i64> {
    Signal { value: a.value.code, format: a.format }
}

fn real(a: Signal<Shadow>) -> Signal<Real> {
    Signal { value: Real(a.value.real), format: a.format }
}

fn both(code: i64, real: Real) -> Shadow {
    Shadow { code, real: real.0 }
}

/// A control value: the shadow is the code itself.
fn control(code: i64) -> Shadow {
    Shadow { code, real: code as f64 }
}

impl Value for Shadow {
    const DECIDES: bool = true;
    const HAS_CODE: bool = true;
    const HAS_REAL: bool = true;

    fn literal(real: f64, format: Format) -> Self {
        both(i64::literal(real, format), Real(real))
    }

    fn raw(code: i64, format: Format) -> Self {
        Shadow { code, real: format.real(code) }
    }

    fn add(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        both(i64::add(code(a), code(b), to), Real::add(real(a), real(b), to))
    }

    fn sub(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        both(i64::sub(code(a), code(b), to), Real::sub(real(a), real(b), to))
    }

    fn mul(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        both(i64::mul(code(a), code(b), to), Real::mul(real(a), real(b), to))
    }

    fn abs(a: Signal<Self>, to: Format) -> Self {
        both(i64::abs(a.value.code), Real::abs(real(a), to))
    }

    fn quantize(a: Signal<Self>, to: Format, rounding: Rounding, overflow: Overflow) -> Self {
        let fitted = i64::quantize(code(a), to, rounding, overflow);
        match (rounding, overflow) {
            // A floor is a decision: the fraction that it leaves stays with the code's side of a
            // cell's edge.
            (Rounding::Floor, _) => Shadow { code: fitted, real: to.real(fitted) },
            (_, Overflow::Wrap) => both(fitted, nearest_turn(a.value.real, to.real(fitted), to)),
            _ => both(fitted, Real::quantize(real(a), to, rounding, overflow)),
        }
    }

    fn scale(a: Self, by: i8) -> Self {
        both(a.code, Real::scale(Real(a.real), by))
    }

    fn bits(a: Signal<Self>, low: u8, to: Format) -> Self {
        control(i64::bits(code(a), low, to))
    }

    fn concat(high: Signal<Self>, low: Signal<Self>, to: Format) -> Self {
        control(i64::concat(code(high), code(low), to))
    }

    fn less(a: Signal<Self>, b: Signal<Self>) -> Self {
        control(i64::less(code(a), code(b)))
    }

    fn equal(a: Signal<Self>, b: Signal<Self>) -> Self {
        control(i64::equal(code(a), code(b)))
    }

    fn and(a: Self, b: Self) -> Self {
        control(a.code & b.code)
    }

    fn or(a: Self, b: Self) -> Self {
        control(a.code | b.code)
    }

    fn not(a: Self) -> Self {
        control(a.code ^ 1)
    }

    fn select(bit: Self, a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        let chosen = if bit.code != 0 { a } else { b };
        both(i64::select(bit.code, code(a), code(b), to), Real(chosen.value.real))
    }

    fn golden(a: Signal<Self>, operands: &[Signal<Self>], ideal: fn(&[f64]) -> f64) -> Self {
        let mut reals = [0.0; 4];
        for (real, operand) in reals.iter_mut().zip(operands) {
            *real = operand.value.real;
        }
        Shadow { code: a.value.code, real: ideal(&reals[..operands.len()]) }
    }

    fn code(a: Signal<Self>) -> i64 {
        a.value.code
    }

    fn unrounded(a: Signal<Self>) -> f64 {
        a.value.real
    }

    fn with_unrounded(a: Signal<Self>, real: f64) -> Self {
        Shadow { real, ..a.value }
    }

    fn known_bit(bit: Self) -> Option<bool> {
        Some(bit.code != 0)
    }
}

impl Storage for Shadow {
    type Words = Shadows;

    fn words(memory: &Memory) -> Shadows {
        Shadows { codes: i64::words(memory), reals: Real::words(memory) }
    }

    fn data(memory: &Memory, words: &mut Shadows) -> Self {
        both(i64::data(memory, &mut words.codes), Real(words.reals.data))
    }

    fn access(
        memory: &Memory,
        words: &mut Shadows,
        address: Signal<Self>,
        write: Option<Write<Self>>,
    ) {
        i64::access(memory, &mut words.codes, code(address), write.map(|w| map_write(w, code)));
        let index = Signal { value: Real(address.value.code as f64), format: address.format };
        let write = write.map(|w| Write { address: follow(w.address), ..map_write(w, real) });
        Real::access(memory, &mut words.reals, index, write);
    }
}

impl Interpretation for Shadow {
    /// Out of line: who asks for rounding errors waits for them, and a core in one piece takes long to compile.
    #[inline(never)]
    fn instance<B: Block>(
        block: &B,
        _name: &'static str,
        state: &mut State<B, Self>,
        inputs: Inputs<B, Signal<Self>>,
    ) -> Outputs<B, Signal<Self>> {
        block.clock(state, inputs)
    }

    fn can_skip(busy: Self) -> bool {
        busy.code == 0
    }
}

fn map_write<V>(write: Write<Shadow>, side: fn(Signal<Shadow>) -> Signal<V>) -> Write<V> {
    Write { enable: side(write.enable), address: side(write.address), data: side(write.data) }
}

/// An address as the code has it.
fn follow(address: Signal<Shadow>) -> Signal<Real> {
    Signal { value: Real(address.value.code as f64), format: address.format }
}

/// The number, moved by whole spans of the format to where it is nearest to the wrapped code.
fn nearest_turn(real: f64, wrapped: f64, to: Format) -> Real {
    let span = 2f64.powi(i32::from(to.width) - i32::from(to.frac));
    Real(real - span * ((real - wrapped) / span).round())
}

#[cfg(test)]
mod tests;
