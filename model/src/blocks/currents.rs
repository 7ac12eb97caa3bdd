// SPDX-License-Identifier: MIT OR Apache-2.0
//! Currents: amplitudes of every channel and of the sum over all terminals, and the sums of eqs. 2
//! and 3.
//!
//! ```text
//! a_k = √(i_k² + q_k²),   a = √((Σ i_k)² + (Σ q_k)²),   x = Σ ±a_k,   y = Σ ±a_k,   corners = Σ a_k of those in x or y
//! ```
//!
//! ```text
//! sum ─(round half even, saturate)─[iq]─[words]─(²)─(+)─[sqrt]─ amplitude ─(±)─ x, y, corners
//!                                            └─(+ over terminals)─[saturate]─ total
//! ```
//!
//! | signal          | format  | unit           | overflow             |
//! | iq, total       | profile | full scale     | saturates, flagged   |
//! | power           | exact   | full scale²    | cannot (range proof) |
//! | amplitude       | total's | full scale     | cannot (range proof) |
//! | x, y, corners   | exact   | full scale     | cannot (range proof) |
//!
//! Words may be moved up together, so that small currents keep their bits: see
//! `currents/block_floating.rs`. x, y and corners then count what the largest current makes of a
//! word's step; total and sensing voltage are at one point again.
//!
//! Latency: (terminals + 2) · (6 products + square root + 1) + 1 clocks from the last sum (the mean
//! square's) to `done`. Source: paper, eqs. 2–5; the sum is that of all terminals' complex
//! currents, for the corners alone carry only a part (docs/physics.md §1).

mod block_floating;

use self::block_floating::wide;
use super::demodulator::Demodulator;
use super::multiplier::{self, Multiplier};
use super::rests::Rests;
use super::sqrt::{self, SquareRoot};
use crate::buildable::{fits, rounds};
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{
    Assumed, Exact, Floor, HalfEven, Proved, Signal, Wrap, bit, int, zero,
};
use hapticore_hdl::states::States;
use hapticore_hdl::{block, call, states, when};

states! {
    /// The steps from words to results; those of alignment and the last are of block-floating words (`currents/block_floating.rs`).
    /// `SquareRoot` waits for the square root.
    pub enum Step {
        Idle, Read, InPhase, ReadQuadrature, Quadrature, Square, Power, SquareRoot,
        AlignRead, AlignLoad, AlignMove, AlignKeep, Restore,
    }
}

block! {
    /// The amplitudes of the currents, and their sums.
    pub struct Currents("currents") {
        terminals: u64,
        signs: [Vec<i8>; 2],
        /// Bits by which a sum over the window is scaled down to full scale.
        shift: i8,
        sum: Format,
        iq: Format,
        /// Of the sums over all terminals.
        total: Format,
        /// Of what is squared.
        part: Format,
        /// Bits by which words may be moved up, together; none where they all have one point.
        block: u8,
        /// The amplitudes that are given out.
        given: Format,
        /// An amplitude's bits, as the square root gives it.
        amplitude: u8,
    }
    submodules {
        words: Memory,
        multiplier: Multiplier,
        sqrt: SquareRoot,
    }
    inputs(currents) {
        /// Asserted for one cycle with each of the demodulator's sums.
        valid: BIT,
        /// The number of the sum.
        index: Format::counter(2 * (currents.terminals + 1)),
        sum: currents.sum,
    }
    outputs(currents) {
        /// Asserted for one cycle when all others are valid; they are stable until the next results.
        done: BIT,
        /// Amplitude of the total current, full scale.
        total: currents.given,
        /// Amplitude of the sensing voltage, full scale.
        sense: currents.given,
        /// Numerator of r_x: the terminals' amplitudes with their signs.
        x: currents.numerator(),
        /// Numerator of r_y: the terminals' amplitudes with their signs.
        y: currents.numerator(),
        /// Denominator of both ratios.
        corners: currents.denominator(),
        /// Smallest amplitude of all terminals, in the unit of the numerators.
        least: currents.sqrt_format(),
        /// A word is saturated.
        saturated: BIT,
    }
    registers(currents) {
        step in Step: if currents.block == 0 { Format::counter(Step::SquareRoot.code()) } else { Step::FORMAT },
        arrived: BIT,
        place: currents.words.address(),
        word: currents.wide(),
        multiplier_busy: BIT,
        channel: Format::counter(currents.terminals + 1),
        total_i: currents.total,
        total_q: currents.total,
        part: currents.part,
        power: Format::unsigned(2 * currents.part.width, 2 * currents.part.frac),
        sqrt_start: BIT,
        sense: currents.sqrt_format(),
        x: currents.numerator(),
        y: currents.numerator(),
        corners: currents.denominator(),
        least: currents.sqrt_format(),
        saturated: BIT,
        done: BIT,
        long: currents.wide(),
        count: Format::counter(currents.block.into()),
        limit: Format::counter(currents.block.into()),
        other: Format::counter(currents.block.into()),
        quadrature: BIT,
        aligning: BIT,
        whole: Format::unsigned(currents.amplitude + currents.down() as u8, currents.part.frac),
    }
}

