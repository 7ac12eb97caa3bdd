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
//! One multiplier serves all three products, on codes as integers; a step takes as long as it does.
//! Latency: 9 steps and a clock from `start` to `done`.

use super::multiplier::{self, Multiplier};
use super::rests::Rests;
use crate::buildable::rounds;
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::{HalfEven, Signal, Wrap, bit, int};
use hapticore_hdl::states::States;
use hapticore_hdl::{block, call, next, states};

states! {
    /// The steps of an estimate. Each lasts as long as a product.
    pub enum Step {
        Idle, Load, Square, NarrowSquare, MeanSquare, Energy, NarrowEnergy, Scale, GainProduct, Finish,
    }
}

block! {
    /// The force estimator.
    pub struct Force("force_estimator") {
        capacitance: Format,
        mean_square: Format,
        /// Of the squares of capacitance and of drive.
        square: Format,
        gain: Format,
        force: Format,
        /// Of the multiplier's operands.
        left: Format,
        right: Format,
    }
    submodules {
        multiplier: Multiplier,
    }
    inputs(force) {
        /// Begins; all others are valid and stable until `done`.
        start: BIT,
        /// The capacitance, in pF.
        capacitance: force.capacitance,
        /// The mean square of the haptic voltage, in full scales squared.
        mean_square: force.mean_square,
        /// Gain of the force, N/pF² at a full-scale haptic mean square.
        gain: force.gain,
    }
    outputs(force) {
        /// Asserted for one cycle when the force is valid.
        done: BIT,
        /// The haptic force, in N.
        haptic_force: force.force,
        /// A word is saturated.
        saturated: BIT,
    }
    registers(force) {
        step in Step,
        multiplier_busy: BIT,
        /// Operands of the multiplier: codes as integers.
        left: force.left.as_uint(),
        right: force.right.as_uint(),
        factor: force.square,
        haptic_force: force.force,
        saturated: BIT,
        done: BIT,
    }
}

impl Force {
    /// The force estimator of a profile.
    ///
    /// # Errors
    /// A format to which no word of the model can be rounded.
    pub fn try_new(profile: &Profile) -> Result<Self, ProfileError> {
        let f = &profile.formats;
        let (capacitance, mean_square, square) = (f.capacitance, f.mean_square, f.square);
        let (gain, force) = (f.force_gain, f.force);
        let left = Format::unsigned(capacitance.width.max(square.width), 0);
        let right = Format::unsigned(capacitance.width.max(mean_square.width).max(gain.width), 0);
        let multiplier = Multiplier::new(left, right, profile.multiplier);
        let block =
            Force { multiplier, capacitance, mean_square, square, gain, force, left, right };
        let products = [
            ("formats.square", "the square of the capacitance"),
            ("formats.square", "the product of square and mean square"),
            ("formats.force", "the product of energy and gain"),
        ];
        for ((field, name), (product, to)) in products.into_iter().zip(block.products()) {
            rounds(field, name, product, to)?;
        }
        Ok(block)
    }

    /// The products square, energy and force, and the formats to which they are rounded.
    #[inline(always)]
    fn products(&self) -> [(Format, Format); 3] {
        [
            (self.capacitance.product(self.capacitance), self.square),
            (self.square.product(self.mean_square), self.square),
            (self.square.product(self.gain), self.force),
        ]
    }

    /// The clocks from `start` to `done`, one after the other, where every bit is known.
    #[inline(never)]
    pub(crate) fn run_on<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) {
        let held = Inputs { start: bit(false), ..i };
        while V::known_bit(state.registers.done) != Some(true) {
            self.clock(state, held);
        }
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        (Step::ALL.len() as u64 - 1) * self.multiplier.latency() + 1
    }

    #[inline(always)]
    fn step<V: Interpretation>(&self, r: Regs<V>, i: In<V>, product: Signal<V>) -> Regs<V> {
        use Step::*;
        let at = |step: Step| r.step.at(step);
        let narrowed = |(of, to): (Format, Format)| product.as_code(of).saturate(to, HalfEven);
        let [of_square, of_energy, of_force] = self.products();
        let (square, square_held) = narrowed(of_square);
        let (energy, energy_held) = narrowed(of_energy);
        let (force, force_held) = narrowed(of_force);
        let (capacitance, mean_square) = (i.capacitance.integer(), i.mean_square.integer());
        let gain = i.gain.integer();
        let factor = at(NarrowSquare).select(square, energy);
        let saturated = (at(NarrowSquare) & square_held)
            | (at(NarrowEnergy) & energy_held)
            | (at(Finish) & force_held);
        Registers {
            step: at(Finish).select(Idle.signal(), r.step + int(1)).resize(r.step.format, Wrap),
            multiplier_busy: bit(false),
            left: at(Load).select(capacitance, r.factor.integer()),
            right: at(Load).select(capacitance, at(MeanSquare).select(mean_square, gain)),
            factor: (at(NarrowSquare) | at(NarrowEnergy)).select(factor, r.factor),
            haptic_force: at(Finish).select(force, r.haptic_force),
            saturated: r.saturated | saturated,
            done: at(Finish),
        }
    }
}

impl Rests for Force {
    #[inline(always)]
    fn under_way<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        !r.step.at(Step::Idle) | r.done
    }
}

impl Block for Force {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let Registers { done, haptic_force, saturated, .. } = r;
        let outputs = Outputs { done, haptic_force, saturated };
        if (i.start | self.under_way(&r)).can_skip() {
            return outputs;
        }
        let inputs =
            multiplier::Inputs { enable: !r.step.at(Step::Idle), left: r.left, right: r.right };
        let product = call!(self.multiplier, state, inputs).product;
        let advance = self.multiplier.ready(r.multiplier_busy);
        let idle = Registers { done: bit(false), ..r };
        let waits = Registers { multiplier_busy: bit(true), ..idle };
        let begin = Registers {
            step: Step::Load.signal(),
            multiplier_busy: bit(false),
            saturated: bit(false),
            ..idle
        };
        next!(self, state,
            i.start => begin,
            r.step.at(Step::Idle) => idle,
            advance => self.step(idle, i, product),
            else waits
        );
        outputs
    }
}

#[cfg(test)]
mod tests;
