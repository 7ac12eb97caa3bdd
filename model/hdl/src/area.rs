// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a circuit takes, counted in its netlist.
//!
//! Flip-flops, the bits of memories and products are counted, and the bits of the operations that
//! synthesis makes most LUTs of: what a LUT count follows from is for the caller to say.

use crate::interpretations::netlist::{Module, Netlist, Node, Op};
use crate::verilog::live::Live;

/// What operations there are, in bits of their results or operands.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Operations {
    /// Bits of registers that something depends on.
    pub flip_flops: f64,
    /// Bits of sums, differences and comparisons by size.
    pub adders: f64,
    /// Bits of selections.
    pub selects: f64,
    /// Bits of memories.
    pub memory_bits: f64,
    /// Products of two variables, each as factors of so many bits.
    pub products: [f64; 2],
}

/// The widest factor of a multiplier of either family: iCE40 and ECP5.
const FACTORS: [u8; 2] = [16, 18];

impl Operations {
    /// Those of a design, with each instance counted.
    pub fn of(netlist: &Netlist) -> Operations {
        let mut within: Vec<Operations> = Vec::new();
        for module in &netlist.modules {
            let own = Operations::of_module(module);
            let all = module.instances.iter().map(|instance| within[instance.module]);
            within.push(all.fold(own, Operations::plus));
        }
        within.last().copied().unwrap_or_default()
    }

    fn plus(self, other: Operations) -> Operations {
        Operations {
            flip_flops: self.flip_flops + other.flip_flops,
            adders: self.adders + other.adders,
            selects: self.selects + other.selects,
            memory_bits: self.memory_bits + other.memory_bits,
            products: [0, 1].map(|n| self.products[n] + other.products[n]),
        }
    }

    fn of_module(module: &Module) -> Operations {
        let live = Live::of(module);
        let mut found = Operations::default();
        for (register, _) in module.registers.iter().zip(&live.registers).filter(|(_, live)| **live)
        {
            found.flip_flops += f64::from(register.format.width);
        }
        for (memory, _) in module.memories.iter().zip(&live.memories).filter(|(_, live)| **live) {
            found.memory_bits += memory.initial.len() as f64 * f64::from(memory.format.width);
        }
        for (wire, _) in module.wires.iter().zip(&live.uses).filter(|(_, uses)| **uses > 0) {
            found.add(module, &wire.op, f64::from(wire.format.width));
        }
        found
    }

    fn add(&mut self, module: &Module, op: &Op, bits: f64) {
        let format = |node: Node| module.wires[node.0 as usize].format;
        let width = |node| f64::from(format(node).width);
        match *op {
            Op::Add(..) | Op::Sub(..) | Op::Abs(_) => self.adders += bits,
            Op::Less(a, b) => self.adders += width(a).max(width(b)),
            Op::Select(..) => self.selects += bits,
            Op::Mul(a, b) => {
                for (count, most) in self.products.iter_mut().zip(FACTORS) {
                    let parts = |node| format(node).width.div_ceil(most);
                    *count += f64::from(parts(a)) * f64::from(parts(b));
                }
            }
            _ => (),
        }
    }
}
