// SPDX-License-Identifier: MIT OR Apache-2.0
//! Controller and walls on one arithmetic unit: what it is asked and gives, and its programs.
//!
//! ```text
//! wall asks, or controller begins ─ start ─ unit ─ number ─[of all inputs]─ word ─┐
//!                                             └────────────────────────────────────┘
//!                                             └ results: the wall's, then the drive word
//! ```
//!
//! Inputs are numbered as their bundles' fields are: the wall's from 0, the controller's from
//! [`OF_CONTROLLER`]; results likewise. The curve's words are looked up by the sum ([`CURVE`]). What may
//! happen at any clock is not folded: the host is heard, faults are latched and cleared.

use super::super::arithmetic_unit::instruction::Operation;
use super::super::arithmetic_unit::program::Programs;
use super::super::arithmetic_unit::translate::Ports;
use super::super::arithmetic_unit::{self, ArithmeticUnit, by_pair};
use super::super::controller::{self, Controller, Watch};
use super::super::sided_wall::{self, SidedWall};
use super::{Begin, Drives, Regs};
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::bundle;
use hapticore_hdl::bundle::{Bundle, Field};
use hapticore_hdl::format::{BIT, Format, MAX_WIDTH};
use hapticore_hdl::interpretations::expression::Expression;
use hapticore_hdl::memory::Write;
use hapticore_hdl::signal::{Proved, Signal, bit, int, zero};
use std::collections::HashMap;

/// The programs: the controller's is there always.
pub const CONTROLLER: usize = 0;
pub const WALL: usize = 1;
/// Clocks from what begins a program to its start.
pub const BEGIN: u64 = 1;

/// The number of the controller's first field.
const OF_CONTROLLER: u8 = 16;
/// The number of the curve.
const CURVE: u8 = 63;

bundle! {
    /// What goes to the unit and comes from it.
    pub struct Folded {
        /// Starts a program.
        begins,
        /// One is running.
        runs,
        /// It is the wall's.
        of_wall,
        /// The row of its words.
        row,
        /// What was asked for.
        word,
        /// A word of the curve, where it has a register.
        curve,
        /// Of the wall.
        wall_target,
        wall_free,
        wall_valid,
        /// Of the controller.
        next_drive,
        next_target,
        next_low,
        next_high,
        watch as Watch,
    }
}

/// The fields of a block in the unit's numbers.
struct Numbers {
    first: u8,
    outputs: &'static [Field],
}

impl Ports for Numbers {
    fn input(&self, input: usize) -> u8 {
        self.first + u8::try_from(input).expect("few inputs")
    }

    fn memory(&self, _memory: &'static str) -> u8 {
        CURVE
    }

    fn output(&self, output: &'static str) -> u8 {
        self.first + number_of(self.outputs, output)
    }
}

/// The number of a field.
fn number_of(fields: &[Field], name: &str) -> u8 {
    let number = fields.iter().position(|field| field.name == name);
    number.expect("a field of the bundle") as u8
}

/// A unit, and what its numbers mean.
#[derive(Debug, Clone)]
pub struct Unit {
    /// Of what is asked for: the fields' numbers.
    asked: Vec<u8>,
    /// Of what is given, likewise.
    given: Vec<u8>,
}

