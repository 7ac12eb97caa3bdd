// SPDX-License-Identifier: MIT OR Apache-2.0
//! Map: position and sheet resistance from the ratios, by tables.
//!
//! ```text
//! p_x = (r_x − origin_x)·scale_x,              p_y likewise                         the ratios' box becomes −1 … 1
//! v = spacing_y((p_y − middle_y(p_x)) · stretch_y(p_x))                             the curved long edges become ±1
//! u = spacing_x((p_x − middle_x(v)) · stretch_x(v))                                 then the short ones
//! x, y, R = table_x,y,R(u, v)                                                       bilinear
//! ```
//!
//! At an insulated edge the ratios stand still while the pad moves on (∂w/∂n = 0), and their image is a star that fills a
//! fifth of its box: a plain table of 33 × 33 is wrong by 3.5 mm rms, after straightening by 0.3 mm. All curves and tables
//! lie in one memory; one multiplier serves every interpolation.
//!
//! ```text
//!     near ─┐
//! far ─(−)──[difference]─(× factor)─[product]─(+ near)─[aligned]─[round half even, saturate]─ result
//! ```
//!
//! | signal            | format  | unit                           | overflow                                           |
//! | p, u, v, words    | profile | box, or full scale             | saturate, flagged                                  |
//! | stretch           | words   | `2^STRETCH_BITS`               | as above                                           |
//! | x, y              | words   | `2^POSITION_BITS` mm           | as above                                           |
//! | R                 | words   | full scales, voltage / current | held at zero from below                            |
//!
//! What an operation makes replaces what no later one needs: p_x becomes u, p_y becomes v. Latency: 19 operations of 10 clocks and a
//! product each, and a clock, from `start` to `done`. Source: paper, eqs. 2–3; PHYSICS §1 (det J > 0).

mod layout;
mod operation;
mod steps;

pub use layout::{Curve, Layout};

use super::multiplier::{self, Multiplier};
use crate::block::{Block, Cell};
use crate::format::{BIT, Format};
use crate::memory::{Memory, Write};
use crate::profile::Profile;
use crate::signal::{Exact, Signal, Value, Wrap, bit, int};
use crate::{bundle, next, parts};

bundle! {
    /// The inputs.
    pub struct Inputs {
        /// The ratios are there, and hold.
        start,
        /// The x ratio.
        r_x,
        /// The y ratio.
        r_y,
        /// Calibration: the x ratio in the middle of the box.
        origin_x,
        /// Calibration: one over half the box's width.
        scale_x,
        /// Calibration: the y ratio in the middle of the box.
        origin_y,
        /// Calibration: one over half the box's height.
        scale_y,
        /// Calibration: writes a word of the tables.
        write,
        /// Calibration: where.
        address,
        /// Calibration: what.
        word,
    }
}

bundle! {
    /// The outputs: registers.
    pub struct Outputs {
        /// Set for one clock when the others are there.
        done,
        /// The position along the long edges, in mm from the middle.
        x,
        /// The position along the short edges, in mm from the middle.
        y,
        /// The sheet's resistance at the pad, in full scales of voltage per current.
        sheet,
        /// Whether a word is held at a rail.
        saturated,
    }
}

bundle! {
    /// The registers. `near`, `difference` and `factor` are codes as integers; `first` and `second` are what the last two
    /// interpolations gave: the middle and the stretch of a curve, or the words above and below the pad.
    pub struct Registers {
        busy,
        operation: [
            "box_x", "box_y", "middle_y", "stretch_y", "straighten_y", "spacing_y", "middle_x", "stretch_x",
            "straighten_x", "spacing_x", "x_above", "x_below", "x", "y_above", "y_below", "y", "r_above", "r_below", "r",
        ],
        step: ["cell", "row", "look_up", "look_up_next", "near", "far", "difference", "multiply"],
        across, along, first, second, base, word, near, difference, factor, aligned, result, x, y, sheet, saturated, done,
    }
}

parts! {
    /// The memory within.
    pub struct Parts of Map {
        words: Memory,
        multiplier: Multiplier,
    }
}

/// Clocks of an operation, without its product.
const STEPS: u64 = 10;

/// The configuration.
#[derive(Debug, Clone)]
pub struct Map {
    words: Memory,
    multiplier: Multiplier,
    layout: Layout,
    ratio: Format,
    scale: Format,
    word: Format,
    weight: Format,
    /// Of the three kinds of operation: into the box, straighten, interpolate.
    products: [Format; 3],
    registers: Registers<Format>,
}