const SQUARE: &str = "a square is not negative";

impl Currents {
    /// The currents of a profile.
    ///
    /// # Errors
    /// I/Q words to which no word of the model can be rounded; sums as [`Demodulator::try_new`].
    pub fn try_new(profile: &Profile) -> Result<Self, ProfileError> {
        let (iq, block) = (profile.formats.iq, profile.formats.block_shift);
        let demodulator = Demodulator::try_new(profile)?;
        let shift = profile.sum_shift() - demodulator.shift();
        let wide = wide(iq, block);
        rounds("formats.iq", "a sum over the window", demodulator.sum().scaled(-shift), wide)?;
        let terminals = profile.terminals.x.len() as u64;
        let (part, total) = match block {
            0 => (profile.formats.total, profile.formats.total),
            _ => (iq, Format::signed(iq.width + Format::counter(terminals).width, iq.frac)),
        };
        let power = Format::unsigned(2 * part.width, 2 * part.frac);
        let sqrt = SquareRoot::new(power, part.frac);
        fits("formats.total", "the radicand of an amplitude", sqrt.widest())?;
        let amplitude = sqrt.sqrt();
        let words = Memory::new("words", (2 * terminals + 2).next_power_of_two() as usize, wide)
            .dont_care_on_collision();
        Ok(Currents {
            words,
            multiplier: Multiplier::new(part.integer(), part.integer(), profile.multiplier),
            sqrt,
            terminals,
            signs: [profile.terminals.x.clone(), profile.terminals.y.clone()],
            shift,
            sum: demodulator.sum(),
            iq,
            total,
            part,
            block,
            given: if block == 0 { amplitude } else { profile.amplitude_format() },
            amplitude: amplitude.width,
        })
    }

    /// The format of an amplitude as the square root gives it.
    #[inline(always)]
    fn sqrt_format(&self) -> Format {
        Format::unsigned(self.amplitude, self.part.frac)
    }

    /// The format of the sums of eqs. 2 and 3.
    #[inline(always)]
    fn numerator(&self) -> Format {
        Format::signed(self.amplitude + 1 + self.down() as u8, self.part.frac)
    }

    /// The format of their denominator.
    #[inline(always)]
    fn denominator(&self) -> Format {
        Format::unsigned(self.amplitude + self.down() as u8, self.part.frac)
    }

    /// The format of an amplitude.
    pub fn amplitude(&self) -> Format {
        self.given
    }

    /// The formats of the numerators and of the denominator of eqs. 2 and 3.
    pub fn sums(&self) -> (Format, Format) {
        (self.numerator(), self.denominator())
    }

    /// The format of the least amplitude.
    pub fn least(&self) -> Format {
        self.sqrt_format()
    }

    /// See `hurry` of the square root.
    pub(crate) fn hurry(&mut self) {
        self.sqrt.hurry();
    }

