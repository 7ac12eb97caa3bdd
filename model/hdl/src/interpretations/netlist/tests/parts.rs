// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registers, memories, claims and instances of small blocks in the graph.

use super::{driver, input};
use crate::block::{Block, Interpretation, State};
use crate::claims::{Claims, Held};
use crate::format::{BIT, Format};
use crate::interpretations::netlist::{Netlist, Node, Op};
use crate::memory::{Memory, Write};
use crate::signal::{Exact, Proved, int};

mod holder {
    use super::*;

    crate::block! {
        /// Registers, a memory, and claims.
        pub struct Holder("holder", reset: false) { pub width: u8 }
        submodules { words: Memory }
        inputs(holder) {
            gone: Format::NONE,
            enable: BIT,
            word: Format::unsigned(2, 0),
        }
        outputs(holder) { word: Format::unsigned(holder.width, 1) }
        registers(holder) {
            /// The last word.
            last: Format::unsigned(holder.width, 1),
            gone: Format::NONE,
        }
    }

    impl Block for Holder {
        fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
            let r = state.load(self);
            let words = &mut state.submodules.words;
            let write = Write { enable: i.enable, address: i.enable, data: i.word };
            self.words.access(words, i.enable, write);
            let read = self.words.data::<V>(words);
            state.store(self, Registers { last: read, ..r });
            Outputs { word: r.last }
        }

        fn claims<V: Interpretation>(&self, r: Regs<V>, i: In<V>) -> Claims<V> {
            let held = Some(Held { when: i.enable, inputs: &["word"] });
            Claims { invariants: vec![("nothing is negative", !r.last.less_than(int(0)))], held }
        }
    }

    impl Holder {
        pub fn new(width: u8) -> Self {
            Holder { width, words: Memory::new("words", 2, Format::unsigned(4, 1)).in_block() }
        }
    }
}

use holder::Holder;

#[test]
fn registers_memories_and_claims_are_listed() {
    let netlist = Netlist::of(&Holder::new(5));
    let module = netlist.top();
    let op = |node: Node| module.wires[node.0 as usize].op.clone();
    let [enable, word] = ["enable", "word"].map(|name| input(module, name));
    assert_eq!((op(enable), op(word), module.resets), (Op::Input(0), Op::Input(1), false));
    let [last] = &module.registers[..] else { panic!("one register has bits") };
    assert_eq!(
        (last.name, last.about, last.format),
        ("last", "The last word.", Format::unsigned(5, 1))
    );
    let Op::Fit(read, Exact, Proved) = op(last.node) else { panic!("it is widened") };
    assert_eq!(op(read), Op::Data(0));
    assert_eq!(driver(module, "word").0, &Op::Register(0));
    let [ram] = &module.memories[..] else { panic!("one memory") };
    let Some((write, address, data)) = ram.write else { panic!("it is written") };
    assert_eq!((ram.address, write, address), (Some(enable), enable, enable));
    assert_eq!(op(data), Op::Fit(word, Exact, Proved), "it takes the memory's point");
    assert_eq!(
        (ram.block, ram.initial.clone(), ram.format),
        (true, vec![0, 0], Format::unsigned(4, 1))
    );
    let [(name, bit)] = module.invariants[..] else { panic!("one invariant") };
    assert_eq!((name, module.wires[bit.0 as usize].format), ("nothing is negative", BIT));
    assert_eq!(module.held, Some((enable, vec![1])));
}

crate::block! {
    /// Holders of two configurations.
    pub struct Pair("pair") {}
    submodules { a: Holder, b: Holder, c: Holder }
    inputs(block) { enable: BIT }
    outputs(block) { word: Format::unsigned(5, 1), of_c: Format::unsigned(6, 1) }
    registers(block) {}
}

impl Block for Pair {
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let of = |word| holder::Inputs {
            gone: crate::signal::zero(Format::NONE),
            enable: i.enable,
            word,
        };
        let a = crate::call!(self.a, state, of(int::<V>(1)));
        let b = crate::call!(self.b, state, of(int::<V>(2)));
        let c = crate::call!(self.c, state, of(int::<V>(2)));
        let word = i.enable.select(a.word, b.word);
        Outputs { word, of_c: c.word }
    }
}

#[test]
fn blocks_of_one_configuration_share_a_module() {
    let netlist = Netlist::of(&Pair { a: Holder::new(5), b: Holder::new(5), c: Holder::new(6) });
    assert_eq!(
        netlist.modules.iter().map(|of| of.name).collect::<Vec<_>>(),
        ["holder", "holder", "pair"]
    );
    let top = netlist.top();
    let instances: Vec<_> = top.instances.iter().map(|of| (of.name, of.module)).collect();
    assert_eq!(instances, [("a", 0), ("b", 0), ("c", 1)]);
    let inputs = &top.instances[0].inputs;
    assert_eq!(inputs[0], input(top, "enable"));
    assert_eq!(top.wires[inputs[1].0 as usize].format, Format::unsigned(2, 0), "the port's width");
    assert_eq!(driver(top, "of_c").0, &Op::Output(2, 0));
}

mod twice {
    use super::*;

    crate::block! {
        /// Reads a memory of one port twice a clock.
        pub struct Twice("twice") {}
        submodules { words: Memory }
        inputs(block) { word: BIT }
        outputs(block) {}
        registers(block) {}
    }

    impl Block for Twice {
        fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
            self.words.read(&mut state.submodules.words, i.word);
            self.words.read(&mut state.submodules.words, i.word);
            Outputs::default()
        }
    }

    #[test]
    #[should_panic(expected = "words has one read port, and is accessed once a clock")]
    fn a_memory_is_accessed_once_a_clock() {
        Netlist::of(&Twice { words: Memory::new("words", 2, BIT) });
    }
}
