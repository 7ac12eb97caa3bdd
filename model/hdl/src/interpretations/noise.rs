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
//! | floor | −(1 − 2^−d)/2 | (1 − 4^−d)/12 | 1 |
//! | quotient, root | 0 | 1/12 | ½ |
//! | constant, word of a table | as it is | 0 | as it is |
//!
//! in the LSBs of what is left. Control follows the clocked value, as in
//! [`Shadow`], so that a path that was not taken adds nothing. A number that saturates, and what the
//! error of a decision does, are beyond this. Source of the variances: the dropped bits take each of
//! their 2^d values equally often.

use super::shadow::{Shadow, Shadows};
use crate::block::{Block, Inputs, Interpretation, Outputs, State};
use crate::format::Format;
use crate::memory::{Memory, Storage, Write};
use crate::signal::{Overflow, Rounding, Signal, Value};
use std::cell::RefCell;
use std::marker::PhantomData;

/// The value of the noise interpretation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Its code, and what it would be without rounding.
    pub shadow: Shadow,
    /// Where its derivatives are written down.
    entry: Entry,
}

/// A memory of the noise interpretation.
#[derive(Debug, Clone)]
pub struct Words {
    shadows: Shadows,
    entries: Vec<Entry>,
    data: Entry,
}

/// An error: of what is rounded so, or of a signal.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Moments {
    /// Mean.
    pub mean: f64,
    /// Variance.
    pub variance: f64,
    /// The largest magnitude.
    pub bound: f64,
}

impl Moments {
    /// Of an error that is known.
    pub fn known(error: f64) -> Self {
        Moments { mean: error, variance: 0.0, bound: error.abs() }
    }

    /// Of a rounding that drops so many bits, in steps of `lsb`.
    fn of_rounding(rounding: Rounding, dropped: u8, lsb: f64) -> Self {
        let part = 0.5f64.powi(dropped.into());
        let (mean, variance, bound) = match rounding {
            Rounding::Floor => (-0.5 * (1.0 - part), (1.0 - part * part) / 12.0, 1.0 - part),
            _ => (0.0, (1.0 + 2.0 * part * part) / 12.0, 0.5),
        };
        Moments { mean, variance, bound }.times(lsb)
    }

    /// Of a quotient or a root, which has no last bit to drop.
    fn of_result(lsb: f64) -> Self {
        Moments { mean: 0.0, variance: 1.0 / 12.0, bound: 0.5 }.times(lsb)
    }

    /// Of this error with a gain.
    pub fn times(self, gain: f64) -> Self {
        Moments {
            mean: gain * self.mean,
            variance: gain * gain * self.variance,
            bound: gain.abs() * self.bound,
        }
    }

    /// Of this error and one that is independent of it, together.
    pub fn plus(self, other: Self) -> Self {
        Moments {
            mean: self.mean + other.mean,
            variance: self.variance + other.variance,
            bound: self.bound + other.bound,
        }
    }

    /// Root of the mean square.
    pub fn rms(self) -> f64 {
        (self.mean * self.mean + self.variance).sqrt()
    }
}

/// Where constants come from that no instance has: a calibration's words.
const OUTSIDE: &str = "calibration";

/// The number of an operation that was written down; 0 where a value is exact.
type Entry = u32;
const EXACT: Entry = 0;

/// An operation: what its result depends on.
#[derive(Debug, Clone, Copy, Default)]
struct Operation {
    from: [(Entry, f64); 2],
}

/// A source of error, added to an operation's result.
#[derive(Debug, Clone, Copy)]
struct Source {
    entry: Entry,
    scope: usize,
    moments: Moments,
}

/// What a floor has left out, which is its error where a golden model says that it is one.
#[derive(Debug, Clone, Copy)]
struct Floored {
    entry: Entry,
    before: f64,
    dropped: u8,
}

/// Blocks within blocks, by the names of their instances.
#[derive(Debug)]
struct Scope {
    parent: usize,
    name: &'static str,
}

#[derive(Debug, Default)]
struct Tape {
    /// Which recording of the thread it is.
    number: u64,
    operations: Vec<Operation>,
    sources: Vec<Source>,
    floored: Option<Floored>,
    scopes: Vec<Scope>,
    scope: usize,
}

thread_local! {
    static TAPE: RefCell<Tape> = RefCell::default();
}

fn with<T>(act: impl FnOnce(&mut Tape) -> T) -> T {
    TAPE.with_borrow_mut(act)
}

impl Tape {
    fn begin(&mut self) {
        let (number, operations) = (self.number + 1, vec![Operation::default()]);
        *self = Tape { number, operations, ..Tape::default() };
        self.scopes.push(Scope { parent: 0, name: OUTSIDE });
    }

    fn operation(&mut self, from: [(Entry, f64); 2]) -> Entry {
        if from.iter().all(|&(entry, gain)| entry == EXACT || gain == 0.0) {
            return EXACT;
        }
        self.push(from)
    }

