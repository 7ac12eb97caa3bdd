// SPDX-License-Identifier: MIT OR Apache-2.0
//! Position and sheet resistance from the ratios: the measured forward map, inverted by Newton
//! steps.
//!
//! ```text
//! r_x = X(u, v),  r_y = Y(u, v)                 splines of what was read at known places; u, v in cells of the table
//! (u, v) += J⁻¹ · (r − (X, Y)(u, v))            `steps` times, from a first guess that is linear in the ratios
//! x = origin_x + u · pitch_x,  y likewise,  R = R(u, v)
//! ```
//!
//! The forward map is smooth; its inverse is not (at an insulated edge the ratios stand still while
//! the pad moves on), so that the former is tabulated, as quadratic B-splines. Ratios are
//! normalised to the table's, by a centre and a gain: those of a sheet whose terminals have large
//! resistances in series span a hundredth of the range.
//!
//! A slot has tens of thousands of clocks for a thousand products, so that one multiplier and one
//! adder suffice. They follow a program (`program.rs`) of instructions (`instruction.rs`) in a
//! memory:
//!
//! ```text
//! program ─[instruction]─┬─ base + option ─ table ───┐
//!                        └─ slot ─ scratch ─┬─[left]─┴[factor]─(×)─(+)─[sum]─(round half up, saturate)─ scratch, x, y, R, base
//!                                           └─────────[word]───┘                         sign ─[quotient]─ left
//! ```
//!
//! | signal        | format          | unit                       | overflow                                             |
//! | words, left   | profile: table  | –                          | saturate: a step gets shorter, a place stays inside    |
//! | sum           | two words, 6 bits | –                        | cannot (range proof)                                  |
//! | u, v          | a word          | 32 cells                   | held within the table                                  |
//! | x, y          | profile         | mm                         | saturate, flagged                                      |
//! | R             | a word's, unsigned | full scales, voltage / current | saturates at zero and at the top               |
//!
//! Where words of block RAMs have registers ([`Profile::registers_block_rams`]) the table is in two banks
//! (`banks.rs`), and both factors come a clock later.
//!
//! `invalid` where the last step began at a place that does not have the normalised ratios, to
//! `2^-TOLERANCE_BITS`. Control does not depend on data. Latency: [`Position::latency`]. Source:
//! Nakamura & Yamamoto 2016, eqs. 2 and 3, for the ratios.

mod at_once;
mod banks;
mod by_statement;
mod instruction;
mod leaps;
mod program;
mod run;
mod trace;

use self::at_once::AtOnce;
use self::banks::Banks;
use self::instruction::{COUNT, LOW, OPEN, Operation, SCALARS, SHARE, SURFACE, WRAP};
use self::leaps::Leaps;
use self::program::Program;
use self::trace::Trace;
use super::multiplier::{self, Multiplier};
use hapticore_contract::calibration::Layout;
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{Floor, Proved, Saturate, Signal, Wrap, bit, code, int, is_set, zero};
use hapticore_hdl::states::States;
use hapticore_hdl::{block, bundle, call, states, when};
use std::sync::{Arc, OnceLock};

bundle! {
    /// The port through which a calibration writes the position table.
    pub struct TablePort {
        /// Writes a word of the position table.
        write,
        /// The word's address.
        address,
        word,
    }
}

bundle! {
    /// What has a register of its own where words do that were read.
    pub struct Held {
        /// A product's operands were read.
        read,
        /// One is a word of the table.
        read_table,
        read_word,
        /// The instruction waits.
        waits,
        /// It has waited long enough.
        settled,
    }
}

states! {
    /// What a spline of the table gives.
    pub enum Spline {
        RX, RY, Resistance,
    }
}

/// How the program's results come without its cycles.
#[derive(Debug, Clone)]
enum Shortcut {
    /// As codes, whatever else an interpretation has.
    Codes(Box<AtOnce>),
    /// With all that an interpretation has.
    Statements(Arc<Trace>),
}

