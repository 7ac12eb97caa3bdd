// SPDX-License-Identifier: MIT OR Apache-2.0
//! Arithmetic unit: what other blocks compute, one operation after the other.
//!
//! ```text
//! program ─[instruction]─┬─ slot ─ words ─ word ─┬─(±)─(lesser, greater)─┐
//!                        │                       └─(×)───────────────────┤
//!                        └─ operation            ports ──────────────────┴─[sum]─(shift, round)─ words, ports
//! ```
//!
//! Where a slot has thousands of clocks for some hundred operations, one adder does them all, by a
//! program. A program is made from what a block is to its inputs and memories from `start` to `done`
//! ([`Expression`]), so that a block is written once, and either has its own adders or is folded onto
//! this one. Formats are settled as the program is made: words are codes as integers.
//!
//! | signal | format | overflow |
//! | sum    | signed, as wide as the widest sum of any program | cannot: it is known from the ranges of all |
//! | words  | signed, as wide as the widest word that is stored | cannot, likewise |
//!
//! An instruction is fetched while the one before is carried out, in a clock, and where words have a register
//! of their own, for parts on which block RAMs are slow and the clock is not, the one before that; a product takes
//! the multiplier's, too, a shift one for each place. Only loops
//! of a constant number of turns go back: latency is constant. Latency: that of the program,
//! [`ArithmeticUnit::latency`].
//!
//! What a program asks for (`Ask`) is given in the clock after; words that a program gives come with their
//! number. A row of words, one for each pad, stays from run to run.
//!
//! [`Expression`]: hapticore_hdl::interpretations::expression::Expression

mod digits;
pub mod instruction;
pub mod program;
pub mod translate;
mod writer;

use self::instruction::{
    ACTION_BITS, Action, BITS, OPERAND_BITS, ROW_SLOT_BITS, SLOT_BITS, SOURCE_BITS, Source,
    TIMES_BITS, WHEN_BITS, When,
};
use self::program::Programs;
use super::multiplier::{self, Multiplier};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{Proved, Signal, Wrap, bit, code, int, zero};
use hapticore_hdl::{block, bundle, call, when};

bundle! {
    /// Fields of an instruction.
    pub struct Fields { source, when, action, operand }
}

bundle! {
    /// Those of the next one.
    pub struct Ahead { next_source, next_when, next_action, next_operand }
}

const FIELDS: Fields<Format> = Fields {
    source: Format::unsigned(SOURCE_BITS, 0),
    when: Format::unsigned(WHEN_BITS, 0),
    action: Format::unsigned(ACTION_BITS, 0),
    operand: Format::unsigned(OPERAND_BITS, 0),
};

block! {
    /// An adder with a program.
    pub struct ArithmeticUnit("arithmetic_unit") {
        /// Where each program begins.
        entries: Vec<usize>,
        clocks: Vec<u64>,
        sum: Format,
        row: Format,
        given: Format,
        /// A word that was read has a register before it is used.
        registers_words: bool,
        /// Of an instruction.
        address: Format,
    }
    submodules {
        program: Memory,
        /// The instructions beyond the program's memory.
        rest: Option<Memory>,
        words: Memory,
        multiplier: Multiplier,
    }
    inputs(unit) {
        /// Begins a program.
        start: BIT,
        /// Its first instruction.
        entry: unit.address,
        /// The row of words that the program means; stable until `done`.
        row: unit.row,
        /// What was asked for in the clock before.
        given: unit.given,
    }
    outputs(unit) {
        /// Asserted for one cycle when a program has ended.
        done: BIT,
        /// The number of what is asked for or shown.
        number: Format::unsigned(OPERAND_BITS, 0),
        /// The sum is what the number means.
        gives: BIT,
        /// The sum.
        sum: unit.sum,
    }
    registers(unit) {
        running: BIT,
        /// Address of the instruction that is fetched.
        fetched: unit.address,
        source: FIELDS.source,
        when: FIELDS.when,
        action: FIELDS.action,
        operand: FIELDS.operand,
        /// The instruction after it, whose word is being read.
        ahead as Ahead: unit.ahead(),
        word: unit.words.format.where_present(unit.registers_words),
        /// The instruction did not end with the clock before, in which the word of the one ahead was taken.
        waited: BIT.where_present(unit.registers_words),
        /// A product is under way for so many clocks.
        multiplies: Format::unsigned(unit.multiplier.latency() as u8, 0),
        sum: unit.sum,
        flag: BIT,
        /// The instruction before this clock went back.
        jumped: BIT,
        /// How often an instruction still goes back.
        times: Format::unsigned(TIMES_BITS, 0),
        /// The bit that was shifted out last, and whether any before it was set.
        half: BIT,
        less: BIT,
        done: BIT,
    }
}

