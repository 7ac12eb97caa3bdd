// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core as hardware has it, whatever its registers hold.
//!
//! ```text
//! declared impossible ─ the clocked interpretation: checked;  here: the low bits, as the wires of the Verilog
//! nothing to be done  ─ the clocked interpretation: skipped;  here: every block, every clock
//! ```
//!
//! A register that an upset has changed may break what is proved of all others; all arithmetic that
//! is not narrowing is that of the clocked interpretation.

use hapticore_hdl::block::Interpretation;
use hapticore_hdl::format::Format;
use hapticore_hdl::memory::{Memory, Storage, Write};
use hapticore_hdl::signal::{Clocked, Overflow, Rounding, Signal, Value};

/// The code on the wires.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bits(pub i64);

/// A memory and its read register.
#[derive(Debug, Clone)]
pub struct Words {
    /// Its words.
    pub words: Vec<Bits>,
    /// What was read last.
    pub data: Bits,
}

#[inline(always)]
fn of(signal: Signal<Bits>) -> Signal<Clocked> {
    Signal { value: signal.value.0, format: signal.format }
}

impl Value for Bits {
    const DECIDES: bool = true;
    const HAS_CODE: bool = true;

    #[inline(always)]
    fn literal(real: f64, format: Format) -> Self {
        Bits(Clocked::literal(real, format))
    }
    #[inline(always)]
    fn add(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        Bits(Clocked::add(of(a), of(b), to))
    }
    #[inline(always)]
    fn sub(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        Bits(Clocked::sub(of(a), of(b), to))
    }
    #[inline(always)]
    fn mul(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        Bits(Clocked::mul(of(a), of(b), to))
    }
    #[inline(always)]
    fn abs(a: Signal<Self>, to: Format) -> Self {
        Bits(<Clocked as Value>::abs(of(a), to))
    }
    #[inline(always)]
    fn quantize(a: Signal<Self>, to: Format, rounding: Rounding, overflow: Overflow) -> Self {
        let overflow = match overflow {
            Overflow::Saturate => Overflow::Saturate,
            _ => Overflow::Wrap,
        };
        Bits(Clocked::quantize(of(a), to, rounding, overflow))
    }
    #[inline(always)]
    fn scale(a: Self, _by: i8) -> Self {
        a
    }
    #[inline(always)]
    fn bits(a: Signal<Self>, low: u8, to: Format) -> Self {
        Bits(Clocked::bits(of(a), low, to))
    }
    #[inline(always)]
    fn concat(high: Signal<Self>, low: Signal<Self>, to: Format) -> Self {
        Bits(Clocked::concat(of(high), of(low), to))
    }
    #[inline(always)]
    fn less(a: Signal<Self>, b: Signal<Self>) -> Self {
        Bits(Clocked::less(of(a), of(b)))
    }
    #[inline(always)]
    fn equal(a: Signal<Self>, b: Signal<Self>) -> Self {
        Bits(Clocked::equal(of(a), of(b)))
    }
    #[inline(always)]
    fn and(a: Self, b: Self) -> Self {
        Bits(a.0 & b.0)
    }
    #[inline(always)]
    fn or(a: Self, b: Self) -> Self {
        Bits(a.0 | b.0)
    }
    #[inline(always)]
    fn not(a: Self) -> Self {
        Bits(a.0 ^ 1)
    }
    #[inline(always)]
    fn select(bit: Self, a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        Bits(Clocked::select(bit.0, of(a), of(b), to))
    }
    #[inline(always)]
    fn raw(code: i64, _format: Format) -> Self {
        Bits(code)
    }
    #[inline(always)]
    fn code(a: Signal<Self>) -> i64 {
        a.value.0
    }
    #[inline(always)]
    fn known_bit(bit: Self) -> Option<bool> {
        Some(bit.0 != 0)
    }
}

impl Storage for Bits {
    type Words = Words;

    fn words(memory: &Memory) -> Words {
        Words { words: memory.codes().into_iter().map(Bits).collect(), data: Bits(0) }
    }

    #[inline(always)]
    fn data(_memory: &Memory, words: &mut Words) -> Self {
        words.data
    }

    /// An address beyond the last word reads zero and writes nothing.
    #[inline(always)]
    fn access(
        memory: &Memory,
        words: &mut Words,
        address: Signal<Self>,
        write: Option<Write<Self>>,
    ) {
        words.data = words.words.get(address.value.0 as usize).copied().unwrap_or(Bits(0));
        if let Some(write) = write
            && write.enable.value.0 != 0
            && let Some(word) = words.words.get_mut(write.address.value.0 as usize)
        {
            *word = Self::quantize(write.data, memory.format, Rounding::Exact, Overflow::Wrap);
        }
    }
}

impl Interpretation for Bits {}
