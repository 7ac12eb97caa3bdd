// SPDX-License-Identifier: MIT OR Apache-2.0
//! Serial divider: the quotient of two unsigned numbers, correctly rounded.
//!
//! ```text
//! quotient = numerator / denominator, to the nearest code, ties to even
//! ```
//!
//! ```text
//! numerator ──[remainder : tail]──(− denominator ≥ 0 ?)── one quotient bit a clock ──[tail]──[round half even, saturate]── quotient
//! ```
//!
//! | signal    | overflow                                                                 |
//! | quotient  | saturates, and says so                                                   |
//! | remainder | cannot: it stays below the denominator (lemma, held by an exhaustive test) |
//!
//! A zero denominator gives a saturated quotient; the caller says what that means. Latency: quotient width + 4 clocks from
//! `start` to `done`. Source: restoring division, Parhami, Computer Arithmetic, §13.

use crate::block::{Block, Cell};
use crate::format::{BIT, Format};
use crate::signal::{Exact, Lemma, Never, Signal, Value, Wrap, bit, code, int};
use crate::{bundle, next, when};

bundle! {
    /// The inputs.
    pub struct Inputs {
        /// Takes the operands and begins.
        start,
        /// What is divided; holds until the quotient is there.
        numerator,
        /// By what; holds likewise.
        denominator,
    }
}

bundle! {
    /// The outputs.
    pub struct Outputs {
        /// Set for one clock when the quotient is there.
        done,
        /// The quotient, held until the next is there.
        quotient,
        /// Whether the quotient is held at its rail.
        saturated,
    }
}