block! {
    /// Position and sheet resistance from the ratios.
    pub struct Position("position") {
        /// Cycles from the program's first instruction to its last.
        clocks: u64,
        steps: u64,
        /// Cycles from a product's operands to its place in the sum.
        wait: u64,
        words: Memory,
        /// Digits of a quotient.
        digits: u8,
        ratio: Format,
        word: Format,
        position: Format,
        sheet: Format,
        /// For interpretations that need not step the program's cycles.
        at_once: Option<Shortcut>,
        /// For clocks of codes at which nobody looks; made when first used.
        leaps: Arc<OnceLock<Leaps>>,
    }
    submodules {
        /// The words, where those that are read have no register.
        table: Option<Memory>,
        /// Else in two banks.
        banks: Option<Banks>,
        scratch: Memory,
        program: Memory,
        multiplier: Multiplier,
    }
    inputs(block) {
        /// Begins; the ratios are valid and stable until `done`.
        start: BIT,
        /// Ratio r_x of eq. 2.
        r_x: block.ratio,
        /// Ratio r_y of eq. 3.
        r_y: block.ratio,
        /// Smallest amplitude over the ratios' denominator.
        share: block.share(),
        table as TablePort: TablePort { write: BIT, address: block.words.address(), word: block.word },
    }
    outputs(block) {
        /// Asserted for one cycle when the others are valid.
        done: BIT,
        /// The position along the long edges, in mm.
        x: block.position,
        /// The position along the short edges, in mm.
        y: block.position,
        /// Resistance of the sheet at the pad, full scales of voltage per current.
        sheet: block.sheet,
        /// No position of the table has the measured ratios.
        invalid: BIT,
        /// A terminal is open.
        lost: BIT,
        /// A position is saturated.
        saturated: BIT,
    }
    registers(block) {
        running: BIT,
        bubble: BIT,
        fetched: block.program.address(),
        instruction: Format::unsigned(instruction::BITS, 0),
        waited: Format::counter(block.wait + 1),
        /// What becomes of the word that was read, as the next four.
        loads: BIT,
        floors: BIT,
        digits: BIT,
        multiplies: BIT,
        tables: BIT,
        held as Held: block.held(),
        pending: Format::unsigned(1 + block.multiplier.latency() as u8, 0),
        left: block.word,
        factor: block.word,
        word: block.word,
        sum: Format::signed(2 * block.word.width + 6, 2 * block.word.frac),
        quotient: Format::unsigned(block.digits, 0),
        base: block.words.address(),
        surface in Spline,
        count: Format::unsigned(4, 0),
        step: Format::counter(block.steps),
        x: block.position,
        y: block.position,
        sheet: block.sheet,
        invalid: BIT,
        lost: BIT,
        saturated: BIT,
        done: BIT,
    }
}

/// An instruction that is carried out in this clock, if it need not wait.
struct Decoded<V> {
    operation: Signal<V>,
    option: Signal<V>,
    /// Whether it is done in this clock.
    done: Signal<V>,
    /// The word that it means.
    slot: Signal<V>,
}

impl<V: Interpretation> Decoded<V> {
    /// Whether it is this one, done in this clock.
    #[inline(always)]
    fn does(&self, operation: Operation) -> Signal<V> {
        self.done & self.is(operation)
    }

    /// Whether it is this one.
    #[inline(always)]
    fn is(&self, operation: Operation) -> Signal<V> {
        self.operation.is(operation as u64).named(operation.name())
    }

    #[inline(always)]
    fn has(&self, option: u8) -> Signal<V> {
        self.option.bits(option.trailing_zeros() as u8, 1)
    }
}

impl Position {
    /// Normalised ratios at the place found and measured ones agree within `2^-TOLERANCE_BITS`.
    pub const TOLERANCE_BITS: u8 = 9;
    /// A step moves by less than this number of cells along either axis.
    pub const STEP_CELLS: f64 = program::STEP as f64;

