// SPDX-License-Identifier: MIT OR Apache-2.0
//! A surface at a place: three rows of the table, then a column of their values and one of their slopes.
//!
//! | clock of a line, L clocks a product | what is made |
//! | --- | --- |
//! | 0, 1, 2 | asks for a, b and c, which are `word` in clocks 2, 3 and 4 |
//! | 3 | difference = b − a, sum = a + b |
//! | 4 | left = (c − b) − difference, right = f |
//! | 5 + L | aligned = difference + left · f |
//! | 6 + L | level = the slope, rounded |
//! | 7 + L | left = difference + slope; the slope goes to the scratch memory |
//! | 8 + 2L | aligned = sum + left · f |
//! | 9 + 2L | level = the value, rounded |
//! | 10 + 2L | deviation = measured − value; the value goes to the scratch memory |
//! | 11 + 2L | the deviation goes to the scratch memory |

use super::layout::{Axis, Surface};
use super::{Inputs, Position, Registers, newton, slots, task};
use crate::memory::Write;
use crate::signal::{Exact, HalfEven, Never, Saturate, Signal, Value, Wrap, bit, code, int};
use crate::{choose, when};

/// The line of the rows' values, after three rows.
pub const VALUES: u64 = 3;
/// The line of the rows' slopes.
pub const SLOPES: u64 = 4;

impl Position {
    /// Clocks of a line.
    pub(super) fn line_clocks(&self) -> u64 {
        12 + 2 * self.multiplier.latency()
    }

    /// Clocks of a product, counted from the operands' clock.
    fn product_clocks(&self) -> u64 {
        self.multiplier.latency()
    }

    /// Clocks until a surface's first address is known.
    pub(super) fn address_clocks(&self) -> u64 {
        2 + self.product_clocks()
    }

    /// Whether the surface is one of the ratios'.
    #[inline(always)]
    fn of_ratio<V: Value>(&self, r: &Registers<Signal<V>>) -> Signal<V> {
        !r.surface.is(Surface::Resistance as u64)
    }

    /// The cell in which a coordinate lies, and how far into it: of the resistance's spline, whose cells are larger, or of
    /// the ratios'.
    #[inline(always)]
    fn cell_of<V: Value>(&self, r: &Registers<Signal<V>>, place: Signal<V>) -> (Signal<V>, Signal<V>) {
        let (width, frac, shift) = (place.format.width, place.format.frac as u8, self.layout.shift());
        let of_ratio = self.of_ratio(r);
        let whole = width - frac;
        let cell = of_ratio.select(place.bits(frac, whole), place.bits(frac + shift, whole - shift));
        (cell, of_ratio.select(place.bits(0, frac), place.bits(shift, frac)))
    }

    /// The address of the first coefficient: columns times the row of the cell, by the multiplier, and its column.
    #[inline(always)]
    pub(super) fn address<V: Value>(
        &self,
        next: Registers<Signal<V>>,
        now: &Registers<Signal<V>>,
        product: Signal<V>,
    ) -> Registers<Signal<V>> {
        let of = |surface: Surface| {
            let columns = self.layout.coefficients(surface, Axis::X);
            (int(self.layout.surface(surface) as u64), int(columns as u64))
        };
        let at_surface = |surface: Surface| now.surface.is(surface as u64);
        let (of_x, of_y, of_r) = (of(Surface::RatioX), of(Surface::RatioY), of(Surface::Resistance));
        let start = at_surface(Surface::RatioX).select(of_x.0, at_surface(Surface::RatioY).select(of_y.0, of_r.0));
        let columns = self.of_ratio(now).select(of_x.1, of_r.1);
        let (column, row) = (self.cell_of(now, now.place_u).0, self.cell_of(now, now.place_v).0);
        let begun = Registers {
            left: row.fit(now.left.format, Exact, Never),
            right: columns.fit(now.right.format, Exact, Never),
            address: (start + column).fit(now.address.format, Exact, Wrap),
            ..next
        };
        let rows = product.bits(0, now.address.format.width);
        let found =
            Registers { address: (now.address + rows).fit(now.address.format, Exact, Wrap), line: int(0), ..next };
        when!(
            V,
            Registers,
            now.clock.is(0) => begun,
            now.clock.is(self.address_clocks() - 1) => self.enter(found, task::LINE),
            else next
        )
    }

