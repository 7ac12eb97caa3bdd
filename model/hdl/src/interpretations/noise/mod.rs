// SPDX-License-Identifier: MIT OR Apache-2.0
//! The noise interpretation: the clocked and the real value of every signal, and how its error
//! follows from the errors of others.
//!
//! ```text
//! e(y) = Σ ∂y/∂x · e(x) + s,   s: what y's own rounding adds
//! ```
//!
//! As blocks run, each operation on data is written down with its partial derivatives, and each
//! rounding as a source. [`Recording::errors`] goes through them backwards once, which gives the gain
//! from every source to a signal, and so its mean, variance and bound. Sources are taken as
//! independent of each other; what two signals have in common is one source, and counts as such.
//!
//! | source, with d bits dropped | mean | variance | bound |
//! | --- | --- | --- | --- |
//! | half even | 0 | (1 + 2·4^−d)/12 | ½ |
//! | floor | −(1 − 2^−d)/2 | (1 − 4^−d)/12 | 1 − 2^−d |
//! | quotient, root | 0 | 1/12 | ½ |
//! | constant, word of a table | as it is | 0 | as it is |
//!
//! in the LSBs of what is left. Control follows the clocked value, as in
//! [`Shadow`], so that a path that was not taken adds nothing. A number that saturates, and what the
//! error of a decision does, are beyond this. Source of the variances: the dropped bits take each of
//! their 2^d values equally often.

mod moments;
mod tape;

pub use self::moments::Moments;
pub use self::tape::{Errors, Mark, Recording};

use self::tape::{EXACT, Entry, Floored, with};
use super::shadow::{Shadow, Shadows};
use crate::block::{Block, Inputs, Interpretation, Outputs, State};
use crate::format::Format;
use crate::memory::{Memory, Storage, Write};
use crate::signal::{Overflow, Rounding, Signal, Value};

/// The value of the noise interpretation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Its code, and what it would be without rounding.
    pub shadow: Shadow,
    /// Where its derivatives are written down.
    entry: Entry,
    /// Last bits of the code that are zero whatever the number is: it has been moved up.
    zeros: u8,
}

impl Noise {
    fn new(shadow: Shadow, entry: Entry) -> Self {
        Noise { shadow, entry, zeros: 0 }
    }
}

/// A memory of the noise interpretation.
#[derive(Debug, Clone)]
pub struct Words {
    shadows: Shadows,
    entries: Vec<Entry>,
    data: Entry,
}

fn shadow(a: Signal<Noise>) -> Signal<Shadow> {
    Signal { value: a.value.shadow, format: a.format }
}

/// A value that is exact, or decides.
fn exact(shadow: Shadow) -> Noise {
    Noise::new(shadow, EXACT)
}

/// The error that a code of this value has already: of a word of a table, of a constant.
fn known(shadow: Shadow, format: Format) -> Noise {
    let error = format.real(shadow.code) - shadow.real;
    let entry = match error {
        0.0 => EXACT,
        _ => with(|tape| tape.source([(EXACT, 0.0); 2], Moments::known(error))),
    };
    Noise::new(shadow, entry)
}

/// What an operation of two operands makes, with the derivatives by either.
fn of_two(shadow: Shadow, [a, b]: [Noise; 2], [by_a, by_b]: [f64; 2]) -> Noise {
    if a.entry == EXACT && b.entry == EXACT {
        return exact(shadow);
    }
    Noise::new(shadow, with(|tape| tape.operation([(a.entry, by_a), (b.entry, by_b)])))
}

impl Value for Noise {
    const DECIDES: bool = true;

    fn literal(real: f64, format: Format) -> Self {
        known(Shadow::literal(real, format), format)
    }

    fn raw(code: i64, format: Format) -> Self {
        exact(Shadow::raw(code, format))
    }

    fn add(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        of_two(Shadow::add(shadow(a), shadow(b), to), [a.value, b.value], [1.0, 1.0])
    }

    fn sub(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        of_two(Shadow::sub(shadow(a), shadow(b), to), [a.value, b.value], [1.0, -1.0])
    }

    fn mul(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        let product = Shadow::mul(shadow(a), shadow(b), to);
        of_two(product, [a.value, b.value], [b.value.shadow.real, a.value.shadow.real])
    }

