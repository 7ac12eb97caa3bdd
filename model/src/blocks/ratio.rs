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
//! A zero denominator gives `invalid`. Latency: 3 · (divider + 1) + 1 clocks from `start` to
//! `done`.

use super::divider::{self, Divider};
use super::rests::Rests;
use crate::buildable::fits;
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::{Proved, Signal, bit, int};
use hapticore_hdl::states::States;
use hapticore_hdl::{block, call, next, states};

states! {
    /// Which ratio is being divided.
    pub enum Step {
        Idle, X, Y, Share,
    }
}

block! {
    /// The ratios from the sums of the currents.
    pub struct Ratio("ratio") {
        sums: Format,
        corners: Format,
        least: Format,
        ratio: Format,
    }
    submodules {
        divider: Divider,
    }
    inputs(block) {
        /// Begins; all others are valid and stable until `done`.
        start: BIT,
        /// Numerator of r_x: the terminals' amplitudes with their signs.
        x: block.sums,
        /// Numerator of r_y: the terminals' amplitudes with their signs.
        y: block.sums,
        /// Denominator of both ratios: the amplitudes of all terminals with a sign.
        corners: block.corners,
        /// Smallest amplitude of all terminals.
        least: block.least,
    }
    outputs(block) {
        /// Asserted for one cycle when the ratios are valid.
        done: BIT,
        /// Ratio r_x of eq. 2.
        r_x: block.ratio,
        /// Ratio r_y of eq. 3.
        r_y: block.ratio,
        /// Smallest amplitude over the denominator; stable until the next `start`.
        share: block.quotient(),
        /// The denominator is zero.
        invalid: BIT,
    }
    registers(block) {
        step in Step,
        divide: BIT,
        r_x: block.ratio,
        r_y: block.ratio,
        invalid: BIT,
        done: BIT,
    }
}

/// The format of a ratio without its sign.
#[inline(always)]
const fn magnitude(ratio: Format) -> Format {
    Format::unsigned(ratio.width - 1, ratio.frac)
}

impl Ratio {
    /// The ratios of a profile; `sums` are the formats of the numerators and of the denominator,
    /// `least` that of an amplitude.
    ///
    /// # Errors
    /// A ratio whose dividend no word of the model holds.
    pub fn try_new(
        profile: &Profile,
        (sums, corners): (Format, Format),
        least: Format,
    ) -> Result<Self, ProfileError> {
        let ratio = profile.formats.ratio;
        let divider = Divider::new(Format { signed: false, ..sums }, corners, magnitude(ratio));
        fits("formats.ratio", "the dividend of a ratio", divider.dividend.width)?;
        Ok(Ratio { divider, sums, corners, least, ratio })
    }

    /// The format of a quotient.
    #[inline(always)]
    fn quotient(&self) -> Format {
        magnitude(self.ratio)
    }

    /// See `hurry` of the divider.
    pub(crate) fn hurry(&mut self) {
        self.divider.hurry();
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
        (Step::ALL.len() as u64 - 1) * (self.divider.latency() + 1) + 1
    }

    #[inline(always)]
    fn step<V: Interpretation>(&self, r: Regs<V>, i: In<V>, divided: divider::Out<V>) -> Regs<V> {
        let [x, y, share] =
            [Step::X, Step::Y, Step::Share].map(|step| divided.done & r.step.at(step));
        let numerator = r.step.at(Step::X).select(i.x, i.y).named("numerator");
        let negative = numerator.less_than(int(0));
        let ratio =
            negative.select(-divided.quotient, divided.quotient).resize(r.r_x.format, Proved);
        Registers {
            step: x.select(
                Step::Y.signal(),
                y.select(Step::Share.signal(), share.select(Step::Idle.signal(), r.step)),
            ),
            divide: x | y,
            // That of x comes first, and moves on: one value, one register that takes it.
            r_x: y.select(r.r_y, r.r_x),
            r_y: (x | y).select(ratio, r.r_y),
            invalid: y.select(i.corners.is(0), r.invalid),
            done: share,
        }
    }
}

impl Rests for Ratio {
    #[inline(always)]
    fn under_way<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        !r.step.at(Step::Idle) | r.done
    }
}

impl Block for Ratio {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let numerator = r.step.at(Step::X).select(i.x, i.y).abs();
        let numerator =
            r.step.at(Step::Share).select(i.least.resize(numerator.format, Proved), numerator);
        let inputs = divider::Inputs { start: r.divide, numerator, denominator: i.corners };
        // The last quotient, the share, stays until the next slot's first.
        let divided = call!(self.divider, state, inputs);
        let Registers { done, r_x, r_y, invalid, .. } = r;
        let outputs = Outputs { done, r_x, r_y, share: divided.quotient, invalid };
        if (i.start | self.under_way(&r)).can_skip() {
            return outputs;
        }
        let begin = Registers { step: Step::X.signal(), divide: bit(true), done: bit(false), ..r };
        next!(self, state, i.start => begin, else self.step(r, i, divided));
        outputs
    }
}

#[cfg(test)]
mod tests;