    /// A clock of a line.
    #[inline(always)]
    pub(super) fn line<V: Value>(
        &self,
        next: Registers<Signal<V>>,
        i: &Inputs<Signal<V>>,
        now: &Registers<Signal<V>>,
        product: Signal<V>,
    ) -> Registers<Signal<V>> {
        let at = |clock: u64| now.clock.is(clock);
        let wait = self.product_clocks();
        let asks = now.clock.less_than(int(2)).named("asks");
        let of_rows = now.line.less_than(int(VALUES)).named("of_rows");
        let on = |address: Signal<V>, asks: Signal<V>| (address + asks).fit(address.format, Exact, Wrap);
        let loads = (at(2) | at(3)).named("loads");
        let next = Registers {
            address: on(now.address, asks & of_rows),
            slot: on(now.slot, asks & !of_rows),
            near: loads.select(now.word, now.near),
            ..next
        };
        when!(
            V,
            Registers,
            at(3) => self.first_difference(next, now),
            at(4) => self.second_difference(next, now),
            at(5 + wait) | at(8 + 2 * wait) => self.align(next, now, product),
            at(6 + wait) | at(9 + 2 * wait) => self.round(next, now),
            at(7 + wait) => self.add_slope(next, now),
            at(10 + 2 * wait) => self.deviate(next, i, now),
            at(self.line_clocks() - 1) => self.following_line(next, now),
            else next
        )
    }

    #[inline(always)]
    fn first_difference<V: Value>(
        &self,
        next: Registers<Signal<V>>,
        now: &Registers<Signal<V>>,
    ) -> Registers<Signal<V>> {
        Registers { difference: now.word - now.near, sum: now.near + now.word, ..next }
    }

    #[inline(always)]
    fn second_difference<V: Value>(
        &self,
        next: Registers<Signal<V>>,
        now: &Registers<Signal<V>>,
    ) -> Registers<Signal<V>> {
        let second = (now.word - now.near) - now.difference;
        let of_rows = now.line.less_than(int(VALUES));
        let along = |place: Signal<V>| self.cell_of(now, place).1;
        let right = of_rows.select(along(now.place_u), along(now.place_v));
        Registers {
            left: second.fit(now.left.format, Exact, Saturate),
            right: right.fit(now.right.format, Exact, Never),
            ..next
        }
    }

    /// The product with what it is added to: the difference, then the sum.
    #[inline(always)]
    fn align<V: Value>(
        &self,
        next: Registers<Signal<V>>,
        now: &Registers<Signal<V>>,
        product: Signal<V>,
    ) -> Registers<Signal<V>> {
        let frac = self.formats.place.frac;
        let first = now.clock.is(5 + self.product_clocks());
        let start = first.select(now.difference, now.sum);
        let aligned = start + product.scaled(-frac);
        Registers { aligned: aligned.scaled(frac).fit(now.aligned.format, Exact, Never), ..next }
    }

    /// Twice the difference and the product's word, and the sum's half: both have one bit more than a word's point.
    #[inline(always)]
    fn round<V: Value>(&self, next: Registers<Signal<V>>, now: &Registers<Signal<V>>) -> Registers<Signal<V>> {
        let (level, frac) = (self.formats.level, self.formats.place.frac);
        let code = now.aligned.scaled(1 - frac).fit(level.integer(), HalfEven, Saturate);
        Registers { level: code.scaled(-level.frac), ..next }
    }

    /// The slope that `level` holds after the first product, as a code of half a word's steps.
    #[inline(always)]
    fn slope<V: Value>(&self, now: &Registers<Signal<V>>) -> Signal<V> {
        now.level.integer().fit(self.formats.slope.integer(), Exact, Saturate)
    }