    /// The clocks from the last sum to `done`, one after the other, where every bit is known.
    #[inline(never)]
    pub(crate) fn run_on<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) {
        let held = Inputs { valid: bit(false), ..i };
        while V::known_bit(state.registers.done) != Some(true) {
            self.clock(state, held);
            self.run_moves(state);
        }
    }

    /// Clocks from the last sum to `done`.
    pub fn latency(&self) -> u64 {
        (self.terminals + 2) * (6 * self.multiplier.latency() + self.sqrt.latency() + 1)
            + 1
            + self.block_latency()
    }

    /// The in-phase or quadrature word of a sum, and whether it is saturated.
    #[inline(always)]
    fn word<V: Interpretation>(&self, sum: Signal<V>) -> (Signal<V>, Signal<V>) {
        let exact = sum.scaled(-self.shift);
        if self.block == 0 {
            return exact.saturate(self.wide(), HalfEven);
        }
        let (word, held) = exact.saturate(self.wide(), Floor);
        (word.golden(&[exact], |of| of[0]), held)
    }

    /// A sum arrives: its word goes into the memory, and with the last the loop over channels
    /// begins.
    #[inline(always)]
    fn accept_sum<V: Interpretation>(&self, r: Regs<V>, i: In<V>, held: Signal<V>) -> Regs<V> {
        let of_channel = i.index.less_than(int(2 * (self.terminals + 1)));
        let begin = if self.block == 0 { Step::Read } else { Step::AlignRead }.signal();
        let r = if self.block == 0 { r } else { self.unaligned(r) };
        Registers {
            step: self.is_last(i.index).select(begin, r.step),
            multiplier_busy: bit(false),
            channel: int(0),
            total_i: zero(self.total),
            total_q: zero(self.total),
            saturated: (!i.index.is(0) & r.saturated) | (of_channel & held),
            ..r
        }
    }

    /// Whether a sum is the window's last.
    #[inline(always)]
    pub(crate) fn is_last<V: Interpretation>(&self, index: Signal<V>) -> Signal<V> {
        index.is(2 * self.terminals + 2)
    }

    /// A total with a terminal's word more, and whether it is saturated.
    #[inline(always)]
    fn add_terminal<V: Interpretation>(&self, r: &Regs<V>) -> (Signal<V>, Signal<V>) {
        (r.total_i + r.part).named("with_terminal").saturate(self.total, Exact)
    }

    /// A step of the loop over channels: words, squares, root, sums.
    #[inline(always)]
    fn step<V: Interpretation>(
        &self,
        r: Regs<V>,
        word: Signal<V>,
        product: Signal<V>,
        sqrt: sqrt::Out<V>,
    ) -> Regs<V> {
        use Step::*;
        let at = |step: Step| r.step.at(step);
        let all = r.channel.is(self.terminals + 1);
        let terminal = r.channel.less_than(int(self.terminals));
        let square = product.resize(self.square(), Assumed(SQUARE)).scaled(-2 * self.part.frac);
        let power = at(Power).select(r.power + square, square).resize(r.power.format, Proved);
        let adds = ((at(ReadQuadrature) | at(Square)) & terminal).named("adds");
        let (more, held) = self.add_terminal(&r);
        let sqrt_done = (at(SquareRoot) & sqrt.done).named("sqrt_done");
        let r = when!(sqrt_done => self.sum_up(r, sqrt.sqrt), else r);
        let total =
            |total: Signal<V>| if self.block == 0 { total } else { self.narrow_total(total) };
        let (in_phase, quadrature) =
            (all.select(total(r.total_i), word), all.select(total(r.total_q), word));
        let part = at(InPhase).select(in_phase, at(Quadrature).select(quadrature, r.part));
        let after = if self.block == 0 { Idle } else { Restore }.signal();
        let following = at(SquareRoot).select(r.step, r.step + int(1));
        Registers {
            step: sqrt_done
                .select(all.select(after, Read.signal()), following)
                .resize(r.step.format, Wrap),
            multiplier_busy: bit(false),
            // The totals change places with every addition: one adder, one register that takes its
            // result.
            total_i: adds.select(r.total_q, r.total_i),
            total_q: when!(adds => more, else r.total_q),
            part,
            power: {
                let squared = at(Quadrature) | at(Power);
                when!(squared => power, else r.power)
            },
            sqrt_start: at(Power),
            saturated: r.saturated | (adds & held),
            done: if self.block == 0 { sqrt_done & all } else { bit(false) },
            ..r
        }
    }

    /// The format of a square as an integer.
    #[inline(always)]
    fn square(&self) -> Format {
        self.registers().power.integer()
    }

    /// An amplitude is there: of a terminal, of the sensing voltage, and last of the total.
    #[inline(always)]
    fn sum_up<V: Interpretation>(&self, r: Regs<V>, amplitude: Signal<V>) -> Regs<V> {
        let opening = r.channel.is(0);
        let terminal = r.channel.less_than(int(self.terminals));
        let smaller = opening | (terminal & amplitude.less_than(r.least));
        let negative = (-amplitude).named("negative");
        let with = |sum: Signal<V>, sign: &dyn Fn(usize) -> i8| {
            let plus = self
                .is_selected(r.channel, |k| sign(k) > 0)
                .select(amplitude, zero(amplitude.format));
            let more = self.is_selected(r.channel, |k| sign(k) < 0).select(negative, plus);
            (opening.select(zero(sum.format), sum) + more).resize(sum.format, Proved)
        };
        let [x, y] = &self.signs;
        Registers {
            channel: (r.channel + int(1)).resize(r.channel.format, Wrap),
            whole: self.whole(&r, amplitude),
            sense: r.channel.is(self.terminals).select(amplitude, r.sense),
            x: with(r.x, &|k| x[k]),
            y: with(r.y, &|k| y[k]),
            corners: with(r.corners, &|k| i8::from(x[k] != 0 || y[k] != 0)),
            least: smaller.select(amplitude, r.least),
            ..r
        }
    }

    /// Whether the channel is one of the terminals that `choose` names.
    fn is_selected<V: Interpretation>(
        &self,
        channel: Signal<V>,
        choose: impl Fn(usize) -> bool,
    ) -> Signal<V> {
        let chosen = (0..self.terminals).filter(|&k| choose(k as usize));
        chosen.map(|k| channel.is(k)).reduce(|a, b| a | b).unwrap_or(bit(false))
    }

    #[inline(always)]
    fn results<V: Interpretation>(&self, r: &Regs<V>, total: Signal<V>) -> Out<V> {
        let Registers { done, sense, x, y, corners, least, saturated, .. } = *r;
        if self.block == 0 {
            return Outputs { done, total, sense, x, y, corners, least, saturated };
        }
        let ((total, beyond), (sense, too)) = (self.rounded(r.whole), self.rounded(sense));
        Outputs { done, total, sense, x, y, corners, least, saturated: saturated | beyond | too }
    }

    /// The total's amplitude, to be moved back.
    #[inline(always)]
    fn whole<V: Interpretation>(&self, r: &Regs<V>, amplitude: Signal<V>) -> Signal<V> {
        if self.block == 0 {
            r.whole
        } else {
            amplitude.scaled(self.down()).resize(r.whole.format, Proved)
        }
    }

    /// A cycle on the way from words to results.
    #[inline(always)]
    fn busy<V: Interpretation>(
        &self,
        r: Regs<V>,
        data: Signal<V>,
        product: Signal<V>,
        sqrt: sqrt::Out<V>,
    ) -> Regs<V> {
        let waits = Registers { multiplier_busy: bit(true), ..r };
        let advance = self.multiplier.ready(r.multiplier_busy) | r.step.at(Step::SquareRoot);
        if self.block == 0 {
            return when!(advance => self.step(r, data.align_point(r.part.format), product, sqrt), else waits);
        }
        let aligns =
            r.step.at_least(Step::AlignRead.signal()) & r.step.less_than(Step::Restore.signal());
        let restores = r.step.at(Step::Restore);
        when!(aligns => self.align(r, data), else when!(restores => self.restore(r), else when!(advance => self.step(r, self.narrow(data), product, sqrt), else waits)))
    }
}