    /// The position of a profile, with nothing in its table yet.
    pub fn new(profile: &Profile) -> Self {
        let layout = Layout::new(profile);
        let word = profile.formats.table;
        let program = Program::new(word);
        let codes =
            program.instructions.iter().map(|instruction| instruction.code().into()).collect();
        let constants = program::constants(&layout, word);
        let table = Memory::new("words", layout.words(), word).dont_care_on_collision();
        let scratch =
            Memory::new("scratch", constants.len(), word).dont_care_on_collision().in_block();
        let multiplier = Multiplier::new(word.integer(), word.integer(), profile.multiplier);
        let banks = profile.registers_block_rams().then(|| Banks::new(&table));
        let wait = 1 + u64::from(banks.is_some()) + multiplier.latency();
        Position {
            clocks: program.clocks(profile.position.steps, wait),
            digits: program.digits(),
            wait,
            program: Memory::table("instructions", Format::unsigned(instruction::BITS, 0), codes),
            // A slot whose table is written meanwhile gives a frame of neither calibration in any
            // case.
            words: table.clone(),
            table: banks.is_none().then_some(table),
            banks,
            scratch: Memory { initial: constants.into(), ..scratch },
            multiplier,
            steps: profile.position.steps,
            ratio: profile.formats.ratio,
            word,
            position: profile.formats.position,
            sheet: profile.sheet(),
            at_once: None,
            leaps: Arc::default(),
        }
    }

    /// Whether the program is running, and not at its end.
    #[inline(always)]
    pub(super) fn is_running<V: Interpretation>(&self, state: &State<Self, V>) -> bool {
        let r = state.load(self);
        is_set(r.running) && !is_set(r.done)
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        self.clocks + 2
    }

    /// From now on interpretations of codes have their results in the clock after `start`, with a
    /// table of these codes.
    pub(crate) fn place_at_once(&mut self, table: Vec<i64>) {
        self.at_once = Some(Shortcut::Codes(Box::new(AtOnce::new(self, table))));
    }

    /// From now on interpretations that decide by codes have their results in the clock after `start`, with all that
    /// they have beside codes.
    pub(crate) fn place_by_statements(&mut self) {
        let program = Program::new(self.word);
        let trace = Trace::of(&program, self.steps, self.wait);
        self.at_once = Some(Shortcut::Statements(Arc::new(trace)));
    }

    /// The registers in the clock after `start`, without the program's clocks.
    fn placed<V: Interpretation>(
        &self,
        shortcut: &Shortcut,
        state: &mut State<Self, V>,
        i: &In<V>,
    ) -> Regs<V> {
        let at_once = match shortcut {
            Shortcut::Codes(at_once) => at_once,
            Shortcut::Statements(trace) => return self.by_statements(trace, state, i),
        };
        let r = state.load(self);
        let placed = at_once.run([i.r_x, i.r_y, i.share].map(V::code));
        let [x, y, sheet] = placed.outputs;
        let flag = |set: bool| bit(set);
        Registers {
            x: code(x, r.x.format),
            y: code(y, r.y.format),
            sheet: code(sheet, r.sheet.format),
            invalid: flag(placed.invalid),
            lost: flag(placed.lost),
            saturated: flag(placed.saturated),
            done: bit(true),
            ..r
        }
    }

    fn held(&self) -> Held<Format> {
        let of = |format: Format| format.where_present(self.banks.is_some());
        let flag = of(BIT);
        Held { read: flag, read_table: flag, read_word: of(self.word), waits: flag, settled: flag }
    }

    /// The format of a share: that of a ratio's magnitude.
    fn share(&self) -> Format {
        Format::unsigned(self.ratio.width - 1, self.ratio.frac)
    }

    /// Sets a word of the table, without a clock.
    pub(crate) fn set_word<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        address: usize,
        word: Signal<V>,
    ) {
        let within = &mut state.submodules;
        if let Some((banks, within)) = self.banks.as_ref().zip(within.banks.as_mut()) {
            return banks.set_word(within, address, word);
        }
        let (table, words) = self.table.as_ref().zip(within.table.as_mut()).expect("no banks");
        let address = int(address as u64).resize(table.address(), Proved);
        table.access(words, address, Write { enable: bit(true), address, data: word });
    }

    /// The memory of the position table.
    pub fn table(&self) -> &Memory {
        &self.words
    }
}

impl Block for Position {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let Registers { done, x, y, sheet, invalid, lost, saturated, .. } = r;
        let outputs = Outputs { done, x, y, sheet, invalid, lost, saturated };
        if (i.start | r.running | r.done | i.table.write).can_skip() {
            return outputs;
        }
        if let Some(shortcut) = self.at_once.as_ref().filter(|_| V::DECIDES && is_set(i.start)) {
            let next = self.placed(shortcut, state, &i);
            state.store(self, next);
            return outputs;
        }
        let now = self.decode(&r);
        let (result, held) = self.result(&r);
        let read = self.read(state, &r, &i, &now, result);
        let next = self.follow(self.compute(r, &read, &now), &r, &now, &read);
        let next = self.give_out(next, &r, &now, result, held);
        let begun = Registers {
            running: bit(true),
            bubble: bit(true),
            sum: self.half(),
            // Of the slot before, another pad's, nothing is left; its program has ended.
            quotient: int(0),
            surface: Spline::RX.signal(),
            step: int(0),
            invalid: bit(false),
            saturated: bit(false),
            ..next
        };
        state.store(self, when!(i.start => begun, else next));
        outputs
    }
}

