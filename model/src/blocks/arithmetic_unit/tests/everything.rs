// SPDX-License-Identifier: MIT OR Apache-2.0
//! A block with every operation of expressions, in formats drawn at random.

use super::PADS;
use crate::support::random::Random;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::bundle::Choice;
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{Assumed, Floor, HalfEven, Proved, Saturate, Signal, Wrap, bit, int};
use hapticore_hdl::{block, bundle};

block! {
    /// Every operation.
    pub struct Everything("everything") {
        a: Format,
        b: Format,
        /// To which values are narrowed.
        to: Format,
    }
    submodules {
        table: Memory,
        kept: Memory,
        others: Memory,
    }
    inputs(of) {
        start: BIT,
        pad: Format::counter(PADS - 1),
        a: of.a,
        b: of.b,
        /// A factor without a sign.
        c: Format::unsigned(9, 3),
        bit: BIT,
    }
    outputs(of) {
        done: BIT,
        sum: of.to,
        difference: of.to,
        product: of.to,
        magnitude: Format::unsigned(of.a.width, of.a.frac),
        floor: of.to,
        wrapped: of.to,
        low_bits: Format::unsigned(3, 0),
        joined: Format::unsigned(8, 0),
        less: BIT,
        equal: BIT,
        logic: BIT,
        lesser: of.a.join(of.b),
        greater: of.a.join(of.b),
        selected: of.a.join(of.b),
        looked_up: of.to,
        mean: of.a,
        /// Of b, as it was kept below a bit.
        before: Format::unsigned(2, 0),
        /// a and a constant, whose points differ.
        raised: of.to,
        /// The lesser or another; one of both where they differ.
        otherwise: of.a.join(of.b),
        different: of.a.join(of.b),
    }
    registers(of) {
        step: Format::counter(4),
        results as Results: Results::of_block(of),
        done: BIT,
    }
}

bundle! {
    /// What it gives.
    pub struct Results {
        sum, difference, product, magnitude, floor, wrapped, low_bits, joined, less, equal, logic, lesser,
        greater, selected, looked_up, mean, before, raised, otherwise, different,
    }
}

impl Results<Format> {
    fn of_block(of: &Everything) -> Self {
        let o = of.outputs();
        Results {
            sum: o.sum,
            difference: o.difference,
            product: o.product,
            magnitude: o.magnitude,
            floor: o.floor,
            wrapped: o.wrapped,
            low_bits: o.low_bits,
            joined: o.joined,
            less: o.less,
            equal: o.equal,
            logic: o.logic,
            lesser: o.lesser,
            greater: o.greater,
            selected: o.selected,
            looked_up: o.looked_up,
            mean: o.mean,
            before: o.before,
            raised: o.raised,
            otherwise: o.otherwise,
            different: o.different,
        }
    }
}

impl Everything {
    pub fn new(random: &mut Random) -> Self {
        let mut format = |signed: bool| {
            let frac = random.below(12) as i8 - 2;
            Format { signed, width: 4 + random.below(12) as u8, frac }
        };
        let [a, b, to] = [format(true), format(false), format(true)];
        Everything {
            a,
            b,
            to,
            table: Memory::table("table", to, (0..8).map(|_| to.real(random.word(to))).collect()),
            others: Memory::new("others", PADS as usize, Format::unsigned(3, 0)),
            kept: Memory::new("kept", 2 * PADS as usize, Format::unsigned(a.width + 1, 0)),
        }
    }

    /// The words that are looked up.
    pub fn table(&self) -> Vec<i64> {
        self.table.codes()
    }

    /// What is computed of the inputs alone.
    fn computed<V: Interpretation>(&self, r: Regs<V>, i: &In<V>) -> Regs<V> {
        let to = self.to;
        let both = i.a + i.b;
        let less = i.a.less_than(i.b);
        let join = self.a.join(self.b);
        let [a, b] = [i.a, i.b].map(|of| of.resize(join, Proved));
        let results = Results {
            sum: both.quantize(to, HalfEven, Saturate),
            difference: (i.a - i.b).quantize(to, HalfEven, Saturate),
            product: (i.a * i.c).quantize(to, HalfEven, Saturate),
            magnitude: i.a.abs(),
            floor: i.a.quantize(to, Floor, Saturate),
            wrapped: (both + i.b).quantize(to, HalfEven, Wrap),
            low_bits: i.a.bits(1, 3),
            joined: i.b.bits(0, 4).concat(i.a.bits(0, 4)),
            less,
            equal: i.a.equals(i.b),
            logic: (less & !i.bit) | (i.a.msb() & i.bit),
            lesser: less.select(a, b),
            greater: less.select(b, a),
            selected: (i.bit & less).select(a, b),
            raised: (i.a + int(3)).quantize(to, HalfEven, Saturate),
            otherwise: less.select(b, a.abs().resize(join, Wrap)),
            different: (!i.a.equals(i.b)).select(a, b),
            ..r.results
        };
        Registers { results, ..r }
    }
}

const MEAN: &str = "a mean is between what it is of";

impl Block for Everything {
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let at = |step: u64| r.step.is(step);
        let within = &mut state.submodules;
        let (found, before) =
            (self.table.data(&mut within.table), self.kept.data(&mut within.kept));
        self.table.read(&mut within.table, i.a.bits(0, 3));
        // What is kept of a pad: its a of the run before, and a flag above.
        let before = before.bits(0, self.a.width).as_code(self.a);
        let data = i.bit.concat(i.a.bits(0, self.a.width));
        let address = i.pad.concat(bit(true));
        let write = Write { enable: at(3), address, data };
        self.kept.access(&mut within.kept, address, write);
        let other = self.others.data(&mut within.others).bits(0, 2);
        let data = i.bit.concat(i.b.bits(0, 2));
        let write = Write { enable: at(3), address: i.pad, data };
        self.others.access(&mut within.others, i.pad, write);
        let mean = (before + i.a).scaled(-1).quantize(self.a, HalfEven, Assumed(MEAN));
        let computed = self.computed(r, &i);
        let kept = Registers {
            results: Results { looked_up: found, mean, before: other, ..r.results },
            ..r
        };
        let next = at(1).select(int(2), at(2).select(int(3), int(0)));
        let step = i.start.select(int(1), next).resize(r.step.format, Proved);
        let choose = |set: Regs<V>, clear: Regs<V>, bit: Signal<V>| Choice::choose(bit, set, clear);
        let r = choose(computed, choose(kept, r, at(2)), at(1));
        state.store(self, Registers { step, done: at(3), ..r });
        let o = r.results;
        Outputs {
            done: r.done,
            sum: o.sum,
            difference: o.difference,
            product: o.product,
            magnitude: o.magnitude,
            floor: o.floor,
            wrapped: o.wrapped,
            low_bits: o.low_bits,
            joined: o.joined,
            less: o.less,
            equal: o.equal,
            logic: o.logic,
            lesser: o.lesser,
            greater: o.greater,
            selected: o.selected,
            looked_up: o.looked_up,
            mean: o.mean,
            before: o.before,
            raised: o.raised,
            otherwise: o.otherwise,
            different: o.different,
        }
    }
}