/// What of an instruction there is to do in a clock.
struct Now<V> {
    /// It ends with this clock.
    ends: Signal<V>,
    stores: Signal<V>,
    gives: Signal<V>,
    /// It is the last.
    stops: Signal<V>,
    /// It goes back: the address changes in the clock after, which is no long path then.
    jumps: Signal<V>,
    /// The one before did.
    jumped: Signal<V>,
    /// It says how often.
    repeats: Signal<V>,
    multiplies: Signal<V>,
    shifts: Signal<V>,
}

impl ArithmeticUnit {
    /// Bits by which what is computed on the way is wider than a sum.
    pub const CARRIES: u8 = 3;

    /// A unit with programs, for so many rows, given words of a format, where hardware multipliers have
    /// so many bits.
    pub fn new(programs: Programs, rows: u64, given: Format, hardware: u8) -> Self {
        let Programs { instructions, entries, clocks, products, behind, words, sum, word, factors } =
            programs;
        let row = Format::counter(rows - 1);
        let codes: Vec<f64> = instructions.iter().map(|of| of.code().into()).collect();
        let address = Format::counter(codes.len() as u64 - 1);
        let (program, rest) = memories(codes, behind == 2);
        let [left, right] = factors;
        let multiplier = Multiplier::new(left, right, hardware);
        let of_products = products.iter().map(|products| products * multiplier.latency());
        let clocks = clocks.iter().zip(of_products).map(|(others, these)| others + these).collect();
        let mut initial: Vec<f64> = words.into_iter().map(|code| code as f64).collect();
        initial.resize(1 << (1 + SLOT_BITS.max(row.width + ROW_SLOT_BITS)), 0.0);
        let of_words = Memory::new("words", initial.len(), word).dont_care_on_collision();
        ArithmeticUnit {
            entries,
            clocks,
            sum: Format { width: sum.width.max(given.width + 1), ..sum },
            row,
            given,
            registers_words: behind == 2,
            address,
            program,
            rest,
            words: Memory { initial: initial.into(), ..of_words.in_block() },
            multiplier,
        }
    }

    /// Whether words of block RAMs have a register before they are used.
    pub fn registers_words(&self) -> bool {
        self.registers_words
    }

    /// Where a program begins.
    pub fn entry(&self, program: usize) -> u64 {
        self.entries[program] as u64
    }

    /// Clocks from `start` to `done` of a program.
    pub fn latency(&self, program: usize) -> u64 {
        self.clocks[program]
    }

    /// The address of the word that an operand means.
    #[inline(always)]
    fn address<V: Interpretation>(&self, operand: Signal<V>, row: Signal<V>) -> Signal<V> {
        let of_row = row.concat(operand.bits(0, ROW_SLOT_BITS));
        let bits = self.words.address().width - 1;
        let (of_row, of_none) = (of_row.bits(0, bits), operand.bits(0, SLOT_BITS).bits(0, bits));
        let is_of_row = operand.bits(SLOT_BITS, 1);
        is_of_row.concat(is_of_row.select(of_row, of_none))
    }