bundle! {
    /// The registers.
    pub struct Registers {
        busy, count, remainder, tail, over, up, done, quotient, saturated,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct Divider {
    numerator: Format,
    denominator: Format,
    quotient: Format,
    registers: Registers<Format>,
    /// The numerator with zeros behind it, so that the integer quotient has the quotient's point.
    dividend: Format,
}

const BELOW: &str = "the remainder of a division stays below its denominator";

impl Divider {
    /// A divider for these unsigned formats.
    ///
    /// # Panics
    /// Where the quotient has fewer fractional bits than the numerator has beyond the denominator's.
    pub fn new(numerator: Format, denominator: Format, quotient: Format) -> Self {
        assert!(!(numerator.signed || denominator.signed || quotient.signed), "a divider is unsigned");
        let pad = quotient.frac - numerator.frac + denominator.frac;
        assert!(pad >= 0, "{numerator} / {denominator} has more fractional bits than {quotient}");
        let width = (numerator.width + pad as u8).max(quotient.width + 1);
        let dividend = Format::unsigned(width, numerator.frac + pad);
        let head = (width - quotient.width).max(denominator.width);
        let registers = Registers {
            busy: BIT,
            count: Format::counter(u64::from(quotient.width) + 2),
            remainder: Format::unsigned(head, 0),
            tail: Format::unsigned(quotient.width, 0),
            over: BIT,
            up: BIT,
            done: BIT,
            quotient,
            saturated: BIT,
        };
        Divider { numerator, denominator, quotient, registers, dividend }
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        u64::from(self.quotient.width) + 4
    }

    /// The registers when a division begins: the dividend's high bits are the first remainder.
    #[inline(always)]
    fn begin<V: Value>(&self, r: Registers<Signal<V>>, i: Inputs<Signal<V>>) -> Registers<Signal<V>> {
        let numerator = i.numerator.fit(self.dividend, Exact, Never);
        let width = self.quotient.width;
        let (remainder, tail) = (numerator.bits(width, self.dividend.width - width), numerator.bits(0, width));
        Registers { busy: bit(true), count: int(0), remainder, tail, ..r }
    }

    /// The count goes on.
    #[inline(always)]
    fn count<V: Value>(&self, r: &Registers<Signal<V>>) -> Signal<V> {
        (r.count + int(1)).fit(r.count.format, Exact, Wrap)
    }

    /// If the high bits already reach the denominator, the quotient does not fit: it is known already, and zeros keep the
    /// remainder below even so.
    #[inline(always)]
    fn check<V: Value>(&self, r: Registers<Signal<V>>, i: Inputs<Signal<V>>) -> Registers<Signal<V>> {
        let over = r.remainder.at_least(i.denominator.integer()).named("too_large");
        let (remainder, tail) = (over.select(int(0), r.remainder), over.select(int(0), r.tail));
        Registers { count: self.count(&r), remainder, tail, over, ..r }
    }

    /// One more bit of the quotient, which follows what is left of the numerator's.
    #[inline(always)]
    fn step<V: Value>(&self, r: Registers<Signal<V>>, rest: Signal<V>, shifted: Signal<V>) -> Registers<Signal<V>> {
        let fits = (!rest.msb()).named("fits");
        Registers {
            count: self.count(&r),
            remainder: fits.select(rest, shifted).fit(r.remainder.format, Exact, Lemma(BELOW)),
            tail: r.tail.concat(fits).bits(0, self.quotient.width),
            ..r
        }
    }

    /// Whether the quotient is rounded up: twice the remainder is past the denominator, or just there and the quotient odd.
    #[inline(always)]
    fn round<V: Value>(&self, r: Registers<Signal<V>>, rest: Signal<V>) -> Registers<Signal<V>> {
        let up = !rest.msb() & (!rest.is(0) | r.tail.bits(0, 1));
        Registers { count: self.count(&r), up, ..r }
    }

    /// The rounded quotient.
    #[inline(always)]
    fn finish<V: Value>(&self, r: Registers<Signal<V>>, i: Inputs<Signal<V>>) -> Registers<Signal<V>> {
        let (rounded, over) = (r.tail + r.up).saturate(self.quotient.integer(), Exact);
        let most = code(self.quotient.max_code() as i64, self.quotient.integer());
        let saturated = over | r.over;
        let quotient = r.over.select(most, rounded).scaled(-self.quotient.frac);
        let quotient = quotient.ideally(&[i.numerator, i.denominator], |of| of[0] / of[1]);
        Registers { busy: bit(false), done: bit(true), quotient, saturated, ..r }
    }
}

impl Divider {
    /// A clock of a division.
    #[inline(always)]
    fn work<V: Value>(
        &self,
        r: Registers<Signal<V>>,
        i: Inputs<Signal<V>>,
        rest: Signal<V>,
        shifted: Signal<V>,
    ) -> Registers<Signal<V>> {
        let at = |count: u64| r.count.is(count);
        let width = u64::from(self.quotient.width);
        when!(
            V,
            Registers,
            at(0) => self.check(r, i),
            at(width + 1) => self.round(r, rest),
            at(width + 2) => self.finish(r, i),
            else self.step(r, rest, shifted)
        )
    }
}

impl Block for Divider {
    const NAME: &'static str = "divider";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = ();

    #[inline]
    fn inputs(&self) -> Inputs<Format> {
        Inputs { start: BIT, numerator: self.numerator, denominator: self.denominator }
    }

    #[inline]
    fn outputs(&self) -> Outputs<Format> {
        Outputs { done: BIT, quotient: self.quotient, saturated: BIT }
    }

    #[inline(always)]
    fn registers(&self) -> Registers<Format> {
        let r = self.registers;
        Registers {
            busy: BIT,
            done: BIT,
            saturated: BIT,
            over: BIT,
            up: BIT,
            count: r.count.counting(),
            tail: r.tail.counting(),
            remainder: r.remainder.counting(),
            ..r
        }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let outputs = Outputs { done: r.done, quotient: r.quotient, saturated: r.saturated };
        if (i.start | r.busy | r.done).idle() {
            return outputs;
        }
        let width = u64::from(self.quotient.width);
        let idle = Registers { done: bit(false), ..r };
        // One subtractor serves every step; the last looks at twice the remainder.
        let shifted = r.remainder.concat(r.tail.msb() & !r.count.is(width + 1)).named("shifted");
        let rest = (shifted - i.denominator.integer()).named("rest");
        next!(
            V,
            Registers,
            self,
            cell,
            i.start => self.begin(idle, i),
            r.busy => self.work(idle, i, rest, shifted),
            else idle
        );
        outputs
    }
}