    fn abs(a: Signal<Self>, to: Format) -> Self {
        let sign = if a.value.shadow.code < 0 { -1.0 } else { 1.0 };
        of_two(Shadow::abs(shadow(a), to), [a.value, a.value], [sign, 0.0])
    }

    fn quantize(a: Signal<Self>, to: Format, rounding: Rounding, overflow: Overflow) -> Self {
        let result = Shadow::quantize(shadow(a), to, rounding, overflow);
        let fewer = a.format.frac - to.frac;
        let (bits, more) = (fewer.max(0).unsigned_abs(), fewer.min(0).unsigned_abs());
        // Bits that are zero are no loss.
        let dropped = bits.saturating_sub(a.value.zeros);
        let zeros = a.value.zeros.saturating_sub(bits) + more;
        // Of nothing at all nothing is rounded away.
        let nothing = a.value.shadow == Shadow { code: 0, real: 0.0 };
        if a.value.entry == EXACT || dropped == 0 || rounding == Rounding::Exact || nothing {
            return Noise { shadow: result, zeros, ..a.value };
        }
        let from = a.value.entry;
        if rounding == Rounding::Floor {
            // A decision, as in `Shadow`, unless a golden model says what it approximates.
            let before = a.format.real(a.value.shadow.code);
            return with(|tape| {
                let entry = tape.push([(EXACT, 0.0); 2]);
                tape.floored = Some(Floored { entry, before, dropped });
                Noise::new(result, entry)
            });
        }
        let moments = Moments::of_rounding(rounding, dropped, to.lsb());
        Noise::new(result, with(|tape| tape.source([(from, 1.0), (EXACT, 0.0)], moments)))
    }

    fn scale(a: Self, by: i8) -> Self {
        let result = Shadow::scale(a.shadow, by);
        Noise { zeros: a.zeros, ..of_two(result, [a, a], [2f64.powi(by.into()), 0.0]) }
    }

    fn bits(a: Signal<Self>, low: u8, to: Format) -> Self {
        exact(Shadow::bits(shadow(a), low, to))
    }

    fn concat(high: Signal<Self>, low: Signal<Self>, to: Format) -> Self {
        exact(Shadow::concat(shadow(high), shadow(low), to))
    }

    fn less(a: Signal<Self>, b: Signal<Self>) -> Self {
        exact(Shadow::less(shadow(a), shadow(b)))
    }

    fn equal(a: Signal<Self>, b: Signal<Self>) -> Self {
        exact(Shadow::equal(shadow(a), shadow(b)))
    }

    fn and(a: Self, b: Self) -> Self {
        exact(Shadow::and(a.shadow, b.shadow))
    }

    fn or(a: Self, b: Self) -> Self {
        exact(Shadow::or(a.shadow, b.shadow))
    }

    fn not(a: Self) -> Self {
        exact(Shadow::not(a.shadow))
    }

    fn select(bit: Self, a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        let chosen = if bit.shadow.code != 0 { a } else { b };
        let shadow = Shadow::select(bit.shadow, shadow(a), shadow(b), to);
        Noise { shadow, ..chosen.value }
    }

    fn golden(a: Signal<Self>, operands: &[Signal<Self>], ideal: fn(&[f64]) -> f64) -> Self {
        let shadows: [Signal<Shadow>; 4] =
            std::array::from_fn(|n| shadow(operands.get(n).copied().unwrap_or(a)));
        let result = Shadow::golden(shadow(a), &shadows[..operands.len()], ideal);
        let (entries, derivatives) = slopes(operands, ideal);
        if entries.iter().all(|entry| *entry == EXACT) {
            return exact(result);
        }
        // What the code is off what its operands' codes lead to.
        let codes: [f64; 4] = std::array::from_fn(|n| {
            operands.get(n).map_or(0.0, |of| of.format.real(of.value.shadow.code))
        });
        let led_to = ideal(&codes[..operands.len()]);
        let off = a.format.real(a.value.shadow.code) - led_to;
        with(|tape| {
            let pair = |n: usize| [0, 1].map(|k| (entries[n + k], derivatives[n + k]));
            let rest = tape.operation(pair(2));
            let both = tape.operation(pair(0));
            let floored = tape.floored.filter(|of| of.entry == a.value.entry);
            let moments = match floored {
                // Saturated: the number is that of its limit, whatever its last bits were.
                Some(Floored { before, .. }) if (before - led_to).abs() > 2.0 * a.format.lsb() => {
                    Moments::default()
                }
                Some(Floored { before, dropped, .. }) => {
                    let of = Moments::of_rounding(Rounding::Floor, dropped, a.format.lsb());
                    Moments { mean: of.mean + before - led_to, ..of }
                }
                None => Moments::of_result(a.format.lsb()),
            };
            let from = [(both, 1.0), (rest, 1.0)];
            let is_exact = off.abs() < 1e-6 * a.format.lsb();
            let entry = if is_exact { tape.operation(from) } else { tape.source(from, moments) };
            Noise::new(result, entry)
        })
    }