impl Map {
    /// A stretch is stored divided by `2^STRETCH_BITS`.
    pub const STRETCH_BITS: i8 = 5;

    /// The map of a profile, with nothing in its tables yet.
    pub fn new(profile: &Profile) -> Self {
        let (ratio, word, scale) = (profile.formats.ratio, profile.formats.map, profile.formats.map_scale);
        let layout = Layout::new(profile);
        // A slot whose tables are written meanwhile gives a frame of neither calibration in any case.
        let words = Memory::new("words", layout.words(), word).never_colliding();
        let fraction = word.width - layout.edge.min(layout.spacing).min(layout.table);
        let weight = Format::unsigned(fraction, fraction as i8);
        let near = Format::signed(word.width.max(ratio.width), 0);
        let difference = near.difference(near);
        let factor = Format::unsigned(weight.width.max(scale.width).max(word.width - 1), 0);
        let multiplier = Multiplier::new(difference, factor, profile.multiplier);
        let (span, stretch) = (word.difference(word), Format::unsigned(word.width - 1, word.frac - Map::STRETCH_BITS));
        let products = [ratio.difference(ratio).product(scale), span.product(stretch), span.product(weight)];
        let registers = Registers {
            busy: BIT,
            operation: Format::counter(operation::ALL - 1),
            step: Format::counter(STEPS + multiplier.latency() - 1),
            across: word,
            along: word,
            first: word,
            second: word,
            base: words.address(),
            word,
            near,
            difference,
            factor,
            aligned: products[0].join(products[1]).join(products[2].sum(word)),
            result: word,
            x: profile.position(),
            y: profile.position(),
            sheet: profile.sheet(),
            saturated: BIT,
            done: BIT,
        };
        Map { words, multiplier, layout, ratio, scale, word, weight, products, registers }
    }

    /// Clocks of an operation.
    fn steps(&self) -> u64 {
        STEPS + self.multiplier.latency()
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        operation::ALL * self.steps() + 1
    }

    /// The memory of curves and tables.
    pub fn words(&self) -> &Memory {
        &self.words
    }
}

impl Block for Map {
    const NAME: &'static str = "map";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = Parts<V>;

    #[inline]
    fn inputs(&self) -> Inputs<Format> {
        let (ratio, scale, address, word) = (self.ratio, self.scale, self.words.address(), self.word);
        Inputs {
            start: BIT,
            r_x: ratio,
            r_y: ratio,
            origin_x: ratio,
            scale_x: scale,
            origin_y: ratio,
            scale_y: scale,
            write: BIT,
            address,
            word,
        }
    }

    #[inline]
    fn outputs(&self) -> Outputs<Format> {
        let Registers { done, x, y, sheet, saturated, .. } = self.registers;
        Outputs { done, x, y, sheet, saturated }
    }

    #[inline(always)]
    fn registers(&self) -> Registers<Format> {
        let (r, word) = (self.registers, self.word);
        let position = r.x.with_point(word.frac - Profile::POSITION_BITS);
        Registers {
            busy: BIT,
            done: BIT,
            saturated: BIT,
            step: r.step.counting(),
            operation: r.operation.counting(),
            base: r.base.counting(),
            factor: r.factor.counting(),
            across: word,
            along: word,
            first: word,
            second: word,
            word,
            near: r.near.with_point(0),
            difference: r.difference.with_point(0),
            aligned: r.aligned,
            result: word,
            x: position,
            y: position,
            sheet: r.sheet,
        }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let outputs = Outputs { done: r.done, x: r.x, y: r.y, sheet: r.sheet, saturated: r.saturated };
        if (i.start | r.busy | r.done | i.write).idle() {
            return outputs;
        }
        let word = self.words.data(&mut cell.parts.words);
        let after = (r.base + r.step.is(3)).fit(r.base.format, Exact, Wrap);
        self.words.access(&mut cell.parts.words, after, Write { enable: i.write, address: i.address, data: i.word });
        let inputs = multiplier::Inputs { enable: r.busy, left: r.difference, right: r.factor };
        let product = self.multiplier.call("multiplier", &mut cell.parts.multiplier, inputs).product;
        let idle = Registers { done: bit(false), ..r };
        let begin = Registers { busy: bit(true), operation: int(0), step: int(0), saturated: bit(false), ..idle };
        next!(V, Registers, self, cell, i.start => begin, r.busy => self.work(idle, i, (word, product)), else idle);
        outputs
    }
}