/// The unit of a profile that folds its controller.
///
/// # Errors
/// Words or programs that the unit cannot hold.
pub fn unit(
    profile: &Profile,
    controller: &Controller,
) -> Result<Option<(Unit, ArithmeticUnit)>, ProfileError> {
    if profile.control.as_ref().is_none_or(|control| !control.folded) {
        return Ok(None);
    }
    let wall = profile.wall.map(|_| SidedWall::try_new(profile)).transpose()?;
    let outputs = <controller::Outputs as Bundle>::FIELDS;
    let of_controller = Numbers { first: OF_CONTROLLER, outputs };
    let of_wall = Numbers { first: 0, outputs: <sided_wall::Outputs as Bundle>::FIELDS };
    let mut expressions: Vec<(Expression, &dyn Ports)> =
        vec![(controller.expression(), &of_controller)];
    expressions.extend(wall.as_ref().map(|wall| (wall.expression(), &of_wall as &dyn Ports)));
    let behind = if profile.registers_block_rams() { 2 } else { 1 };
    let mut programs = Programs::of(&expressions, behind).map_err(|too_large| {
        let expected = format_args!("programs of at most {} {}", too_large.most, too_large.what);
        ProfileError::value("control.folded", expected, too_large.got)
    })?;
    sums_fit(programs.sum.width)?;
    let widths = widths(controller, wall.as_ref());
    let width = |number: u8| widths.get(&number).copied().unwrap_or(0);
    // What is alike in width is side by side, which takes fewer multiplexers.
    let asked = programs.renumber(Operation::Ask, |number| (width(number), number));
    let given = programs.renumber(Operation::Give, |number| number);
    let word = Format::signed(asked.iter().map(|number| width(*number)).max().unwrap_or(1), 0);
    let block = ArithmeticUnit::new(programs, profile.pads, word, profile.multiplier);
    Ok(Some((Unit { asked, given }, block)))
}

/// Whether a unit can hold sums of so many bits.
pub(super) fn sums_fit(width: u8) -> Result<(), ProfileError> {
    let most = MAX_WIDTH - ArithmeticUnit::CARRIES;
    if width <= most {
        return Ok(());
    }
    let expected = format_args!("sums of at most {most} bits");
    Err(ProfileError::value("control.folded", expected, width))
}

/// The bits of each input as a signed integer, by its number.
fn widths(controller: &Controller, wall: Option<&SidedWall>) -> HashMap<u8, u8> {
    let mut widths = HashMap::new();
    let mut number = 0;
    let mut see = |format: Format| {
        widths.insert(number, as_signed(format));
        number += 1;
    };
    if let Some(wall) = wall {
        <sided_wall::Inputs as Bundle>::map(wall.inputs(), &mut see);
    }
    number = OF_CONTROLLER;
    let mut see = |format: Format| {
        widths.insert(number, as_signed(format));
        number += 1;
    };
    let inputs = controller.inputs();
    <controller::Inputs as Bundle>::map(inputs, &mut see);
    widths.insert(CURVE, as_signed(inputs.tuning.curve_word));
    widths
}

/// The bits of a word as a signed integer.
fn as_signed(format: Format) -> u8 {
    format.width + u8::from(!format.signed)
}

impl Drives {
    /// The registers beside the unit, where there is one.
    pub(super) fn folded(&self) -> Folded<Format> {
        let Some(unit) = &self.unit else {
            return Folded::of(Format::NONE);
        };
        let walls = self.has_walls();
        let force = self.estimates.prompt_force;
        Folded {
            begins: BIT,
            runs: BIT,
            of_wall: BIT.where_present(walls),
            row: self.pad,
            word: unit.inputs().given,
            curve: self.points.format.where_present(unit.registers_words()),
            wall_target: force.where_present(walls),
            wall_free: BIT.where_present(walls),
            wall_valid: BIT.where_present(walls),
            next_drive: self.of_drive.drive,
            next_target: self.of_drive.target,
            next_low: BIT,
            next_high: BIT,
            watch: Watch::registers(self.silent_frames),
        }
    }