    fn push(&mut self, from: [(Entry, f64); 2]) -> Entry {
        self.operations.push(Operation { from });
        Entry::try_from(self.operations.len() - 1).expect("a slot has fewer than 2^32 operations")
    }

    /// An entry with an error of its own.
    fn source(&mut self, from: [(Entry, f64); 2], moments: Moments) -> Entry {
        let entry = self.push(from);
        self.sources.push(Source { entry, scope: self.scope, moments });
        entry
    }

    fn enter(&mut self, name: &'static str) -> usize {
        let (before, parent) = (self.scope, self.scope);
        let known = self.scopes.iter().position(|of| of.parent == parent && of.name == name);
        self.scope = known.unwrap_or_else(|| {
            self.scopes.push(Scope { parent, name });
            self.scopes.len() - 1
        });
        before
    }

    /// The gain from each operation's result to that of `entry`.
    fn gains(&self, entry: Entry) -> Vec<f64> {
        let mut gains = vec![0.0; entry as usize + 1];
        gains[entry as usize] = 1.0;
        for number in (1..=entry as usize).rev() {
            if gains[number] != 0.0 {
                for (from, derivative) in self.operations[number].from {
                    gains[from as usize] += derivative * gains[number];
                }
            }
        }
        gains
    }

    fn path(&self, mut scope: usize) -> String {
        if scope == 0 {
            return OUTSIDE.into();
        }
        let mut names = Vec::new();
        while scope != 0 {
            names.push(self.scopes[scope].name);
            scope = self.scopes[scope].parent;
        }
        names.reverse();
        names.join(".")
    }
}

/// What blocks compute with [`Noise`] on this thread, from [`Recording::begin`] on. There is one a
/// thread: as another one begins, this one ends, and its methods panic.
#[derive(Debug)]
pub struct Recording {
    number: u64,
    of_this_thread: PhantomData<*const ()>,
}

/// A time of a recording.
#[derive(Debug, Clone, Copy)]
pub struct Mark {
    operations: usize,
    sources: usize,
}

/// The error of a signal.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Errors {
    /// All of it.
    pub total: Moments,
    /// By where it comes from: the path of the instance that rounds, or the name of an input.
    pub by_source: Vec<(String, Moments)>,
}

impl Recording {
    /// Begins to write down.
    pub fn begin() -> Self {
        with(Tape::begin);
        Recording { number: with(|tape| tape.number), of_this_thread: PhantomData }
    }

    fn with<T>(&self, act: impl FnOnce(&mut Tape) -> T) -> T {
        with(|tape| {
            assert_eq!(tape.number, self.number, "another recording has begun on this thread");
            act(tape)
        })
    }

    /// Now.
    pub fn mark(&self) -> Mark {
        self.with(|tape| Mark { operations: tape.operations.len(), sources: tape.sources.len() })
    }

    /// Forgets what was written down since: signals of that time are no longer to be used.
    pub fn rewind(&self, to: Mark) {
        self.with(|tape| {
            tape.operations.truncate(to.operations);
            tape.sources.truncate(to.sources);
            tape.floored = None;
        });
    }

    /// A signal from outside with a name, whose error is `moments`: that of its code, if it is
    /// known, included.
    pub fn input(
        &self,
        name: &'static str,
        shadow: Shadow,
        format: Format,
        moments: Moments,
    ) -> Signal<Noise> {
        let entry = self.with(|tape| {
            let before = tape.enter(name);
            let entry = tape.source([(EXACT, 0.0); 2], moments);
            tape.scope = before;
            entry
        });
        Signal { value: Noise { shadow, entry }, format }
    }

    /// How many operations have been written down.
    pub fn operations(&self) -> usize {
        self.with(|tape| tape.operations.len())
    }

    /// The error of a value.
    pub fn errors(&self, of: Noise) -> Errors {
        self.with(|tape| {
            let gains = tape.gains(of.entry);
            let mut by_scope = vec![Moments::default(); tape.scopes.len()];
            for source in &tape.sources {
                let gain = gains.get(source.entry as usize).copied().unwrap_or(0.0);
                if gain != 0.0 {
                    by_scope[source.scope] =
                        by_scope[source.scope].plus(source.moments.times(gain));
                }
            }
            let total = by_scope.iter().fold(Moments::default(), |sum, of| sum.plus(*of));
            let named = by_scope.into_iter().enumerate().filter(|(_, of)| of.bound > 0.0);
            Errors { total, by_source: named.map(|(n, of)| (tape.path(n), of)).collect() }
        })
    }
}

fn shadow(a: Signal<Noise>) -> Signal<Shadow> {
    Signal { value: a.value.shadow, format: a.format }
}

/// A value that is exact, or decides.
fn exact(shadow: Shadow) -> Noise {
    Noise { shadow, entry: EXACT }
}

