// SPDX-License-Identifier: MIT OR Apache-2.0
//! A block with every kind of part: what it computes, what a visitor sees, what an editor changes,
//! and which formats it refuses.

use crate::block::{Block, Edit, Interpretation, State, Submodule, Visitor, widen};
use crate::bundle::Field;
use crate::format::{BIT, Format};
use crate::interpretations::range::{Range, take_violations, whole};
use crate::interpretations::real::Real;
use crate::interpretations::shadow::Shadow;
use crate::memory::Memory;
use crate::probe::{Variable, sample, variables};
use crate::signal::{Proved, Signal, Wrap, bit, code};

mod doubler {
    use super::*;

    crate::block! {
        /// Adds up what comes in; its sum has a finer point.
        pub struct Doubler("doubler") {
            pub is_absent: bool,
        }
        submodules {}
        inputs(doubler) { word: Format::signed(4, 0) }
        outputs(doubler) { twice: Format::signed(5, 0) }
        registers(doubler) {
            sum: Format::signed(6, 1),
            absent: BIT.where_present(!doubler.is_absent),
        }
    }

    impl Block for Doubler {
        fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
            let r = state.load(self);
            let sum = (r.sum + i.word).resize(Format::signed(5, 0).scaled(-1), Wrap);
            state.store(self, Registers { sum, ..r });
            Outputs { twice: i.word + i.word }
        }
    }
}

use doubler::Doubler;

crate::block! {
    /// Holds a doubler, one that may be absent, and words.
    pub struct Parent("parent") {}
    submodules {
        first: Doubler,
        second: Option<Doubler>,
        words: Memory,
    }
    inputs(parent) { word: Format::signed(4, 0) }
    outputs(parent) { twice: Format::signed(5, 0) }
    registers(parent) {
        /// The last word.
        last: Format::signed(6, 2),
    }
}

impl Block for Parent {
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let doubled = crate::call!(self.first, state, doubler::Inputs { word: i.word });
        state.store(self, Registers { last: i.word });
        Outputs { twice: doubled.twice }
    }
}

fn parent(second: bool) -> Parent {
    let doubler = Doubler { is_absent: false };
    Parent {
        first: Doubler { is_absent: true },
        second: second.then_some(doubler),
        words: Memory::new("words", 2, Format::unsigned(3, 0)),
    }
}

fn word<V: Interpretation>(value: i64) -> Inputs<Signal<V>> {
    Inputs { word: code(value, Format::signed(4, 0)) }
}

#[test]
fn registers_take_the_point_of_their_format() {
    let block = parent(false);
    let mut state = block.reset::<i64>();
    assert_eq!((state.registers.last, state.submodules.first.registers.sum), (0, 0));
    let twice = crate::block::Interpretation::step(&block, &mut state, word(-3)).twice;
    assert_eq!((twice.value, twice.format), (-6, Format::signed(5, 0)));
    assert_eq!(state.registers.last, -12, "s4.0 in s6.2");
    assert_eq!(state.submodules.first.registers.sum, -6, "s5.1 in s6.1");
    assert_eq!(state.load(&block).last.format, Format::signed(6, 2));
    assert_eq!(state.clone().registers.last, -12);
}

/// All interpretations run the same parts.
#[test]
fn a_block_within_runs_in_every_interpretation() {
    let block = parent(false);
    let (mut real, mut shadow) = (block.reset::<Real>(), block.reset::<Shadow>());
    assert_eq!(block.clock(&mut real, word(-3)).twice.value, Real(-6.0));
    assert_eq!(real.submodules.first.registers.sum, Real(-3.0));
    assert_eq!(block.clock(&mut shadow, word(-3)).twice.value, Shadow { code: -6, real: -6.0 });
    assert_eq!(shadow.submodules.first.registers.sum, Shadow { code: -6, real: -3.0 });
    let mut range = block.reset::<Range>();
    let any = Inputs {
        word: Signal { value: whole(Format::signed(4, 0)), format: Format::signed(4, 0) },
    };
    assert_eq!(block.clock(&mut range, any).twice.value, Range { low: -16, high: 14 });
    assert_eq!(range.registers.last, Range { low: -32, high: 28 });
    assert_eq!(take_violations(), []);
}

#[derive(Default)]
struct Seen(Vec<String>);

impl Visitor<i64> for Seen {
    fn enter(&mut self, name: &'static str) {
        self.0.push(format!("{name} {{"));
    }
    fn register(&mut self, field: &'static Field, format: Format, value: i64) {
        self.0.push(format!("{} {format} = {value}", field.name));
    }
    fn memory(&mut self, memory: &Memory, words: &<i64 as crate::memory::Storage>::Words) {
        let mut words = words.clone();
        self.0.push(format!("{}: {}", memory.name, memory.data::<i64>(&mut words).value));
    }
    fn leave(&mut self) {
        self.0.push("}".into());
    }
}

