// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where the value of a wire matters: whether a register, an output, a memory or a block within
//! takes it at a clock. What a multiplexer does not choose does not matter.

use super::bits::any;
use super::state::{At, Unrolled};
use crate::interpretations::netlist::{Module, Node, Op};
use crate::verilog::live::Live;

/// What a wire goes into.
#[derive(Debug, Clone, Copy)]
enum Use {
    /// Always taken.
    Always,
    /// Taken where this bit is as said.
    Where(Node, bool),
    /// Taken where that wire is.
    Through(Node),
    /// Taken where that wire is, and this bit is as said.
    Chosen(Node, Node, bool),
}

/// For each wire what it goes into.
pub struct Uses(Vec<Vec<Use>>);

impl Uses {
    pub fn of(module: &Module, live: &Live) -> Uses {
        let mut uses = Uses(vec![Vec::new(); module.wires.len()]);
        for port in &module.outputs {
            uses.add(port.node, Use::Always);
        }
        for (register, _) in module.registers.iter().zip(&live.registers).filter(|(_, live)| **live)
        {
            uses.add(register.node, Use::Always);
        }
        for node in module.instances.iter().flat_map(|instance| &instance.inputs) {
            uses.add(*node, Use::Always);
        }
        for ram in &module.memories {
            ram.address.iter().for_each(|node| uses.add(*node, Use::Always));
            if let Some((enable, place, data)) = ram.write {
                uses.add(enable, Use::Always);
                [place, data].into_iter().for_each(|node| uses.add(node, Use::Where(enable, true)));
            }
        }
        for (index, wire) in
            module.wires.iter().enumerate().filter(|(index, _)| live.uses[*index] > 0)
        {
            let of = Node(index as u32);
            match wire.op {
                Op::Select(bit, a, b) => {
                    uses.add(bit, Use::Through(of));
                    uses.add(a, Use::Chosen(of, bit, true));
                    uses.add(b, Use::Chosen(of, bit, false));
                }
                ref op => op.operands().into_iter().for_each(|a| uses.add(a, Use::Through(of))),
            }
        }
        uses
    }

    fn add(&mut self, node: Node, of: Use) {
        self.0[node.0 as usize].push(of);
    }
}

impl Unrolled<'_> {
    /// Whether the value of a wire matters at a clock, as a Boolean term.
    pub fn matters(&mut self, at: At, uses: &Uses, node: Node) -> String {
        self.define(at, ("use of wire", node), "Bool", |unrolled| {
            let each = uses.0[node.0 as usize].iter().map(|of| match *of {
                Use::Always => "true".to_owned(),
                Use::Where(bit, set) => unrolled.is(at, bit, set),
                Use::Through(wire) => unrolled.matters(at, uses, wire),
                Use::Chosen(wire, bit, set) => {
                    let taken = unrolled.matters(at, uses, wire);
                    format!("(and {} {taken})", unrolled.is(at, bit, set))
                }
            });
            any(&each.collect::<Vec<_>>())
        })
    }

    fn is(&mut self, at: At, bit: Node, set: bool) -> String {
        let bit = self.is_set(at, bit);
        if set { bit } else { format!("(not {bit})") }
    }
}
