// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clocked interpretation, except that no block may ever leave a clock out.

use hapticore_model::block::Interpretation;
use hapticore_model::format::Format;
use hapticore_model::memory::{Memory, Storage, Write};
use hapticore_model::signal::{Overflow, Rounding, Signal, Value};

/// A raw code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NeverIdle(pub i64);

fn of(a: Signal<NeverIdle>) -> Signal<i64> {
    Signal { value: a.value.0, format: a.format }
}

impl Value for NeverIdle {
    fn literal(real: f64, format: Format) -> Self {
        NeverIdle(i64::literal(real, format))
    }
    fn add(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        NeverIdle(i64::add(of(a), of(b), to))
    }
    fn sub(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        NeverIdle(i64::sub(of(a), of(b), to))
    }
    fn mul(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        NeverIdle(i64::mul(of(a), of(b), to))
    }
    fn square(a: Signal<Self>, to: Format) -> Self {
        NeverIdle(i64::square(of(a), to))
    }
    fn abs(a: Signal<Self>, to: Format) -> Self {
        NeverIdle(<i64 as Value>::abs(of(a), to))
    }
    fn quantize(a: Signal<Self>, to: Format, rounding: Rounding, overflow: Overflow) -> Self {
        NeverIdle(i64::quantize(of(a), to, rounding, overflow))
    }
    fn scale(a: Self, by: i8) -> Self {
        NeverIdle(i64::scale(a.0, by))
    }
    fn bits(a: Signal<Self>, low: u8, to: Format) -> Self {
        NeverIdle(i64::bits(of(a), low, to))
    }
    fn concat(high: Signal<Self>, low: Signal<Self>, to: Format) -> Self {
        NeverIdle(i64::concat(of(high), of(low), to))
    }
    fn less(a: Signal<Self>, b: Signal<Self>) -> Self {
        NeverIdle(i64::less(of(a), of(b)))
    }
    fn equal(a: Signal<Self>, b: Signal<Self>) -> Self {
        NeverIdle(i64::equal(of(a), of(b)))
    }
    fn and(a: Self, b: Self) -> Self {
        NeverIdle(i64::and(a.0, b.0))
    }
    fn or(a: Self, b: Self) -> Self {
        NeverIdle(i64::or(a.0, b.0))
    }
    fn not(a: Self) -> Self {
        NeverIdle(i64::not(a.0))
    }
    fn select(bit: Self, a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        NeverIdle(i64::select(bit.0, of(a), of(b), to))
    }
    fn raw(code: i64, _format: Format) -> Self {
        NeverIdle(code)
    }
    fn code(a: Signal<Self>) -> i64 {
        a.value.0
    }
    fn known(bit: Self) -> Option<bool> {
        Some(bit.0 != 0)
    }
}

impl Storage for NeverIdle {
    type Words = <i64 as Storage>::Words;

    fn words(memory: &Memory) -> Self::Words {
        i64::words(memory)
    }
    fn data(memory: &Memory, words: &mut Self::Words) -> Self {
        NeverIdle(i64::data(memory, words))
    }
    fn access(memory: &Memory, words: &mut Self::Words, address: Signal<Self>, write: Option<Write<Self>>) {
        let write = write.map(|w| Write { enable: of(w.enable), address: of(w.address), data: of(w.data) });
        i64::access(memory, words, of(address), write);
    }
}

impl Interpretation for NeverIdle {}
