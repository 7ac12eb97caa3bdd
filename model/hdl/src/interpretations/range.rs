// SPDX-License-Identifier: MIT OR Apache-2.0
//! The range interpretation: a value is the interval of codes that a signal may take.
//!
//! Control (counters, steps, addresses) is known exactly, so its intervals are points and the
//! interpretation follows the one schedule that the core has; data spread over every input in their
//! stated ranges. A narrowing that says it cannot overflow is checked at every clock; what does not
//! hold is kept as a [`Violation`].

use crate::block::{Block, Inputs, Interpretation, Outputs, State};
use crate::format::Format;
use crate::memory::{Memory, Storage, Write};
use crate::signal::{Overflow, Rounding, Signal, Value};
use std::cell::RefCell;
use std::fmt;
use std::panic::Location;

/// The value of the range interpretation: `low ..= high`, in codes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Range {
    /// The least code.
    pub low: i128,
    /// The greatest code.
    pub high: i128,
}

/// A narrowing that is declared not to overflow, and a range that does; or an address beyond the
/// words of a memory.
///
/// ```
/// use hapticore_hdl::format::Format;
/// use hapticore_hdl::interpretations::range::{Range, take_violations, whole};
/// use hapticore_hdl::signal::{Proved, Signal, int};
///
/// let byte = Format::unsigned(8, 0);
/// let any: Signal<Range> = Signal { value: whole(byte), format: byte };
/// (any + any + int(3)).resize(byte, Proved);
/// let [violation] = &take_violations()[..] else { panic!("one narrowing") };
/// assert_eq!(violation.lacking(), 2);
/// assert!(violation.to_string().ends_with(": 3 … 513 lacks 2 bits in u8.0"), "{violation}");
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Violation {
    /// The instances down to the block, with dots between; empty for the block that is run.
    pub instance: String,
    /// The memory, where it is an address that leaves it.
    pub memory: Option<&'static str>,
    /// The line of the block that narrows, or addresses the memory.
    pub line: &'static Location<'static>,
    /// The range before the narrowing, in codes of the narrowed format; or of the address.
    pub range: Range,
    /// The format that does not hold it; or of the memory's addresses.
    pub format: Format,
}

impl Violation {
    /// The bits that the format lacks, one at least where it lacks a sign; none where a memory has
    /// fewer words than its address has codes.
    pub fn lacking(&self) -> u8 {
        let Format { signed, width, .. } = self.format;
        let negative = self.range.low < 0;
        let bits = |code: i128| (128 - (if code < 0 { !code } else { code }).leading_zeros()) as u8;
        let needed = bits(self.range.low).max(bits(self.range.high)) + u8::from(signed || negative);
        needed.saturating_sub(width).max(u8::from(negative && !signed))
    }
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Violation { instance, memory, line, range: Range { low, high }, format } = self;
        let place = if instance.is_empty() { String::new() } else { format!("{instance}, ") };
        write!(f, "{place}{}:{}: ", line.file(), line.line())?;
        match (memory, self.lacking()) {
            (Some(memory), _) => write!(f, "address {low} … {high} leaves the memory {memory}"),
            (None, 1) => write!(f, "{low} … {high} lacks 1 bit in {format}"),
            (None, lacking) => write!(f, "{low} … {high} lacks {lacking} bits in {format}"),
        }
    }
}

thread_local! {
    static SCOPE: RefCell<Vec<&'static str>> = const { RefCell::new(Vec::new()) };
    static VIOLATIONS: RefCell<Vec<Violation>> = const { RefCell::new(Vec::new()) };
    static ASSUMPTIONS: RefCell<Vec<&'static str>> = const { RefCell::new(Vec::new()) };
}

/// The violations found since the last call, on this thread.
pub fn take_violations() -> Vec<Violation> {
    VIOLATIONS.with_borrow_mut(std::mem::take)
}

/// The assumptions relied on since the last call, on this thread, each once.
pub fn take_assumptions() -> Vec<&'static str> {
    ASSUMPTIONS.with_borrow_mut(std::mem::take)
}

/// The range of a whole format.
pub fn whole(format: Format) -> Range {
    Range { low: format.min_code(), high: format.max_code() }
}

impl Range {
    /// Just one code.
    pub fn point(code: i128) -> Self {
        Range { low: code, high: code }
    }