    /// What the instruction does in this clock.
    #[inline(always)]
    fn now<V: Interpretation>(&self, r: &Regs<V>) -> Now<V> {
        let always = r.running & r.when.is(When::Always as u64);
        let never = r.running & r.when.is(When::Never as u64);
        let acts = |action: Action| never & r.action.is(action as u64);
        let told = r.source.bits(0, 1);
        let shifts = always & r.source.bits(1, 2).is(Source::Left as u64 >> 1);
        let multiplies = always & r.source.is(Source::Product as u64);
        let waits = (shifts & !r.operand.is(1)) | (multiplies & !r.multiplies.msb());
        let (shows, repeats) = (acts(Action::Give), acts(Action::Repeat));
        Now {
            ends: (!waits).named("ends"),
            stores: acts(Action::Store).named("stores"),
            gives: (shows & !told).named("gives_sum"),
            stops: (shows & told).named("stops"),
            jumps: (repeats & told & !r.times.is(0)).named("jumps"),
            jumped: r.jumped,
            repeats: (repeats & !told).named("repeats"),
            multiplies: multiplies.named("multiplies_now"),
            shifts: shifts.named("shifts"),
        }
    }

    /// The sum and the word, twice the sum, or the difference of sum and word: one adder for all, as the
    /// difference is the sum with all bits of the word inverted and one more. A sum holds every difference whose
    /// sign is looked at.
    #[inline(always)]
    fn total<V: Interpretation>(&self, r: &Regs<V>, word: Signal<V>) -> Signal<V> {
        let is_difference = r.source.is(Source::Difference as u64);
        let subtracts = (is_difference | r.when.is(When::Less as u64)).named("subtracts");
        let width = self.sum.width;
        let carried = |signal: Signal<V>, carry: Signal<V>| {
            let bits = signal.resize(self.sum, Proved).bits(0, width);
            bits.concat(carry).as_code(Format::signed(width + 1, 0))
        };
        let inverted = (code::<V>(-1, Format::signed(1, 0)) - word).resize(word.format, Proved);
        let twice = r.source.is(Source::Left as u64).named("twice");
        let other = twice.select(r.sum, subtracts.select(inverted, word));
        let total = carried(r.sum, bit(true)) + carried(other, subtracts);
        total.bits(1, width).as_code(self.sum).named("total")
    }

    /// What the sum takes, and whether it does.
    #[inline(always)]
    fn taken<V: Interpretation>(
        &self,
        r: &Regs<V>,
        i: &In<V>,
        now: &Now<V>,
        word: Signal<V>,
        product: Signal<V>,
    ) -> (Signal<V>, Signal<V>) {
        let odd = r.action.bits(0, 1);
        let width = self.sum.width;
        let wide = |signal: Signal<V>| signal.resize(self.sum, Proved);
        let total = self.total(r, word);
        let less = total.msb();
        // A digit of a quotient.
        let digit = total.bits(0, 1) | r.when.is(When::Less as u64);
        let total = total.bits(1, width - 1).concat(digit).as_code(self.sum);
        let right = wide(r.sum.bits(1, width - 1).as_code(Format::signed(width - 1, 0)));
        let told = wide(odd.select(r.sum.is(0), r.sum.msb()));
        let product = product.resize(self.sum, Wrap);
        let odd_source = r.source.bits(0, 1);
        let pair = |set: Signal<V>, clear: Signal<V>| odd_source.select(set, clear);
        let pairs =
            [pair(told, wide(word)), pair(right, total), total, pair(wide(i.given), product)];
        let of_pair = r.source.bits(1, SOURCE_BITS - 1);
        let source = by_pair(of_pair, zero(self.sum), pairs.len(), |number| pairs[number]);
        let by_less = r.when.bits(0, 1).select(odd.select(less, !less), r.flag);
        let takes = r.when.bits(1, 1).select(by_less, r.when.bits(0, 1));
        let waits = now.multiplies & !now.ends;
        (source, r.running & takes & !waits)
    }
}

/// One of `pairs` choices between two words, each by the lowest bit of a number: that of the number's other
/// bits. In lookup tables with four inputs a pair and whether it is meant are one, which a tree of all bits is
/// not.
#[inline(always)]
pub(super) fn by_pair<V: Interpretation>(
    of_pair: Signal<V>,
    none: Signal<V>,
    pairs: usize,
    pair: impl Fn(usize) -> Signal<V>,
) -> Signal<V> {
    (0..pairs)
        .rev()
        .fold(none, |others, number| of_pair.is(number as u64).select(pair(number), others))
}

