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

pub use layout::{Curve, Layout};

use super::multiplier::{self, Multiplier};
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

const FRACTION: &str = "a number less its floor is below one";

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

    /// A coordinate of −1 … 1 as the cell of `2^bits` in which it lies, and how far into it.
    #[inline(always)]
    fn cell_of<V: Value>(&self, coordinate: Signal<V>, bits: u8) -> (Signal<V>, Signal<V>) {
        let one = int(1);
        let positive = (coordinate + one).fit(Format::unsigned(self.word.width, self.word.frac), Exact, Never);
        let cells = positive.scaled(bits as i8 - 1);
        let index = cells.fit(Format::unsigned(bits, 0), Floor, Never);
        (index, (cells - index).fit(self.weight, Exact, Lemma(FRACTION)))
    }

    /// What the operation is.
    #[inline(always)]
    fn kind<V: Value>(&self, operation: Signal<V>) -> Kind<V> {
        use operation::*;
        let at = |which: u64| operation.is(which);
        let in_layers = |which: u64| at(LAYERS + which) | at(LAYERS + 3 + which) | at(LAYERS + 6 + which);
        Kind {
            boxed: (at(BOX_X) | at(BOX_Y)).named("boxed"),
            straightened: (at(STRAIGHTEN_Y) | at(STRAIGHTEN_X)).named("straightened"),
            spaced: (at(SPACING_Y) | at(SPACING_X)).named("spaced"),
            tables: (!operation.less_than(int(LAYERS))).named("tables"),
            below: in_layers(1).named("below"),
            between: in_layers(2).named("between"),
        }
    }

    /// The coordinate that an operation looks at: across the sheet's length (x), or along its other side (y).
    #[inline(always)]
    fn coordinate<V: Value>(&self, r: &Registers<Signal<V>>, kind: &Kind<V>) -> Signal<V> {
        use operation::*;
        let at = |which: u64| r.operation.is(which);
        let of_x = at(MIDDLE_Y) | at(STRETCH_Y) | at(STRAIGHTEN_X) | at(SPACING_X) | (kind.tables & !kind.between);
        of_x.select(r.across, r.along).named("coordinate")
    }

    /// Where the curve or table of an operation begins in the memory.
    #[inline(always)]
    fn offset<V: Value>(&self, operation: Signal<V>) -> Signal<V> {
        use operation::*;
        let at = |which: u64| operation.is(which);
        let curve = |curve: Curve| int(self.layout.curve(curve) as u64);
        let table = |layer: usize| int(self.layout.table(layer) as u64);
        let layer = |k: u64| !operation.less_than(int(LAYERS + 3 * k));
        let curves = [
            (MIDDLE_Y, Curve::MiddleY),
            (STRETCH_Y, Curve::StretchY),
            (MIDDLE_X, Curve::MiddleX),
            (STRETCH_X, Curve::StretchX),
            (SPACING_Y, Curve::SpacingY),
        ];
        let of_curve =
            curves.iter().fold(curve(Curve::SpacingX), |rest, &(which, of)| at(which).select(curve(of), rest));
        let of_table = layer(2).select(table(2), layer(1).select(table(1), table(0)));
        layer(0).select(of_table, of_curve)
    }

    /// First: the cell in which the coordinate lies, and what the difference is multiplied by.
    #[inline(always)]
    fn cell<V: Value>(&self, r: Registers<Signal<V>>, i: &Inputs<Signal<V>>, kind: &Kind<V>) -> Registers<Signal<V>> {
        let along_x = r.operation.is(operation::BOX_X);
        let coordinate = self.coordinate(&r, kind);
        let [edge, spacing, table] =
            [self.layout.edge, self.layout.spacing, self.layout.table].map(|bits| self.cell_of(coordinate, bits));
        let choose = |table: Signal<V>, spacing: Signal<V>, edge: Signal<V>| {
            kind.tables.select(table, kind.spaced.select(spacing, edge))
        };
        let (index, weight) = (choose(table.0, spacing.0, edge.0), choose(table.1, spacing.1, edge.1));
        let stretch = r.second.fit(Format::unsigned(self.word.width - 1, self.word.frac), Exact, Saturate).integer();
        let scale = along_x.select(i.scale_x, i.scale_y).integer();
        let origin = along_x.select(i.origin_x, i.origin_y);
        let factor = kind.straightened.select(stretch, weight.integer());
        Registers {
            base: (self.offset(r.operation) + index).fit(self.registers.base, Exact, Wrap),
            near: kind.boxed.select(origin.integer(), r.first.integer()),
            difference: self.far(&r, i, kind),
            factor: kind.boxed.select(scale, factor),
            ..r
        }
    }

    /// Then, in a table: the row above the pad, or the one below it.
    #[inline(always)]
    fn row<V: Value>(&self, r: Registers<Signal<V>>, kind: &Kind<V>) -> Registers<Signal<V>> {
        let bits = self.layout.table;
        let row = self.cell_of(r.along, bits).0 + kind.below;
        let rows = row.concat(zero(Format::unsigned(bits, 0))) + row;
        Registers { base: kind.tables.select(r.base + rows, r.base).fit(self.registers.base, Exact, Wrap), ..r }
    }

    /// What the difference is taken of where it is no word of the memory: a ratio, a coordinate, or the word below.
    #[inline(always)]
    fn far<V: Value>(&self, r: &Registers<Signal<V>>, i: &Inputs<Signal<V>>, kind: &Kind<V>) -> Signal<V> {
        let ratio = r.operation.is(operation::BOX_X).select(i.r_x, i.r_y);
        let coordinate = r.operation.is(operation::STRAIGHTEN_X).select(r.across, r.along);
        kind.boxed.select(ratio.integer(), kind.straightened.select(coordinate.integer(), r.second.integer()))
    }

    /// The product with its point, and in an interpolation what it starts from.
    #[inline(always)]
    fn aligned<V: Value>(&self, r: &Registers<Signal<V>>, kind: &Kind<V>, product: Signal<V>) -> Signal<V> {
        let [boxed, straight, between] =
            self.products.map(|format| product.fit(Format { frac: 0, ..format }, Exact, Wrap).scaled(-format.frac));
        let near = r.near.fit(Format { frac: 0, ..self.word }, Exact, Wrap).scaled(-self.word.frac);
        kind.boxed.select(boxed, kind.straightened.select(straight, between + near))
    }

    /// Last: the result goes where the operation says.
    #[inline(always)]
    fn finish<V: Value>(&self, r: Registers<Signal<V>>, kind: &Kind<V>) -> Registers<Signal<V>> {
        use operation::*;
        let at = |operation: u64| r.operation.is(operation);
        let result = r.result;
        let mm = result.scaled(Profile::POSITION_BITS);
        let end = at(ALL - 1);
        let of_x = (at(BOX_X) | at(STRAIGHTEN_X) | at(SPACING_X)).named("of_x");
        let of_y = (at(BOX_Y) | at(STRAIGHTEN_Y) | at(SPACING_Y)).named("of_y");
        let second = at(STRETCH_Y) | at(STRETCH_X) | kind.below;
        Registers {
            busy: !end,
            operation: end.select(int(0), r.operation + int(1)).fit(self.registers.operation, Exact, Never),
            step: int(0),
            across: of_x.select(result, r.across),
            along: of_y.select(result, r.along),
            first: (of_x | of_y | second).select(r.first, result),
            second: second.select(result, r.second),
            x: at(LAYERS + 2).select(mm, r.x),
            y: at(LAYERS + 5).select(mm, r.y),
            sheet: end.select(result.fit(self.registers.sheet, Exact, Saturate), r.sheet),
            done: end,
            ..r
        }
    }

    /// Before: the result is rounded.
    #[inline(always)]
    fn round<V: Value>(&self, r: Registers<Signal<V>>) -> Registers<Signal<V>> {
        let (result, held) = r.aligned.saturate(self.word, HalfEven);
        Registers { result, saturated: r.saturated | held, ..r }
    }

    #[inline(always)]
    fn work<V: Value>(
        &self,
        r: Registers<Signal<V>>,
        i: Inputs<Signal<V>>,
        (word, product): (Signal<V>, Signal<V>),
    ) -> Registers<Signal<V>> {
        let at = |step: u64| r.step.is(step);
        let kind = self.kind(r.operation);
        let moved = Registers { step: (r.step + int(1)).fit(self.registers.step, Exact, Wrap), word, ..r };
        when!(
            V,
            Registers,
            at(0),
            self.cell(moved, &i, &kind),
            when!(
                V,
                Registers,
                at(1),
                self.row(moved, &kind),
                when!(
                    V,
                    Registers,
                    at(self.steps() - 3),
                    Registers { aligned: self.aligned(&r, &kind, product), ..moved },
                    when!(
                        V,
                        Registers,
                        at(self.steps() - 2),
                        self.round(moved),
                        when!(
                            V,
                            Registers,
                            at(self.steps() - 1),
                            self.finish(moved, &kind),
                            self.subtract(moved, &kind, r.word)
                        )
                    )
                )
            )
        )
    }

    /// Between: the words that were asked for, and the difference.
    #[inline(always)]
    fn subtract<V: Value>(&self, r: Registers<Signal<V>>, kind: &Kind<V>, word: Signal<V>) -> Registers<Signal<V>> {
        let before = |step: u64| r.step.is(step + 1);
        let reads = !(kind.boxed | kind.straightened | kind.between);
        let difference = (r.difference - r.near).fit(self.registers.difference, Exact, Wrap);
        let far = (before(5) & reads).select(word.integer(), r.difference);
        Registers {
            near: (before(4) & reads).select(word.integer(), r.near),
            difference: before(6).select(difference, far),
            ..r
        }
    }
}

/// Which kinds of operation one is.
struct Kind<V> {
    /// Brings a ratio into the box.
    boxed: Signal<V>,
    /// Straightens an edge.
    straightened: Signal<V>,
    /// Evens out the spacing.
    spaced: Signal<V>,
    /// Looks up a table.
    tables: Signal<V>,
    /// In the row below the pad.
    below: Signal<V>,
    /// Between the two rows.
    between: Signal<V>,
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
        let after = (r.base + r.step.is(3)).fit(self.registers.base, Exact, Wrap);
        self.words.access(&mut cell.parts.words, after, Write { enable: i.write, address: i.address, data: i.word });
        let inputs = multiplier::Inputs { enable: r.busy, left: r.difference, right: r.factor };
        let product = self.multiplier.call("multiplier", &mut cell.parts.multiplier, inputs).product;
        let idle = Registers { done: bit(false), ..r };
        let begin = Registers { busy: bit(true), operation: int(0), step: int(0), saturated: bit(false), ..idle };
        let next =
            when!(V, Registers, i.start, begin, when!(V, Registers, r.busy, self.work(idle, i, (word, product)), idle));
        cell.store(self, next);
        outputs
    }
}