    fn code(a: Signal<Self>) -> i64 {
        a.value.shadow.code
    }

    fn known_bit(bit: Self) -> Option<bool> {
        Some(bit.shadow.code != 0)
    }
}

/// The derivatives of a golden model by its operands, by differences: of those that are not exact.
fn slopes(operands: &[Signal<Noise>], ideal: fn(&[f64]) -> f64) -> ([Entry; 4], [f64; 4]) {
    let (mut entries, mut derivatives, mut reals) = ([EXACT; 4], [0.0; 4], [0.0; 4]);
    for (real, operand) in reals.iter_mut().zip(operands) {
        *real = operand.value.shadow.real;
    }
    for (n, operand) in operands.iter().enumerate() {
        if operand.value.entry == EXACT {
            continue;
        }
        let step = (1e-6 * reals[n].abs()).max(1e-3 * operand.format.lsb());
        let at = |by: f64| {
            let mut moved = reals;
            moved[n] += by;
            ideal(&moved[..operands.len()])
        };
        entries[n] = operand.value.entry;
        derivatives[n] = (at(step) - at(-step)) / (2.0 * step);
    }
    (entries, derivatives)
}

impl Storage for Noise {
    type Words = Words;

    fn words(memory: &Memory) -> Words {
        let known = |(code, real)| known(Shadow { code, real }, memory.format).entry;
        let entries = match memory.initial.is_empty() {
            true => vec![EXACT; memory.words],
            false => memory.codes().into_iter().zip(memory.reals()).map(known).collect(),
        };
        Words { shadows: Shadow::words(memory), entries, data: EXACT }
    }

    fn data(memory: &Memory, words: &mut Words) -> Self {
        Noise::new(Shadow::data(memory, &mut words.shadows), words.data)
    }

    fn access(
        memory: &Memory,
        words: &mut Words,
        address: Signal<Self>,
        write: Option<Write<Self>>,
    ) {
        words.data = words.entries.get(at(address)).copied().unwrap_or(EXACT);
        if let Some(write) = write.as_ref().filter(|write| write.enable.value.shadow.code != 0) {
            words.entries[at(write.address)] = write.data.value.entry;
        }
        let write = write.map(|write| Write {
            enable: shadow(write.enable),
            address: shadow(write.address),
            data: shadow(write.data),
        });
        Shadow::access(memory, &mut words.shadows, shadow(address), write);
    }
}

fn at(address: Signal<Noise>) -> usize {
    address.value.shadow.code as usize
}

impl Interpretation for Noise {
    /// Out of line: who asks for errors waits for them, and a core in one piece takes long to
    /// compile.
    #[inline(never)]
    fn instance<B: Block>(
        block: &B,
        name: &'static str,
        state: &mut State<B, Self>,
        inputs: Inputs<B, Signal<Self>>,
    ) -> Outputs<B, Signal<Self>> {
        Noise::within(name, || block.clock(state, inputs))
    }

    fn within<T>(name: &'static str, act: impl FnOnce() -> T) -> T {
        let before = with(|tape| tape.enter(name));
        let result = act();
        with(|tape| tape.scope = before);
        result
    }

    fn can_skip(busy: Self) -> bool {
        busy.shadow.code == 0
    }
}

#[cfg(test)]
mod tests;
