// SPDX-License-Identifier: MIT OR Apache-2.0
//! Memories whose words are claimed to be small, and what the other blocks do not have: shared
//! expressions with a name to be guessed, orders of numbers without a name, what nothing needs.

use crate::block::{Block, Interpretation, State};
use crate::format::{BIT, Format};
use crate::memory::{Memory, Write};
use crate::next;
use crate::signal::{Assumed, Wrap};

crate::block! {
    /// Two memories: one may read anything where it is written, the other reads the word before.
    pub struct Store("store") {}
    submodules { either: Memory, before: Memory, forgotten: Memory }
    inputs(block) {
        start: BIT,
        place: Format::unsigned(2, 0),
        change: Format::signed(4, 1),
    }
    outputs(block) {
        of_either: Format::unsigned(2, 0),
        of_before: Format::unsigned(2, 0),
        distance: Format::unsigned(3, 1),
        is_less: BIT,
        chosen: Format::signed(5, 1),
        pair: Format::unsigned(4, 0),
    }
    registers(block) {
        turn: Format::unsigned(3, 0),
        last: Format::signed(4, 1),
        choice: Format::signed(4, 1),
        other: Format::signed(4, 1),
    }
}

pub fn store() -> Store {
    let word = Format::unsigned(3, 0);
    Store {
        either: Memory::new("either", 8, word).dont_care_on_collision(),
        before: Memory::new("before", 8, word),
        forgotten: Memory::new("forgotten", 2, word),
    }
}

impl Block for Store {
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let sum = (i.place + r.turn).resize(r.turn.format, Wrap);
        let word = i.place.bits(0, 3);
        self.either.access(
            &mut state.submodules.either,
            sum,
            Write { enable: i.start, address: i.place, data: word },
        );
        self.before.access(
            &mut state.submodules.before,
            i.place,
            Write { enable: i.start, address: sum, data: word },
        );
        self.forgotten.read(&mut state.submodules.forgotten, i.start);
        let either = self.either.data::<V>(&mut state.submodules.either);
        let before = self.before.data::<V>(&mut state.submodules.before);
        let forgotten = self.forgotten.data::<V>(&mut state.submodules.forgotten);

        let small = either.resize(Format::unsigned(2, 0), Assumed("words are small"));
        let low = before.resize(Format::unsigned(2, 0), Assumed("so are others"));
        let distance = (i.change - r.last).abs();
        let distance = distance.resize(Format::unsigned(3, 1), Assumed("steps are short"));
        // What nothing needs: neither a claim, nor a use of what it is made of, nor a name.
        let _ = forgotten.resize(Format::unsigned(1, 0), Assumed("nobody asks")) + small;

        let pair = either.bits(1, 2).concat(before.bits(0, 2));
        let choice = i.start.select(i.change, r.last);
        let next = Registers { turn: r.turn.increment(), last: i.change, choice, other: choice };
        next!(self, state, i.start | pair.bits(3, 1) => next, else r);
        Outputs {
            of_either: i.start.select(small, i.place),
            of_before: low,
            distance,
            is_less: (i.change + i.place).less_than(r.last - i.change),
            chosen: (r.choice + r.other).resize(Format::signed(5, 1), Wrap),
            pair,
        }
    }
}
