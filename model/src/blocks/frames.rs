// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames: a slot's results as words one after the other; where they are invalid, the pad's last valid ones.
//!
//! ```text
//! results ─(one by one)─┬──(valid ?)── word
//!                       └─[held: fields of every pad]─┘
//! ```
//!
//! Words are codes as integers, in the formats of [`Field::format`]. The haptic mean square is always valid and never held.
//! Latency: fields + 2 clocks from `start` to the last word. Source: DESIGN §3 (invalid: last value held).

use crate::block::{Block, Cell};
use crate::format::{BIT, Format};
pub use crate::frame::Field;
use crate::memory::{Memory, Write};
use crate::profile::Profile;
use crate::signal::{Exact, HalfEven, Never, Saturate, Signal, Value, bit, int};
use crate::{bundle, next, parts};

bundle! {
    /// The inputs.
    pub struct Inputs {
        /// All others are there, and hold.
        start,
        /// The pad.
        pad,
        /// The results are invalid: those held go out.
        invalid,
        /// As [`Field::RatioX`].
        r_x,
        /// As [`Field::RatioY`].
        r_y,
        /// As [`Field::X`].
        x,
        /// As [`Field::Y`].
        y,
        /// As [`Field::Sheet`].
        sheet,
        /// As [`Field::Capacitance`].
        capacitance,
        /// As [`Field::Force`].
        haptic_force,
        /// As [`Field::MeanSquare`].
        mean_square,
    }
}

bundle! {
    /// The outputs: registers.
    pub struct Outputs {
        /// Set for a clock for each word.
        valid,
        /// Which field the word is.
        index,
        /// The word.
        word,
        /// Set with the last word.
        done,
    }
}

bundle! {
    /// The registers.
    pub struct Registers {
        busy, count, index, valid, word, done,
    }
}

parts! {
    /// The memory within.
    pub struct Parts of Frames {
        held: Memory,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct Frames {
    held: Memory,
    inputs: Inputs<Format>,
    registers: Registers<Format>,
}

/// Fields in a frame.
const FIELDS: u64 = Field::ALL.len() as u64;

impl Frames {
    /// The frames of a profile.
    pub fn new(profile: &Profile) -> Self {
        let of = |field: Field| field.format(profile);
        let word = Field::word(profile);
        let pad = Format::counter(profile.pads - 1);
        let inputs = Inputs {
            start: BIT,
            pad,
            invalid: BIT,
            r_x: of(Field::RatioX),
            r_y: of(Field::RatioY),
            x: of(Field::X),
            y: of(Field::Y),
            sheet: of(Field::Sheet),
            capacitance: of(Field::Capacitance),
            haptic_force: of(Field::Force),
            mean_square: of(Field::MeanSquare),
        };
        let registers = Registers {
            busy: BIT,
            count: Format::counter(FIELDS),
            index: Format::counter(FIELDS - 1),
            valid: BIT,
            word,
            done: BIT,
        };
        let words = (1usize << pad.width) * Field::ALL.len();
        Frames { held: Memory::new("held", words, word).never_colliding(), inputs, registers }
    }

    /// Clocks from `start` to the last word.
    pub fn latency(&self) -> u64 {
        FIELDS + 2
    }

    /// A ratio as frames carry it.
    #[inline(always)]
    pub fn ratio<V: Value>(&self, ratio: Signal<V>) -> Signal<V> {
        let format = self.inputs.r_x;
        if ratio.format == format { ratio } else { ratio.fit(format, HalfEven, Saturate) }
    }

    /// The result that is the field `index`, as an integer.
    #[inline(always)]
    fn result<V: Value>(&self, i: &Inputs<Signal<V>>, index: Signal<V>) -> Signal<V> {
        let fields = [i.r_x, i.r_y, i.x, i.y, i.sheet, i.capacitance, i.haptic_force, i.mean_square];
        let word = |k: usize| fields[k].integer().fit(self.registers.word.with_point(0), Exact, Never);
        // A tree of multiplexers, a level for each bit of the index.
        let pair = |k: usize| index.bits(0, 1).select(word(2 * k + 1), word(2 * k));
        let four = |k: usize| index.bits(1, 1).select(pair(2 * k + 1), pair(2 * k));
        index.bits(2, 1).select(four(1), four(0))
    }
}

impl Block for Frames {
    const NAME: &'static str = "frames";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = Parts<V>;

    #[inline]
    fn inputs(&self) -> Inputs<Format> {
        self.inputs
    }

    #[inline]
    fn outputs(&self) -> Outputs<Format> {
        let Registers { valid, index, word, done, .. } = self.registers;
        Outputs { valid, index, word, done }
    }

    #[inline(always)]
    fn registers(&self) -> Registers<Format> {
        let r = self.registers;
        Registers {
            busy: BIT,
            done: BIT,
            valid: BIT,
            count: r.count.counting(),
            index: r.index.counting(),
            word: r.word.with_point(0),
        }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let outputs = Outputs { valid: r.valid, index: r.index, word: r.word, done: r.done };
        if (i.start | r.busy | r.valid).idle() {
            return outputs;
        }
        // While the word of `count − 1` goes out, that of `count` is asked for.
        let before = (r.count - int(1)).bits(0, self.registers.index.width);
        let emits = (r.busy & !r.count.is(0)).named("emits");
        let held = self.held.data(&mut cell.parts.held);
        let never_held = before.is(FIELDS - 1);
        let word = (i.invalid & !never_held).select(held, self.result(&i, before));
        let place = |index: Signal<V>| i.pad.concat(index.bits(0, self.registers.index.width));
        let write = Write { enable: r.valid, address: place(r.index), data: r.word };
        self.held.access(&mut cell.parts.held, place(r.count), write);
        let end = r.count.is(FIELDS);
        let working = Registers {
            busy: r.busy & !end,
            count: r.busy.select(r.count + int(1), r.count).fit(r.count.format, Exact, crate::signal::Wrap),
            index: emits.select(before, r.index),
            valid: emits,
            word: emits.select(word, r.word),
            done: emits & end,
        };
        let begin = Registers { busy: bit(true), count: int(0), valid: bit(false), done: bit(false), ..r };
        next!(V, Registers, self, cell, i.start => begin, else working);
        outputs
    }
}