/// What the memories and the multiplier have ready in a clock.
struct Read<V> {
    instruction: Signal<V>,
    word: Signal<V>,
    of_table: Signal<V>,
    product: Signal<V>,
}

impl Position {
    /// Half of a word's least step: what rounding adds.
    #[inline(always)]
    fn half<V: Interpretation>(&self) -> Signal<V> {
        code(1 << (self.word.frac - 1), Format::signed(self.word.width + 1, 2 * self.word.frac))
    }

    #[inline(always)]
    fn decode<V: Interpretation>(&self, r: &Regs<V>) -> Decoded<V> {
        let word = r.instruction;
        let operation = operation(word);
        let option = word.bits(0, instruction::OPTION_BITS);
        let is = |other: Operation| operation.is(other as u64).named(other.name());
        let (waits, settled) = match self.banks {
            Some(_) => (r.held.waits, r.held.settled),
            None => (waits(operation).named("waits"), r.waited.is(self.wait + 1)),
        };
        let done = (r.running & !r.bubble & (!waits | settled)).named("does");
        let group = word.bits(instruction::OPTION_BITS, instruction::SLOT_BITS);
        let index = word.bits(instruction::OPTION_BITS + instruction::SLOT_BITS, 2);
        let by = |index: Signal<V>| index.resize(Format::unsigned(4, 0), Proved);
        let none = int(0);
        let of_surface = by(r.surface);
        let of_pair = by(r.surface.bits(0, 1).concat(bit(false)));
        let of_sign = by(r.sum.msb());
        let of_index = index.bits(1, 1).select(
            index.bits(0, 1).select(of_pair, by(r.count)),
            index.bits(0, 1).select(of_surface, is(Operation::LoadDigit).select(of_sign, by(none))),
        );
        // Groups are aligned: the low bits alone tell their words apart.
        let low = bits_or(group.bits(0, 4), of_index.named("of_group"));
        let slot = group.bits(4, instruction::SLOT_BITS - 4).concat(low);
        Decoded { operation, option, done, slot: slot.named("slot") }
    }

    /// The sum as a word, and whether it was saturated.
    #[inline(always)]
    fn result<V: Interpretation>(&self, r: &Regs<V>) -> (Signal<V>, Signal<V>) {
        let (word, held) = r.sum.saturate(self.word, Floor);
        let rounded = word.golden(&[r.sum, self.half()], |of| (of[0] - of[1]).clamp(-1.0, 1.0));
        (rounded.named("result"), held.named("held"))
    }

