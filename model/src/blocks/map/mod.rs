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
//! near, far ─[difference]─(× weight)─[product]─(+ near)─[round half even, saturate]─ result
//! ```
//!
//! | signal            | format  | unit                           | overflow                                           |
//! | p, u, v, words    | profile | box, or full scale             | saturate, flagged                                  |
//! | stretch           | words   | `2^STRETCH_BITS`               | as above                                           |
//! | x, y              | words   | `2^POSITION_BITS` mm           | as above                                           |
//! | R                 | words   | full scales, voltage / current | held at zero from below                            |
//!
//! Latency: 19 operations of 6 clocks + 1 from `start` to `done`. Source: paper, eqs. 2–3; PHYSICS §1 (det J > 0).

mod layout;

pub use layout::{Curve, Layout};

use crate::block::{Block, Cell};
use crate::format::{BIT, Format};
use crate::memory::{Memory, Write};
use crate::profile::Profile;
use crate::signal::{Exact, Floor, HalfEven, Lemma, Never, Saturate, Signal, Value, Wrap, bit, int, zero};
use crate::{bundle, parts, when};

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
    /// The registers. `difference`, `factor` and `product` are codes as integers.
    pub struct Registers {
        busy,
        operation: [
            "box_x", "box_y", "middle_y", "stretch_y", "straighten_y", "spacing_y", "middle_x", "stretch_x",
            "straighten_x", "spacing_x", "x_above", "x_below", "x", "y_above", "y_below", "y", "r_above", "r_below", "r",
        ],
        step: ["coordinate", "near", "far", "difference", "multiply", "finish"],
        p_x, p_y, middle, stretch, u, v, above, below, base, near, difference, factor, product, x, y, sheet,
        saturated, done,
    }
}

parts! {
    /// The memory within.
    pub struct Parts of Map {
        words: Memory,
    }
}

/// The operations, in their order; after the last come those of the three layers.
mod operation {
    pub const BOX_X: u64 = 0;
    pub const BOX_Y: u64 = 1;
    pub const MIDDLE_Y: u64 = 2;
    pub const STRETCH_Y: u64 = 3;
    pub const STRAIGHTEN_Y: u64 = 4;
    pub const SPACING_Y: u64 = 5;
    pub const MIDDLE_X: u64 = 6;
    pub const STRETCH_X: u64 = 7;
    pub const STRAIGHTEN_X: u64 = 8;
    pub const SPACING_X: u64 = 9;
    /// Of each of three layers: along the row above, along the row below, between the two.
    pub const LAYERS: u64 = 10;
    pub const ALL: u64 = LAYERS + 9;
}

/// Clocks of an operation.
const STEPS: u64 = 6;

/// The configuration.
#[derive(Debug, Clone)]
pub struct Map {
    words: Memory,
    layout: Layout,
    ratio: Format,
    scale: Format,
    word: Format,
    weight: Format,
    registers: Registers<Format>,
}

const FRACTION: &str = "a number less its floor is below one";

impl Map {
    /// A stretch is stored divided by `2^STRETCH_BITS`.
    pub const STRETCH_BITS: i8 = 5;

    /// The map of a profile, with nothing in its tables yet.
    pub fn new(profile: &Profile) -> Self {
        let (ratio, word, scale) = (profile.formats.ratio, profile.formats.map, profile.formats.map_scale);
        let layout = Layout::new(profile);
        let words = Memory::new("words", layout.words(), word);
        let fraction = word.width - layout.edge.min(layout.spacing).min(layout.table);
        let weight = Format::unsigned(fraction, fraction as i8);
        let difference = Format::signed(word.width.max(ratio.width) + 1, 0);
        let factor = Format::unsigned(weight.width.max(scale.width).max(word.width - 1), 0);
        let registers = Registers {
            busy: BIT,
            operation: Format::counter(operation::ALL - 1),
            step: Format::counter(STEPS - 1),
            p_x: word,
            p_y: word,
            middle: word,
            stretch: word,
            u: word,
            v: word,
            above: word,
            below: word,
            base: words.address(),
            near: word,
            difference,
            factor,
            product: difference.product(factor),
            x: profile.position(),
            y: profile.position(),
            sheet: profile.sheet(),
            saturated: BIT,
            done: BIT,
        };
        Map { words, layout, ratio, scale, word, weight, registers }
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        operation::ALL * STEPS + 1
    }

    /// The memory of curves and tables.
    pub fn words(&self) -> &Memory {
        &self.words
    }

