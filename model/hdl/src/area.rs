// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a circuit takes, counted in its netlist.
//!
//! Flip-flops, memories and products are counted, and the bits of the operations that
//! synthesis makes most LUTs of: what a LUT count follows from is for the caller to say.

mod memories;

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
    /// Multipliers that products take, on iCE40 and on ECP5.
    pub multipliers: [f64; 2],
    /// Block RAMs that memories take, on iCE40 and on ECP5.
    pub block_rams: [f64; 2],
}

/// A family's multiplier: bits of its widest factor, and of the narrowest product that synthesis gives
/// one. Source: Yosys 0.70, `synth_ice40 -dsp` and `synth_ecp5`, `mul2dsp`.
struct Multiplier {
    factor: u8,
    least_product: u8,
}

/// Those of iCE40 and ECP5.
const MULTIPLIERS: [Multiplier; 2] =
    [Multiplier { factor: 16, least_product: 11 }, Multiplier { factor: 18, least_product: 0 }];

/// The narrowest factor that synthesis gives a multiplier.
const LEAST_FACTOR: u8 = 2;

impl Multiplier {
    /// How many a product takes: factors that are too wide are cut into slices.
    fn count(&self, a: u8, b: u8) -> usize {
        let slices = |width: u8| {
            let last = (width - 1) % self.factor + 1;
            let whole = usize::from((width - 1) / self.factor);
            std::iter::repeat_n(self.factor, whole).chain([last])
        };
        let takes = |a: u8, b: u8| a.min(b) >= LEAST_FACTOR && a + b >= self.least_product;
        slices(a).map(|a| slices(b).filter(|b| takes(a, *b)).count()).sum()
    }
}

/// Counts of both families.
fn plus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

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
            multipliers: plus(self.multipliers, other.multipliers),
            block_rams: plus(self.block_rams, other.block_rams),
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
            let taken = memories::block_rams(memory).map(|count| count as f64);
            found.block_rams = plus(found.block_rams, taken);
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
                for (count, of) in self.multipliers.iter_mut().zip(MULTIPLIERS) {
                    *count += of.count(format(a).width, format(b).width) as f64;
                }
            }
            _ => (),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_factors_are_cut_and_narrow_slices_take_no_multiplier() {
        let [ice40, ecp5] = &MULTIPLIERS;
        assert_eq!(
            [(18, 18), (19, 18), (20, 18), (36, 24), (1, 9)].map(|(a, b)| ecp5.count(a, b)),
            [1, 1, 2, 4, 0]
        );
        assert_eq!(
            [(16, 16), (17, 16), (18, 16), (18, 8), (4, 6)].map(|(a, b)| ice40.count(a, b)),
            [1, 1, 2, 1, 0]
        );
        let narrow =
            [(16, 1), (1, 16), (2, 16), (2, 8), (2, 9), (3, 8), (32, 32), (33, 32), (34, 48)];
        assert_eq!(narrow.map(|(a, b)| ice40.count(a, b)), [0, 0, 1, 0, 1, 1, 4, 4, 9]);
        assert_eq!(narrow.map(|(a, b)| ecp5.count(a, b)), [0, 0, 1, 1, 1, 1, 4, 4, 6]);
    }

    #[test]
    fn operations_of_two_parts_are_their_sums() {
        let of = |n: f64| Operations {
            flip_flops: n,
            adders: 2.0 * n,
            selects: 3.0 * n,
            memory_bits: 4.0 * n,
            multipliers: [5.0 * n, 6.0 * n],
            block_rams: [7.0 * n, 8.0 * n],
        };
        assert_eq!(of(1.0).plus(of(10.0)), of(11.0));
    }

    /// Counted by hand in `verilog/tests/parts.v`: each instance counts, what nothing needs does not.
    #[test]
    fn operations_are_those_of_the_netlist() {
        let netlist = Netlist::of(&crate::verilog::tests::parts::parts());
        let adder = Operations { flip_flops: 3.0, adders: 4.0, ..Operations::default() };
        assert_eq!(Operations::of(&Netlist { modules: netlist.modules[..1].to_vec() }), adder);
        let expected = Operations {
            // step, count, last, kept; two adders of 3 bits and one of 4
            flip_flops: (1 + 3 + 7 + 5) as f64 + (3 + 3 + 4) as f64,
            // sums, differences, magnitudes, orders; those of the adders
            adders: (7 + 6 + 4 + 4 + 4) as f64
                + (6 + 7 + 5 + 3) as f64
                + (5 + 3 + 5 + 4 + 4 + 5) as f64,
            // what step, count, last and kept take next; choice, choices, assumed
            selects: (2 + 9 + 21 + 10) as f64 + (6 + 17 + 3) as f64,
            memory_bits: (8 * 3 + 5 * 4) as f64,
            // 6 × 6 bits are enough for iCE40; 5 × 3, 3 × 5 and 5 × 5 are not
            multipliers: [1.0, 4.0],
            block_rams: [1.0; 2],
        };
        assert_eq!(Operations::of(&netlist), expected);
        assert_eq!(Operations::of(&Netlist { modules: Vec::new() }), Operations::default());
    }
}
