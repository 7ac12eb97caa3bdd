// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the map does in each clock of an operation.

use super::operation::{self, Kind};
use super::{Inputs, Map, Registers};
use crate::format::Format;
use crate::profile::Profile;
use crate::signal::{Exact, Floor, HalfEven, Lemma, Never, Saturate, Signal, Value, Wrap, int, zero};
use crate::when;

const FRACTION: &str = "a number less its floor is below one";

impl Map {
    /// A coordinate of −1 … 1 as the cell of `2^bits` in which it lies, and how far into it.
    #[inline(always)]
    fn cell_of<V: Value>(&self, coordinate: Signal<V>, bits: u8) -> (Signal<V>, Signal<V>) {
        let one = int(1);
        let positive = (coordinate + one).fit(Format::unsigned(self.word.width, self.word.frac), Exact, Never);
        let cells = positive.scaled(bits as i8 - 1);
        let index = cells.fit(Format::unsigned(bits, 0), Floor, Never);
        (index, (cells - index).fit(self.weight, Exact, Lemma(FRACTION)))
    }
    /// The coordinate that an operation looks at: across the sheet's length (x), or along its other side (y).
    #[inline(always)]
    fn coordinate<V: Value>(&self, r: &Registers<Signal<V>>, kind: &Kind<V>) -> Signal<V> {
        use operation::*;
        let at = |which: u64| r.operation.is(which);
        let of_x = at(MIDDLE_Y) | at(STRETCH_Y) | at(STRAIGHTEN_X) | at(SPACING_X) | (kind.tables & !kind.between);
        of_x.select(r.across, r.along).named("coordinate")
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
            base: (operation::offset(&self.layout, r.operation) + index).fit(r.base.format, Exact, Wrap),
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
        Registers { base: kind.tables.select(r.base + rows, r.base).fit(r.base.format, Exact, Wrap), ..r }
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
        let [boxed, straight, between] = self.products.map(|format| product.as_code(format));
        let near = r.near.as_code(self.word);
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
            operation: end.select(int(0), r.operation + int(1)).fit(r.operation.format, Exact, Never),
            step: int(0),
            across: of_x.select(result, r.across),
            along: of_y.select(result, r.along),
            first: (of_x | of_y | second).select(r.first, result),
            second: second.select(result, r.second),
            x: at(LAYERS + 2).select(mm, r.x),
            y: at(LAYERS + 5).select(mm, r.y),
            sheet: end.select(result.fit(r.sheet.format, Exact, Saturate), r.sheet),
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

    /// A clock of an operation.
    #[inline(always)]
    pub(super) fn work<V: Value>(
        &self,
        r: Registers<Signal<V>>,
        i: Inputs<Signal<V>>,
        (word, product): (Signal<V>, Signal<V>),
    ) -> Registers<Signal<V>> {
        let at = |step: u64| r.step.is(step);
        let kind = Kind::of(r.operation);
        let moved = Registers { step: (r.step + int(1)).fit(r.step.format, Exact, Wrap), word, ..r };
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
        let difference = (r.difference - r.near).fit(r.difference.format, Exact, Wrap);
        let far = (before(5) & reads).select(word.integer(), r.difference);
        Registers {
            near: (before(4) & reads).select(word.integer(), r.near),
            difference: before(6).select(difference, far),
            ..r
        }
    }
}