    /// A coordinate of −1 … 1 as the cell of `2^bits` in which it lies, and how far into it.
    #[inline(always)]
    fn cell_of<V: Value>(&self, coordinate: Signal<V>, bits: u8) -> (Signal<V>, Signal<V>) {
        let one = int(1);
        let positive = (coordinate + one).fit(Format::unsigned(self.word.width, self.word.frac), Exact, Never);
        let cells = positive.scaled(bits as i8 - 1);
        let index = cells.fit(Format::unsigned(bits, 0), Floor, Never);
        (index, (cells - index).fit(self.weight, Exact, Lemma(FRACTION)))
    }

    /// The address at which an operation reads, and the weight of the word after it.
    #[inline(always)]
    fn place<V: Value>(&self, r: &Registers<Signal<V>>) -> (Signal<V>, Signal<V>) {
        use operation::*;
        let at = |operation: u64| r.operation.is(operation);
        let offset = |curve: Curve| int(self.layout.curve(curve) as u64);
        let straight = at(MIDDLE_Y) | at(STRETCH_Y);
        let (edge, edge_weight) = self.cell_of(straight.select(r.p_x, r.v), self.layout.edge);
        let (spacing, spacing_weight) = self.cell_of(at(SPACING_Y).select(r.v, r.u), self.layout.spacing);
        let edge_offset = straight.select(
            at(MIDDLE_Y).select(offset(Curve::MiddleY), offset(Curve::StretchY)),
            at(MIDDLE_X).select(offset(Curve::MiddleX), offset(Curve::StretchX)),
        );
        let spacing_offset = at(SPACING_Y).select(offset(Curve::SpacingY), offset(Curve::SpacingX));
        let spaced = at(SPACING_Y) | at(SPACING_X);
        let curve = spaced.select(spacing_offset + spacing, edge_offset + edge);
        let (node, node_weight) = self.node(r);
        let tables = r.operation.at_least(int(LAYERS));
        let weight = tables.select(node_weight, spaced.select(spacing_weight, edge_weight));
        (tables.select(node, curve).fit(self.registers.base, Exact, Lemma(WITHIN)), weight)
    }

    /// Of the tables: the node left of the pad in the row above or below it, and the weight of the next.
    #[inline(always)]
    fn node<V: Value>(&self, r: &Registers<Signal<V>>) -> (Signal<V>, Signal<V>) {
        let bits = self.layout.table;
        let (column, across) = self.cell_of(r.u, bits);
        let (row, down) = self.cell_of(r.v, bits);
        let row = row + self.below(r);
        let rows = row.concat(zero(Format::unsigned(bits, 0))) + row;
        let offset = |layer: usize| int(self.layout.table(layer) as u64);
        let layer = |k: u64| r.operation.at_least(int(operation::LAYERS + 3 * k));
        let offset = layer(2).select(offset(2), layer(1).select(offset(1), offset(0)));
        (offset + rows + column, self.between(r).select(down, across))
    }

    /// Whether the operation is the one of its kind in any of the layers.
    #[inline(always)]
    fn in_layers<V: Value>(&self, r: &Registers<Signal<V>>, which: u64) -> Signal<V> {
        let at = |layer: u64| r.operation.is(operation::LAYERS + 3 * layer + which);
        at(0) | at(1) | at(2)
    }

    #[inline(always)]
    fn below<V: Value>(&self, r: &Registers<Signal<V>>) -> Signal<V> {
        self.in_layers(r, 1)
    }

    #[inline(always)]
    fn between<V: Value>(&self, r: &Registers<Signal<V>>) -> Signal<V> {
        self.in_layers(r, 2)
    }

    /// Whether the operation multiplies a difference that needs no look-up: box or straighten.
    #[inline(always)]
    fn kinds<V: Value>(&self, r: &Registers<Signal<V>>) -> (Signal<V>, Signal<V>) {
        use operation::*;
        let at = |operation: u64| r.operation.is(operation);
        (at(BOX_X) | at(BOX_Y), at(STRAIGHTEN_Y) | at(STRAIGHTEN_X))
    }

    /// The first step: where to read and with which weight, or what to multiply straight away.
    #[inline(always)]
    fn coordinate<V: Value>(&self, r: Registers<Signal<V>>, i: Inputs<Signal<V>>) -> Registers<Signal<V>> {
        let at = |operation: u64| r.operation.is(operation);
        let (boxed, straightened) = self.kinds(&r);
        let between = self.between(&r);
        let (base, weight) = self.place(&r);
        let along_x = at(operation::BOX_X);
        let from_origin = along_x.select(i.r_x, i.r_y) - along_x.select(i.origin_x, i.origin_y);
        let from_middle = at(operation::STRAIGHTEN_Y).select(r.p_y, r.p_x) - r.middle;
        let stretch = r.stretch.fit(Format::unsigned(self.word.width - 1, self.word.frac), Exact, Saturate);
        let scale = along_x.select(i.scale_x, i.scale_y);
        let of_rows = r.below - r.above;
        let difference = straightened.select(from_middle.integer(), of_rows.integer());
        let factor = straightened.select(stretch.integer(), weight.integer());
        Registers {
            base,
            near: between.select(r.above, r.near),
            difference: boxed.select(from_origin.integer(), difference),
            factor: boxed.select(scale.integer(), factor),
            ..r
        }
    }

