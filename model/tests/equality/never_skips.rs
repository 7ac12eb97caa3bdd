// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clocked interpretation, except that no block may ever leave a clock out.

use hapticore_hdl::block::{Block, Inputs, Interpretation, Outputs, State};
use hapticore_hdl::format::Format;
use hapticore_hdl::memory::{Memory, Storage, Write};
use hapticore_hdl::signal::{Overflow, Rounding, Signal, Value};

/// A raw code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NeverSkips(pub i64);

fn inner(a: Signal<NeverSkips>) -> Signal<i64> {
    Signal { value: a.value.0, format: a.format }
}

impl Value for NeverSkips {
    fn literal(real: f64, format: Format) -> Self {
        NeverSkips(i64::literal(real, format))
    }
    fn add(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        NeverSkips(i64::add(inner(a), inner(b), to))
    }
    fn sub(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        NeverSkips(i64::sub(inner(a), inner(b), to))
    }
    fn mul(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        NeverSkips(i64::mul(inner(a), inner(b), to))
    }
    fn square(a: Signal<Self>, to: Format) -> Self {
        NeverSkips(i64::square(inner(a), to))
    }
    fn abs(a: Signal<Self>, to: Format) -> Self {
        NeverSkips(<i64 as Value>::abs(inner(a), to))
    }
    fn quantize(a: Signal<Self>, to: Format, rounding: Rounding, overflow: Overflow) -> Self {
        NeverSkips(i64::quantize(inner(a), to, rounding, overflow))
    }
    fn scale(a: Self, by: i8) -> Self {
        NeverSkips(i64::scale(a.0, by))
    }
    fn bits(a: Signal<Self>, low: u8, to: Format) -> Self {
        NeverSkips(i64::bits(inner(a), low, to))
    }
    fn concat(high: Signal<Self>, low: Signal<Self>, to: Format) -> Self {
        NeverSkips(i64::concat(inner(high), inner(low), to))
    }
    fn less(a: Signal<Self>, b: Signal<Self>) -> Self {
        NeverSkips(i64::less(inner(a), inner(b)))
    }
    fn equal(a: Signal<Self>, b: Signal<Self>) -> Self {
        NeverSkips(i64::equal(inner(a), inner(b)))
    }
    fn and(a: Self, b: Self) -> Self {
        NeverSkips(i64::and(a.0, b.0))
    }
    fn or(a: Self, b: Self) -> Self {
        NeverSkips(i64::or(a.0, b.0))
    }
    fn not(a: Self) -> Self {
        NeverSkips(i64::not(a.0))
    }
    fn select(bit: Self, a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        NeverSkips(i64::select(bit.0, inner(a), inner(b), to))
    }
    fn raw(code: i64, _format: Format) -> Self {
        NeverSkips(code)
    }
    fn code(a: Signal<Self>) -> i64 {
        a.value.0
    }
    fn known_bit(bit: Self) -> Option<bool> {
        Some(bit.0 != 0)
    }
}

impl Storage for NeverSkips {
    type Words = <i64 as Storage>::Words;

    fn words(memory: &Memory) -> Self::Words {
        i64::words(memory)
    }
    fn data(memory: &Memory, words: &mut Self::Words) -> Self {
        NeverSkips(i64::data(memory, words))
    }
    fn access(
        memory: &Memory,
        words: &mut Self::Words,
        address: Signal<Self>,
        write: Option<Write<Self>>,
    ) {
        let write = write.map(|w| Write {
            enable: inner(w.enable),
            address: inner(w.address),
            data: inner(w.data),
        });
        i64::access(memory, words, inner(address), write);
    }
}

impl Interpretation for NeverSkips {
    /// Out of line in tests: a core in one piece takes long to compile. Benches ask for its speed.
    #[cfg_attr(debug_assertions, inline(never))]
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn instance<B: Block>(
        block: &B,
        _name: &'static str,
        state: &mut State<B, Self>,
        inputs: Inputs<B, Signal<Self>>,
    ) -> Outputs<B, Signal<Self>> {
        block.clock(state, inputs)
    }
}