impl Block for ArithmeticUnit {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let now = self.now(&r);
        let outputs = Outputs { done: r.done, number: r.operand, gives: now.gives, sum: r.sum };
        if (i.start | r.running | r.done).can_skip() {
            return outputs;
        }
        let within = &mut state.submodules;
        let read = self.words.data(&mut within.words);
        let word = if self.registers_words { r.word } else { read };
        let inputs = multiplier::Inputs {
            enable: now.multiplies,
            left: r.sum.bits(0, self.multiplier.inputs().left.width),
            right: word.bits(0, self.multiplier.inputs().right.width),
        };
        let product = call!(self.multiplier, state, inputs).product;
        let (taken, takes) = self.taken(&r, &i, &now, word, product);
        let fields = fields(self.instruction(state, &r));
        let within = &mut state.submodules;
        let write = Write {
            enable: now.stores,
            address: self.address(r.operand, i.row),
            data: r.sum.resize(self.words.format, Wrap),
        };
        self.words.access(&mut within.words, self.address(fields.operand, i.row), write);
        let fetched = self.fetched(&r, &i, &now);
        self.fetch(state, fetched);
        let next = Registers { fetched, sum: takes.select(taken, r.sum), ..r };
        let next = self.followed(next, &r, &now, word);
        state.store(self, self.decoded(next, &i, &now, fields, read));
        outputs
    }
}

impl ArithmeticUnit {
    /// The instruction that was fetched.
    #[inline(always)]
    fn instruction<V: Interpretation>(&self, state: &mut State<Self, V>, r: &Regs<V>) -> Signal<V> {
        let within = &mut state.submodules;
        let first = self.program.data(&mut within.program);
        match self.rest.as_ref().zip(within.rest.as_mut()) {
            Some((rest, words)) => r.fetched.msb().select(rest.data(words), first),
            None => first,
        }
    }

    /// Fetches an instruction, of either memory.
    #[inline(always)]
    fn fetch<V: Interpretation>(&self, state: &mut State<Self, V>, address: Signal<V>) {
        let within = &mut state.submodules;
        let low = |memory: &Memory| {
            let to = memory.address();
            address.bits(0, to.width).as_code(to)
        };
        self.program.read(&mut within.program, low(&self.program));
        if let Some((rest, words)) = self.rest.as_ref().zip(within.rest.as_mut()) {
            rest.read(words, low(rest));
        }
    }

