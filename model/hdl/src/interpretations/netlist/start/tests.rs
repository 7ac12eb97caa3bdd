// SPDX-License-Identifier: MIT OR Apache-2.0
//! Starts that no output depends on, and others.

use super::is_irrelevant;
use crate::block::{Block, Interpretation, State};
use crate::format::{BIT, Format};
use crate::interpretations::netlist::Netlist;
use crate::signal::{Wrap, bit, int};

crate::block! {
    /// Doubles a number twice, and gives zero until it has.
    pub struct Doubler("doubler") {}
    submodules {}
    inputs(block) { start: BIT, number: Format::unsigned(4, 0) }
    outputs(block) { result: Format::unsigned(4, 0) }
    registers(block) {
        step: Format::unsigned(2, 0),
        number: Format::unsigned(4, 0),
        shown: Format::unsigned(4, 0),
    }
}

impl Block for Doubler {
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let busy = !r.step.is(0);
        let step = (r.step - int(1)).resize(r.step.format, Wrap);
        let step = busy.select(step, int(0)).resize(r.step.format, Wrap);
        let twice = (r.number + r.number).resize(r.number.format, Wrap);
        let next = Registers {
            step: i.start.select(int(2), step).resize(r.step.format, Wrap),
            number: i.start.select(i.number, twice),
            shown: (r.step.is(1) & bit(true)).select(twice, r.shown),
        };
        state.store(self, next);
        Outputs { result: r.shown }
    }
}

#[test]
fn a_register_that_is_loaded_first_may_start_with_anything() {
    let netlist = Netlist::of(&Doubler {});
    let irrelevant: Vec<_> = (0..3).map(|register| is_irrelevant(&netlist, register)).collect();
    assert_eq!(irrelevant, [false, true, false], "step, number, shown");
}
