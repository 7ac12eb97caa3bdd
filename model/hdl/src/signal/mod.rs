// SPDX-License-Identifier: MIT OR Apache-2.0
//! Signals: what blocks compute with. A signal has a format and a value, and what a value *is*
//! depends on the interpretation.
//!
//! | interpretation | a value is | gives |
//! | --- | --- | --- |
//! | [`Clocked`] | a raw code | the cycle-accurate model, at native speed |
//! | [`Real`](crate::interpretations::real::Real) | an `f64`, never rounded | what a signal would be with unlimited word length |
//! | [`Shadow`](crate::interpretations::shadow::Shadow) | both, control following the code | the rounding error of every signal |
//! | [`Noise`](crate::interpretations::noise::Noise) | both, and its derivatives | the error to be expected of a signal, by source |
//! | [`Range`](crate::interpretations::range::Range) | an interval of codes | a proof that nothing overflows |
//! | [`Node`](crate::interpretations::netlist::Node) | a node of a graph | the netlist that is printed as Verilog |
//!
//! Operators are exact and infer their format. Only [`Signal::quantize`] and [`Signal::resize`]
//! narrow, and they name their rounding and their overflow.
//!
//! ```
//! use hapticore_hdl::format::Format;
//! use hapticore_hdl::signal::{Clocked, HalfEven, Saturate, Signal, code};
//!
//! let adc = Format::signed(16, 15);
//! let (x, gain): (Signal<Clocked>, _) = (code(-32768, adc), code(3, Format::unsigned(2, 0)));
//! let product = x * gain;
//! assert_eq!((product.value, product.format), (-98304, Format::signed(18, 15)));
//! assert_eq!(product.quantize(adc, HalfEven, Saturate).value, -32768);
//! ```

mod operators;

use crate::format::{BIT, Format};

/// An operation: in line where a core is clocked, out of line where blocks are elaborated. Elaborated blocks in one piece
/// took half of the time in which this workspace's tests are compiled. A macro, since a closure that clocks cores is not
/// always inlined.
macro_rules! operate {
    ($value:ty, $operation:expr) => {
        if <$value>::ELABORATES { $crate::signal::out_of_line(|| $operation) } else { $operation }
    };
}
pub(crate) use operate;

/// The value of the clocked interpretation: a raw code.
pub type Clocked = i64;

/// What a narrowing does with the bits below the new least significant one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Rounding {
    /// To the nearest code, ties to the even one.
    HalfEven,
    /// Towards minus infinity. Meant, as in a table address: interpretations without rounding
    /// follow it too.
    Floor,
    /// There are none: the new format has as many fractional bits.
    Exact,
}

/// What a narrowing does with a number beyond the new format.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Overflow {
    /// Saturates: the nearest code of the format.
    Saturate,
    /// Keeps the low bits, as a phase does.
    Wrap,
    /// It cannot happen; the interpretation as ranges proves it.
    Proved,
    /// It cannot happen for the reason named, which relates several signals and so is beyond
    /// intervals. A solver proves it from the netlist ([`smt`](crate::smt)) and what the block
    /// [claims](crate::block::Block::claims) of itself; test builds check it at each clock.
    Assumed(&'static str),
}

pub use Overflow::{Assumed, Proved, Saturate, Wrap};
pub use Rounding::{Exact, Floor, HalfEven};

/// A signal: a value, and the format in which it is read.
#[derive(Debug, Clone, Copy)]
pub struct Signal<V> {
    /// What the interpretation makes of it.
    pub value: V,
    /// How its code is read as a number.
    pub format: Format,
}

