// SPDX-License-Identifier: MIT OR Apache-2.0
//! Multiplier: the product of two codes, in as many clocks as the part's hardware multipliers need.
//!
//! ```text
//! left ─┬─(×)─────────────────────────────────[product]           where both fit one hardware multiplier
//!       └─halves─(× each of right's halves)─[partial products]─(Σ)─[product]      elsewhere
//! ```
//!
//! A product wider than a hardware multiplier takes several of them and an adder tree; in one clock that is the slowest path
//! of the core (ECP5, 26 × 26 bits: 14 ns), so that the partial products have registers. Operands are codes as integers and
//! follow one another clock by clock. Its registers have no reset, as those within hardware multipliers have none.
//!
//! | signal   | overflow             |
//! | partials | cannot: exact        |
//! | product  | cannot (range proof) |
//!
//! Latency: 1 clock, or 2 where an operand is halved.

use crate::block::{Block, Cell};
use crate::format::{BIT, Format};
use crate::signal::{Exact, Floor, Never, Signal, Value, bit, int};
use crate::{bundle, next};

bundle! {
    /// The inputs.
    pub struct Inputs {
        /// Set while somebody waits for a product.
        enable,
        /// A code as an integer.
        left,
        /// A code as an integer.
        right,
    }
}

bundle! {
    /// The output: a register.
    pub struct Outputs {
        /// The product.
        product,
    }
}

bundle! {
    /// The registers.
    pub struct Registers {
        high_high, high_low, low_high, low_low, product,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct Multiplier {
    left: Format,
    right: Format,
    /// Of each operand: its low bits, which are multiplied apart; none where it fits.
    low: [u8; 2],
    registers: Registers<Format>,
}

impl Multiplier {
    /// A multiplier of two integer formats on a part whose hardware multipliers take words of `hardware` bits, both signed or
    /// both unsigned.
    ///
    /// # Panics
    /// Where a format is no integer's.
    pub fn new(left: Format, right: Format, hardware: u8) -> Self {
        assert!(left.frac == 0 && right.frac == 0, "{left} × {right} is of codes as integers");
        let any_signed = left.signed || right.signed;
        let low = [left, right].map(|operand| {
            let width = operand.width + u8::from(any_signed && !operand.signed);
            if width > hardware { operand.width / 2 } else { 0 }
        });
        let high = |operand: Format, low: u8| Format { width: operand.width - low, frac: -(low as i8), ..operand };
        let (left_high, right_high) = (high(left, low[0]), high(right, low[1]));
        let [left_low, right_low] = low.map(|bits| Format::unsigned(bits.max(1), 0));
        let registers = Registers {
            high_high: left_high.product(right_high),
            high_low: left_high.product(right_low),
            low_high: left_low.product(right_high),
            low_low: left_low.product(right_low),
            product: left.product(right),
        };
        Multiplier { left, right, low, registers }
    }

    /// Clocks from operands to their product.
    pub fn latency(&self) -> u64 {
        if self.low == [0, 0] { 1 } else { 2 }
    }

    /// Whether a step that lasts as long as a product ends with this clock; `waited` says that one has gone by.
    #[inline(always)]
    pub fn paces<V: Value>(&self, waited: Signal<V>) -> Signal<V> {
        if self.latency() == 1 { bit(true) } else { waited }
    }

    /// The format of the product.
    pub fn product(&self) -> Format {
        self.registers.product
    }

    /// An operand as a multiple of `2^low` and the rest: where numbers are not rounded, what the multiple leaves of it.
    #[inline(always)]
    fn halves<V: Value>(operand: Signal<V>, low: u8) -> (Signal<V>, Signal<V>) {
        let Format { signed, width, .. } = operand.format;
        let high = operand.fit(Format { signed, width: width - low, frac: -(low as i8) }, Floor, Never);
        let rest = operand.bits(0, low).ideally(&[operand, high, int(1 << low)], |of| of[0] - of[1] / of[2] * of[2]);
        (high, rest)
    }

    /// The partial products of the operands.
    #[inline(always)]
    fn partials<V: Value>(&self, i: Inputs<Signal<V>>, r: Registers<Signal<V>>) -> Registers<Signal<V>> {
        let split = |operand: Signal<V>, low: u8| match low {
            0 => (operand, None),
            _ => {
                let (high, rest) = Self::halves(operand, low);
                (high, Some(rest))
            }
        };
        let ((left, left_low), (right, right_low)) = (split(i.left, self.low[0]), split(i.right, self.low[1]));
        Registers {
            high_high: left * right,
            high_low: right_low.map_or(r.high_low, |low| left * low),
            low_high: left_low.map_or(r.low_high, |low| low * right),
            low_low: left_low.zip(right_low).map_or(r.low_low, |(a, b)| a * b),
            ..r
        }
    }

    /// Their sum.
    #[inline(always)]
    fn sum<V: Value>(&self, r: &Registers<Signal<V>>) -> Signal<V> {
        let whole = |sum: Signal<V>| sum.fit(self.registers.product, Exact, Never);
        match self.low {
            [0, _] => whole(r.high_high + r.high_low),
            [_, 0] => whole(r.high_high + r.low_high),
            _ => whole(whole(r.high_high + r.low_low) + (r.high_low + r.low_high)),
        }
    }
}

impl Block for Multiplier {
    const NAME: &'static str = "multiplier";
    const RESETS: bool = false;
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = ();

    #[inline]
    fn inputs(&self) -> Inputs<Format> {
        Inputs { enable: BIT, left: self.left, right: self.right }
    }

    #[inline]
    fn outputs(&self) -> Outputs<Format> {
        Outputs { product: self.registers.product }
    }

    #[inline(always)]
    fn registers(&self) -> Registers<Format> {
        let Registers { high_high, high_low, low_high, low_low, product } = self.registers;
        let [left, right] = self.low.map(|bits| bits as i8);
        Registers {
            high_high: high_high.with_point(-left - right),
            high_low: high_low.with_point(-left),
            low_high: low_high.with_point(-right),
            low_low: low_low.with_point(0),
            product: product.with_point(0),
        }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let outputs = Outputs { product: r.product };
        if i.enable.idle() {
            return outputs;
        }
        if self.latency() == 1 {
            next!(V, Registers, self, cell, i.enable => Registers { product: i.left * i.right, ..r }, else r);
        } else {
            let next = Registers { product: self.sum(&r), ..self.partials(i, r) };
            next!(V, Registers, self, cell, i.enable => next, else r);
        }
        outputs
    }
}