    /// A clock of the unit, where there is one.
    #[inline(always)]
    pub(super) fn unit_now<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        r: &Regs<V>,
    ) -> Option<arithmetic_unit::Out<V>> {
        let (unit, within) = self.unit.as_ref().zip(state.submodules.unit.as_mut())?;
        let of = r.folded;
        let entry = |program: usize| int(unit.entry(program));
        let entry = match self.has_walls() {
            true => of.of_wall.select(entry(WALL), entry(CONTROLLER)),
            false => entry(CONTROLLER),
        };
        let entry = entry.resize(unit.inputs().entry, Proved);
        let inputs =
            arithmetic_unit::Inputs { start: of.begins, entry, row: of.row, given: of.word };
        Some(unit.call("unit", within, inputs))
    }

    /// What a wall on the unit gives.
    #[inline(always)]
    pub(super) fn walled<V: Interpretation>(
        &self,
        r: &Regs<V>,
        unit: &Option<arithmetic_unit::Out<V>>,
    ) -> sided_wall::Out<V> {
        let of = r.folded;
        let done = unit.map_or(zero(Format::NONE), |unit| unit.done & of.of_wall);
        sided_wall::Outputs {
            done,
            target: of.wall_target,
            free: of.wall_free,
            valid: of.wall_valid,
        }
    }

    /// The controller's drive word: by itself, or by the unit.
    #[inline(always)]
    pub(super) fn controlled<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        r: &Regs<V>,
        unit: &Option<arithmetic_unit::Out<V>>,
        inputs: controller::In<V>,
    ) -> controller::Out<V> {
        let within = self.controller.as_ref().zip(state.submodules.controller.as_mut());
        if let Some((block, within)) = within {
            return block.call("controller", within, inputs);
        }
        let of = r.folded;
        let unit = unit.expect("a unit where there is no controller");
        let done = unit.done & self.of_controller(&of);
        controller::Outputs {
            done,
            drive: of.next_drive,
            target: of.next_target,
            low: of.next_low,
            high: of.next_high,
            faults: of.watch.latched,
        }
    }

    /// Whether there is something to do beside the unit.
    #[inline(always)]
    pub(super) fn beside_unit<V: Interpretation>(
        &self,
        r: &Regs<V>,
        controller: &controller::In<V>,
        begin: &Begin<V>,
    ) -> Signal<V> {
        if self.unit.is_none() {
            return bit(false);
        }
        let asks = begin.wall.map_or(bit(false), |wall| wall.start);
        let told = controller.alive | controller.clear_faults | controller.tuning.curve_write;
        r.folded.begins | r.folded.runs | asks | controller.start | told
    }

    /// The registers beside the unit after this clock.
    #[inline(always)]
    pub(super) fn next_folded<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        r: &Regs<V>,
        unit: &Option<arithmetic_unit::Out<V>>,
        begin: &Begin<V>,
        controller: &controller::In<V>,
    ) -> Folded<Signal<V>> {
        let of = r.folded;
        let Some(unit) = unit else { return of };
        let found = self.looked_up(state, unit, controller);
        let (curve, kept) = match of.curve.format.is_none() {
            true => (found, of.curve),
            false => (of.curve, of.runs.select(found, of.curve)),
        };
        let asks = begin.wall.map_or(bit(false), |wall| wall.start);
        let begins = asks | controller.start;
        let row = begin.wall.map_or(controller.pad, |wall| asks.select(wall.pad, controller.pad));
        let wall = <sided_wall::Outputs as Bundle>::FIELDS;
        let drive = <controller::Outputs as Bundle>::FIELDS;
        let given =
            |fields, first: u8, name: &str| self.is_given(unit, first + number_of(fields, name));
        let of_wall = |name, old: Signal<V>| match old.format.is_none() {
            true => old,
            false => given(wall, 0, name).select(unit.sum.as_code(old.format), old),
        };
        let of_drive = |name, old: Signal<V>| match old.format.is_none() {
            true => old,
            false => given(drive, OF_CONTROLLER, name).select(unit.sum.as_code(old.format), old),
        };
        let is_set = |name| given(drive, OF_CONTROLLER, name) & unit.sum.bits(0, 1);
        let heard = of.watch.heard(controller.alive, controller.clear_faults);
        let counted = of.watch.counted(controller.alive, self.silent_frames);
        let silent = controller.start.select(counted, heard.silent);
        // Of the register, so that nothing is compared that is still being counted.
        let silence = of.watch.silent.is(self.silent_frames) & !controller.alive;
        let watch = Watch { silent, ..heard }.found(
            of.begins & self.of_controller(&of) & silence,
            is_set("sensor_fault"),
            is_set("force_fault"),
        );
        Folded {
            begins,
            runs: begins | (of.runs & !unit.done),
            of_wall: match of.of_wall.format.is_none() {
                true => of.of_wall,
                false => begins.select(asks, of.of_wall),
            },
            row: begins.select(row, of.row),
            word: of.runs.select(self.word(r, unit, begin, controller, curve), of.word),
            curve: kept,
            wall_target: of_wall("target", of.wall_target),
            wall_free: of_wall("free", of.wall_free),
            wall_valid: of_wall("valid", of.wall_valid),
            next_drive: of_drive("drive", of.next_drive),
            next_target: of_drive("target", of.next_target),
            next_low: of_drive("low", of.next_low),
            next_high: of_drive("high", of.next_high),
            watch,
        }
    }

    /// The program is the controller's.
    #[inline(always)]
    fn of_controller<V: Interpretation>(&self, of: &Folded<Signal<V>>) -> Signal<V> {
        if self.has_walls() { !of.of_wall } else { bit(true) }
    }

    /// The word of the curve that the sum of the clock before names.
    #[inline(always)]
    fn looked_up<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        unit: &arithmetic_unit::Out<V>,
        controller: &controller::In<V>,
    ) -> Signal<V> {
        let within = &mut state.submodules.points;
        let curve = self.points.data(within);
        let tuning = controller.tuning;
        let write = Write {
            enable: tuning.curve_write,
            address: tuning.curve_address,
            data: tuning.curve_word,
        };
        // There is a word for any sum: most are not used.
        self.points.access(within, unit.sum.bits(0, self.points.address().width), write);
        curve
    }

    /// Whether the unit gives a field; never one that is a constant.
    #[inline(always)]
    fn is_given<V: Interpretation>(&self, unit: &arithmetic_unit::Out<V>, field: u8) -> Signal<V> {
        let given = &self.numbers.as_ref().expect("a unit's").given;
        match given.iter().position(|given| *given == field) {
            Some(number) => unit.gives & number_is(unit.number, number, given.len()),
            None => bit(false),
        }
    }

    /// What the unit asks for.
    #[inline(always)]
    fn word<V: Interpretation>(
        &self,
        r: &Regs<V>,
        unit: &arithmetic_unit::Out<V>,
        begin: &Begin<V>,
        controller: &controller::In<V>,
        curve: Signal<V>,
    ) -> Signal<V> {
        let to = r.folded.word.format;
        let asked = &self.numbers.as_ref().expect("a unit's").asked;
        let mut words = [zero(to); MOST_ASKED];
        let mut see = |field: u8, signal: Signal<V>| {
            if let Some(place) = asked.iter().position(|asked| *asked == field) {
                words[place] = signal.integer().resize(to, Proved);
            }
        };
        see(CURVE, curve);
        let mut field = 0;
        begin.wall.map(|wall| {
            <sided_wall::Inputs as Bundle>::map(wall, |signal| {
                see(field, signal);
                field += 1;
            })
        });
        let tuning = controller::Tuning {
            enable: controller.tuning.enable & !r.folded.watch.any(),
            ..controller.tuning
        };
        field = OF_CONTROLLER;
        let controller = controller::Inputs { tuning, ..*controller };
        <controller::Inputs as Bundle>::map(controller, |signal| {
            see(field, signal);
            field += 1;
        });
        chosen(&words[..asked.len()], unit.number)
    }
}

/// Most inputs that programs ask for.
const MOST_ASKED: usize = 32;

/// The word of a number.
#[inline(always)]
fn chosen<V: Interpretation>(words: &[Signal<V>], number: Signal<V>) -> Signal<V> {
    let (to, odd) = (words[0].format, number.bits(0, 1));
    let of_pair = number.bits(1, Format::counter(words.len() as u64 - 1).width - 1);
    by_pair(of_pair, zero(to), words.len().div_ceil(2), |number| {
        let second = words.get(2 * number + 1).copied().unwrap_or(zero(to));
        odd.select(second, words[2 * number])
    })
}

/// Whether a number below `count` is this one.
#[inline(always)]
fn number_is<V: Interpretation>(number: Signal<V>, this: usize, count: usize) -> Signal<V> {
    number.bits(0, Format::counter(count as u64 - 1).width).is(this as u64)
}
