// SPDX-License-Identifier: MIT OR Apache-2.0
//! The inside of a component: a block's clocked model, and the Verilog printed from it.

use super::PortWidth;
use hapticore_hdl::block::{Block, Edit, State, Submodule};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::memory::{Memory, Storage};
use hapticore_hdl::signal::Signal;
use hapticore_hdl::verilog::{Design, Direction};
use rust_hdl_core::ast::{Verilog, Wrapper};

/// A block that rust-hdl's simulator clocks.
pub struct Simulated<B: Block> {
    block: B,
    state: State<B, i64>,
    design: Design,
    inputs: Vec<u64>,
    outputs: Vec<u64>,
    settled: bool,
}

impl<B: Block> Simulated<B> {
    /// The block at reset, behind ports of these names and widths.
    ///
    /// # Panics
    /// Where the ports are not the block's.
    pub fn new(block: B, inputs: &[PortWidth], outputs: &[PortWidth]) -> Self {
        let design = Design::of(&block, "a rust-hdl component");
        let of = |direction: Direction| {
            let ports = design.ports.iter().filter(move |port| port.direction == direction);
            ports
                .map(|port| (port.name.as_str(), usize::from(port.format.width)))
                .collect::<Vec<_>>()
        };
        assert_eq!(of(Direction::Input), inputs, "the inputs of {}", B::NAME);
        assert_eq!(of(Direction::Output), outputs, "the outputs of {}", B::NAME);
        Simulated {
            state: block.reset(),
            inputs: vec![0; inputs.len()],
            outputs: Vec::new(),
            settled: false,
            block,
            design,
        }
    }

    /// What the outputs are, the inputs being these. At an edge of the clock the registers are
    /// replaced first.
    pub fn update(&mut self, edge: bool, reset: bool, inputs: &[u64]) -> &[u64] {
        if edge {
            match reset {
                true => Submodule::edit(&self.block, &mut self.state, &mut Reset),
                false => {
                    clock(&self.block, &mut self.state, inputs);
                }
            }
        }
        if edge || !self.settled || self.inputs != inputs {
            // What the outputs are before the next edge depends on the inputs, too: a clock that is
            // not kept tells.
            self.outputs = clock(&self.block, &mut self.state.clone(), inputs);
            self.inputs.copy_from_slice(inputs);
            self.settled = true;
        }
        &self.outputs
    }

    /// An instance of the printed module, and all modules printed.
    pub fn hdl(&self) -> Verilog {
        let names = ["clock", "reset"]
            .into_iter()
            .chain(self.design.ports.iter().map(|port| port.name.as_str()));
        let connections: Vec<_> = names.map(|name| format!("    .{name}({name})")).collect();
        let code = format!("{} block (\n{}\n);", self.design.top(), connections.join(",\n"));
        Verilog::Wrapper(Wrapper { code, cores: self.design.text() })
    }
}

/// A reset, as the printed module has it: registers are zero, memories keep what they hold.
struct Reset;

impl Edit<i64> for Reset {
    fn word(&mut self, _format: Format, _value: i64) -> i64 {
        0
    }

    fn memory(&mut self, _memory: &Memory, _words: &mut <i64 as Storage>::Words) {}
}

/// One clock, from bits to bits.
fn clock<B: Block>(block: &B, state: &mut State<B, i64>, inputs: &[u64]) -> Vec<u64> {
    let mut inputs = inputs.iter();
    let read = |format: Format| Signal {
        value: code(*inputs.next().expect("a word a port"), format),
        format,
    };
    let outputs = block.step(state, B::Inputs::map(block.inputs(), read));
    let mut words = Vec::new();
    B::Outputs::each(B::Outputs::zip(outputs, block.outputs()), |_, (signal, format)| {
        if !format.is_none() {
            words.push(signal.value as u64 & mask(format));
        }
    });
    words
}

fn mask(format: Format) -> u64 {
    u64::MAX >> (64 - format.width)
}

/// The code whose two's complement bits these are.
fn code(bits: u64, format: Format) -> i64 {
    let unused = 64 - format.width;
    if format.signed { (bits << unused) as i64 >> unused } else { (bits & mask(format)) as i64 }
}