#[test]
fn a_visitor_sees_what_is_present_in_order() {
    for (second, others) in
        [(false, vec![]), (true, vec!["second {", "sum s6.1 = 0", "absent u1.0 = 0", "}"])]
    {
        let block = parent(second);
        let mut state = block.reset::<i64>();
        block.clock(&mut state, word(1));
        let mut seen = Seen::default();
        Submodule::visit(&block, "top", &state, &mut seen);
        let before = ["top {", "last s6.2 = 4", "first {", "sum s6.1 = 2", "}"];
        assert_eq!(seen.0, [&before[..], &others, &["words: 0", "}"]].concat());
    }
}

/// Of every part: what is put back is what a block clocked in place holds.
#[test]
fn a_state_that_was_taken_out_is_put_back_with_its_memories() {
    let block = parent(true);
    let [mut in_place, mut moved] = [(); 2].map(|()| block.reset::<i64>());
    for value in [3, -2] {
        for state in [&mut in_place, &mut moved] {
            Submodule::edit(&block, state, &mut Raise(0));
        }
        block.clock(&mut in_place, word(value));
        let mut own = moved.take_out();
        block.clock(&mut own, word(value));
        moved.put_back(own);
        let seen = [&in_place, &moved].map(|state| {
            let mut seen = Seen::default();
            Submodule::visit(&block, "top", state, &mut seen);
            (seen.0, format!("{:?}", state.submodules.words))
        });
        assert_eq!(seen[1], seen[0]);
    }
}

/// Adds 1 to every register, and 2 to the word that a memory has read.
struct Raise(usize);

impl Edit<i64> for Raise {
    fn word(&mut self, _format: Format, value: i64) -> i64 {
        self.0 += 1;
        value + 1
    }
    fn memory(&mut self, memory: &Memory, words: &mut <i64 as crate::memory::Storage>::Words) {
        let address = code::<i64>(0, memory.address());
        let write =
            crate::memory::Write { enable: bit(true), address, data: code(5, memory.format) };
        memory.access(words, address, write);
        memory.read(words, address);
    }
}

#[test]
fn an_edit_changes_what_is_present() {
    for (second, edits) in [(false, 2), (true, 4)] {
        let (block, mut edit) = (parent(second), Raise(0));
        let mut state = block.reset::<i64>();
        Submodule::edit(&block, &mut state, &mut edit);
        assert_eq!(edit.0, edits);
        assert_eq!((state.registers.last, state.submodules.first.registers.sum), (1, 1));
        assert_eq!(state.submodules.first.registers.absent, 0, "it has no bits");
        assert_eq!(
            state.submodules.second.as_ref().map(|of| of.registers.absent),
            second.then_some(1)
        );
        assert_eq!(block.words.data::<i64>(&mut state.submodules.words).value, 5);
    }
}

#[test]
fn a_probe_names_and_samples_registers() {
    let block = parent(true);
    let mut state = block.reset::<i64>();
    block.clock(&mut state, word(1));
    let named: Vec<Variable> = variables(&block, "top");
    let paths: Vec<String> = named
        .iter()
        .map(|of| format!("{}.{} {}", of.scope.join("."), of.name, of.format))
        .collect();
    let expected =
        ["top.last s6.2", "top.first.sum s6.1", "top.second.sum s6.1", "top.second.absent u1.0"];
    assert_eq!(paths, expected);
    let mut codes = Vec::new();
    sample(&block, &state, &mut codes);
    assert_eq!(codes, [4, 2, 0, 0]);
}

crate::bundle! {
    pub struct One { only }
}

fn widened<V: Interpretation>(value: i64, given: Format, declared: Format) -> V {
    let signal = One { only: code::<V>(value, given) };
    widen::<One, V>("block", signal, One { only: declared }).only
}

#[test]
fn a_value_is_brought_to_its_declared_point() {
    let [given, declared] = [Format::signed(3, 0), Format::signed(6, 2)];
    assert_eq!(widened::<i64>(-3, given, declared), -12);
    assert_eq!(widened::<i64>(-3, given, Format::signed(4, 0)), -3);
    assert_eq!(widened::<Range>(-3, given, declared), Range::point(-12));
    assert_eq!(widened::<Real>(-3, given, declared), Real(-3.0));
}

#[test]
#[should_panic(expected = "block.only is declared s4.0, which cannot represent every s5.0")]
fn what_elaborates_refuses_a_format_that_is_too_narrow() {
    widened::<Range>(0, Format::signed(5, 0), Format::signed(4, 0));
}

/// Codes are checked in builds with debug assertions and without optimisation, whatever the value.
#[test]
#[cfg(all(debug_assertions, not(optimised)))]
#[should_panic(expected = "block.only is declared s4.0, which cannot represent every s5.0")]
fn what_runs_refuses_a_format_that_is_too_narrow() {
    widened::<i64>(0, Format::signed(5, 0), Format::signed(4, 0));
}

#[test]
fn a_signal_is_nothing_where_its_port_is_absent() {
    let signal: Signal<i64> = code(3, Format::unsigned(2, 0));
    let present = signal.where_present(BIT);
    assert_eq!((present.value, present.format), (3, Format::unsigned(2, 0)));
    let absent = signal.where_present(Format::NONE);
    assert_eq!((absent.value, absent.format), (0, Format::NONE));
    assert_eq!(signal.named("a name").resize(Format::unsigned(3, 0), Proved).value, 3);
}
