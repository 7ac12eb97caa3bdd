// SPDX-License-Identifier: MIT OR Apache-2.0
//! Position and sheet resistance from the ratios: the measured forward map, inverted by Newton steps.
//!
//! ```text
//! r_x = X(u, v),  r_y = Y(u, v)                 splines of what was read at known places; u, v in cells of the table
//! (u, v) += J⁻¹ · (r − (X, Y)(u, v))            `steps` times, from the middle of the cell whose ratios are nearest
//! x = origin_x + (u − middle) · pitch_x,  y likewise,  R = R(u, v)
//! ```
//!
//! The forward map is smooth; its inverse is not (at an insulated edge the ratios stand still while the pad moves on), so that
//! the former is tabulated. A quadratic B-spline along a line is, with coefficients a, b, c and the place f in the cell,
//!
//! ```text
//! slope = (b − a) + f·((c − b) − (b − a)),   value = ½·((a + b) + f·((b − a) + slope))
//! ```
//!
//! two products for both. Three rows and then a column of their values and one of their slopes make a surface:
//!
//! ```text
//! table ─[word]─[near]─(−)─[difference]─(−)─[left]─(× f)─(+)─[aligned]─[round half even]─[level]─┬─ scratch ─ [word] …
//!                  └───(+)─[sum]───────────────────────────┘                                     └─ r − level ─ scratch
//! scratch ─[left, right]─(×)─(−)─[minor]─|·|─[determinant]─[divider]─ u, v
//! ```
//!
//! | signal           | format          | unit                | overflow                                              |
//! | words, left      | profile: table  | –                   | saturate: a table's neighbours differ by less than ½  |
//! | slope, residual  | half as large   | ratio (per cell)    | saturate: a step gets shorter or longer, no result     |
//! | level            | two bits more   | ratio               | saturates: held within twice the table's range         |
//! | minor            | width + 11 bits | ratio² per cell     | cannot (range proof); low bits are cut                 |
//! | u, v             | unsigned        | cells               | held within the table                                  |
//! | x, y             | profile         | mm                  | saturate, flagged                                      |
//! | R                | a word's, unsigned | full scales, voltage / current | saturates at zero and at the top            |
//!
//! `invalid` where the place that was found does not have the ratios that were measured, to `2^-TOLERANCE_BITS`. Control does
//! not depend on data. Latency: [`Position::latency`]. Source: Nakamura & Yamamoto 2016, eqs. 2 and 3, for the ratios.

mod layout;
mod newton;
mod search;
mod spline;

pub use layout::{Axis, Guesses, Layout, Surface};

use super::divider::{self, Divider};
use super::multiplier::{self, Multiplier};
use crate::block::{Block, Cell};
use crate::format::{BIT, Format};
use crate::memory::{Memory, Write};
use crate::profile::Profile;
use crate::signal::{Exact, Floor, Never, Signal, Value, Wrap, bit, int};
use crate::{bundle, choose, next, parts};

bundle! {
    /// The inputs.
    pub struct Inputs {
        /// Begins; the ratios are valid and stable until `done`.
        start,
        /// The x ratio.
        r_x,
        /// The y ratio.
        r_y,
        /// Calibration: writes a word of the position table.
        write,
        /// Calibration: the word's address.
        address,
        /// Calibration: the word.
        word,
    }
}

bundle! {
    /// The outputs: registers.
    pub struct Outputs {
        /// Asserted for one cycle when the others are valid.
        done,
        /// The position along the long edges, in mm.
        x,
        /// The position along the short edges, in mm.
        y,
        /// The sheet's resistance at the pad, in full scales of voltage per current.
        sheet,
        /// No place of the table has the measured ratios.
        invalid,
        /// A position is saturated.
        saturated,
    }
}