    /// The smallest range that holds both.
    pub fn join(self, other: Range) -> Self {
        Range { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Whether every code of `other` is in this range.
    pub fn holds(self, other: Range) -> bool {
        self.low <= other.low && other.high <= self.high
    }

    fn is_point(self) -> bool {
        self.low == self.high
    }

    fn map(self, f: impl Fn(i128) -> i128) -> Self {
        Range { low: f(self.low), high: f(self.high) }
    }

    /// The range of a bit, from what is known to be so and what may be so.
    fn bit(surely: bool, maybe: bool) -> Self {
        Range { low: i128::from(surely), high: i128::from(maybe) }
    }
}

fn align(a: Signal<Range>, to: Format) -> Range {
    a.value.map(|code| code << (to.frac - a.format.frac))
}

fn round(code: i128, drop: i8, rounding: Rounding) -> i128 {
    match rounding {
        _ if drop <= 0 => code << -drop,
        Rounding::HalfEven => (code + (1 << (drop - 1)) - 1 + ((code >> drop) & 1)) >> drop,
        _ => code >> drop,
    }
}

fn wrap(range: Range, to: Format) -> Range {
    let turns = (range.low - to.min_code()) >> to.width;
    let moved = range.map(|code| code - (turns << to.width));
    if whole(to).holds(moved) { moved } else { whole(to) }
}

/// The range as it is, noted as a violation where the format does not hold it.
#[track_caller]
fn never(range: Range, to: Format) -> Range {
    if !whole(to).holds(range) {
        violated(range, to, None);
    }
    clamp(range, to)
}

#[track_caller]
fn violated(range: Range, format: Format, memory: Option<&'static str>) {
    let instance = SCOPE.with_borrow(|scope| scope.join("."));
    let violation = Violation { instance, memory, line: Location::caller(), range, format };
    VIOLATIONS.with_borrow_mut(|found| found.push(violation));
}

fn assume(range: Range, to: Format, name: &'static str) -> Range {
    ASSUMPTIONS.with_borrow_mut(|found| {
        if !found.contains(&name) {
            found.push(name);
        }
    });
    clamp(range, to)
}

fn clamp(range: Range, to: Format) -> Range {
    range.map(|code| code.clamp(to.min_code(), to.max_code()))
}

/// Operations are out of line, as instances are.
impl Value for Range {
    const ELABORATES: bool = true;

    fn literal(real: f64, format: Format) -> Self {
        Range::point(i128::from(format.code_saturating(real)))
    }

    fn raw(code: i64, _format: Format) -> Self {
        Range::point(code.into())
    }

    #[inline(never)]
    fn add(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        let (a, b) = (align(a, to), align(b, to));
        Range { low: a.low + b.low, high: a.high + b.high }
    }

    #[inline(never)]
    fn sub(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        let (a, b) = (align(a, to), align(b, to));
        Range { low: a.low - b.high, high: a.high - b.low }
    }

    #[inline(never)]
    fn mul(a: Signal<Self>, b: Signal<Self>, _to: Format) -> Self {
        let (a, b) = (a.value, b.value);
        let corners = [a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high];
        corners.into_iter().map(Range::point).reduce(Range::join).expect("four corners")
    }

    #[inline(never)]
    fn square(a: Signal<Self>, to: Format) -> Self {
        let magnitude = Self::abs(a, to);
        magnitude.map(|code| code * code)
    }

    #[inline(never)]
    fn abs(a: Signal<Self>, _to: Format) -> Self {
        let a = a.value;
        let low = if a.low <= 0 && a.high >= 0 { 0 } else { a.low.abs().min(a.high.abs()) };
        Range { low, high: a.low.abs().max(a.high.abs()) }
    }

    #[inline(never)]
    #[track_caller]
    fn quantize(a: Signal<Self>, to: Format, rounding: Rounding, overflow: Overflow) -> Self {
        let range = a.value.map(|code| round(code, a.format.frac - to.frac, rounding));
        match overflow {
            Overflow::Saturate => clamp(range, to),
            Overflow::Wrap => wrap(range, to),
            Overflow::Proved => never(range, to),
            Overflow::Assumed(name) => assume(range, to, name),
        }
    }

    fn scale(a: Self, _by: i8) -> Self {
        a
    }

    #[inline(never)]
    fn bits(a: Signal<Self>, low: u8, to: Format) -> Self {
        wrap(a.value.map(|code| code >> low), to)
    }

    #[inline(never)]
    fn concat(high: Signal<Self>, low: Signal<Self>, _to: Format) -> Self {
        let shift = low.format.width;
        Range {
            low: (high.value.low << shift) | low.value.low,
            high: (high.value.high << shift) | low.value.high,
        }
    }

    #[inline(never)]
    fn at_most(a: Signal<Self>, most: Signal<Self>) -> Self {
        let (a, most) = (a.value, most.value);
        Range { low: a.low.min(most.low), high: a.high.min(most.high) }
    }

    #[inline(never)]
    fn less(a: Signal<Self>, b: Signal<Self>) -> Self {
        let to = a.format.join(b.format);
        let (a, b) = (align(a, to), align(b, to));
        Range::bit(a.high < b.low, a.low < b.high)
    }

    #[inline(never)]
    fn equal(a: Signal<Self>, b: Signal<Self>) -> Self {
        let to = a.format.join(b.format);
        let (a, b) = (align(a, to), align(b, to));
        Range::bit(a.is_point() && a == b, a.low <= b.high && b.low <= a.high)
    }

    fn and(a: Self, b: Self) -> Self {
        Range { low: a.low & b.low, high: a.high & b.high }
    }

    fn or(a: Self, b: Self) -> Self {
        Range { low: a.low | b.low, high: a.high | b.high }
    }

    fn not(a: Self) -> Self {
        Range { low: 1 - a.high, high: 1 - a.low }
    }

    #[inline(never)]
    fn select(bit: Self, a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        match (bit.low, bit.high) {
            (1, _) => align(a, to),
            (_, 0) => align(b, to),
            _ => align(a, to).join(align(b, to)),
        }
    }

    fn code(a: Signal<Self>) -> i64 {
        a.value.low as i64
    }

    fn known_bit(bit: Self) -> Option<bool> {
        bit.is_point().then_some(bit.low != 0)
    }
}

impl Storage for Range {
    type Words = (Vec<Range>, Range);

    fn words(memory: &Memory) -> Self::Words {
        (
            memory.codes().into_iter().map(|code| Range::point(code.into())).collect(),
            Range::point(0),
        )
    }

    fn data(_memory: &Memory, words: &mut Self::Words) -> Self {
        words.1
    }

    #[track_caller]
    fn access(
        memory: &Memory,
        words: &mut Self::Words,
        address: Signal<Self>,
        write: Option<Write<Self>>,
    ) {
        words.1 = read(&words.0, within(memory, address.value));
        let Some(write) = write.filter(|write| write.enable.value.high != 0) else { return };
        let data = align(write.data, memory.format);
        let surely = write.enable.value.low == 1 && write.address.value.is_point();
        let place = within(memory, write.address.value);
        for word in &mut words.0[place.low as usize..=place.high as usize] {
            *word = if surely { data } else { word.join(data) };
        }
    }
}

impl Interpretation for Range {
    /// Out of line: a proof runs few clocks, and a core in intervals in one piece takes long to
    /// compile.
    #[inline(never)]
    fn instance<B: Block>(
        block: &B,
        name: &'static str,
        state: &mut State<B, Self>,
        inputs: Inputs<B, Signal<Self>>,
    ) -> Outputs<B, Signal<Self>> {
        SCOPE.with_borrow_mut(|scope| scope.push(name));
        let outputs = block.clock(state, inputs);
        SCOPE.with_borrow_mut(|scope| scope.pop());
        outputs
    }

    /// Surely not busy: that skipping changes no bit is tested on the clocked interpretation.
    fn can_skip(busy: Self) -> bool {
        busy == Range::point(0)
    }
}

/// The address within the words of a memory; noted as a violation where it leaves them.
#[track_caller]
fn within(memory: &Memory, address: Range) -> Range {
    let last = memory.words as i128 - 1;
    if address.low < 0 || address.high > last {
        violated(address, memory.address(), Some(memory.name));
    }
    Range { low: address.low.clamp(0, last), high: address.high.clamp(0, last) }
}

/// The join of the words that an address may mean.
fn read(words: &[Range], address: Range) -> Range {
    let within = &words[address.low as usize..=address.high as usize];
    within.iter().copied().reduce(Range::join).expect("an address means a word")
}
