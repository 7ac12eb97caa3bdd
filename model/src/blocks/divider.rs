// SPDX-License-Identifier: MIT OR Apache-2.0
//! Serial divider: the quotient of two unsigned numbers, correctly rounded.
//!
//! ```text
//! quotient = numerator / denominator, to the nearest code, ties to even
//! ```
//!
//! ```text
//! numerator ──[remainder : tail]──(− denominator ≥ 0 ?)── one quotient bit per clock ──[tail]──[round half even, saturate]── quotient
//! ```
//!
//! | signal    | overflow                                                                 |
//! | quotient  | saturates, and says so                                                   |
//! | remainder | cannot: it stays below the denominator (assumed; proved by a solver)     |
//!
//! A zero denominator gives a saturated quotient; the caller says what that means. Latency:
//! quotient width + 4 clocks from `start` to `done`. Source: restoring division, Parhami, Computer
//! Arithmetic, §13.

use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::claims::{Claims, Held};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::{Assumed, Exact, Proved, Signal, bit, code, int};
use hapticore_hdl::{block, next, when};

block! {
    /// A divider that gives a bit of the quotient in each clock.
    pub struct Divider("divider") {
        numerator: Format,
        denominator: Format,
        quotient: Format,
        /// The numerator with zeros behind it, so that the integer quotient has the quotient's point.
        pub(super) dividend: Format,
        /// Bits of the remainder.
        head: u8,
        /// For interpretations as codes, which need not step its clocks one by one.
        hurried: bool,
    }
    submodules {}
    inputs(divider) {
        /// Begins; the operands are valid and stable until `done`.
        start: BIT,
        /// The dividend.
        numerator: divider.numerator,
        /// The divisor.
        denominator: divider.denominator,
    }
    outputs(divider) {
        /// Asserted for one cycle when the quotient is valid.
        done: BIT,
        /// The quotient, stable until the next `done`.
        quotient: divider.quotient,
        /// The quotient is saturated.
        saturated: BIT,
    }
    registers(divider) {
        busy: BIT,
        count: Format::counter(u64::from(divider.quotient.width) + 2),
        remainder: Format::unsigned(divider.head, 0),
        tail: Format::unsigned(divider.quotient.width, 0),
        over: BIT,
        up: BIT,
        done: BIT,
        quotient: divider.quotient,
        saturated: BIT,
    }
}

const BELOW: &str = "the remainder of a division stays below its denominator";
const NOTHING: &str = "nothing is divided where the quotient would be too large";

impl Divider {
    /// A divider for these unsigned formats.
    ///
    /// # Panics
    /// Where the quotient has fewer fractional bits than the numerator has beyond the
    /// denominator's.
    pub fn new(numerator: Format, denominator: Format, quotient: Format) -> Self {
        assert!(
            !(numerator.signed || denominator.signed || quotient.signed),
            "a divider is unsigned"
        );
        let pad = quotient.frac - numerator.frac + denominator.frac;
        assert!(pad >= 0, "{numerator} / {denominator} has more fractional bits than {quotient}");
        let width = (numerator.width + pad as u8).max(quotient.width + 1);
        let dividend = Format::unsigned(width, numerator.frac + pad);
        let head = (width - quotient.width).max(denominator.width);
        Divider { numerator, denominator, quotient, dividend, head, hurried: false }
    }

    /// From now on interpretations that know every bit have their results in the clock after `start`:
    /// operands are stable until then.
    pub(crate) fn hurry(&mut self) {
        self.hurried = true;
    }

