// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every operation, registers that share conditions, states, memories and instances; names that
//! are words of Verilog or taken.

use crate::block::{Block, Interpretation, State};
use crate::claims::{Claims, Held};
use crate::format::{BIT, Format};
use crate::memory::{Memory, Write};
use crate::signal::{Assumed, Proved, Signal, Wrap, bit, code, int};
use crate::states::States;
use crate::{call, next};

mod adder {
    use super::*;

    crate::block! {
        /// A block without reset.
        pub struct Adder("adder", reset: false) { pub width: u8 }
        submodules {}
        inputs(adder) { word: Format::unsigned(adder.width, 0) }
        outputs(adder) { word: Format::unsigned(adder.width, 0), sum: Format::unsigned(adder.width, 0) }
        registers(adder) { sum: Format::unsigned(adder.width, 0) }
    }

    impl Block for Adder {
        fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
            let r = state.load(self);
            let sum = (r.sum + i.word).resize(self.registers().sum, Wrap);
            state.store(self, Registers { sum });
            Outputs { word: i.word, sum: r.sum }
        }
    }
}

crate::states! {
    /// Steps.
    pub enum Step { Idle, Work }
}

crate::block! {
    /// Every part.
    pub struct Parts("parts") {}
    submodules { a: adder::Adder, b: adder::Adder, wide: adder::Adder, words: Memory, table: Memory, unread: Memory }
    inputs(block) {
        /// Begins.
        start: BIT,
        case: Format::signed(5, 2),
        /// A count that a register has, too.
        count: Format::unsigned(3, 0),
    }
    outputs(block) {
        /// The step.
        step in Step,
        count: Format::unsigned(3, 0),
        sum: Format::signed(7, 2),
        difference: Format::signed(7, 2),
        product: Format::signed(8, 2),
        product_of_constant: Format::signed(9, 2),
        square: Format::unsigned(9, 4),
        magnitude: Format::unsigned(5, 2),
        magnitude_unsigned: Format::unsigned(3, 0),
        bits: Format::unsigned(2, 0),
        bits_beyond: Format::unsigned(7, 0),
        joined: Format::unsigned(6, 0),
        less: BIT,
        less_unsigned: BIT,
        less_mixed: BIT,
        equal: BIT,
        logic: BIT,
        choice: Format::signed(6, 2),
        choices: Format::signed(6, 2),
        words: Format::unsigned(6, 0),
        of_a: Format::unsigned(3, 0),
        of_wide: Format::unsigned(4, 0),
        negative: Format::signed(5, 2),
        assumed: Format::unsigned(3, 0),
    }
    registers(block) {
        /// What it does.
        step in Step,
        count: Format::unsigned(3, 0),
        /// Nobody asks for it.
        idle: BIT,
        last: Format::signed(7, 3),
        kept: Format::signed(5, 2),
    }
}

pub fn parts() -> Parts {
    let [narrow, wide] = [3, 4].map(|width| adder::Adder { width });
    let word = Format::signed(4, 1);
    Parts {
        a: narrow.clone(),
        b: narrow,
        wide,
        words: Memory::new("words", 8, Format::unsigned(3, 0)).dont_care_on_collision().in_block(),
        table: Memory::table("table", word, vec![-1.0, 0.5, 1.0, 2.5, -4.0]),
        unread: Memory::new("unread", 2, word),
    }
}

impl Parts {
    fn work<V: Interpretation>(&self, r: Regs<V>, i: In<V>) -> Regs<V> {
        Registers {
            count: r.count.increment(),
            last: i.case.resize(Format::signed(5, 2), Proved),
            ..r
        }
    }
}

impl Block for Parts {
    fn claims<V: Interpretation>(&self, r: Regs<V>, i: In<V>) -> Claims<V> {
        Claims {
            invariants: vec![
                ("a count is small", r.count.less_than(int(4))),
                ("what is kept is a half", r.kept.bits(0, 1).is(0) | !r.step.at(Step::Work)),
            ],
            held: Some(Held { when: i.start, inputs: &["count", "case"] }),
        }
    }

    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let is_working = r.step.at(Step::Work);
        let a = call!(self.a, state, adder::Inputs { word: i.count });
        let b = call!(self.b, state, adder::Inputs { word: a.sum });
        let wide = call!(self.wide, state, adder::Inputs { word: i.count });
        let write = Write { enable: is_working & i.start, address: r.count, data: i.count };
        self.words.access(&mut state.submodules.words, i.count, write);
        self.table.read(&mut state.submodules.table, i.count);
        self.unread.read(&mut state.submodules.unread, i.start);
        let words = self.words.data::<V>(&mut state.submodules.words);
        let table = self.table.data::<V>(&mut state.submodules.table);
        let sum = (i.case + i.count).named("sum_of_both");
        let long = ((r.kept + i.case) * (r.kept - i.case)).bits(0, 3);
        let started = Registers {
            step: Step::Work.signal(),
            count: int(0),
            last: sum.bits(0, 3).scaled(-1),
            ..r
        };
        let ended = Registers { step: Step::Idle.signal(), idle: bit(true), kept: i.case, ..r };
        next!(self, state,
            i.start => started,
            is_working & r.count.is(7) => ended,
            is_working => self.work(r, i),
            else r
        );
        let small = (r.count + i.count).resize(r.count.format, Assumed("counts are small"));
        let choose = |a: Signal<V>, b: Signal<V>| i.start.select(a, b);
        Outputs {
            step: r.step,
            count: r.count,
            sum,
            difference: i.case - r.count,
            product: i.case * i.count,
            product_of_constant: i.count * code(-11, Format::signed(5, 2)),
            square: i.case.square(),
            magnitude: i.case.abs(),
            magnitude_unsigned: i.count.abs(),
            bits: i.case.bits(1, 2),
            bits_beyond: i.case.bits(0, 7),
            joined: i.count.concat(r.count),
            less: i.case.less_than(r.kept),
            less_unsigned: i.count.less_than(r.count),
            less_mixed: i.case.less_than(i.count),
            equal: i.case.equals(i.count) | r.last.is(3),
            logic: !(i.start & (is_working | !r.kept.msb())),
            choice: choose(i.case, r.count),
            choices: is_working
                .select(choose(i.case, r.kept), choose(code(-3, i.case.format), int(5))),
            words: words.concat(table.bits(1, 3)),
            of_a: (b.sum + long).resize(Format::unsigned(3, 0), Wrap),
            of_wide: wide.word.bits(0, 3).concat(wide.sum.msb()),
            negative: code(-7, i.case.format),
            assumed: is_working.select(small, i.count),
        }
    }
}
