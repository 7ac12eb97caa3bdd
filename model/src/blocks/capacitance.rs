// SPDX-License-Identifier: MIT OR Apache-2.0
//! Capacitance: the total current over the sensing voltage, with the sheet's resistance taken out.
//!
//! ```text
//! C = gain · a / √(v² − (a·R)²)        (docs/physics.md §2, robust form; R of the pad's place, from the map)
//! C = gain · a / v                     (paper, eq. 6, where the profile asks for it alone)
//! ```
//!
//! ```text
//! a ─(×)─[drop]─(²)─(v² −)─[clamp at 0]─[sqrt]─ a ÷ ─[admittance]─(× gain)─[round half even, saturate]─ capacitance
//! R ─┘
//! ```
//!
//! | signal      | format      | unit        | overflow                                 |
//! | drop        | amplitude's | full scale  | saturates, flagged                       |
//! | radicand    | exact       | full scale² | held at zero from below, then `invalid` |
//! | admittance  | profile     | –           | saturates, flagged                       |
//! | capacitance | profile     | pF          | saturates, flagged                       |
//!
//! One multiplier serves all four products; it works on codes as integers, so that their points
//! need not agree, and a step takes as long as it does. Latency: 7 products + square root + divider
//! + 3 clocks from `start` to `done`.

use super::divider::{self, Divider};
use super::multiplier::{self, Multiplier};
use super::rests::Rests;
use super::sqrt::{self, SquareRoot};
use crate::buildable::{fits, rounds};
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::{HalfEven, Saturate, Signal, Wrap, bit, int, zero};
use hapticore_hdl::states::States;
use hapticore_hdl::{block, call, next, states};

states! {
    /// The steps of a capacitance. `SquareRoot` and `Divide` wait for their blocks, all others last as long as a product.
    pub enum Step {
        Idle, Load, Sense, Drop, Square, DropSquare, Radicand, SquareRoot, Divide, GainProduct, Finish,
    }
}

block! {
    /// The capacitance from the amplitudes.
    pub struct Capacitance("capacitance") {
        /// Whether the sheet's resistance is taken out.
        correct: bool,
        amplitude: Format,
        sheet: Format,
        admittance: Format,
        gain: Format,
        capacitance: Format,
        /// Of the multiplier's operands.
        left: Format,
        right: Format,
    }
    submodules {
        multiplier: Multiplier,
        sqrt: SquareRoot,
        divider: Divider,
    }
    inputs(block) {
        /// Begins; all others are valid and stable until `done`.
        start: BIT,
        /// Amplitude of the total current, full scale.
        total: block.amplitude,
        /// Amplitude of the sensing voltage, full scale.
        sense: block.amplitude,
        /// Resistance of the sheet at the pad, full scales of voltage per current.
        sheet: block.sheet,
        /// Picofarads at an admittance of one.
        gain: block.gain,
    }
    outputs(block) {
        /// Asserted for one cycle when the capacitance is valid.
        done: BIT,
        /// The capacitance, in pF.
        capacitance: block.capacitance,
        /// No capacitance has these amplitudes.
        invalid: BIT,
        /// A word is saturated.
        saturated: BIT,
    }
    registers(block) {
        step in Step,
        multiplier_busy: BIT,
        /// Operands of the multiplier: codes as integers.
        left: block.left.as_uint(),
        right: block.right.as_uint(),
        drop: block.amplitude,
        square: block.square(),
        sqrt_start: BIT,
        divide: BIT,
        capacitance: block.capacitance,
        invalid: BIT,
        saturated: BIT,
        done: BIT,
    }
}

/// The format of an amplitude's square.
#[inline(always)]
const fn square(amplitude: Format) -> Format {
    Format::unsigned(2 * amplitude.width, 2 * amplitude.frac)
}

impl Capacitance {
    /// The capacitance of a profile, for amplitudes of a format.
    ///
    /// # Errors
    /// An admittance whose dividend no word of the model holds, a capacitance to which none can be
    /// rounded.
    pub fn try_new(profile: &Profile, amplitude: Format) -> Result<Self, ProfileError> {
        let f = &profile.formats;
        let (sheet, admittance, gain) = (profile.sheet(), f.admittance, f.capacitance_gain);
        let sqrt = SquareRoot::new(square(amplitude), amplitude.frac);
        let divider = Divider::new(amplitude, sqrt.sqrt(), admittance);
        let left = Format::unsigned(amplitude.width.max(admittance.width), 0);
        let right = Format::unsigned(amplitude.width.max(sheet.width).max(gain.width), 0);
        let correct = profile.capacitance.sheet_correction;
        let multiplier = Multiplier::new(left, right, profile.multiplier);
        let capacitance = f.capacitance;
        fits("formats.total", "the radicand of the capacitance", sqrt.widest())?;
        fits("formats.admittance", "the dividend of the admittance", divider.dividend.width)?;
        let block = Capacitance {
            multiplier,
            sqrt,
            divider,
            correct,
            amplitude,
            sheet,
            admittance,
            gain,
            capacitance,
            left,
            right,
        };
        rounds(
            "formats.capacitance",
            "the product of admittance and gain",
            block.gain_product(),
            capacitance,
        )?;
        Ok(block)
    }

    /// The format of the capacitance before it is rounded.
    #[inline(always)]
    fn gain_product(&self) -> Format {
        self.admittance.product(self.gain)
    }

    /// See `hurry` of the square root and the divider.
    pub(crate) fn hurry(&mut self) {
        // Its `done` would come within a step of two clocks, which does not look at it.
        if self.multiplier.latency() == 1 {
            self.sqrt.hurry();
        }
        self.divider.hurry();
    }

