// SPDX-License-Identifier: MIT OR Apache-2.0
//! Block-floating words. Those of all terminals are moved up by as many bits as the largest leaves,
//! those of the sensing voltage by as many as theirs leave. At the end total and sensing voltage
//! are moved back to one point.
//!
//! ```text
//! sum ─(floor, saturate)─[words: wide]─(least number of unused bits of all)─[limit]
//!                        [words: wide]─(« limit)─(round half even)─[words: narrow]   and on as with words of one point
//! [total, sense] ─(» their limits, round half even)─ total, sense
//! ```
//!
//! Every word takes the same clocks, however far it is moved. Position is a ratio of terminals: it
//! needs no point. Latency: B + 3 clocks a word, of 2 · terminals + 2 words, twice; B clocks of
//! moving back; B the profile's `block_shift`.

use super::{Currents, Registers, Regs, Step};
use hapticore_hdl::block::{Interpretation, State};
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::{Floor, HalfEven, Proved, Saturate, Signal, Wrap, bit, int};
use hapticore_hdl::states::States;

/// The format of an I/Q word with all the bits by which it may be moved up.
#[inline(always)]
pub(super) const fn wide(iq: Format, block: u8) -> Format {
    Format::signed(iq.width + block, iq.frac.saturating_add(block as i8))
}

impl Currents {
    /// Clocks that words of one point do without: alignment, and moving back.
    pub(super) fn block_latency(&self) -> u64 {
        let shift = u64::from(self.block);
        if shift == 0 { 0 } else { 2 * 2 * (self.terminals + 1) * (shift + 3) + shift }
    }

    /// A word as it is first kept.
    pub(super) fn wide(&self) -> Format {
        wide(self.iq, self.block)
    }

    /// Bits by which a total's word is rounded before it is squared, so that it has no more than a
    /// terminal's.
    #[inline(always)]
    pub(super) fn down(&self) -> i8 {
        Format::counter(self.terminals).width as i8
    }

    /// Whether the word's sign bit is not alone: to move it further up would change it.
    #[inline(always)]
    fn full<V: Interpretation>(&self, long: Signal<V>) -> Signal<V> {
        let (sign, next) = (long.msb(), long.bits(long.format.width - 2, 1));
        (sign & !next) | (next & !sign)
    }

    /// A clock before the loop over channels: words are scanned one after the other, then moved.
    #[inline(always)]
    pub(super) fn align<V: Interpretation>(&self, r: Regs<V>, word: Signal<V>) -> Regs<V> {
        use Step::*;
        let at = |step: Step| r.step.at(step);
        let most = u64::from(self.block);
        let moving = r.count.less_than(r.limit);
        let lower = at(AlignMove) & !r.aligning & self.full(r.long) & moving;
        let shifted = r.long.scaled(1).resize(r.long.format, Wrap);
        let shifts = at(AlignMove) & (moving | !r.aligning);
        let ends = at(AlignKeep);
        // With the last word of the terminals the limits change places, as with that of the sensing
        // voltage.
        let sense = r.channel.is(self.terminals);
        let before_sense = r.channel.is(self.terminals - 1);
        let swaps = ends & r.quadrature & (before_sense | sense);
        let limit = lower.select(r.count, r.limit).resize(r.limit.format, Proved);
        let fresh = (swaps & before_sense & !r.aligning).select(int(most), r.other);
        let further = r.channel.increment();
        let next = (ends & r.quadrature).select(sense.select(int(0), further), r.channel);
        let following = at(AlignMove).select(
            r.count.is(most - 1).select(AlignKeep.signal(), AlignMove.signal()),
            ends.select(
                (r.quadrature & sense & r.aligning).select(Read.signal(), AlignRead.signal()),
                r.step + int(1),
            ),
        );
        let counted = at(AlignMove).select(r.count + int(1), int(0));
        Registers {
            step: following.resize(r.step.format, Wrap),
            long: at(AlignLoad).select(word, shifts.select(shifted, r.long)),
            count: counted.resize(r.count.format, Wrap),
            limit: swaps.select(fresh, limit),
            other: swaps.select(r.limit, r.other),
            quadrature: (ends & !r.quadrature) | (r.quadrature & !ends),
            channel: next.resize(r.channel.format, Wrap),
            aligning: r.aligning | (ends & r.quadrature & sense),
            ..r
        }
    }

    /// The clocks in which a word is moved bit by bit, one after the other: nothing else changes in them.
    #[inline(always)]
    pub(super) fn run_moves<V: Interpretation>(&self, state: &mut State<Self, V>) {
        while V::known_bit(state.load(self).step.at(Step::AlignMove).value) == Some(true) {
            let r = state.load(self);
            state.store(self, self.align(r, r.long));
        }
    }

    /// The word that is kept of a moved one, and whether this is the clock to keep it.
    #[inline(always)]
    pub(super) fn moved<V: Interpretation>(&self, r: &Regs<V>) -> (Signal<V>, Signal<V>) {
        let word = r.long.quantize(self.iq, HalfEven, Saturate);
        (word.scaled(-(self.block as i8)), r.step.at(Step::AlignKeep) & r.aligning)
    }

    /// A terminal's or the sensing voltage's word, read again.
    #[inline(always)]
    pub(super) fn narrow<V: Interpretation>(&self, word: Signal<V>) -> Signal<V> {
        let narrow = Format { frac: word.format.frac, ..self.iq };
        word.resize(narrow, Wrap).scaled(self.block as i8)
    }

    /// A total's word, as wide as a terminal's.
    #[inline(always)]
    pub(super) fn narrow_total<V: Interpretation>(&self, total: Signal<V>) -> Signal<V> {
        total.scaled(-self.down()).quantize(self.iq, HalfEven, Proved)
    }

    /// A clock of moving total and sensing voltage back.
    #[inline(always)]
    pub(super) fn restore<V: Interpretation>(&self, r: Regs<V>) -> Regs<V> {
        let halved = |amplitude: Signal<V>, limit: Signal<V>| {
            let half = amplitude.scaled(-1);
            let half = half.quantize(amplitude.format, Floor, Proved).golden(&[half], |of| of[0]);
            r.count.less_than(limit).select(half, amplitude)
        };
        let end = r.count.is(u64::from(self.block) - 1);
        Registers {
            step: end.select(Step::Idle.signal(), r.step).resize(r.step.format, Wrap),
            count: r.count.increment(),
            whole: halved(r.whole, r.limit),
            sense: halved(r.sense, r.other),
            done: end,
            ..r
        }
    }

    /// An amplitude in its output format, and whether it is saturated.
    #[inline(always)]
    pub(super) fn rounded<V: Interpretation>(
        &self,
        amplitude: Signal<V>,
    ) -> (Signal<V>, Signal<V>) {
        amplitude.saturate(self.given, HalfEven)
    }

    /// What alignment begins with.
    #[inline(always)]
    pub(super) fn unaligned<V: Interpretation>(&self, r: Regs<V>) -> Regs<V> {
        let most = int(u64::from(self.block));
        Registers { limit: most, count: int(0), quadrature: bit(false), aligning: bit(false), ..r }
    }
}
