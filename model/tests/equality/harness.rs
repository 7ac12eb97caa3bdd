// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bench on which a block is clocked.

use hapticore_hdl::block::{Block, Edit, Inputs, Interpretation, Outputs, State, Submodule};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::netlist::simulation::Simulation;
use hapticore_hdl::memory::Memory;
use hapticore_hdl::probe::{Variable, sample, variables};
use hapticore_hdl::signal::Signal;
use std::any::Any;

use super::in_place::in_place_of;

/// Operations of a test: all of them where code is optimised, one of two hundred where it is not; one of as many as
/// `HAPTICORE_SHARE` says where that is set. Of few operations eight.
pub fn operations(all: u64) -> u64 {
    let share = std::env::var("HAPTICORE_SHARE").ok().and_then(|share| share.parse().ok());
    let share = share.unwrap_or(if cfg!(optimised) { 1 } else { 200 });
    (all / share.max(1)).max(all.min(8))
}

/// A block under test.
pub struct Bench<B: Block, V: Interpretation = i64> {
    pub block: B,
    pub state: State<B, V>,
    pub clock: u64,
    /// Clocked in place of the block where the test is judged by a mutant.
    netlist: Option<Box<Simulation>>,
}

impl<B: Block, V: Interpretation> Bench<B, V> {
    /// The block at reset, in some interpretation.
    pub fn read(block: B) -> Self {
        let mut state: State<B, V> = block.reset();
        let mut netlist = None;
        if let Some(state) = (&mut state as &mut dyn Any).downcast_mut::<State<B, i64>>() {
            netlist = in_place_of(&block).map(Box::new);
            netlist.iter_mut().for_each(|netlist| *state = netlist.reset(&block));
        }
        Bench { state, block, clock: 0, netlist }
    }

    /// Runs one clock and returns the outputs.
    pub fn clock(&mut self, inputs: Inputs<B, i64>) -> Outputs<B, i64> {
        if let Some(netlist) = &mut self.netlist {
            self.clock += 1;
            let state = (&mut self.state as &mut dyn Any).downcast_mut();
            return netlist.step(&self.block, state.expect("only codes have mutants"), inputs);
        }
        let with_formats = B::Inputs::zip(inputs, self.block.inputs());
        let signals = B::Inputs::map(with_formats, |(code, format)| Signal {
            value: V::raw(code, format),
            format,
        });
        self.clock += 1;
        let outputs = V::step(&self.block, &mut self.state, signals);
        B::Outputs::map(outputs, V::code)
    }

    /// As the reset input does: registers are zero, memories keep their words.
    #[allow(dead_code, reason = "tests of whole cores begin with a core at reset")]
    pub fn press_reset(&mut self) {
        self.block.edit(&mut self.state, &mut Reset);
    }

    /// Every register, and what it holds.
    pub fn registers(&self) -> impl Iterator<Item = (Variable, V)> + use<B, V> {
        let mut values = Vec::new();
        sample(&self.block, &self.state, &mut values);
        variables(&self.block, B::NAME).into_iter().zip(values)
    }
}

struct Reset;

impl<V: Interpretation> Edit<V> for Reset {
    fn word(&mut self, format: Format, _value: V) -> V {
        V::raw(0, format)
    }

    fn memory(&mut self, _memory: &Memory, _words: &mut V::Words) {}
}

impl<B: Block> Bench<B> {
    /// The block at reset.
    pub fn new(block: B) -> Self {
        Bench::read(block)
    }
}

/// Every field by name.
pub fn show<S: Bundle>(bundle: S::Of<i64>) -> String {
    let mut text = Vec::new();
    S::each(bundle, |field, code| text.push(format!("{} {code}", field.name)));
    text.join(", ")
}