    #[inline(always)]
    fn add_slope<V: Value>(&self, next: Registers<Signal<V>>, now: &Registers<Signal<V>>) -> Registers<Signal<V>> {
        let both = now.difference + self.slope(now).scaled(-1);
        Registers { left: both.fit(now.left.format, HalfEven, Saturate), ..next }
    }

    /// The measured ratio less the surface's value.
    #[inline(always)]
    fn deviate<V: Value>(
        &self,
        next: Registers<Signal<V>>,
        i: &Inputs<Signal<V>>,
        now: &Registers<Signal<V>>,
    ) -> Registers<Signal<V>> {
        let measured = now.surface.is(Surface::RatioX as u64).select(i.r_x, i.r_y);
        let sheet = now.level.fit(now.sheet.format, HalfEven, Saturate);
        let ends = now.line.is(VALUES) & !self.of_ratio(now);
        Registers {
            deviation: (measured - now.level).fit(now.deviation.format, Exact, Never),
            sheet: choose!(V, ends, sheet, now.sheet),
            ..next
        }
    }

    /// What a clock writes into the scratch memory: slopes, values, and what is left of the ratios.
    #[inline(always)]
    pub(super) fn keep<V: Value>(&self, now: &Registers<Signal<V>>) -> Write<V> {
        let wait = self.product_clocks();
        let at = |clock: u64| now.clock.is(clock);
        let (slope, value, residual) = (at(7 + wait), at(10 + 2 * wait), at(11 + 2 * wait));
        let enable = now.task.is(task::LINE) & (slope | value | residual);
        let of_rows = now.line.less_than(int(VALUES));
        let of = |first: u64, which: Signal<V>| (int(first) + which).fit(now.slot.format, Exact, Wrap);
        let unused = code(slots::UNUSED as i64, now.slot.format);
        let values = now.line.is(VALUES);
        let of_slope =
            of_rows.select(of(slots::SLOPES, now.line), values.select(of(slots::ALONG_V, now.surface), unused));
        let of_value =
            of_rows.select(of(slots::VALUES, now.line), values.select(unused, of(slots::ALONG_U, now.surface)));
        let of_residual = values.select(of(slots::RESIDUAL, now.surface), unused);
        let word = self.formats.word;
        let rounded = |a: Signal<V>| a.fit(word.integer(), HalfEven, Saturate);
        let value_word = choose!(V, value, rounded(now.level.integer().scaled(-2)), self.residual(now));
        let data = choose!(V, slope, self.slope(now), value_word);
        Write { enable, address: slope.select(of_slope, value.select(of_value, of_residual)), data: data.as_code(word) }
    }

    /// The deviation as a code of half a word's steps.
    #[inline(always)]
    fn residual<V: Value>(&self, now: &Registers<Signal<V>>) -> Signal<V> {
        now.deviation.fit(self.formats.slope, HalfEven, Saturate).integer()
    }

    /// The last clock of a line: the next line, surface or task.
    #[inline(always)]
    fn following_line<V: Value>(&self, next: Registers<Signal<V>>, now: &Registers<Signal<V>>) -> Registers<Signal<V>> {
        let values = now.line.is(VALUES).named("values");
        let of_x = now.surface.is(Surface::RatioX as u64).named("of_x");
        let of_y = now.surface.is(Surface::RatioY as u64).named("of_y");
        let found = now.pass.is(self.steps).named("found");
        let surface_ends = now.line.is(SLOPES) | (values & (found | !self.of_ratio(now)));
        // Two words of the row are behind the address.
        let to_next_row = |surface| int(self.layout.coefficients(surface, Axis::X) as u64 - 2);
        let row = self.of_ratio(now).select(to_next_row(Surface::RatioX), to_next_row(Surface::Resistance));
        let row_follows = now.line.less_than(int(VALUES - 1)).named("row_follows");
        let tolerance = code(1, crate::format::Format::unsigned(1, Position::TOLERANCE_BITS));
        let beyond = tolerance.less_than(now.deviation.abs()).named("beyond");
        let goes_on = Registers {
            line: (now.line + int(1)).fit(now.line.format, Exact, Wrap),
            address: row_follows.select((now.address + row).fit(now.address.format, Exact, Wrap), now.address),
            slot: values.select(int(slots::SLOPES), int(slots::VALUES)),
            invalid: (values & of_x).select(beyond, (values & of_y).select(now.invalid | beyond, now.invalid)),
            clock: int(0),
            ..next
        };
        let surface = Registers { surface: of_x.select(int(1), int(2)), ..goes_on };
        let crosses = Registers { cross: int(newton::DETERMINANT), ..goes_on };
        let scales = Registers { address: int(self.layout.geometry(Axis::X) as u64), cross: int(0), ..goes_on };
        when!(
            V,
            Registers,
            !surface_ends => goes_on,
            of_x | (of_y & found) => self.enter(surface, task::ADDRESS),
            of_y => self.enter(crosses, task::CROSS),
            else self.enter(scales, task::SCALE)
        )
    }

