// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames: a slot's results as words one after the other; where they are invalid, the pad's last
//! valid ones, and of a lifted pad its last valid place.
//!
//! ```text
//! results ─(one by one)─┬──(valid, touching ?)── word
//!                       └─[held: fields of every pad]─┘
//! ```
//!
//! Words are codes as integers, in the formats of [`Field::format`]. The haptic mean square is
//! always valid and never held. Ratios, position and sheet resistance of a lifted pad are held, since currents so small tell no
//! place; its capacitance and force are the slot's. Latency: fields + 2 clocks from `start` to the last word. Source:
//! docs/decisions.md §13 (invalid: last value held).

use super::rests::Rests;
use hapticore_contract::frame::Field;
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{HalfEven, Proved, Saturate, Signal, Wrap, bit, int};
use hapticore_hdl::{block, next};

block! {
    /// The frames of all pads.
    pub struct Frames("frames") {
        pad: Format,
        word: Format,
        /// The format of each field.
        fields: [Format; Field::ALL.len()],
    }
    submodules {
        held: Memory,
    }
    inputs(frames) {
        /// Begins; all others are valid and stable until `done`.
        start: BIT,
        pad: frames.pad,
        /// The results are invalid: the pad's last valid ones are given out instead.
        invalid: BIT,
        /// The pad does not touch: its last valid place is given out instead.
        lifted: BIT,
        /// Ratio r_x, eq. 2.
        r_x: frames.fields[0],
        /// Ratio r_y, eq. 3.
        r_y: frames.fields[1],
        /// Position along the long edges, mm.
        x: frames.fields[2],
        /// Position along the short edges, mm.
        y: frames.fields[3],
        /// Resistance of the sheet at the pad, full scales of voltage per current.
        sheet: frames.fields[4],
        /// Capacitance between pad and sheet, pF.
        capacitance: frames.fields[5],
        /// Haptic force, N.
        haptic_force: frames.fields[6],
        /// Mean square of the haptic voltage, full scale².
        mean_square: frames.fields[7],
    }
    outputs(frames) {
        /// Asserted for one cycle for each word.
        valid: BIT,
        /// The number of the word's field.
        index: INDEX,
        word: frames.word(),
        /// Asserted with the last word.
        done: BIT,
    }
    registers(frames) {
        busy: BIT,
        count: Format::counter(FIELDS),
        index: INDEX,
        valid: BIT,
        word: frames.word(),
        done: BIT,
    }
}

/// Fields in a frame.
const FIELDS: u64 = Field::ALL.len() as u64;
/// Fields of the place: all before the capacitance.
const PLACE: u64 = Field::Capacitance as u64;
const INDEX: Format = Format::counter(FIELDS - 1);

impl Frames {
    /// The frames of a profile.
    pub fn new(profile: &Profile) -> Self {
        let (pad, word) = (Format::counter(profile.pads - 1), Field::word(profile));
        let words = (FIELDS as usize) << pad.width;
        let held = Memory::new("held", words, word).dont_care_on_collision();
        Frames { pad, word, fields: Field::ALL.map(|field| field.format(profile)), held }
    }

    /// The format of a frame's word.
    #[inline(always)]
    fn word(&self) -> Format {
        self.word.assume_frac(0)
    }

    /// Clocks from `start` to the last word.
    pub fn latency(&self) -> u64 {
        FIELDS + 2
    }

    /// A ratio as frames carry it.
    #[inline(always)]
    pub fn ratio<V: Interpretation>(&self, ratio: Signal<V>) -> Signal<V> {
        let format = self.fields[0];
        if ratio.format == format { ratio } else { ratio.quantize(format, HalfEven, Saturate) }
    }

    /// The result that is the field `index`, as an integer.
    #[inline(always)]
    fn result<V: Interpretation>(&self, i: &In<V>, index: Signal<V>) -> Signal<V> {
        let fields =
            [i.r_x, i.r_y, i.x, i.y, i.sheet, i.capacitance, i.haptic_force, i.mean_square];
        let word = |k: usize| fields[k].integer().resize(self.word(), Proved);
        // A tree of multiplexers, a level for each bit of the index.
        let pair = |k: usize| index.bits(0, 1).select(word(2 * k + 1), word(2 * k));
        let four = |k: usize| index.bits(1, 1).select(pair(2 * k + 1), pair(2 * k));
        index.bits(2, 1).select(four(1), four(0))
    }
}

impl Rests for Frames {
    #[inline(always)]
    fn under_way<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        r.busy | r.valid
    }
}

impl Block for Frames {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let outputs = Outputs { valid: r.valid, index: r.index, word: r.word, done: r.done };
        if (i.start | self.under_way(&r)).can_skip() {
            return outputs;
        }
        // While the word of `count − 1` goes out, that of `count` is asked for.
        let before = (r.count - int(1)).bits(0, INDEX.width);
        let emits = (r.busy & !r.count.is(0)).named("emits");
        let held = self.held.data(&mut state.submodules.held);
        let never_held = before.is(FIELDS - 1);
        let of_place = before.less_than(int(PLACE));
        let holds = (i.invalid & !never_held) | (i.lifted & of_place);
        let word = holds.select(held, self.result(&i, before));
        let place = |index: Signal<V>| i.pad.concat(index.bits(0, INDEX.width));
        let write = Write { enable: r.valid, address: place(r.index), data: r.word };
        self.held.access(&mut state.submodules.held, place(r.count), write);
        let end = r.count.is(FIELDS);
        let working = Registers {
            busy: r.busy & !end,
            count: r.busy.select(r.count + int(1), r.count).resize(r.count.format, Wrap),
            index: emits.select(before, r.index),
            valid: emits,
            word: emits.select(word, r.word),
            done: emits & end,
        };
        let begin =
            Registers { busy: bit(true), count: int(0), valid: bit(false), done: bit(false), ..r };
        next!(self, state, i.start => begin, else working);
        outputs
    }
}

#[cfg(test)]
mod tests;
