// SPDX-License-Identifier: MIT OR Apache-2.0
//! Small things that every peripheral does with bits.

use hapticore_model::format::Format;
use hapticore_model::signal::{Signal, Value, Wrap, int};

/// One more, wrapping.
#[inline(always)]
pub fn next<V: Value>(count: Signal<V>) -> Signal<V> {
    (count + int(1)).resize(count.format, Wrap)
}

/// One less, wrapping.
#[inline(always)]
pub fn previous<V: Value>(count: Signal<V>) -> Signal<V> {
    (count - int(1)).bits(0, count.format.width)
}

/// Either bit, not both.
#[inline(always)]
pub fn xor<V: Value>(a: Signal<V>, b: Signal<V>) -> Signal<V> {
    !a.equals(b)
}

/// The low bits of a word as a code of a format.
#[inline(always)]
pub fn read_as<V: Value>(word: Signal<V>, format: Format) -> Signal<V> {
    word.bits(0, format.width).as_code(format)
}

/// Set by one bit, cleared by another, else as it was; setting wins.
#[inline(always)]
pub fn flag<V: Value>(before: Signal<V>, set: Signal<V>, clear: Signal<V>) -> Signal<V> {
    set | (before & !clear)
}

/// Bits side by side, the first the least significant.
///
/// # Panics
/// Where there are none.
#[inline(always)]
pub fn word<V: Value>(bits: impl IntoIterator<Item = Signal<V>>) -> Signal<V> {
    bits.into_iter().reduce(|low, high| high.concat(low)).expect("a word has bits")
}
