// SPDX-License-Identifier: MIT OR Apache-2.0
//! Force estimator: the haptic force from the capacitance and the haptic voltage.
//!
//! ```text
//! F = gain · C² · m        (paper, eq. 8: F_h = k (C′V_h)²; the gain holds k and the full scales)
//! ```
//!
//! ```text
//! C ─(²)─[round half even]─ square ─(× m)─[round half even]─ energy ─(× gain)─[round half even, saturate]─ force
//! ```
//!
//! | signal         | format  | unit | overflow           |
//! | square, energy | profile | pF²  | saturates, flagged |
//! | force          | profile | N    | saturates, flagged |
//!
//! One multiplier serves all three products, on codes as integers. Latency: 8 clocks from `start` to `done`.

use crate::block::{Block, Cell};
use crate::format::{BIT, Format};
use crate::profile::Profile;
use crate::signal::{Exact, HalfEven, Signal, Value, Wrap, bit, int};
use crate::{bundle, when};

bundle! {
    /// The inputs.
    pub struct Inputs {
        /// All others are there, and hold.
        start,
        /// The capacitance.
        capacitance,
        /// The mean square of the haptic voltage.
        mean_square,
        /// Newtons per square picofarad at full mean square.
        gain,
    }
}

bundle! {
    /// The outputs: registers.
    pub struct Outputs {
        /// Set for one clock when the force is there.
        done,
        /// The haptic force.
        haptic_force,
        /// Whether a word is held at a rail.
        saturated,
    }
}

bundle! {
    /// The registers. `left`, `right` and `product` are codes as integers.
    pub struct Registers {
        step: ["idle", "load", "square", "weigh", "energy", "scale", "force"],
        left, right, product, haptic_force, saturated, done,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct Force {
    capacitance: Format,
    mean_square: Format,
    square: Format,
    gain: Format,
    registers: Registers<Format>,
}

impl Force {
    /// The force estimator of a profile.
    pub fn new(profile: &Profile) -> Self {
        let f = &profile.formats;
        let (capacitance, mean_square, square, gain) = (f.capacitance, f.mean_square, f.square, f.force_gain);
        let left = Format::unsigned(capacitance.width.max(square.width), 0);
        let right = Format::unsigned(capacitance.width.max(mean_square.width).max(gain.width), 0);
        let step = Format::unsigned(3, 0);
        let product = left.product(right);
        let registers = Registers { step, left, right, product, haptic_force: f.force, saturated: BIT, done: BIT };
        Force { capacitance, mean_square, square, gain, registers }
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        8
    }

    /// The product of two codes in the format `to`, and whether it is held at a rail.
    #[inline(always)]
    fn product<V: Value>(
        &self,
        r: &Registers<Signal<V>>,
        (left, right): (Format, Format),
        to: Format,
    ) -> (Signal<V>, Signal<V>) {
        let format = left.product(right);
        r.product.fit(Format { frac: 0, ..format }, Exact, Wrap).scaled(-format.frac).saturate(to, HalfEven)
    }

    #[inline(always)]
    fn step<V: Value>(&self, r: Registers<Signal<V>>, i: Inputs<Signal<V>>) -> Registers<Signal<V>> {
        let at = |step: u64| r.step.is(step);
        let (square, square_held) = self.product(&r, (self.capacitance, self.capacitance), self.square);
        let (energy, energy_held) = self.product(&r, (self.square, self.mean_square), self.square);
        let (force, force_held) = self.product(&r, (self.square, self.gain), self.registers.haptic_force);
        let [capacitance, mean_square, gain] = [i.capacitance, i.mean_square, i.gain].map(Signal::integer);
        let factor = at(3).select(square, energy).integer();
        let saturated = (at(3) & square_held) | (at(5) & energy_held) | (at(7) & force_held);
        Registers {
            step: at(7).select(int(0), r.step + int(1)).fit(self.registers.step, Exact, Wrap),
            left: at(1).select(capacitance, factor),
            right: at(1).select(capacitance, at(3).select(mean_square, gain)),
            product: r.left * r.right,
            haptic_force: at(7).select(force, r.haptic_force),
            saturated: r.saturated | saturated,
            done: at(7),
        }
    }
}

impl Block for Force {
    const NAME: &'static str = "force_estimator";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = ();

    #[inline]
    fn inputs(&self) -> Inputs<Format> {
        let (capacitance, mean_square, gain) = (self.capacitance, self.mean_square, self.gain);
        Inputs { start: BIT, capacitance, mean_square, gain }
    }

    #[inline]
    fn outputs(&self) -> Outputs<Format> {
        Outputs { done: BIT, haptic_force: self.registers.haptic_force, saturated: BIT }
    }

    #[inline(always)]
    fn registers(&self) -> Registers<Format> {
        let r = self.registers;
        Registers {
            done: BIT,
            saturated: BIT,
            step: r.step.counting(),
            left: r.left.counting(),
            right: r.right.counting(),
            product: r.product.counting(),
            ..r
        }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let outputs = Outputs { done: r.done, haptic_force: r.haptic_force, saturated: r.saturated };
        if (i.start | !r.step.is(0) | r.done).idle() {
            return outputs;
        }
        let idle = Registers { done: bit(false), ..r };
        let begin = Registers { step: int(1), saturated: bit(false), ..idle };
        let next = when!(V, Registers, i.start, begin, when!(V, Registers, r.step.is(0), idle, self.step(idle, i)));
        cell.store(self, next);
        outputs
    }
}
