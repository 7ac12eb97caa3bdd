// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a block was given and gave, clock by clock.

use hapticore_hdl::block::Block;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::signal::Signal;
use hapticore_hdl::verilog::{Direction, Port};

/// Codes of all ports at every clock after reset: inputs, then outputs, in the order of the ports.
#[derive(Debug, Clone)]
pub struct Trace {
    /// Ports in the order of the traced values.
    pub ports: Vec<Port>,
    codes: Vec<i64>,
}

impl Trace {
    /// Runs a block's clocked model from reset. The stimulus is told the outputs of the clock
    /// before, and gives the codes of the inputs, or nothing at its end.
    ///
    /// # Panics
    /// Where a code is not one of its port's format.
    pub fn record<B: Block>(
        block: &B,
        ports: Vec<Port>,
        mut stimulus: impl FnMut(&[i64]) -> Option<Vec<i64>>,
    ) -> Trace {
        let inputs = ports.iter().filter(|port| port.direction == Direction::Input).count();
        let mut state = block.reset::<i64>();
        let mut codes: Vec<i64> = Vec::new();
        let mut outputs = vec![0; ports.len() - inputs];
        while let Some(given) = stimulus(&outputs) {
            let mut given = given.into_iter();
            let signals = B::Inputs::map(block.inputs(), |format| {
                if format.is_none() {
                    return Signal { value: 0, format };
                }
                let value = given.next().expect("a code for each input");
                assert!(
                    (format.min_code()..=format.max_code()).contains(&i128::from(value)),
                    "{value} is no code of {format}"
                );
                codes.push(value);
                Signal { value, format }
            });
            outputs.clear();
            B::Outputs::each(block.step(&mut state, signals), |_, signal| {
                outputs.extend((!signal.format.is_none()).then_some(signal.value));
            });
            codes.extend(&outputs);
        }
        Trace { ports, codes }
    }

    /// Number of clocks in the trace.
    pub fn clocks(&self) -> usize {
        self.codes.len() / self.ports.len()
    }

    /// The codes of a clock.
    pub fn row(&self, clock: usize) -> &[i64] {
        &self.codes[clock * self.ports.len()..][..self.ports.len()]
    }

    /// The inputs of a clock, by name.
    pub fn inputs(&self, clock: usize) -> String {
        let inputs = self
            .ports
            .iter()
            .zip(self.row(clock))
            .filter(|(port, _)| port.direction == Direction::Input);
        inputs.map(|(port, code)| format!("{} {code}", port.name)).collect::<Vec<_>>().join(", ")
    }

    /// All codes as 64-bit words, least significant byte first.
    pub fn bytes(&self) -> Vec<u8> {
        self.codes.iter().flat_map(|code| code.to_le_bytes()).collect()
    }
}

/// The bits of a code.
pub fn bits(code: i64, width: u8) -> u64 {
    code as u64 & (u64::MAX >> (64 - u32::from(width)))
}
