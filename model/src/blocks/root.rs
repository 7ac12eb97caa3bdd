// SPDX-License-Identifier: MIT OR Apache-2.0
//! Serial square root, correctly rounded.
//!
//! ```text
//! root = √radicand, to the nearest code; a tie cannot be, since (n + ½)² is no integer
//! ```
//!
//! ```text
//! radicand ──[tail]─2 bits a clock─[remainder]──(− (4·partial + 1) ≥ 0 ?)── one root bit a clock ──[+ ½]── root
//! ```
//!
//! | signal    | overflow                                                                   |
//! | root      | cannot: it has half the radicand's integer bits, and one more              |
//! | remainder | cannot: it is at most twice the partial root (lemma, held by an exhaustive test) |
//!
//! Latency: half the radicand's width + 2 clocks from `start` to `done`. Source: digit-by-digit root, Parhami, Computer
//! Arithmetic, §21.

use crate::block::{Block, Cell};
use crate::format::{BIT, Format};
use crate::signal::{Exact, Lemma, Never, Signal, Value, Wrap, bit, int};
use crate::{bundle, next, when};

bundle! {
    /// The inputs.
    pub struct Inputs {
        /// Takes the radicand and begins.
        start,
        /// The number whose root is taken.
        radicand,
    }
}

bundle! {
    /// The outputs.
    pub struct Outputs {
        /// Set for one clock when the root is there.
        done,
        /// The root, held until the next is there.
        root,
    }
}

bundle! {
    /// The registers.
    pub struct Registers {
        busy, count, radicand, tail, remainder, partial, done, root,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct Root {
    radicand: Format,
    /// Bits of the root before rounding.
    digits: u8,
    /// The radicand, widened to two bits a digit.
    padded: Format,
    registers: Registers<Format>,
}

const BELOW: &str = "the remainder of a root is at most twice the root so far";

impl Root {
    /// A root with `frac` fractional bits of an unsigned format.
    ///
    /// # Panics
    /// Where the radicand has more than twice as many fractional bits.
    pub fn new(radicand: Format, frac: i8) -> Self {
        assert!(!radicand.signed && radicand.frac <= 2 * frac, "√{radicand} has more fractional bits than {frac}");
        let digits = ((radicand.integer_bits() + 1) / 2 + i16::from(frac)) as u8;
        let padded = Format::unsigned(2 * digits, 2 * frac);
        let registers = Registers {
            busy: BIT,
            count: Format::counter(digits.into()),
            radicand: padded,
            tail: Format::unsigned(2 * digits, 0),
            remainder: Format::unsigned(digits + 1, 0),
            partial: Format::unsigned(digits, 0),
            done: BIT,
            root: Format::unsigned(digits + 1, frac),
        };
        Root { radicand, digits, padded, registers }
    }

    /// The format of the root.
    #[inline]
    pub fn root(&self) -> Format {
        self.registers.root
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        u64::from(self.digits) + 2
    }

    #[inline(always)]
    fn begin<V: Value>(&self, r: Registers<Signal<V>>, i: Inputs<Signal<V>>) -> Registers<Signal<V>> {
        let radicand = i.radicand.fit(self.padded, Exact, Never);
        let tail = radicand.bits(0, self.padded.width);
        Registers { busy: bit(true), count: int(0), radicand, tail, remainder: int(0), partial: int(0), ..r }
    }

    /// One more digit: with root n so far, the next is set where 4n + 1 still goes into the remainder.
    #[inline(always)]
    fn step<V: Value>(&self, r: Registers<Signal<V>>) -> Registers<Signal<V>> {
        let width = self.padded.width;
        let shifted = r.remainder.concat(r.tail.bits(width - 2, 2)).named("shifted");
        let trial = r.partial.concat(bit(false)).concat(bit(true));
        let rest = (shifted - trial).named("rest");
        let fits = (!rest.msb()).named("fits");
        Registers {
            count: (r.count + int(1)).fit(r.count.format, Exact, Wrap),
            tail: r.tail.concat(int::<V>(0)).concat(int(0)).bits(0, width),
            remainder: fits.select(rest, shifted).fit(r.remainder.format, Exact, Lemma(BELOW)),
            partial: r.partial.concat(fits).bits(0, self.digits),
            ..r
        }
    }

    /// The rounded root: up where the remainder is past n, for (n + ½)² = n² + n + ¼.
    #[inline(always)]
    fn finish<V: Value>(&self, r: Registers<Signal<V>>) -> Registers<Signal<V>> {
        let rounded = r.partial + r.partial.less_than(r.remainder);
        let root = rounded.scaled(-self.root().frac).ideally(&[r.radicand], |of| of[0].sqrt());
        Registers { busy: bit(false), done: bit(true), root, ..r }
    }
}

impl Block for Root {
    const NAME: &'static str = "root";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = ();

    #[inline]
    fn inputs(&self) -> Inputs<Format> {
        Inputs { start: BIT, radicand: self.radicand }
    }

    #[inline]
    fn outputs(&self) -> Outputs<Format> {
        Outputs { done: BIT, root: self.root() }
    }

    #[inline(always)]
    fn registers(&self) -> Registers<Format> {
        let r = self.registers;
        Registers {
            busy: BIT,
            done: BIT,
            count: r.count.counting(),
            tail: r.tail.counting(),
            partial: r.partial.counting(),
            remainder: r.remainder.counting(),
            radicand: self.padded,
            root: r.root,
        }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let outputs = Outputs { done: r.done, root: r.root };
        if (i.start | r.busy | r.done).idle() {
            return outputs;
        }
        let last = r.count.is(self.digits.into());
        let idle = Registers { done: bit(false), ..r };
        next!(
            V,
            Registers,
            self,
            cell,
            i.start => self.begin(idle, i),
            r.busy => when!(V, Registers, last, self.finish(idle), self.step(idle)),
            else idle
        );
        outputs
    }
}