bundle! {
    /// The registers. `word`, `near`, `difference`, `sum`, `left`, `right` and `aligned` are codes as integers.
    pub struct Registers {
        task: ["idle", "search", "address", "line", "cross", "divide", "scale"],
        clock, pass,
        surface: ["ratio_x", "ratio_y", "resistance"],
        line: ["row_0", "row_1", "row_2", "values", "slopes"],
        cross: ["determinant", "along_u", "along_v"],
        address, slot, word, near, difference, sum, left, right, aligned, level, deviation,
        guess_u, guess_v, partial, distance, least, place_u, place_v,
        minor, determinant, negative, divide, x, y, sheet, invalid, saturated, done,
    }
}

parts! {
    /// The blocks and memories within.
    pub struct Parts of Position {
        table: Memory,
        scratch: Memory,
        multiplier: Multiplier,
        divider: Divider,
    }
}

/// The codes of `task`.
mod task {
    pub const IDLE: u64 = 0;
    pub const SEARCH: u64 = 1;
    pub const ADDRESS: u64 = 2;
    pub const LINE: u64 = 3;
    pub const CROSS: u64 = 4;
    pub const DIVIDE: u64 = 5;
    pub const SCALE: u64 = 6;
}

/// The formats of the signals between.
#[derive(Debug, Clone, Copy)]
struct Formats {
    ratio: Format,
    /// Of the table.
    word: Format,
    /// Of slopes and residuals: a word's bits, for half its range.
    slope: Format,
    level: Format,
    place: Format,
    /// Of the difference of two products of slopes.
    minor: Format,
    position: Format,
    sheet: Format,
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct Position {
    table: Memory,
    scratch: Memory,
    multiplier: Multiplier,
    divider: Divider,
    layout: Layout,
    steps: u64,
    formats: Formats,
    registers: Registers<Format>,
}

impl Position {
    /// Ratios at the place found and measured ones agree within `2^-TOLERANCE_BITS`.
    pub const TOLERANCE_BITS: i8 = 10;
    /// The place of the table's middle is stored in units of `2^ORIGIN_BITS` mm.
    pub const ORIGIN_BITS: i8 = 10;
    /// The size of a cell is stored in units of `2^PITCH_BITS` mm.
    pub const PITCH_BITS: i8 = 6;
    /// A step moves by less than `2^STEP_BITS` cells along either axis.
    pub const STEP_BITS: u8 = 2;

    /// The position of a profile, with nothing in its table yet.
    pub fn new(profile: &Profile) -> Self {
        let layout = Layout::new(profile);
        let formats = Formats::new(profile, &layout);
        let Formats { word, place, minor, .. } = formats;
        let operand = word.integer();
        let table = Memory::new("words", layout.words(), word).never_colliding();
        let magnitude = magnitude(minor);
        let quotient = Format::unsigned(Position::STEP_BITS + place.frac as u8, place.frac);
        Position {
            registers: registers(&layout, &formats, profile.position.steps, &table),
            // A slot whose table is written meanwhile gives a frame of neither calibration in any case.
            table,
            scratch: Memory::new("scratch", slots::ALL as usize, word).never_colliding().in_block(),
            multiplier: Multiplier::new(operand, operand, profile.multiplier),
            divider: Divider::new(magnitude, magnitude, quotient),
            layout,
            steps: profile.position.steps,
            formats,
        }
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        let guesses = self.guesses().map(|axis| axis.count as u64);
        let search = guesses[0] * guesses[1] * search::CLOCKS;
        let (address, line) = (self.address_clocks(), self.line_clocks());
        let evaluation = 2 * (address + 4 * line);
        let step = 2 * line + 3 * self.cross_clocks() + 2 * (self.divider.latency() + 1);
        let last = address + 4 * line + 2 * self.scale_clocks();
        search + self.steps * (evaluation + step) + evaluation + last + 1
    }

    /// The memory of the position table.
    pub fn table(&self) -> &Memory {
        &self.table
    }

