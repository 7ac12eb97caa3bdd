// SPDX-License-Identifier: MIT OR Apache-2.0
//! A block, clocked by codes.

use hapticore_hdl::block::{Block, Inputs, Outputs, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::signal::Signal;

/// A block and its registers.
pub struct Bench<B: Block> {
    pub block: B,
    state: State<B, i64>,
}

impl<B: Block> Bench<B> {
    /// The block at reset.
    pub fn new(block: B) -> Self {
        Bench { state: block.reset(), block }
    }

    /// Runs one clock and returns the outputs.
    pub fn clock(&mut self, inputs: Inputs<B, i64>) -> Outputs<B, i64> {
        let with_formats = B::Inputs::zip(inputs, self.block.inputs());
        let signals = B::Inputs::map(with_formats, |(value, format)| Signal { value, format });
        B::Outputs::map(self.block.step(&mut self.state, signals), |signal| signal.value)
    }
}

impl<B: Block> Bench<B> {
    /// What the registers hold.
    pub fn registers(&self) -> hapticore_hdl::block::Registers<B, i64> {
        self.state.registers
    }
}
