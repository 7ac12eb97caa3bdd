// SPDX-License-Identifier: MIT OR Apache-2.0
//! Mutants that are equivalent whatever the inputs, and others.

use super::is_equivalent;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::interpretations::netlist::Netlist;
use hapticore_hdl::interpretations::netlist::mutants::Mutant;
use hapticore_hdl::signal::{Wrap, bit, int};
use hapticore_hdl::states;
use hapticore_hdl::states::States;

const NUMBER: Format = Format::unsigned(4, 0);

states! {
    /// The steps of an operation.
    pub enum Step { Idle, Wait, Add }
}

hapticore_hdl::block! {
    /// Doubles a number, and counts clocks beside it.
    pub struct Doubler("doubler") {
        /// The number rests for a clock before it is doubled.
        waits: bool,
    }
    submodules {}
    inputs(block) { start: BIT, number: NUMBER }
    outputs(block) { done: BIT, twice: NUMBER, clocks: Format::unsigned(16, 0) }
    registers(block) {
        step in Step,
        number: NUMBER,
        twice: NUMBER,
        done: BIT,
        clocks: Format::unsigned(16, 0),
    }
}

impl Block for Doubler {
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let begin = if self.waits { Step::Wait } else { Step::Add };
        let twice = (r.number + r.number).resize(NUMBER, Wrap);
        let adds = r.step.at(Step::Add);
        let step = r.step.at(Step::Wait).select(Step::Add.signal(), Step::Idle.signal());
        let next = Registers {
            step: i.start.select(begin.signal(), step),
            number: i.start.select(i.number, r.number),
            twice: adds.select(twice, r.twice),
            done: adds & bit(true),
            clocks: (r.clocks + int(1)).resize(r.clocks.format, Wrap),
        };
        state.store(self, next);
        Outputs { done: r.done, twice: r.twice, clocks: r.clocks }
    }
}

/// The mutants that are proved to be equivalent.
fn proved(waits: bool) -> Vec<String> {
    let netlist = Netlist::of(&Doubler { waits });
    let all = Mutant::all(&netlist, netlist.top()).into_iter().map(|mutant| mutant.to_string());
    all.filter(|name| is_equivalent(&netlist, name)).collect()
}

#[test]
fn an_operand_that_rests_may_be_a_clock_old_and_one_that_does_not_may_not() {
    let reset = "doubler.number: missing reset";
    let [first, second] = [0, 1].map(|k| format!("doubler.sum 0 operand {k}: stale operand"));
    assert_eq!(proved(true), [reset, &first, &second]);
    assert_eq!(proved(false), [reset]);
}
