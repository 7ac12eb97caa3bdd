// SPDX-License-Identifier: MIT OR Apache-2.0
//! A block, clocked by codes.

use hapticore_hdl::block::{Block, Edit, Inputs, Outputs, State, Submodule};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::netlist::simulation::Simulation;
use hapticore_hdl::memory::{Memory, Storage};
use hapticore_hdl::signal::Signal;

use crate::in_place::in_place_of;

/// A block and its registers.
#[derive(Clone)]
pub struct Bench<B: Block> {
    pub block: B,
    state: State<B, i64>,
    /// Clocked in place of the block where the test is judged by a mutant.
    netlist: Option<Simulation>,
}

impl<B: Block> Bench<B> {
    /// The block at reset.
    pub fn new(block: B) -> Self {
        let mut netlist = in_place_of(&block);
        let reset = netlist.as_mut().map(|netlist| netlist.reset(&block));
        Bench { state: reset.unwrap_or_else(|| block.reset()), block, netlist }
    }

    /// Runs one clock and returns the outputs.
    pub fn clock(&mut self, inputs: Inputs<B, i64>) -> Outputs<B, i64> {
        if let Some(netlist) = &mut self.netlist {
            return netlist.step(&self.block, &mut self.state, inputs);
        }
        let with_formats = B::Inputs::zip(inputs, self.block.inputs());
        let signals = B::Inputs::map(with_formats, |(value, format)| Signal { value, format });
        B::Outputs::map(self.block.step(&mut self.state, signals), |signal| signal.value)
    }
}

/// A reset as hardware has it: registers are zero, memories keep what they hold.
struct Reset;

impl Edit<i64> for Reset {
    fn word(&mut self, _format: Format, _value: i64) -> i64 {
        0
    }

    fn memory(&mut self, _memory: &Memory, _words: &mut <i64 as Storage>::Words) {}
}

impl<B: Block> Bench<B> {
    /// A clock with the reset asserted.
    pub fn reset(&mut self) {
        Submodule::edit(&self.block, &mut self.state, &mut Reset);
    }

    /// What the registers hold.
    pub fn registers(&self) -> hapticore_hdl::block::Registers<B, i64> {
        self.state.registers
    }
}