/// What a signal's value may be: the arithmetic of an interpretation. Every operation is told the
/// exact format of its result.
pub trait Value: Copy + std::fmt::Debug + 'static {
    /// Whether formats are checked at every register and port as it runs (elsewhere only in debug
    /// builds without optimisation).
    const ELABORATES: bool = false;

    /// Whether every bit is known as it runs.
    const DECIDES: bool = false;

    /// Whether a value has a raw code, so that exact sums of codes may be made in any way that is
    /// exact.
    const HAS_CODE: bool = false;

    /// Whether a value has a number that is never rounded: alone or beside its code.
    const HAS_REAL: bool = false;

    /// A constant: the number `real`, to the nearest code where the interpretation has codes.
    fn literal(real: f64, format: Format) -> Self;
    /// The sum of two signals.
    fn add(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self;
    /// The difference of two signals.
    fn sub(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self;
    /// The product of two signals.
    fn mul(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self;
    /// The square of a signal, which an interpretation may know to be positive.
    #[inline(always)]
    fn square(a: Signal<Self>, to: Format) -> Self {
        Self::mul(a, a, to)
    }
    /// The magnitude of a signal.
    fn abs(a: Signal<Self>, to: Format) -> Self;
    /// The signal in a narrower or wider format. An interpretation may say which line narrows.
    #[track_caller]
    fn quantize(a: Signal<Self>, to: Format, rounding: Rounding, overflow: Overflow) -> Self;
    /// The same code with its point moved: the number times `2^by`.
    fn scale(a: Self, by: i8) -> Self;
    /// The `to.width` bits of the code from bit `low` up, as an unsigned integer.
    fn bits(a: Signal<Self>, low: u8, to: Format) -> Self;
    /// The codes of two unsigned integers, side by side.
    fn concat(high: Signal<Self>, low: Signal<Self>, to: Format) -> Self;
    /// Whether `a < b`.
    fn less(a: Signal<Self>, b: Signal<Self>) -> Self;
    /// Whether `a = b`.
    fn equal(a: Signal<Self>, b: Signal<Self>) -> Self;
    /// AND of two bits.
    fn and(a: Self, b: Self) -> Self;
    /// OR of two bits.
    fn or(a: Self, b: Self) -> Self;
    /// One bit: the other.
    fn not(a: Self) -> Self;
    /// `a` where the bit is set, else `b`.
    fn select(bit: Self, a: Signal<Self>, b: Signal<Self>, to: Format) -> Self;

    /// The lesser of two signals of one format; as an interval it is known to be at most either.
    #[inline(always)]
    fn at_most(a: Signal<Self>, most: Signal<Self>) -> Self {
        Self::select(Self::less(most, a), most, a, a.format)
    }

    /// In interpretations without rounding: the golden model `ideal` of the operands. In all
    /// others: `a` itself. With it a block that approximates (a table) or works digit by digit (a
    /// division) says what it approximates.
    #[inline(always)]
    fn golden(a: Signal<Self>, _operands: &[Signal<Self>], _ideal: fn(&[f64]) -> f64) -> Self {
        a.value
    }

    /// The raw code given, in a format.
    #[inline(always)]
    fn raw(code: i64, format: Format) -> Self {
        Self::literal(format.real(code), format)
    }

    /// The code that a signal has, in interpretations that have one; the nearest in others.
    fn code(a: Signal<Self>) -> i64;

    /// The number that the circuit has: that of its code, in interpretations with codes.
    #[inline(always)]
    fn real(a: Signal<Self>) -> f64 {
        a.format.real(Self::code(a))
    }

    /// The number that the signal would be without rounding, in interpretations that keep it.
    #[inline(always)]
    fn unrounded(a: Signal<Self>) -> f64 {
        Self::real(a)
    }

    /// The signal with this number as its unrounded one, in interpretations that keep it.
    #[inline(always)]
    fn with_unrounded(a: Signal<Self>, _real: f64) -> Self {
        a.value
    }

    /// What a bit is, where the interpretation knows.
    fn known_bit(bit: Self) -> Option<bool>;
}

/// A constant by its code.
#[inline(always)]
pub fn code<V: Value>(code: i64, format: Format) -> Signal<V> {
    operate!(V, Signal { value: V::raw(code, format), format })
}

/// A signal of this format with the value 0.
#[inline(always)]
pub fn zero<V: Value>(format: Format) -> Signal<V> {
    code(0, format)
}

/// An unsigned integer constant, in the narrowest format that holds it.
#[inline(always)]
pub fn int<V: Value>(value: u64) -> Signal<V> {
    code(value as i64, Format::counter(value))
}

/// A constant by its number, which need not be a code: interpretations without rounding have it as
/// it is. Not for a block's clock, where [`code`] is quicker.
#[inline(always)]
pub fn constant<V: Value>(real: f64, format: Format) -> Signal<V> {
    Signal { value: V::literal(real, format), format }
}

/// A constant bit.
#[inline(always)]
pub fn bit<V: Value>(set: bool) -> Signal<V> {
    code(i64::from(set), BIT)
}

/// Whether a bit is set, in interpretations that know.
#[inline(always)]
pub fn is_set<V: Value>(bit: Signal<V>) -> bool {
    V::known_bit(bit.value) == Some(true)
}

/// Whether a bit is not set, in interpretations that know every bit as they run.
#[inline(always)]
pub fn is_clear<V: Value>(bit: Signal<V>) -> bool {
    V::DECIDES && V::known_bit(bit.value) == Some(false)
}

/// Whether the interpretation knows a bit.
#[inline(always)]
pub fn is_known<V: Value>(bit: &Signal<V>) -> bool {
    V::known_bit(bit.value).is_some()
}

/// Whether the interpretation of a signal knows every bit.
#[inline(always)]
pub fn decides<V: Value>(_signal: &Signal<V>) -> bool {
    V::DECIDES
}

/// An operation of an elaborated block.
#[inline(never)]
pub(crate) fn out_of_line<T>(operation: impl FnOnce() -> T) -> T {
    operation()
}

#[cold]
#[inline(never)]
fn is_not_exact(from: Format, to: Format) -> ! {
    panic!("{from} → {to} is not exact")
}

impl<V: Value> Signal<V> {
    /// The signal narrowed to the format `to`: what is lost below its least significant bit and
    /// beyond its range is named.
    #[inline(always)]
    #[track_caller]
    pub fn quantize(self, to: Format, rounding: Rounding, overflow: Overflow) -> Self {
        if (V::ELABORATES || cfg!(debug_assertions))
            && rounding == Exact
            && to.frac < self.format.frac
        {
            is_not_exact(self.format, to);
        }
        Signal { value: V::quantize(self, to, rounding, overflow), format: to }
    }

    /// This signal where a port or register of `format` is present, nothing where it is absent.
    #[inline(always)]
    pub fn where_present(self, format: Format) -> Self {
        if format.is_none() { zero(format) } else { self }
    }

    /// The same number in the format `to`, which has no fewer fractional bits; what is lost beyond
    /// its range is named.
    ///
    /// # Panics
    /// In debug builds and where blocks are elaborated, where `to` has fewer fractional bits.
    #[inline(always)]
    #[track_caller]
    pub fn resize(self, to: Format, overflow: Overflow) -> Self {
        self.quantize(to, Exact, overflow)
    }

    /// The count after this one, of as many bits: the last code is followed by zero.
    #[inline(always)]
    #[track_caller]
    pub fn increment(self) -> Self {
        (self + int(1)).resize(self.format, Wrap)
    }

    /// The same number in a format that can represent its own: an interpretation as codes aligns it
    /// once, here, and not at every operation that it meets others in. To all others it is the
    /// signal as it was.
    #[inline(always)]
    #[track_caller]
    pub fn align_point(self, to: Format) -> Self {
        if V::DECIDES { self.resize(to, Proved) } else { self }
    }

    /// As [`Signal::quantize`] with saturation, and a bit that says whether the number saturated.
    #[inline(always)]
    #[track_caller]
    pub fn saturate(self, to: Format, rounding: Rounding) -> (Self, Self) {
        let rounded = self.quantize(self.format.rounded(to), rounding, Proved);
        let limited = rounded.resize(to, Saturate);
        let saturated = rounded
            .beyond(to)
            .golden(&[limited, rounded], |of| f64::from(u8::from(of[0] != of[1])));
        (limited, saturated)
    }

    /// Whether the code, read as one of `to`, is not this number: bits from its sign up are not all
    /// alike.
    #[inline(always)]
    fn beyond(self, to: Format) -> Self {
        operate!(V, self.has_unlike_bits(to))
    }

    #[inline(always)]
    fn has_unlike_bits(self, to: Format) -> Self {
        let Format { signed, width, .. } = self.format;
        let low = to.width - u8::from(to.signed);
        if width <= low {
            return if signed && !to.signed { self.msb() } else { bit(false) };
        }
        let above = self.bits(low, width - low);
        match signed && to.signed {
            true => !(above.is(0) | above.is((1 << (width - low)) - 1)),
            false => !above.is(0),
        }
    }

    /// The same bits with the point moved: the number times `2^by`.
    #[inline(always)]
    pub fn scaled(self, by: i8) -> Self {
        operate!(V, Signal { value: V::scale(self.value, by), format: self.format.scaled(by) })
    }

    /// The code as an integer: the number times `2^frac`.
    #[inline(always)]
    pub fn integer(self) -> Self {
        self.scaled(self.format.frac)
    }

    /// The number whose code in the format `to` this integer is: the low bits of it, where it has
    /// more.
    #[inline(always)]
    #[track_caller]
    pub fn as_code(self, to: Format) -> Self {
        self.resize(to.integer(), Wrap).scaled(-to.frac)
    }

    /// The magnitude; that of the most negative code too.
    #[inline(always)]
    pub fn abs(self) -> Self {
        operate!(V, {
            let to = Format::unsigned(self.format.width, self.format.frac);
            Signal { value: V::abs(self, to), format: to }
        })
    }

    /// The exact square; 2B + 1 bits hold that of the most negative code.
    #[inline(always)]
    pub fn square(self) -> Self {
        operate!(V, {
            let product = self.format.product(self.format);
            let to = Format::unsigned(product.width - u8::from(self.format.signed), product.frac);
            Signal { value: V::square(self, to), format: to }
        })
    }

    /// `width` bits of the code from bit `low` up, as an unsigned integer. Bits beyond the word are zero, or
    /// copies of its sign.
    #[inline(always)]
    pub fn bits(self, low: u8, width: u8) -> Self {
        operate!(V, {
            let to = Format::unsigned(width, 0);
            Signal { value: V::bits(self, low, to), format: to }
        })
    }

    /// The most significant bit.
    #[inline(always)]
    pub fn msb(self) -> Self {
        self.bits(self.format.width - 1, 1)
    }

    /// This unsigned integer, with `low` to the right of it.
    #[inline(always)]
    pub fn concat(self, low: Self) -> Self {
        operate!(V, {
            let to = Format::unsigned(self.format.width + low.format.width, 0);
            Signal { value: V::concat(self, low, to), format: to }
        })
    }

    /// Whether this is less than `other`.
    #[inline(always)]
    pub fn less_than(self, other: Self) -> Self {
        operate!(V, Signal { value: V::less(self, other), format: BIT })
    }

    /// Whether this is at least `other`.
    #[inline(always)]
    pub fn at_least(self, other: Self) -> Self {
        !self.less_than(other)
    }

    /// Whether this equals `other`.
    #[inline(always)]
    pub fn equals(self, other: Self) -> Self {
        operate!(V, Signal { value: V::equal(self, other), format: BIT })
    }

    /// Whether this equals the integer `other`.
    #[inline(always)]
    pub fn is(self, other: u64) -> Self {
        operate!(V, self.equals(int(other)))
    }

    /// The lesser of this and `most`, which has the same format.
    #[inline(always)]
    pub fn at_most(self, most: Self) -> Self {
        operate!(V, {
            debug_assert!(self.format == most.format);
            Signal { value: V::at_most(self, most), ..self }
        })
    }

    /// `a` where this bit is set, else `b`.
    #[inline(always)]
    pub fn select(self, a: Self, b: Self) -> Self {
        operate!(V, {
            debug_assert!(self.format == BIT);
            let to = a.format.join(b.format);
            Signal { value: V::select(self.value, a, b, to), format: to }
        })
    }

    /// See [`Value::golden`].
    #[inline(always)]
    pub fn golden(self, operands: &[Self], ideal: fn(&[f64]) -> f64) -> Self {
        Signal { value: V::golden(self, operands, ideal), ..self }
    }
}
