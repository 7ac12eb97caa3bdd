// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ratios of the currents, one after the other through one divider.
//!
//! ```text
//! r_x = x / corners,   r_y = y / corners,   share = least / corners        (paper, eqs. 2 and 3)
//! ```
//!
//! ```text
//! x, y ─[magnitude]─┬─[divider, round half even]─┬─(±)─ r_x, r_y
//! least ────────────┘                            └───── share
//! ```
//!
//! | signal          | format  | unit | overflow                                      |
//! | r_x, r_y, share | profile | –    | cannot: a numerator is at most its denominator |
//!
//! A zero denominator gives `invalid`. Latency: 3 · (divider + 1) + 1 clocks from `start` to `done`.

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
        /// The least amplitude of the terminals.
        least,
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
        /// The least of the terminals' currents, as a share of the denominator; until the next slot's `start`.
        share,
        /// Whether the denominator is zero.
        invalid,
    }
}

bundle! {
    /// The registers.
    pub struct Registers {
        step: ["idle", "x", "y", "share"],
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
    least: Format,
    registers: Registers<Format>,
}

impl Ratio {
    /// The ratios of a profile; `sums` are the formats of the numerators and of the denominator, `least` that of an amplitude.
    pub fn new(profile: &Profile, (sums, corners): (Format, Format), least: Format) -> Self {
        let ratio = profile.formats.ratio;
        let quotient = Format::unsigned(ratio.width - 1, ratio.frac);
        let divider = Divider::new(Format { signed: false, ..sums }, corners, quotient);
        let step = Format::unsigned(2, 0);
        let registers = Registers { step, divide: BIT, r_x: ratio, r_y: ratio, invalid: BIT, done: BIT };
        Ratio { divider, sums, corners, least, registers }
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        3 * (self.divider.latency() + 1) + 1
    }

    #[inline(always)]
    fn step<V: Value>(
        &self,
        r: Registers<Signal<V>>,
        i: Inputs<Signal<V>>,
        divided: divider::Outputs<Signal<V>>,
    ) -> Registers<Signal<V>> {
        let [first, second, third] = [1, 2, 3].map(|step| divided.done & r.step.is(step));
        let numerator = r.step.is(1).select(i.x, i.y).named("numerator");
        let negative = numerator.less_than(int(0));
        let ratio = negative.select(-divided.quotient, divided.quotient).fit(r.r_x.format, Exact, Never);
        Registers {
            step: first.select(int(2), second.select(int(3), third.select(int(0), r.step))),
            divide: first | second,
            // That of x comes first, and moves on: one value, one register that takes it.
            r_x: second.select(r.r_y, r.r_x),
            r_y: (first | second).select(ratio, r.r_y),
            invalid: second.select(i.corners.is(0), r.invalid),
            done: third,
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
        Inputs { start: BIT, x: self.sums, y: self.sums, corners: self.corners, least: self.least }
    }

    #[inline]
    fn outputs(&self) -> Outputs<Format> {
        let Registers { r_x, r_y, .. } = self.registers;
        Outputs { done: BIT, r_x, r_y, share: self.divider.outputs().quotient, invalid: BIT }
    }

    #[inline(always)]
    fn registers(&self) -> Registers<Format> {
        let r = self.registers;
        Registers { done: BIT, divide: BIT, invalid: BIT, step: r.step.counting(), ..r }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let numerator = r.step.is(1).select(i.x, i.y).abs();
        let numerator = r.step.is(3).select(i.least.fit(numerator.format, Exact, Never), numerator);
        let inputs = divider::Inputs { start: r.divide, numerator, denominator: i.corners };
        // The last quotient, the share, stays until the next slot's first.
        let divided = self.divider.call("divider", &mut cell.parts.divider, inputs);
        let outputs = Outputs { done: r.done, r_x: r.r_x, r_y: r.r_y, share: divided.quotient, invalid: r.invalid };
        if (i.start | !r.step.is(0) | r.done).idle() {
            return outputs;
        }
        let begin = Registers { step: int(1), divide: bit(true), done: bit(false), ..r };
        next!(V, Registers, self, cell, i.start => begin, else self.step(r, i, divided));
        outputs
    }
}