    /// The address of the instruction that is fetched next.
    #[inline(always)]
    fn fetched<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>, now: &Now<V>) -> Signal<V> {
        let back = int::<V>(0) - r.operand;
        let ends = now.ends.resize(back.format, Proved);
        let by = r.jumped.select(back, ends);
        let following = (r.fetched + by).resize(r.fetched.format, Wrap);
        r.running.select(following, i.entry)
    }

    /// Flag, times and what a shift has lost.
    #[inline(always)]
    fn followed<V: Interpretation>(
        &self,
        next: Regs<V>,
        r: &Regs<V>,
        now: &Now<V>,
        word: Signal<V>,
    ) -> Regs<V> {
        let rounds = r.half & (r.less | r.sum.bits(0, 1));
        let acts = |action: Action| r.action.is(action as u64);
        let tested = when!(
            acts(Action::Test) => word.bits(0, 1),
            acts(Action::TestSum) => r.sum.bits(0, 1),
            acts(Action::TestNegative) => r.sum.msb(),
            else rounds
        );
        let any = [Action::Test, Action::TestSum, Action::TestNegative, Action::Round].map(acts);
        let tests = any.into_iter().fold(bit(false), |any, this| any | this);
        let is_right = now.shifts & r.source.bits(0, 1);
        let fewer = (r.times - int(1)).resize(r.times.format, Wrap);
        let counted = now.jumps.select(fewer, r.times);
        let multiplies = r.multiplies.concat(now.multiplies & r.multiplies.is(0));
        Registers {
            flag: tests.select(tested, r.flag),
            times: now.repeats.select(r.operand.bits(0, TIMES_BITS), counted),
            half: is_right & r.sum.bits(0, 1),
            less: is_right & (r.half | r.less),
            multiplies: multiplies.bits(0, r.multiplies.format.width),
            running: r.running & !now.stops,
            jumped: now.jumps,
            done: now.stops,
            ..next
        }
    }

    /// The instruction that was fetched, where the one before it ends; none after a jump.
    #[inline(always)]
    fn decoded<V: Interpretation>(
        &self,
        r: Regs<V>,
        i: &In<V>,
        now: &Now<V>,
        fetched: Fields<Signal<V>>,
        read: Signal<V>,
    ) -> Regs<V> {
        let on = r.running & now.ends;
        let rests = i.start | now.jumps | now.jumped | now.stops;
        let rest = |next: Signal<V>| rests.select(zero(next.format), next);
        let ahead = r.ahead;
        let (following, ahead, word) = match self.registers_words {
            false => (fetched, ahead, r.word),
            true => {
                let following = Fields {
                    source: ahead.next_source,
                    when: ahead.next_when,
                    action: ahead.next_action,
                    operand: ahead.next_operand,
                };
                let ahead = Ahead {
                    next_source: on.select(fetched.source, ahead.next_source),
                    next_when: rest(on.select(fetched.when, ahead.next_when)),
                    next_action: rest(on.select(fetched.action, ahead.next_action)),
                    next_operand: on.select(fetched.operand, ahead.next_operand),
                };
                // A product has taken its word in its first clock, and a shift takes none.
                let acts = !(following.when.is(0) & following.action.is(0));
                (following, ahead, (r.running & !r.waited & acts).select(read, r.word))
            }
        };
        let places = (r.operand - now.shifts).resize(r.operand.format, Wrap);
        Registers {
            running: i.start | r.running,
            source: on.select(following.source, r.source),
            when: rest(on.select(following.when, r.when)),
            action: rest(on.select(following.action, r.action)),
            // How far back is known in the clock after, too.
            operand: (on & !now.jumps).select(following.operand, places),
            ahead,
            word,
            waited: match self.registers_words {
                true => r.running & !now.ends,
                false => r.waited,
            },
            ..r
        }
    }

    /// The fields of the instruction ahead, where there is one.
    fn ahead(&self) -> Ahead<Format> {
        let of = |format: Format| format.where_present(self.registers_words);
        Ahead {
            next_source: of(FIELDS.source),
            next_when: of(FIELDS.when),
            next_action: of(FIELDS.action),
            next_operand: of(FIELDS.operand),
        }
    }
}

/// The memories of a program: one, or where block RAMs are small and the program is at most a quarter longer than
/// a power of two, one of that and one of the rest.
fn memories(mut codes: Vec<f64>, large: bool) -> (Memory, Option<Memory>) {
    let table = |name, mut codes: Vec<f64>| {
        // Instructions behind the last are fetched, and not carried out.
        codes.resize(codes.len().next_power_of_two(), 0.0);
        Memory::table(name, Format::unsigned(BITS, 0), codes)
    };
    let full = codes.len().next_power_of_two() / 2;
    let splits = !large && full < codes.len() && 4 * (codes.len() - full) <= full;
    let rest = splits.then(|| table("rest", codes.split_off(full)));
    (table("instructions", codes), rest)
}

/// The fields of an instruction.
#[inline(always)]
fn fields<V: Interpretation>(instruction: Signal<V>) -> Fields<Signal<V>> {
    Fields {
        source: instruction.bits(OPERAND_BITS, SOURCE_BITS),
        when: instruction.bits(OPERAND_BITS + SOURCE_BITS, WHEN_BITS),
        action: instruction.bits(BITS - ACTION_BITS, ACTION_BITS),
        operand: instruction.bits(0, OPERAND_BITS),
    }
}

#[cfg(test)]
mod tests;