impl Rests for Currents {
    #[inline(always)]
    fn under_way<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        r.arrived | !r.step.at(Step::Idle) | r.done
    }
}

impl Block for Currents {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        // The last root, the total's, stays until the next slot's first.
        let inputs = sqrt::Inputs { start: r.sqrt_start, radicand: r.power };
        let sqrt::Outputs { done, sqrt } = call!(self.sqrt, state, inputs);
        let sqrt = sqrt::Outputs { done, sqrt: sqrt.align_point(r.sense.format) };
        let outputs = self.results(&r, sqrt.sqrt);
        let busy = !r.step.at(Step::Idle);
        if (i.valid | self.under_way(&r)).can_skip() {
            return outputs;
        }
        let (word, held) = self.word(i.sum);
        let inputs =
            multiplier::Inputs { enable: busy, left: r.part.integer(), right: r.part.integer() };
        let product = call!(self.multiplier, state, inputs).product;
        let of_channel = i.index.less_than(int(2 * (self.terminals + 1))).named("of_channel");
        let data = self.words.data(&mut state.submodules.words);
        let second = !r.step.less_than(Step::ReadQuadrature.signal());
        let second = if self.block == 0 {
            second
        } else {
            r.step.less_than(Step::AlignRead.signal()).select(second, r.quadrature)
        };
        let address = r.channel.concat(second);
        let address = address.bits(0, self.words.address().width);
        let write = Write { enable: r.arrived, address: r.place, data: r.word };
        self.words.access(&mut state.submodules.words, address, write);
        let idle = Registers { done: bit(false), sqrt_start: bit(false), ..r };
        let next = when!(i.valid => self.accept_sum(idle, i, held), else when!(busy => self.busy(idle, data, product, sqrt), else idle));
        let arrived = i.valid & of_channel;
        let place = i.index.bits(0, self.words.address().width);
        let (place, word) = (arrived.select(place, r.place), when!(arrived => word, else r.word));
        let (arrived, place, word) = if self.block == 0 {
            (arrived, place, word)
        } else {
            let (moved, keeps) = self.moved(&r);
            let here = r.channel.concat(r.quadrature).bits(0, self.words.address().width);
            (
                arrived | keeps,
                keeps.select(here, place),
                when!(keeps => moved.resize(word.format, Proved), else word),
            )
        };
        state.store(self, Registers { arrived, place, word, ..next });
        outputs
    }
}

#[cfg(test)]
mod tests;
