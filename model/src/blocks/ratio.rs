// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ratios of the currents, one after the other through one divider.
//!
//! ```text
//! r_x = x / corners,   r_y = y / corners        (paper, eqs. 2 and 3)
//! ```
//!
//! ```text
//! x, y ─[magnitude]─[divider, round half even]─(±)─ r_x, r_y
//! ```
//!
//! | signal   | format  | unit | overflow                                             |
//! | r_x, r_y | profile | –    | cannot: a numerator is at most its denominator        |
//!
//! A zero denominator gives `invalid`. Latency: 2 · (divider + 1) + 1 clocks from `start` to `done`.

use super::divider::{self, Divider};
use crate::block::{Block, Cell};
use crate::format::{BIT, Format};
use crate::profile::Profile;
use crate::signal::{Exact, Never, Signal, Value, bit, int};
use crate::{bundle, next, parts};

bundle! {
    /// The inputs.
    pub struct Inputs {
        /// The sums are there, and hold.
        start,
        /// The numerator of r_x.
        x,
        /// The numerator of r_y.
        y,
        /// Their denominator.
        corners,
    }
}

bundle! {
    /// The outputs: registers.
    pub struct Outputs {
        /// Set for one clock when the ratios are there.
        done,
        /// The x ratio.
        r_x,
        /// The y ratio.
        r_y,
        /// Whether the denominator is zero.
        invalid,
    }
}

bundle! {
    /// The registers.
    pub struct Registers {
        step: ["idle", "x", "y"],
        divide, r_x, r_y, invalid, done,
    }
}

parts! {
    /// The block within.
    pub struct Parts of Ratio {
        divider: Divider,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct Ratio {
    divider: Divider,
    sums: Format,
    corners: Format,
    registers: Registers<Format>,
}

impl Ratio {
    /// The ratios of a profile; `sums` are the formats of the numerators and of the denominator.
    pub fn new(profile: &Profile, (sums, corners): (Format, Format)) -> Self {
        let ratio = profile.formats.ratio;
        let quotient = Format::unsigned(ratio.width - 1, ratio.frac);
        let divider = Divider::new(Format { signed: false, ..sums }, corners, quotient);
        let step = Format::unsigned(2, 0);
        let registers = Registers { step, divide: BIT, r_x: ratio, r_y: ratio, invalid: BIT, done: BIT };
        Ratio { divider, sums, corners, registers }
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        2 * (self.divider.latency() + 1) + 1
    }

    #[inline(always)]
    fn step<V: Value>(
        &self,
        r: Registers<Signal<V>>,
        i: Inputs<Signal<V>>,
        divided: divider::Outputs<Signal<V>>,
    ) -> Registers<Signal<V>> {
        let (first, second) = (divided.done & r.step.is(1), divided.done & r.step.is(2));
        let numerator = r.step.is(1).select(i.x, i.y).named("numerator");
        let negative = numerator.less_than(int(0));
        let ratio = negative.select(-divided.quotient, divided.quotient).fit(r.r_x.format, Exact, Never);
        Registers {
            step: first.select(int(2), second.select(int(0), r.step)),
            divide: first,
            // That of x comes first, and moves on: one value, one register that takes it.
            r_x: second.select(r.r_y, r.r_x),
            r_y: divided.done.select(ratio, r.r_y),
            invalid: second.select(i.corners.is(0), r.invalid),
            done: second,
        }
    }
}

impl Block for Ratio {
    const NAME: &'static str = "ratio";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = Parts<V>;

    #[inline]
    fn inputs(&self) -> Inputs<Format> {
        Inputs { start: BIT, x: self.sums, y: self.sums, corners: self.corners }
    }

    #[inline]
    fn outputs(&self) -> Outputs<Format> {
        let Registers { r_x, r_y, .. } = self.registers;
        Outputs { done: BIT, r_x, r_y, invalid: BIT }
    }

    #[inline(always)]
    fn registers(&self) -> Registers<Format> {
        let r = self.registers;
        Registers { done: BIT, divide: BIT, invalid: BIT, step: r.step.counting(), ..r }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let outputs = Outputs { done: r.done, r_x: r.r_x, r_y: r.r_y, invalid: r.invalid };
        if (i.start | !r.step.is(0) | r.done).idle() {
            return outputs;
        }
        let numerator = r.step.is(1).select(i.x, i.y).abs();
        let inputs = divider::Inputs { start: r.divide, numerator, denominator: i.corners };
        let divided = self.divider.call("divider", &mut cell.parts.divider, inputs);
        let begin = Registers { step: int(1), divide: bit(true), done: bit(false), ..r };
        next!(V, Registers, self, cell, i.start => begin, else self.step(r, i, divided));
        outputs
    }
}