/// The error that a code of this value has already: of a word of a table, of a constant.
fn known(shadow: Shadow, format: Format) -> Noise {
    let error = format.real(shadow.code) - shadow.real;
    let entry = match error {
        0.0 => EXACT,
        _ => with(|tape| tape.source([(EXACT, 0.0); 2], Moments::known(error))),
    };
    Noise { shadow, entry }
}

/// What an operation of two operands makes, with the derivatives by either.
fn of_two(shadow: Shadow, [a, b]: [Noise; 2], [by_a, by_b]: [f64; 2]) -> Noise {
    if a.entry == EXACT && b.entry == EXACT {
        return exact(shadow);
    }
    Noise { shadow, entry: with(|tape| tape.operation([(a.entry, by_a), (b.entry, by_b)])) }
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
        let dropped = u8::try_from(a.format.frac - to.frac).unwrap_or(0);
        // Of nothing at all nothing is rounded away.
        let nothing = a.value.shadow == Shadow { code: 0, real: 0.0 };
        if a.value.entry == EXACT || dropped == 0 || rounding == Rounding::Exact || nothing {
            return Noise { shadow: result, ..a.value };
        }
        let from = a.value.entry;
        if rounding == Rounding::Floor {
            // A decision, as in `Shadow`, unless a golden model says what it approximates.
            let before = a.format.real(a.value.shadow.code);
            return with(|tape| {
                let entry = tape.push([(EXACT, 0.0); 2]);
                tape.floored = Some(Floored { entry, before, dropped });
                Noise { shadow: result, entry }
            });
        }
        let moments = Moments::of_rounding(rounding, dropped, to.lsb());
        let entry = with(|tape| tape.source([(from, 1.0), (EXACT, 0.0)], moments));
        Noise { shadow: result, entry }
    }

    fn scale(a: Self, by: i8) -> Self {
        let result = Shadow::scale(a.shadow, by);
        of_two(result, [a, a], [2f64.powi(by.into()), 0.0])
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
            Noise { shadow: result, entry }
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
        Noise { shadow: Shadow::data(memory, &mut words.shadows), entry: words.data }
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
        let before = with(|tape| tape.enter(name));
        let outputs = block.clock(state, inputs);
        with(|tape| tape.scope = before);
        outputs
    }

    fn can_skip(busy: Self) -> bool {
        busy.shadow.code == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::{Floor, HalfEven, Proved};

    fn input(recording: &Recording, real: f64, format: Format) -> Signal<Noise> {
        let code = format.code(real).expect("a code");
        let moments = Moments { mean: 0.0, variance: 1.0, bound: 2.0 };
        recording.input("input", Shadow { code, real }, format, moments)
    }

    #[test]
    fn what_two_signals_have_in_common_counts_once() {
        let recording = Recording::begin();
        let format = Format::signed(8, 2);
        let [x, y] = [3.0, -5.0].map(|real| input(&recording, real, format));
        let variance = |of: Signal<Noise>| recording.errors(of.value).total.variance;
        assert_eq!(variance(x + y), 2.0);
        assert_eq!(variance(x + x), 4.0);
        assert_eq!(variance(x - x), 0.0);
        assert_eq!(variance(x * y), 34.0, "5²+3²");
        assert_eq!(variance((x - x) * y), 0.0);
    }

    /// The errors of every code, as often as each other, against the formulas.
    #[test]
    fn roundings_have_the_moments_of_the_bits_that_they_drop() {
        for (rounding, dropped) in
            [HalfEven, Floor].into_iter().flat_map(|r| (1..7).map(move |d| (r, d)))
        {
            let (fine, coarse) = (Format::signed(12, 6), Format::signed(12, 6 - dropped));
            let codes = -(4i64 << dropped)..4 << dropped;
            let error = |code: i64| {
                let rounded =
                    i64::quantize(Signal { value: code, format: fine }, coarse, rounding, Proved);
                coarse.real(rounded) - fine.real(code)
            };
            let count = codes.clone().count() as f64;
            let mean = codes.clone().map(error).sum::<f64>() / count;
            let square = codes.clone().map(|code| error(code).powi(2)).sum::<f64>() / count;
            let bound = codes.map(|code| error(code).abs()).fold(0.0, f64::max);
            let moments = Moments::of_rounding(rounding, dropped as u8, coarse.lsb());
            assert!((moments.mean - mean).abs() < 1e-12, "{rounding:?} {dropped}");
            assert!((moments.rms().powi(2) - square).abs() < 1e-12, "{rounding:?} {dropped}");
            assert!((moments.bound - bound).abs() < 1e-12, "{rounding:?} {dropped}");
        }
    }

    #[test]
    #[should_panic(expected = "another recording")]
    fn a_recording_ends_as_another_begins() {
        let first = Recording::begin();
        Recording::begin();
        first.mark();
    }
}