    /// The last step: the product, rounded, goes where the operation says.
    #[inline(always)]
    fn finish<V: Value>(&self, r: Registers<Signal<V>>) -> Registers<Signal<V>> {
        use operation::*;
        let at = |operation: u64| r.operation.is(operation);
        let product = |left: Format, right: Format| {
            let format = left.product(right);
            r.product.fit(Format { frac: 0, ..format }, Exact, Wrap).scaled(-format.frac)
        };
        let (word, span) = (self.word, self.word.difference(self.word));
        let (boxed, straightened) = self.kinds(&r);
        let in_box = product(self.ratio.difference(self.ratio), self.scale).saturate(word, HalfEven);
        let stretch = Format::unsigned(word.width - 1, word.frac);
        let straight = product(span, stretch).scaled(Map::STRETCH_BITS).saturate(word, HalfEven);
        let between = (r.near + product(span, self.weight)).saturate(word, HalfEven);
        let result = boxed.select(in_box.0, straightened.select(straight.0, between.0));
        let held = boxed.select(in_box.1, straightened.select(straight.1, between.1));
        let to = |operation: u64, register: Signal<V>| at(operation).select(result, register);
        let either = |a: u64, b: u64, register: Signal<V>| (at(a) | at(b)).select(result, register);
        let mm = result.scaled(Profile::POSITION_BITS);
        let end = at(ALL - 1);
        Registers {
            busy: !end,
            operation: end.select(int(0), r.operation + int(1)).fit(self.registers.operation, Exact, Never),
            p_x: to(BOX_X, r.p_x),
            p_y: to(BOX_Y, r.p_y),
            middle: either(MIDDLE_Y, MIDDLE_X, r.middle),
            stretch: either(STRETCH_Y, STRETCH_X, r.stretch),
            v: either(STRAIGHTEN_Y, SPACING_Y, r.v),
            u: either(STRAIGHTEN_X, SPACING_X, r.u),
            above: self.in_layers(&r, 0).select(result, r.above),
            below: self.below(&r).select(result, r.below),
            x: at(LAYERS + 2).select(mm, r.x),
            y: at(LAYERS + 5).select(mm, r.y),
            sheet: end.select(result.fit(self.registers.sheet, Exact, Saturate), r.sheet),
            saturated: r.saturated | held,
            done: end,
            ..r
        }
    }

    #[inline(always)]
    fn work<V: Value>(&self, r: Registers<Signal<V>>, i: Inputs<Signal<V>>, word: Signal<V>) -> Registers<Signal<V>> {
        let at = |step: u64| r.step.is(step);
        let (boxed, straightened) = self.kinds(&r);
        let reads = !(boxed | straightened | self.between(&r));
        let moved = Registers {
            step: at(STEPS - 1).select(int(0), r.step + int(1)).fit(self.registers.step, Exact, Never),
            near: (at(2) & reads).select(word, r.near),
            difference: (at(3) & reads).select((word - r.near).integer(), r.difference),
            product: at(4).select(r.difference * r.factor, r.product),
            ..r
        };
        when!(
            V,
            Registers,
            at(0),
            self.coordinate(moved, i),
            when!(V, Registers, at(STEPS - 1), self.finish(moved), moved)
        )
    }
}

const WITHIN: &str = "the cells of a curve or table lie within the memory";

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
        let r = self.registers;
        Registers {
            busy: BIT,
            done: BIT,
            saturated: BIT,
            step: r.step.counting(),
            operation: r.operation.counting(),
            base: r.base.counting(),
            factor: r.factor.counting(),
            ..r
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
        let after = (r.base + r.step.is(2)).fit(self.registers.base, Exact, Wrap);
        self.words.access(&mut cell.parts.words, after, Write { enable: i.write, address: i.address, data: i.word });
        let idle = Registers { done: bit(false), ..r };
        let begin = Registers { busy: bit(true), operation: int(0), step: int(0), saturated: bit(false), ..idle };
        let next = when!(V, Registers, i.start, begin, when!(V, Registers, r.busy, self.work(idle, i, word), idle));
        cell.store(self, next);
        outputs
    }
}
