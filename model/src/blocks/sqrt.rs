// SPDX-License-Identifier: MIT OR Apache-2.0
//! Serial square root, correctly rounded.
//!
//! ```text
//! sqrt = √radicand, to the nearest code; a tie cannot be, since (n + ½)² is no integer
//! ```
//!
//! ```text
//! radicand ──[tail]─2 bits per cycle─[remainder]──(− (4·partial + 1) ≥ 0 ?)── one bit per cycle ──[+ ½]── sqrt
//! ```
//!
//! | signal    | overflow                                                                   |
//! | sqrt      | cannot: it has half the radicand's integer bits, and one more              |
//! | remainder | cannot: it is at most twice the partial root (assumed; proved by a solver)  |
//!
//! Latency: half the radicand's width + 2 clocks from `start` to `done`. Source: digit-by-digit
//! square root, Parhami, Computer Arithmetic, §21.

use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::claims::Claims;
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::{Assumed, Proved, Signal, bit, int};
use hapticore_hdl::{block, next, when};

block! {
    /// A square root.
    pub struct SquareRoot("sqrt") {
        radicand: Format,
        /// Bits of the square root before rounding.
        digits: u8,
        /// Fractional bits of the square root.
        frac: i8,
        /// For interpretations that need not step its clocks one by one.
        hurried: bool,
    }
    submodules {}
    inputs(block) {
        /// Starts a square root.
        start: BIT,
        radicand: block.radicand,
    }
    outputs(block) {
        /// Asserted for one cycle when the square root is valid.
        done: BIT,
        /// The square root, stable until the next `done`.
        sqrt: block.sqrt(),
    }
    registers(block) {
        busy: BIT,
        count: Format::counter(block.digits.into()),
        radicand: block.padded(),
        tail: Format::unsigned(2 * block.digits, 0),
        remainder: Format::unsigned(block.digits + 1, 0),
        partial: Format::unsigned(block.digits, 0),
        done: BIT,
        sqrt: block.sqrt(),
    }
}

const BELOW: &str = "the remainder of a square root is at most twice the root so far";

impl SquareRoot {
    /// A square root with `frac` fractional bits of an unsigned format.
    ///
    /// # Panics
    /// Where the radicand has more than twice as many fractional bits.
    pub fn new(radicand: Format, frac: i8) -> Self {
        assert!(
            !radicand.signed && radicand.frac <= 2 * frac,
            "√{radicand} has more fractional bits than {frac}"
        );
        let digits = ((radicand.integer_bits() + 1) / 2 + i16::from(frac)) as u8;
        SquareRoot { radicand, digits, frac, hurried: false }
    }

    /// The format of the square root.
    #[inline(always)]
    pub fn sqrt(&self) -> Format {
        Format::unsigned(self.digits + 1, self.frac)
    }

    /// The radicand, widened to two bits a digit.
    #[inline(always)]
    fn padded(&self) -> Format {
        Format::unsigned(2 * self.digits, 2 * self.frac)
    }

    /// From now on interpretations that know every bit have their results in the clock after `start`.
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

    /// The width of its widest word: what is left of the radicand, moved by a digit.
    pub fn widest(&self) -> u8 {
        self.padded().width + 2
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        u64::from(self.digits) + 2
    }

    #[inline(always)]
    fn begin<V: Interpretation>(&self, r: Regs<V>, i: In<V>) -> Regs<V> {
        let radicand = i.radicand.resize(self.padded(), Proved);
        let tail = radicand.bits(0, self.padded().width);
        Registers {
            busy: bit(true),
            count: int(0),
            radicand,
            tail,
            remainder: int(0),
            partial: int(0),
            ..r
        }
    }

    /// One more digit: with root n so far, the next is set where 4n + 1 still goes into the
    /// remainder.
    #[inline(always)]
    fn step<V: Interpretation>(&self, r: Regs<V>) -> Regs<V> {
        let width = self.padded().width;
        let shifted = r.remainder.concat(r.tail.bits(width - 2, 2)).named("shifted");
        let trial = r.partial.concat(bit(false)).concat(bit(true));
        let rest = (shifted - trial).named("rest");
        let fits = (!rest.msb()).named("fits");
        Registers {
            count: r.count.increment(),
            tail: r.tail.concat(int::<V>(0)).concat(int(0)).bits(0, width),
            remainder: fits.select(rest, shifted).resize(r.remainder.format, Assumed(BELOW)),
            partial: r.partial.concat(fits).bits(0, self.digits),
            ..r
        }
    }

    /// The rounded root: up where the remainder is past n, for (n + ½)² = n² + n + ¼.
    #[inline(always)]
    fn finish<V: Interpretation>(&self, r: Regs<V>) -> Regs<V> {
        let rounded = r.partial + r.partial.less_than(r.remainder);
        let sqrt = rounded.scaled(-self.sqrt().frac).golden(&[r.radicand], |of| of[0].sqrt());
        Registers { busy: bit(false), done: bit(true), sqrt, ..r }
    }
}

impl Block for SquareRoot {
    fn claims<V: Interpretation>(&self, r: Regs<V>, _inputs: In<V>) -> Claims<V> {
        let digits = u64::from(self.digits);
        let below = !r.partial.concat(bit(false)).less_than(r.remainder);
        Claims {
            invariants: vec![
                ("a root takes as many clocks", !r.busy | r.count.less_than(int(digits + 1))),
                (BELOW, !r.busy | below),
                ("a root has as many bits as digits so far", !r.busy | self.only_digits(&r)),
            ],
            held: None,
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

impl SquareRoot {
    /// Whether nothing is in the root above the digits so far.
    fn only_digits<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        let above = |digits: u8| {
            let rest = r.partial.bits(digits, self.digits - digits).is(0);
            !r.count.is(digits.into()) | rest
        };
        (0..self.digits).map(above).reduce(|a, b| a & b).expect("a root has digits")
    }

    #[inline(always)]
    fn cycle<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let outputs = Outputs { done: r.done, sqrt: r.sqrt };
        if (i.start | r.busy | r.done).can_skip() {
            return outputs;
        }
        let last = r.count.is(self.digits.into());
        let idle = Registers { done: bit(false), ..r };
        next!(self, state,
            i.start => self.begin(idle, i),
            r.busy => when!(last => self.finish(idle), else self.step(idle)),
            else idle
        );
        outputs
    }
}

#[cfg(test)]
mod tests;