    /// The clocks that follow the first, one after the other.
    #[inline(never)]
    fn run_on<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) {
        let held = Inputs { start: bit(false), ..i };
        while V::known_bit(state.registers.done) != Some(true) {
            self.cycle(state, held);
        }
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        u64::from(self.quotient.width) + 4
    }

    /// The registers when a division begins: the dividend's high bits are the first remainder.
    #[inline(always)]
    fn begin<V: Interpretation>(&self, r: Regs<V>, i: In<V>) -> Regs<V> {
        let numerator = i.numerator.resize(self.dividend, Proved);
        let width = self.quotient.width;
        let (remainder, tail) =
            (numerator.bits(width, self.dividend.width - width), numerator.bits(0, width));
        Registers { busy: bit(true), count: int(0), remainder, tail, ..r }
    }

    /// If the high bits already reach the denominator, the quotient does not fit: it is known
    /// already, and zeros keep the remainder below even so.
    #[inline(always)]
    fn check<V: Interpretation>(&self, r: Regs<V>, i: In<V>) -> Regs<V> {
        let over = r.remainder.at_least(i.denominator.integer()).named("too_large");
        let (remainder, tail) = (over.select(int(0), r.remainder), over.select(int(0), r.tail));
        Registers { count: r.count.increment(), remainder, tail, over, ..r }
    }

    /// One more bit of the quotient, which follows what is left of the numerator's.
    #[inline(always)]
    fn step<V: Interpretation>(&self, r: Regs<V>, rest: Signal<V>, shifted: Signal<V>) -> Regs<V> {
        let fits = (!rest.msb()).named("fits");
        Registers {
            count: r.count.increment(),
            remainder: fits.select(rest, shifted).resize(r.remainder.format, Assumed(BELOW)),
            tail: r.tail.concat(fits).bits(0, self.quotient.width),
            ..r
        }
    }

    /// Whether the quotient is rounded up: twice the remainder is past the denominator, or just
    /// there and the quotient odd.
    #[inline(always)]
    fn round<V: Interpretation>(&self, r: Regs<V>, rest: Signal<V>) -> Regs<V> {
        let up = !rest.msb() & (!rest.is(0) | r.tail.bits(0, 1));
        Registers { count: r.count.increment(), up, ..r }
    }

    /// The rounded quotient.
    #[inline(always)]
    fn finish<V: Interpretation>(&self, r: Regs<V>, i: In<V>) -> Regs<V> {
        let (rounded, over) = (r.tail + r.up).saturate(self.quotient.integer(), Exact);
        let most = code(self.quotient.max_code() as i64, self.quotient.integer());
        let saturated = over | r.over;
        let quotient = r.over.select(most, rounded).scaled(-self.quotient.frac);
        let quotient = quotient.golden(&[i.numerator, i.denominator], |of| of[0] / of[1]);
        Registers { busy: bit(false), done: bit(true), quotient, saturated, ..r }
    }

    /// A cycle of a division.
    #[inline(always)]
    fn work<V: Interpretation>(
        &self,
        r: Regs<V>,
        i: In<V>,
        rest: Signal<V>,
        shifted: Signal<V>,
    ) -> Regs<V> {
        let at = |count: u64| r.count.is(count);
        let width = u64::from(self.quotient.width);
        when!(at(0) => self.check(r, i),
            at(width + 1) => self.round(r, rest),
            at(width + 2) => self.finish(r, i),
            else self.step(r, rest, shifted)
        )
    }
}

impl Block for Divider {
    fn claims<V: Interpretation>(&self, r: Regs<V>, i: In<V>) -> Claims<V> {
        let width = u64::from(self.quotient.width);
        let begun = r.busy & !r.count.is(0);
        let below = r.remainder.less_than(i.denominator.integer());
        Claims {
            invariants: vec![
                ("a division takes as many clocks", !r.busy | r.count.less_than(int(width + 3))),
                (BELOW, !begun | i.start | r.over | below),
                (NOTHING, !(begun & r.over) | (r.remainder.is(0) & self.only_digits(&r))),
            ],
            held: Some(Held { when: r.busy & !i.start, inputs: &["denominator"] }),
        }
    }

    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let outputs = self.cycle(state, i);
        if self.hurried && V::known_bit(i.start.value) == Some(true) {
            self.run_on(state, i);
        }
        outputs
    }
}

impl Divider {
    /// Whether nothing of the dividend is left above the digits so far.
    fn only_digits<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        let width = self.quotient.width;
        let above = |digits: u8| {
            let rest = r.tail.bits(digits, width - digits).is(0);
            !r.count.is(u64::from(digits) + 1) | rest
        };
        (0..width).map(above).reduce(|a, b| a & b).expect("a quotient has bits")
    }

    #[inline(always)]
    fn cycle<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let outputs = Outputs { done: r.done, quotient: r.quotient, saturated: r.saturated };
        if (i.start | r.busy | r.done).can_skip() {
            return outputs;
        }
        let width = u64::from(self.quotient.width);
        let idle = Registers { done: bit(false), ..r };
        // One subtractor serves every step; the last compares twice the remainder.
        let shifted = r.remainder.concat(r.tail.msb() & !r.count.is(width + 1)).named("shifted");
        let rest = (shifted - i.denominator.integer()).named("rest");
        next!(self, state,
            i.start => self.begin(idle, i),
            r.busy => self.work(idle, i, rest, shifted),
            else idle
        );
        outputs
    }
}

#[cfg(test)]
mod tests;