    fn guesses(&self) -> [Guesses; 2] {
        [Axis::X, Axis::Y].map(|axis| self.layout.guesses(axis))
    }
}

/// The format of a minor's magnitude.
fn magnitude(minor: Format) -> Format {
    Format::unsigned(minor.width - 1, minor.frac)
}

impl Formats {
    fn new(profile: &Profile, layout: &Layout) -> Self {
        let word = profile.formats.table;
        let width = word.width;
        Formats {
            ratio: profile.formats.ratio,
            word,
            slope: Format::signed(width, width as i8),
            level: Format::signed(width + 2, width as i8 + 1),
            place: layout.place(word),
            minor: Format::signed(width + 11, width as i8 + 10),
            position: profile.formats.position,
            sheet: profile.sheet(),
        }
    }

    /// The measured ratio less that of a place, or of a word of the table.
    fn deviation(&self) -> Format {
        self.ratio.difference(self.level)
    }

    /// Both deviations' magnitudes.
    fn distance(&self) -> Format {
        let deviation = self.deviation();
        Format::unsigned(deviation.width + 1, deviation.frac)
    }

    /// A product of a word and a place within its cell, with what is added to it.
    fn aligned(&self) -> Format {
        Format::signed(2 * self.word.width + 1, 0)
    }
}

/// The formats of the registers.
fn registers(layout: &Layout, formats: &Formats, steps: u64, table: &Memory) -> Registers<Format> {
    let Formats { word, place, minor, .. } = *formats;
    let integer = Format::signed(word.width + 1, 0);
    let deviation = formats.deviation();
    let guess = |axis| Format::counter(layout.cells(axis) as u64 - 1);
    Registers {
        task: Format::counter(task::SCALE),
        clock: Format::unsigned(4, 0),
        pass: Format::counter(steps),
        surface: Format::counter(Surface::Resistance as u64),
        line: Format::counter(spline::SLOPES),
        cross: Format::counter(newton::ALONG_V_STEP),
        address: table.address(),
        slot: Format::counter(slots::ALL - 1),
        word: word.integer(),
        near: word.integer(),
        difference: integer,
        sum: integer,
        left: word.integer(),
        right: word.integer(),
        aligned: formats.aligned(),
        level: formats.level,
        deviation,
        guess_u: guess(Axis::X),
        guess_v: guess(Axis::Y),
        partial: Format::unsigned(deviation.width, deviation.frac),
        distance: formats.distance(),
        least: formats.distance(),
        place_u: place,
        place_v: place,
        minor,
        determinant: magnitude(minor),
        negative: BIT,
        divide: BIT,
        x: formats.position,
        y: formats.position,
        sheet: formats.sheet,
        invalid: BIT,
        saturated: BIT,
        done: BIT,
    }
}

/// Words of the scratch memory.
mod slots {
    /// Values of three rows, then their slopes.
    pub const VALUES: u64 = 0;
    pub const SLOPES: u64 = 3;
    /// Slopes along u of r_x and r_y, then along v, then what is left of both.
    pub const ALONG_U: u64 = 6;
    pub const ALONG_V: u64 = 8;
    pub const RESIDUAL: u64 = 10;
    /// What nobody reads.
    pub const UNUSED: u64 = 15;
    pub const ALL: u64 = 16;
}

impl Block for Position {
    const NAME: &'static str = "position";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = Parts<V>;

    #[inline]
    fn inputs(&self) -> Inputs<Format> {
        let Formats { ratio, word, .. } = self.formats;
        Inputs { start: BIT, r_x: ratio, r_y: ratio, write: BIT, address: self.table.address(), word }
    }

    #[inline]
    fn outputs(&self) -> Outputs<Format> {
        let Registers { done, x, y, sheet, invalid, saturated, .. } = self.registers;
        Outputs { done, x, y, sheet, invalid, saturated }
    }