    /// One clock of the memories and of the multiplier.
    #[inline(always)]
    fn read<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        r: &Regs<V>,
        i: &In<V>,
        now: &Decoded<V>,
        result: Signal<V>,
    ) -> Read<V> {
        let option = now.is(Operation::MultiplyTable).select(now.option, int(0));
        let address = (r.base + option).resize(r.base.format, Wrap);
        let of_table = self.of_table(state, r, i.table, address);
        let word = self.scratch.data(&mut state.submodules.scratch);
        let instruction = self.program.data(&mut state.submodules.program);
        let enable = now.does(Operation::Store) | now.does(Operation::Input);
        let write =
            Write { enable, address: variable(now.slot), data: self.stored(r, i, now, result) };
        self.scratch.access(&mut state.submodules.scratch, now.slot, write);
        self.program.read(&mut state.submodules.program, self.fetch(r, now));
        let (now, next) = (r.pending.bits(0, 1), r.pending.bits(1, 1));
        // A product of two clocks goes on in the second.
        let enable = if self.multiplier.latency() == 1 { now } else { now | next };
        let inputs =
            multiplier::Inputs { enable, left: r.factor.integer(), right: r.word.integer() };
        let product = call!(self.multiplier, state, inputs).product;
        Read { instruction, word, of_table, product: product.scaled(-2 * self.word.frac) }
    }

    /// The word of the table that was asked for, and a clock of its memories.
    #[inline(always)]
    fn of_table<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        r: &Regs<V>,
        port: TablePort<Signal<V>>,
        address: Signal<V>,
    ) -> Signal<V> {
        let within = &mut state.submodules;
        if let Some((banks, within)) = self.banks.as_ref().zip(within.banks.as_mut()) {
            let inputs = banks::Inputs { read_address: address, takes: r.multiplies, table: port };
            return banks.call("banks", within, inputs).word;
        }
        let (table, words) = self.table.as_ref().zip(within.table.as_mut()).expect("no banks");
        let word = table.data(words);
        let write = Write { enable: port.write, address: port.address, data: port.word };
        table.access(words, address, write);
        word
    }

    /// What goes into the scratch memory.
    #[inline(always)]
    fn stored<V: Interpretation>(
        &self,
        r: &Regs<V>,
        i: &In<V>,
        now: &Decoded<V>,
        result: Signal<V>,
    ) -> Signal<V> {
        let turned = r.sum.quantize(self.word, Floor, Wrap);
        // The whole turn that is nearest to the code's.
        let turned = turned.golden(&[r.sum, self.half(), turned], |of| {
            let number = of[0] - of[1];
            number - 2.0 * ((number - of[2]) / 2.0).round()
        });
        let ratio = r.surface.bits(0, 1).select(i.r_y, i.r_x);
        let ratio = now.has(SHARE).select(i.share.resize(self.ratio, Proved), ratio);
        let halved = ratio.scaled(-1);
        let high = halved.quantize(self.word, Floor, Proved);
        let rest = (self.ratio.frac + 1 - self.word.frac) as u8;
        // What the high part leaves, in steps of a word. It is the code's: a ratio without rounding may be
        // many steps away, which the high part then is, too.
        let (high, low) = match rest {
            0 => (high, zero(self.word)),
            _ => {
                let step = code(1, Format::unsigned(1, self.word.frac));
                let low = ratio.bits(0, rest).scaled(-(rest as i8));
                (high.golden(&[halved, low, step], |of| of[0] - of[1] * of[2]), low)
            }
        };
        let taken = now.has(LOW).select(low, high);
        let kept = now.has(WRAP).select(turned, result);
        now.is(Operation::Input).select(taken, kept)
    }

    /// Where the next instruction but one lies.
    #[inline(always)]
    fn fetch<V: Interpretation>(&self, r: &Regs<V>, now: &Decoded<V>) -> Signal<V> {
        let target = r.instruction.bits(0, instruction::TARGET_BITS);
        let target = target.resize(r.fetched.format, Wrap);
        let following = r.fetched.increment();
        let on =
            self.jumps(r, now).select(target, (now.done | r.bubble).select(following, r.fetched));
        let ends = now.does(Operation::End);
        (r.running & !ends).select(on, int(0)).named("fetch")
    }

    #[inline(always)]
    fn found<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        r.step.is(self.steps)
    }

    #[inline(always)]
    fn jumps<V: Interpretation>(&self, r: &Regs<V>, now: &Decoded<V>) -> Signal<V> {
        let repeats = now.does(Operation::Repeat) & !r.count.is(0);
        let other = now.does(Operation::Surfaces) & r.surface.at(Spline::RX);
        let again = now.does(Operation::Pass) & !r.step.is(self.steps - 1);
        let found = now.does(Operation::Found) & self.found(r);
        (repeats | other | again | found).named("jumps")
    }

    /// The registers that compute: what was read goes to the multiplier, and its products into the
    /// sum.
    #[inline(always)]
    fn compute<V: Interpretation>(&self, r: Regs<V>, read: &Read<V>, now: &Decoded<V>) -> Regs<V> {
        let does = |operation: Operation| now.does(operation);
        let (digit, quotient) = (does(Operation::LoadDigit), does(Operation::LoadQuotient));
        let loads = does(Operation::Load) | does(Operation::LoadCell) | digit | quotient;
        let tables = does(Operation::MultiplyTable);
        let sum = self.sum_with(&r, read.product);
        let added = when!(r.pending.msb() => sum, else r.sum);
        let clears = does(Operation::Store) | does(Operation::Output);
        let whole = self.whole(read.word);
        let word = r.floors.select(whole, read.word);
        let operand = r.digits.select(self.of_digits(&r), word);
        let (multiplies, tables_word, right) = match self.banks {
            Some(_) => (r.held.read, r.held.read_table, r.held.read_word),
            None => (r.multiplies, r.tables, read.word),
        };
        let factor = tables_word.select(read.of_table, r.left);
        let pending = r.pending.concat(multiplies);
        Registers {
            loads,
            floors: does(Operation::LoadCell),
            digits: quotient,
            multiplies: does(Operation::Multiply) | tables,
            tables,
            pending: pending.bits(0, r.pending.format.width),
            left: r.loads.select(operand, r.left),
            factor: multiplies.select(factor, r.factor),
            word: multiplies.select(right, r.word),
            sum: when!(clears => self.half(), else added),
            quotient: digit.select(self.with_digit(&r), r.quotient),
            base: self.next_base(&r, now),
            ..r
        }
    }

    /// The sum with a product more.
    #[inline(always)]
    fn sum_with<V: Interpretation>(&self, r: &Regs<V>, product: Signal<V>) -> Signal<V> {
        (r.sum + product).resize(r.sum.format, Proved)
    }

    /// A place without its fraction of a cell.
    #[inline(always)]
    fn whole<V: Interpretation>(&self, word: Signal<V>) -> Signal<V> {
        word.quantize(Format::signed(6, 5), Floor, Proved)
    }

    /// The quotient with a digit more, which is set where the sum is not negative.
    #[inline(always)]
    fn with_digit<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        r.quotient.concat(!r.sum.msb()).bits(0, r.quotient.format.width)
    }

    /// What has registers of its own, after this clock; `on`: the next instruction is taken.
    #[inline(always)]
    fn next_held<V: Interpretation>(
        &self,
        r: &Regs<V>,
        on: Signal<V>,
        read: &Read<V>,
    ) -> Held<Signal<V>> {
        if self.banks.is_none() {
            return r.held;
        }
        let operation = operation(read.instruction);
        Held {
            read: r.multiplies,
            read_table: r.tables,
            read_word: r.multiplies.select(read.word, r.held.read_word),
            waits: on.select(waits(operation), r.held.waits),
            settled: r.running & !on & r.waited.is(self.wait),
        }
    }

    #[inline(always)]
    fn next_base<V: Interpretation>(&self, r: &Regs<V>, now: &Decoded<V>) -> Signal<V> {
        let scalars =
            r.surface.bits(0, 1).concat(code(0, Format::counter(Layout::SCALARS as u64 - 1)));
        let sets = now.does(Operation::Set) & now.has(SCALARS);
        let from_sum = r.sum.bits(self.word.frac as u8, r.base.format.width);
        // Halves of a wide product have wider ranges than the whole: what cannot be is ruled out
        // once more.
        let last = code(self.words.words as i64 - 3, r.base.format);
        let from_sum =
            if self.multiplier.latency() == 1 { from_sum } else { from_sum.at_most(last) };
        let kept = now.does(Operation::Base).select(from_sum, r.base);
        sets.select(scalars.resize(r.base.format, Proved), kept)
    }

    /// The quotient of its digits, of which a set bit is +1 and another −1, as a place.
    #[inline(always)]
    fn of_digits<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        let bits = r.quotient.format.width;
        let coded = (!r.quotient.msb()).concat(r.quotient.bits(0, bits - 1));
        let quotient =
            Format::signed(bits, i8::try_from(bits + 2).expect("sixteen digits at most"));
        let step =
            code(1, Format::unsigned(1, i8::try_from(bits).expect("sixteen digits at most")));
        // What the remainder, over the determinant in `left`, leaves; nothing where the quotient is
        // at full scale: its largest code is two steps below one, the next four. The program has
        // taken the half of rounding out of the sum.
        coded.as_code(quotient).golden(&[coded.as_code(quotient), r.sum, r.left, step], |of| {
            let is_held = 8.0 * of[0].abs() > 1.0 - 3.0 * of[3];
            if is_held { of[0] } else { of[0] + of[1] / of[2].abs() / 8.0 }
        })
    }

    /// The registers that say where the program is.
    #[inline(always)]
    fn follow<V: Interpretation>(
        &self,
        next: Regs<V>,
        r: &Regs<V>,
        now: &Decoded<V>,
        read: &Read<V>,
    ) -> Regs<V> {
        let does = |operation: Operation| now.does(operation);
        let set = does(Operation::Set);
        let value = r.instruction.bits(instruction::OPTION_BITS, 4);
        let less = (r.count - int(1)).resize(r.count.format, Wrap);
        let counted = (does(Operation::Repeat) & !r.count.is(0)).select(less, r.count);
        let following = r.surface.at(Spline::RX).select(
            Spline::RY.signal(),
            self.found(r).select(Spline::Resistance.signal(), Spline::RX.signal()),
        );
        let surface = does(Operation::Surfaces).select(following, r.surface);
        let on = now.done | r.bubble;
        let more = r.waited.increment();
        let ends = does(Operation::End);
        Registers {
            running: r.running & !ends,
            bubble: self.jumps(r, now),
            fetched: self.fetch(r, now),
            instruction: on.select(read.instruction, r.instruction),
            held: self.next_held(r, on, read),
            waited: (on | !r.running).select(int(0), more),
            count: (set & now.has(COUNT)).select(value, counted),
            surface: (set & now.has(SURFACE)).select(Spline::RX.signal(), surface),
            step: does(Operation::Pass).select(r.step.increment(), r.step),
            done: ends,
            ..next
        }
    }

    /// The output registers.
    #[inline(always)]
    fn give_out<V: Interpretation>(
        &self,
        next: Regs<V>,
        r: &Regs<V>,
        now: &Decoded<V>,
        result: Signal<V>,
        held: Signal<V>,
    ) -> Regs<V> {
        let output = now.does(Operation::Output);
        let (of_x, of_y) = (output & r.surface.at(Spline::RX), output & r.surface.at(Spline::RY));
        let position = result.integer().as_code(r.x.format);
        let tolerance = self.word.frac as u8 - Position::TOLERANCE_BITS;
        let above = result.integer().bits(tolerance, Position::TOLERANCE_BITS + 1);
        let beyond = !(above.is(0) | above.is((1 << (Position::TOLERANCE_BITS + 1)) - 1));
        let stores = now.does(Operation::Store);
        let checks = stores & now.has(instruction::CHECK);
        let opens = stores & now.has(OPEN);
        let before = r.surface.at(Spline::RY) & r.invalid;
        Registers {
            x: of_x.select(position, r.x),
            y: of_y.select(position, r.y),
            sheet: when!(output & r.surface.at(Spline::Resistance) => result.resize(r.sheet.format, Saturate), else r.sheet),
            invalid: checks.select(before | beyond, r.invalid),
            lost: opens.select(result.integer().less_than(int(0)), r.lost),
            saturated: r.saturated | ((of_x | of_y) & held),
            ..next
        }
    }
}

