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
//! One multiplier serves all three products, on codes as integers; a step takes as long as it does. Latency: 9 steps and a
//! clock from `start` to `done`.

use super::multiplier::{self, Multiplier};
use crate::block::{Block, Cell};
use crate::format::{BIT, Format};
use crate::profile::Profile;
use crate::signal::{Exact, HalfEven, Signal, Value, Wrap, bit, int};
use crate::{bundle, next, parts};

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
    /// The registers. `left` and `right` are codes as integers.
    pub struct Registers {
        step: [
            "idle", "load", "square", "narrow_square", "weigh", "energy", "narrow_energy", "scale", "gain_product", "finish",
        ],
        waited, left, right, factor, haptic_force, saturated, done,
    }
}

parts! {
    /// The block within.
    pub struct Parts of Force {
        multiplier: Multiplier,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct Force {
    multiplier: Multiplier,
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
        let step = Format::unsigned(4, 0);
        let multiplier = Multiplier::new(left, right, profile.multiplier);
        let registers = Registers {
            step,
            waited: BIT,
            left,
            right,
            factor: square,
            haptic_force: f.force,
            saturated: BIT,
            done: BIT,
        };
        Force { multiplier, capacitance, mean_square, square, gain, registers }
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        9 * self.multiplier.latency() + 1
    }

    /// The product of two codes in the format `to`, and whether it is held at a rail.
    #[inline(always)]
    fn narrow<V: Value>(
        &self,
        product: Signal<V>,
        (left, right): (Format, Format),
        to: Format,
    ) -> (Signal<V>, Signal<V>) {
        product.as_code(left.product(right)).saturate(to, HalfEven)
    }

    #[inline(always)]
    fn step<V: Value>(
        &self,
        r: Registers<Signal<V>>,
        i: Inputs<Signal<V>>,
        product: Signal<V>,
    ) -> Registers<Signal<V>> {
        let at = |step: u64| r.step.is(step);
        let (square, square_held) = self.narrow(product, (self.capacitance, self.capacitance), self.square);
        let (energy, energy_held) = self.narrow(product, (self.square, self.mean_square), self.square);
        let (force, force_held) = self.narrow(product, (self.square, self.gain), r.haptic_force.format);
        let [capacitance, mean_square, gain] = [i.capacitance, i.mean_square, i.gain].map(Signal::integer);
        let factor = at(3).select(square, energy);
        let saturated = (at(3) & square_held) | (at(6) & energy_held) | (at(9) & force_held);
        Registers {
            step: at(9).select(int(0), r.step + int(1)).fit(r.step.format, Exact, Wrap),
            waited: bit(false),
            left: at(1).select(capacitance, r.factor.integer()),
            right: at(1).select(capacitance, at(4).select(mean_square, gain)),
            factor: (at(3) | at(6)).select(factor, r.factor),
            haptic_force: at(9).select(force, r.haptic_force),
            saturated: r.saturated | saturated,
            done: at(9),
        }
    }
}

impl Block for Force {
    const NAME: &'static str = "force_estimator";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = Parts<V>;

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
            waited: BIT,
            factor: self.square,
            haptic_force: r.haptic_force,
        }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let outputs = Outputs { done: r.done, haptic_force: r.haptic_force, saturated: r.saturated };
        if (i.start | !r.step.is(0) | r.done).idle() {
            return outputs;
        }
        let inputs = multiplier::Inputs { enable: !r.step.is(0), left: r.left, right: r.right };
        let product = self.multiplier.call("multiplier", &mut cell.parts.multiplier, inputs).product;
        let acts = self.multiplier.paces(r.waited);
        let idle = Registers { done: bit(false), ..r };
        let waits = Registers { waited: bit(true), ..idle };
        let begin = Registers { step: int(1), waited: bit(false), saturated: bit(false), ..idle };
        next!(
            V,
            Registers,
            self,
            cell,
            i.start => begin,
            r.step.is(0) => idle,
            acts => self.step(idle, i, product),
            else waits
        );
        outputs
    }
}
