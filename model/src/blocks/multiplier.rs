// SPDX-License-Identifier: MIT OR Apache-2.0
//! Multiplier: the product of two codes, in as many clocks as the part's hardware multipliers need.
//!
//! ```text
//! left ─┬─(×)─────────────────────────────────[product]           where both fit one hardware multiplier
//!       └─halves─(× each of right's halves)─[partial products]─(Σ)─[product]      elsewhere
//! ```
//!
//! A product wider than a hardware multiplier takes several of them and an adder tree. In one clock
//! that is the slowest path of the core (ECP5, 26 × 26 bits: 14 ns), so that the partial products
//! have registers. Operands are codes as integers and follow one another clock by clock. Its
//! registers have no reset, as those within hardware multipliers have none.
//!
//! | signal   | overflow             |
//! | partials | cannot: exact        |
//! | product  | cannot (range proof) |
//!
//! Latency: 1 clock, or 2 where an operand is halved.

use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::{Floor, Proved, Signal, bit, int};
use hapticore_hdl::{block, next};

block! {
    /// A multiplier of codes as integers, in one clock or two.
    pub struct Multiplier("multiplier", reset: false) {
        left: Format,
        right: Format,
        /// Of each operand: its low bits, which are multiplied apart; none where it fits.
        low: [u8; 2],
    }
    submodules {}
    inputs(multiplier) {
        /// Asserted while a product is multiplier_busy for.
        enable: BIT,
        /// Left operand, a code as an integer.
        left: multiplier.left,
        /// Right operand, a code as an integer.
        right: multiplier.right,
    }
    outputs(multiplier) {
        product: multiplier.product(),
    }
    registers(multiplier) {
        high_high: multiplier.high(0).product(multiplier.high(1)),
        high_low: multiplier.high(0).product(multiplier.low(1)),
        low_high: multiplier.low(0).product(multiplier.high(1)),
        low_low: multiplier.low(0).product(multiplier.low(1)),
        product: multiplier.product(),
    }
}

impl Multiplier {
    /// A multiplier of two integer formats on a part whose hardware multipliers take words of
    /// `hardware` bits, both signed or both unsigned.
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
        Multiplier { left, right, low }
    }

    /// The format of the upper part of an operand: a multiple of `2^low`.
    #[inline(always)]
    fn high(&self, operand: usize) -> Format {
        let (format, low) = ([self.left, self.right][operand], self.low[operand]);
        Format { width: format.width - low, frac: -(low as i8), ..format }
    }

    /// The format of the low bits of an operand.
    #[inline(always)]
    fn low(&self, operand: usize) -> Format {
        Format::unsigned(self.low[operand].max(1), 0)
    }

    /// Clocks from operands to their product.
    pub fn latency(&self) -> u64 {
        if self.low == [0, 0] { 1 } else { 2 }
    }

    /// Whether a step that lasts as long as a product ends with this clock; `multiplier_busy` says
    /// that one has gone by.
    #[inline(always)]
    pub fn ready<V: Interpretation>(&self, multiplier_busy: Signal<V>) -> Signal<V> {
        if self.latency() == 1 { bit(true) } else { multiplier_busy }
    }

    /// The format of the product.
    #[inline(always)]
    pub fn product(&self) -> Format {
        self.left.product(self.right).assume_frac(0)
    }

    /// An operand as a multiple of `2^low` and the remainder: where numbers are not rounded, what
    /// the multiple leaves of it.
    #[inline(always)]
    fn halves<V: Interpretation>(operand: Signal<V>, low: u8) -> (Signal<V>, Signal<V>) {
        let Format { signed, width, .. } = operand.format;
        let high = operand.quantize(
            Format { signed, width: width - low, frac: -(low as i8) },
            Floor,
            Proved,
        );
        let rest = operand
            .bits(0, low)
            .golden(&[operand, high, int(1 << low)], |of| of[0] - of[1] / of[2] * of[2]);
        (high, rest)
    }

    /// The partial products of the operands.
    #[inline(always)]
    fn partials<V: Interpretation>(&self, i: In<V>, r: Regs<V>) -> Regs<V> {
        let split = |operand: Signal<V>, low: u8| match low {
            0 => (operand, None),
            _ => {
                let (high, rest) = Self::halves(operand, low);
                (high, Some(rest))
            }
        };
        let ((left, left_low), (right, right_low)) =
            (split(i.left, self.low[0]), split(i.right, self.low[1]));
        Registers {
            high_high: left * right,
            high_low: right_low.map_or(r.high_low, |low| left * low),
            low_high: left_low.map_or(r.low_high, |low| low * right),
            low_low: match (left_low, right_low) {
                (Some(left), Some(right)) => left * right,
                _ => r.low_low,
            },
            ..r
        }
    }

    /// Sum of the partial products, aligned.
    #[inline(always)]
    fn sum<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        let whole = |sum: Signal<V>| sum.resize(self.product(), Proved);
        match self.low {
            [0, _] => whole(r.high_high + r.high_low),
            [_, 0] => whole(r.high_high + r.low_high),
            _ => whole(whole(r.high_high + r.low_low) + (r.high_low + r.low_high)),
        }
    }
}

impl Block for Multiplier {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let outputs = Outputs { product: r.product };
        if i.enable.can_skip() {
            return outputs;
        }
        if self.latency() == 1 {
            next!(self, state, i.enable => Registers { product: i.left * i.right, ..r }, else r);
        } else {
            let next = Registers { product: self.sum(&r), ..self.partials(i, r) };
            next!(self, state, i.enable => next, else r);
        }
        outputs
    }
}

#[cfg(test)]
mod tests;