    #[inline(always)]
    fn registers(&self) -> Registers<Format> {
        let r = self.registers;
        let width = self.formats.word.width as i8;
        let deviation = self.formats.ratio.frac.max(width + 1);
        Registers {
            task: r.task.counting(),
            clock: r.clock.counting(),
            pass: r.pass.counting(),
            surface: r.surface.counting(),
            line: r.line.counting(),
            cross: r.cross.counting(),
            address: r.address.counting(),
            slot: r.slot.counting(),
            word: r.word.with_point(0),
            near: r.near.with_point(0),
            difference: r.difference.with_point(0),
            sum: r.sum.with_point(0),
            left: r.left.with_point(0),
            right: r.right.with_point(0),
            aligned: r.aligned.with_point(0),
            level: r.level.with_point(width + 1),
            deviation: r.deviation.with_point(deviation),
            guess_u: r.guess_u.counting(),
            guess_v: r.guess_v.counting(),
            partial: r.partial.with_point(deviation),
            distance: r.distance.with_point(deviation),
            least: r.least.with_point(deviation),
            negative: BIT,
            divide: BIT,
            invalid: BIT,
            saturated: BIT,
            done: BIT,
            ..r
        }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let Registers { done, x, y, sheet, invalid, saturated, .. } = r;
        let outputs = Outputs { done, x, y, sheet, invalid, saturated };
        let busy = !r.task.is(task::IDLE);
        if (i.start | busy | r.done | i.write).idle() {
            return outputs;
        }
        let word = self.table.data(&mut cell.parts.table).integer();
        let write = Write { enable: i.write, address: i.address, data: i.word };
        self.table.access(&mut cell.parts.table, r.address, write);
        let kept = self.scratch.data(&mut cell.parts.scratch).integer();
        let slot = choose!(V, r.task.is(task::CROSS), self.operand_slot(&r), r.slot);
        self.scratch.access(&mut cell.parts.scratch, slot, self.keep(&r));
        let inputs = multiplier::Inputs { enable: busy, left: r.left, right: r.right };
        let product = self.multiplier.call("multiplier", &mut cell.parts.multiplier, inputs).product;
        let inputs = divider::Inputs { start: r.divide, numerator: self.magnitude(&r), denominator: r.determinant };
        let divided = self.divider.call("divider", &mut cell.parts.divider, inputs);
        let from_table = !(r.task.is(task::CROSS) | (r.task.is(task::LINE) & !r.line.less_than(int(spline::VALUES))));
        // What is asked for in a clock is `word` two clocks later.
        let word = from_table.select(word, kept);
        let idle = Registers { done: bit(false), divide: bit(false), ..r };
        let goes_on = Registers { clock: (r.clock + int(1)).fit(r.clock.format, Exact, Wrap), word, ..idle };
        let on = |task: u64| r.task.is(task);
        next!(
            V,
            Registers,
            self,
            cell,
            i.start => self.begin(idle),
            on(task::LINE) => self.line(goes_on, &i, &r, product),
            on(task::SEARCH) => self.search(goes_on, &i, &r),
            on(task::DIVIDE) & !divided.done => idle,
            on(task::DIVIDE) => self.step(idle, divided.quotient),
            on(task::CROSS) => self.cross(goes_on, &r, product),
            on(task::ADDRESS) => self.address(goes_on, &r, product),
            on(task::SCALE) => self.scale(goes_on, &r, product),
            else idle
        );
        outputs
    }
}

impl Position {
    /// Goes to the first clock of a task.
    #[inline(always)]
    fn enter<V: Value>(&self, r: Registers<Signal<V>>, task: u64) -> Registers<Signal<V>> {
        Registers { task: int(task), clock: int(0), ..r }
    }

    /// A minor's magnitude.
    #[inline(always)]
    fn magnitude<V: Value>(&self, r: &Registers<Signal<V>>) -> Signal<V> {
        r.minor.abs().fit(r.determinant.format, Exact, Never)
    }

    /// The product of two slopes, as a minor: low bits are cut.
    #[inline(always)]
    fn of_slopes<V: Value>(&self, product: Signal<V>) -> Signal<V> {
        product.as_code(self.formats.slope.product(self.formats.slope)).fit(self.formats.minor, Floor, Never)
    }
}