    /// Clocks of a position in millimetres.
    pub(super) fn scale_clocks(&self) -> u64 {
        6 + self.product_clocks()
    }

    /// A position in millimetres: the middle's place, and cells from there times their size. `cross` is the axis.
    #[inline(always)]
    pub(super) fn scale<V: Value>(
        &self,
        next: Registers<Signal<V>>,
        now: &Registers<Signal<V>>,
        product: Signal<V>,
    ) -> Registers<Signal<V>> {
        let at = |clock: u64| now.clock.is(clock);
        let of_y = now.cross.bits(0, 1).named("of_y_axis");
        let asks = at(0).named("asks_pitch");
        let next = Registers {
            address: (now.address + asks).fit(now.address.format, Exact, Wrap),
            near: at(2).select(now.word, now.near),
            ..next
        };
        let operands = Registers { left: self.from_middle(now, of_y).integer(), right: now.word, ..next };
        let end = self.scale_clocks() - 1;
        when!(
            V,
            Registers,
            at(3) => operands,
            at(end - 1) => self.align_place(next, now, product),
            at(end) => self.take_place(next, now, of_y),
            else next
        )
    }

    /// Cells from the table's middle.
    #[inline(always)]
    fn from_middle<V: Value>(&self, now: &Registers<Signal<V>>, of_y: Signal<V>) -> Signal<V> {
        let place = self.formats.place;
        let middle = |axis| code((self.layout.cells(axis) as i64) << (place.frac - 1), place);
        let from = of_y.select(now.place_v, now.place_u) - of_y.select(middle(Axis::Y), middle(Axis::X));
        from.fit(crate::format::Format::signed(place.width, place.frac), Exact, Never)
    }

    /// Bits by which a product of cells and their size has its point further left than the middle's place.
    fn origin_shift(&self) -> i8 {
        self.formats.place.frac + Position::ORIGIN_BITS - Position::PITCH_BITS
    }

    #[inline(always)]
    fn align_place<V: Value>(
        &self,
        next: Registers<Signal<V>>,
        now: &Registers<Signal<V>>,
        product: Signal<V>,
    ) -> Registers<Signal<V>> {
        let aligned = now.near.scaled(self.origin_shift()) + product;
        Registers { aligned: aligned.fit(now.aligned.format, Exact, Never), ..next }
    }

    /// The last clock: the position, and after that of x the other axis.
    #[inline(always)]
    fn take_place<V: Value>(
        &self,
        next: Registers<Signal<V>>,
        now: &Registers<Signal<V>>,
        of_y: Signal<V>,
    ) -> Registers<Signal<V>> {
        let (place, word) = (self.formats.place, self.formats.word);
        let millimetres = now.aligned.scaled(Position::PITCH_BITS - place.frac - word.frac);
        let (position, held) = millimetres.saturate(self.formats.position, HalfEven);
        let taken = Registers {
            x: of_y.select(now.x, position),
            y: of_y.select(position, now.y),
            saturated: now.saturated | held,
            done: of_y,
            ..next
        };
        let along_y = Registers { cross: int(1), address: int(self.layout.geometry(Axis::Y) as u64), ..taken };
        let idle = self.enter(taken, task::IDLE);
        when!(V, Registers, of_y, idle, Registers { clock: int(0), done: bit(false), ..along_y })
    }
}