/// The operation of an instruction.
#[inline(always)]
fn operation<V: Interpretation>(instruction: Signal<V>) -> Signal<V> {
    instruction.bits(instruction::BITS - instruction::OPERATION_BITS, instruction::OPERATION_BITS)
}

/// Whether an operation is one that waits for products.
#[inline(always)]
fn waits<V: Interpretation>(operation: Signal<V>) -> Signal<V> {
    let is = |other: Operation| operation.is(other as u64).named(other.name());
    let [first, others @ ..] = Operation::WAITING;
    let mut waits = is(first);
    for other in others {
        waits = waits | is(other);
    }
    waits
}

/// The slot, or the variable in its place where it is a constant's. No program stores to a constant;
/// an upset instruction could, and nothing writes a constant again.
#[inline(always)]
fn variable<V: Interpretation>(slot: Signal<V>) -> Signal<V> {
    let bits = program::VARIABLES.trailing_zeros() as u8;
    bit(true).concat(slot.bits(0, bits)).named("variable")
}

/// Either integer's bits, of four each.
#[inline(always)]
fn bits_or<V: Interpretation>(a: Signal<V>, b: Signal<V>) -> Signal<V> {
    let bit = |k: u8| a.bits(k, 1) | b.bits(k, 1);
    bit(3).concat(bit(2)).concat(bit(1)).concat(bit(0))
}

#[cfg(test)]
mod tests;
