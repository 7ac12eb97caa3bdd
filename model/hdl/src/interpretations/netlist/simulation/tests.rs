// SPDX-License-Identifier: MIT OR Apache-2.0
//! A netlist does what its block does, on every clock.

use super::Simulation;
use crate::block::{Block, Interpretation, State};
use crate::format::{BIT, Format};
use crate::interpretations::netlist::Netlist;
use crate::memory::{Memory, Write};
use crate::signal::{HalfEven, Saturate, Signal, Wrap, code};

mod product {
    use super::*;

    crate::block! {
        /// A product, one cycle later.
        pub struct Product("product") {}
        submodules {}
        inputs(block) { a: Format::signed(6, 3), b: Format::unsigned(5, 0) }
        outputs(block) { half: Format::signed(8, 1), absent: Format::NONE }
        registers(block) { half: Format::signed(8, 1), absent: Format::NONE }
    }

    impl Block for Product {
        fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
            let r = state.load(self);
            let half = (i.a * i.b).scaled(-1).quantize(Format::signed(8, 1), HalfEven, Saturate);
            state.store(self, Registers { half, absent: r.absent });
            Outputs { half: r.half, absent: r.absent }
        }
    }
}

mod sums {
    use super::*;

    crate::block! {
        /// Sums of products by address.
        pub struct Sums("sums") {}
        submodules {
            pub product: product::Product,
            pub words: Memory,
        }
        inputs(block) {
            a: Format::signed(6, 3),
            b: Format::unsigned(5, 0),
            address: Format::unsigned(2, 0),
            store: BIT,
            clear: BIT,
        }
        outputs(block) { sum: Format::signed(10, 1), word: Format::signed(10, 1) }
        registers(block) { sum: Format::signed(10, 1) }
    }

    impl Block for Sums {
        fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
            let r = state.load(self);
            let product = crate::call!(self.product, state, product::Inputs { a: i.a, b: i.b });
            let word = self.words.data(&mut state.submodules.words);
            let write = Write { enable: i.store, address: i.address.increment_low(), data: r.sum };
            self.words.access(&mut state.submodules.words, i.address, write);
            let sum = (r.sum + product.half).resize(r.sum.format, Wrap);
            let zero = code_of(0, r.sum.format);
            state.store(self, Registers { sum: i.clear.select(zero, sum) });
            Outputs { sum: r.sum, word }
        }
    }

    fn code_of<V: Interpretation>(code: i64, format: Format) -> Signal<V> {
        Signal { value: V::raw(code, format), format }
    }

    impl<V: Interpretation> Signal<V> {
        /// The next address.
        fn increment_low(self) -> Self {
            (self + code_of(1, Format::unsigned(1, 0))).resize(self.format, Wrap)
        }
    }
}

fn block() -> sums::Sums {
    let words = Memory::new("words", 4, Format::signed(10, 1));
    sums::Sums { product: product::Product {}, words }
}

/// Inputs of a clock, of any format.
fn inputs(random: &mut u64) -> sums::Inputs<i64> {
    let mut below = |count: i64| {
        *random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (*random >> 33) as i64 % count
    };
    sums::Inputs {
        a: below(64) - 32,
        b: below(32),
        address: below(4),
        store: below(2),
        clear: i64::from(below(9) == 0),
    }
}

#[test]
fn a_netlist_runs_as_its_block_does() {
    let (block, mut random) = (block(), 1);
    let mut simulation = Simulation::new(Netlist::of(&block));
    let (mut clocked, mut state) = (block.reset::<i64>(), simulation.reset(&block));
    for clock in 0..10_000 {
        let given = inputs(&mut random);
        // A test may change what a state holds.
        if clock % 100 == 50 {
            clocked.submodules.product.registers.half = clock % 128;
            state.submodules.product.registers.half = clock % 128;
            clocked.submodules.words.words_mut()[2] = clock % 256;
            state.submodules.words.words_mut()[2] = clock % 256;
        }
        let formats = block.inputs();
        let signals = sums::Inputs {
            a: code(given.a, formats.a),
            b: code(given.b, formats.b),
            address: code(given.address, formats.address),
            store: code(given.store, formats.store),
            clear: code(given.clear, formats.clear),
        };
        let expected = block.clock(&mut clocked, signals);
        let got = simulation.step(&block, &mut state, given);
        assert_eq!((got.sum, got.word), (expected.sum.value, expected.word.value), "{clock}");
        assert_eq!(state.registers.sum, clocked.registers.sum, "clock {clock}");
        let words = |state: &State<sums::Sums, i64>| state.submodules.words.words().to_vec();
        assert_eq!(words(&state), words(&clocked), "clock {clock}");
    }
}

/// A mutant may write where no word is.
#[test]
fn a_register_starts_with_the_code_that_is_set() {
    let block = block();
    let netlist = Netlist::of(&block);
    let mut simulation = Simulation::new(netlist);
    simulation.set(1, 0, 77);
    let state = simulation.reset(&block);
    assert_eq!((state.registers.sum, state.submodules.product.registers.half), (77, 0));
}
