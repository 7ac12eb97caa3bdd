// SPDX-License-Identifier: MIT OR Apache-2.0
//! Block-floating words: those of all terminals are moved up by as many bits as the largest leaves, those of the sensing
//! voltage by as many as theirs leave; at the end total and sensing voltage are moved back to one point.
//!
//! ```text
//! sum ─(floor, saturate)─[words: wide]─(least number of unused bits of all)─[limit]
//!                        [words: wide]─(« limit)─(round half even)─[words: narrow]   and on as with words of one point
//! [total, sense] ─(» their limits, round half even)─ total, sense
//! ```
//!
//! Every word takes the same clocks, however far it is moved. Position is a ratio of terminals: it needs no point.
//! Latency: B + 3 clocks a word, of 2 · terminals + 2 words, twice; B clocks of moving back; B the profile's `block_shift`.

use super::{Currents, Registers};
use crate::format::Format;
use crate::signal::{Exact, Floor, HalfEven, Never, Saturate, Signal, Value, Wrap, bit, int};

/// The steps before those of the loop over channels, and the one after them.
pub(super) const READ: u64 = 8;
const LOAD: u64 = 9;
const MOVE: u64 = 10;
const KEEP: u64 = 11;
pub(super) const RESTORE: u64 = 12;

impl Currents {
    /// Clocks that words of one point do without: alignment, and moving back.
    pub(super) fn block_latency(&self) -> u64 {
        let shift = u64::from(self.block);
        if shift == 0 { 0 } else { 2 * 2 * (self.terminals + 1) * (shift + 3) + shift }
    }

    /// A word as it is first kept.
    pub(super) fn wide(&self) -> Format {
        Format::signed(self.iq.width + self.block, self.iq.frac + self.block as i8)
    }

    /// Bits by which a total's word is rounded before it is squared, so that it has no more than a terminal's.
    #[inline(always)]
    pub(super) fn down(&self) -> i8 {
        Format::counter(self.terminals).width as i8
    }

    /// Whether the word's sign bit is not alone: to move it further up would change it.
    #[inline(always)]
    fn full<V: Value>(&self, long: Signal<V>) -> Signal<V> {
        let (sign, next) = (long.msb(), long.bits(long.format.width - 2, 1));
        (sign & !next) | (next & !sign)
    }

    /// A clock before the loop over channels: words are looked at one after the other, then moved.
    #[inline(always)]
    pub(super) fn align<V: Value>(&self, r: Registers<Signal<V>>, word: Signal<V>) -> Registers<Signal<V>> {
        let at = |step: u64| r.step.is(step);
        let most = u64::from(self.block);
        let moving = r.count.less_than(r.limit);
        let lower = at(MOVE) & !r.aligning & self.full(r.long) & moving;
        let shifted = r.long.scaled(1).fit(r.long.format, Exact, Wrap);
        let shifts = at(MOVE) & (moving | !r.aligning);
        let ends = at(KEEP);
        // With the last word of the terminals the limits change places, as with that of the sensing voltage.
        let sense = r.channel.is(self.terminals);
        let before_sense = r.channel.is(self.terminals - 1);
        let swaps = ends & r.quadrature & (before_sense | sense);
        let limit = lower.select(r.count, r.limit).fit(r.limit.format, Exact, Never);
        let fresh = (swaps & before_sense & !r.aligning).select(int(most), r.other);
        let further = (r.channel + int(1)).fit(r.channel.format, Exact, Wrap);
        let next = (ends & r.quadrature).select(sense.select(int(0), further), r.channel);
        let following = at(MOVE).select(
            r.count.is(most - 1).select(int(KEEP), int(MOVE)),
            ends.select((r.quadrature & sense & r.aligning).select(int(1), int(READ)), r.step + int(1)),
        );
        let counted = at(MOVE).select(r.count + int(1), int(0));
        Registers {
            step: following.fit(r.step.format, Exact, Wrap),
            long: at(LOAD).select(word, shifts.select(shifted, r.long)),
            count: counted.fit(r.count.format, Exact, Wrap),
            limit: swaps.select(fresh, limit),
            other: swaps.select(r.limit, r.other),
            quadrature: (ends & !r.quadrature) | (r.quadrature & !ends),
            channel: next.fit(r.channel.format, Exact, Wrap),
            aligning: r.aligning | (ends & r.quadrature & sense),
            ..r
        }
    }

    /// The word that is kept of a moved one, and whether this is the clock to keep it.
    #[inline(always)]
    pub(super) fn moved<V: Value>(&self, r: &Registers<Signal<V>>) -> (Signal<V>, Signal<V>) {
        let word = r.long.fit(self.iq, HalfEven, Saturate);
        (word.scaled(-(self.block as i8)), r.step.is(KEEP) & r.aligning)
    }

    /// A terminal's or the sensing voltage's word, read again.
    #[inline(always)]
    pub(super) fn narrow<V: Value>(&self, word: Signal<V>) -> Signal<V> {
        let narrow = Format { frac: word.format.frac, ..self.iq };
        word.fit(narrow, Exact, Wrap).scaled(self.block as i8)
    }

    /// A total's word, as wide as a terminal's.
    #[inline(always)]
    pub(super) fn narrow_total<V: Value>(&self, total: Signal<V>) -> Signal<V> {
        total.scaled(-self.down()).fit(self.iq, HalfEven, Never)
    }

    /// A clock of moving total and sensing voltage back.
    #[inline(always)]
    pub(super) fn restore<V: Value>(&self, r: Registers<Signal<V>>) -> Registers<Signal<V>> {
        let halved = |amplitude: Signal<V>, limit: Signal<V>| {
            let half = amplitude.scaled(-1);
            let half = half.fit(amplitude.format, Floor, Never).ideally(&[half], |of| of[0]);
            r.count.less_than(limit).select(half, amplitude)
        };
        let end = r.count.is(u64::from(self.block) - 1);
        Registers {
            step: end.select(int(0), r.step).fit(r.step.format, Exact, Wrap),
            count: (r.count + int(1)).fit(r.count.format, Exact, Wrap),
            whole: halved(r.whole, r.limit),
            sense: halved(r.sense, r.other),
            done: end,
            ..r
        }
    }

    /// An amplitude as it is given out, and whether it is held at a rail.
    #[inline(always)]
    pub(super) fn rounded<V: Value>(&self, amplitude: Signal<V>) -> (Signal<V>, Signal<V>) {
        amplitude.saturate(self.given, HalfEven)
    }

    /// What alignment begins with.
    #[inline(always)]
    pub(super) fn unaligned<V: Value>(&self, r: Registers<Signal<V>>) -> Registers<Signal<V>> {
        let most = int(u64::from(self.block));
        Registers { limit: most, count: int(0), quadrature: bit(false), aligning: bit(false), ..r }
    }
}