    /// The clocks that are left to `done`, one after the other, where every bit is known.
    #[inline(never)]
    pub(crate) fn run_on<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) {
        let held = Inputs { start: bit(false), ..i };
        while V::known_bit(state.registers.done) != Some(true) {
            self.clock(state, held);
        }
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        let clocks = |step: &Step| match step {
            Step::Idle => 1,
            // The square root begins with this step, and outlasts it.
            Step::Radicand => 0,
            Step::SquareRoot => self.sqrt.latency() + 1,
            Step::Divide => self.divider.latency() + 1,
            _ => self.multiplier.latency(),
        };
        Step::ALL.iter().map(clocks).sum()
    }

    /// The format of the radicand.
    #[inline(always)]
    fn square(&self) -> Format {
        square(self.amplitude)
    }

    /// The multiplier's operands of this step, as integers.
    #[inline(always)]
    fn operands<V: Interpretation>(
        &self,
        r: &Regs<V>,
        i: &In<V>,
        admittance: Signal<V>,
    ) -> (Signal<V>, Signal<V>) {
        let (total, sense) = (i.total.integer(), i.sense.integer());
        let (drop, admittance) = (r.drop.integer(), admittance.integer());
        let sheet = if self.correct { i.sheet } else { zero(self.sheet) }.integer();
        use Step::*;
        let at = |step: Step| r.step.at(step);
        let left =
            at(Load).select(total, at(Sense).select(sense, at(Square).select(drop, admittance)));
        let right = at(Load)
            .select(sheet, at(Sense).select(sense, at(Square).select(drop, i.gain.integer())));
        (left, right)
    }

    /// v² − (a·R)², held at zero from below, and whether nothing is left.
    #[inline(always)]
    fn radicand<V: Interpretation>(
        &self,
        r: &Regs<V>,
        product: Signal<V>,
    ) -> (Signal<V>, Signal<V>) {
        let drop = product.as_code(self.amplitude.product(self.amplitude));
        let left = (r.square - drop).named("left_over").resize(r.square.format, Saturate);
        (left, left.equals(zero(left.format)))
    }

    #[inline(always)]
    fn step<V: Interpretation>(
        &self,
        r: Regs<V>,
        i: In<V>,
        (product, nothing_left, sqrt_done, divided): (
            Signal<V>,
            Signal<V>,
            Signal<V>,
            divider::Out<V>,
        ),
    ) -> Regs<V> {
        use Step::*;
        let at = |step: Step| r.step.at(step);
        let (drop, drop_held) =
            product.as_code(self.amplitude.product(self.sheet)).saturate(self.amplitude, HalfEven);
        let square = product.as_code(self.amplitude.product(self.amplitude));
        let (result, held) =
            product.as_code(self.gain_product()).saturate(r.capacitance.format, HalfEven);
        let (left, right) = self.operands(&r, &i, divided.quotient);
        let waits = (at(SquareRoot) & !sqrt_done) | (at(Divide) & !divided.done);
        let onward = at(Finish).select(Idle.signal(), r.step + int(1));
        let saturated = (at(Drop) & drop_held)
            | (at(Divide) & divided.done & divided.saturated)
            | (at(Finish) & held);
        Registers {
            step: waits.select(r.step, onward).resize(r.step.format, Wrap),
            multiplier_busy: bit(false),
            left,
            right,
            drop: at(Drop).select(drop, r.drop),
            square: at(Square).select(square, r.square),
            sqrt_start: at(DropSquare),
            divide: at(SquareRoot) & sqrt_done,
            capacitance: at(Finish).select(result, r.capacitance),
            invalid: at(Radicand).select(nothing_left, r.invalid),
            saturated: r.saturated | saturated,
            done: at(Finish),
        }
    }
}

impl Rests for Capacitance {
    #[inline(always)]
    fn under_way<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        !r.step.at(Step::Idle) | r.done
    }
}

impl Block for Capacitance {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let Registers { done, capacitance, invalid, saturated, .. } = r;
        let outputs = Outputs { done, capacitance, invalid, saturated };
        if (i.start | self.under_way(&r)).can_skip() {
            return outputs;
        }
        let inputs =
            multiplier::Inputs { enable: !r.step.at(Step::Idle), left: r.left, right: r.right };
        let product = call!(self.multiplier, state, inputs).product;
        let (radicand, nothing_left) = self.radicand(&r, product);
        let inputs = sqrt::Inputs { start: r.sqrt_start, radicand };
        let sqrt = call!(self.sqrt, state, inputs);
        let inputs =
            divider::Inputs { start: r.divide, numerator: i.total, denominator: sqrt.sqrt };
        let divided = call!(self.divider, state, inputs);
        let idle = Registers { sqrt_start: bit(false), divide: bit(false), done: bit(false), ..r };
        let begin = Registers {
            step: Step::Load.signal(),
            multiplier_busy: bit(false),
            saturated: bit(false),
            ..idle
        };
        let waits = Registers { multiplier_busy: bit(true), ..idle };
        let advance = self.multiplier.ready(r.multiplier_busy)
            | r.step.at(Step::SquareRoot)
            | r.step.at(Step::Divide);
        let results = (product, nothing_left, sqrt.done, divided);
        next!(self, state,
            i.start => begin,
            r.step.at(Step::Idle) => idle,
            advance => self.step(idle, i, results),
            else waits
        );
        outputs
    }
}

#[cfg(test)]
mod tests;
