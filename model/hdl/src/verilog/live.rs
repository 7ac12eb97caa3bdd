// SPDX-License-Identifier: MIT OR Apache-2.0
//! What of a module its outputs depend on, and how often each wire is needed.

use crate::interpretations::netlist::{Module, Node, Op};

/// What is needed of a module.
pub struct Live {
    /// For each wire, how many need it.
    pub uses: Vec<u32>,
    /// For each register, whether something depends on it.
    pub registers: Vec<bool>,
    /// For each memory, whether something reads it.
    pub memories: Vec<bool>,
}

impl Live {
    /// Looks backwards from outputs and instances.
    pub fn of(module: &Module) -> Live {
        let mut live = Live {
            uses: vec![0; module.wires.len()],
            registers: vec![false; module.registers.len()],
            memories: vec![false; module.memories.len()],
        };
        let mut open: Vec<Node> = module.outputs.iter().map(|port| port.node).collect();
        open.extend(module.instances.iter().flat_map(|instance| &instance.inputs));
        while let Some(node) = open.pop() {
            let uses = &mut live.uses[node.0 as usize];
            *uses += 1;
            if *uses == 1 {
                live.follow(module, node, &mut open);
            }
        }
        live
    }

    fn follow(&mut self, module: &Module, node: Node, open: &mut Vec<Node>) {
        match module.wires[node.0 as usize].op {
            Op::Register(index) => {
                self.registers[index] = true;
                open.push(module.registers[index].node);
            }
            Op::Data(index) => {
                self.memories[index] = true;
                let ram = &module.memories[index];
                open.extend(ram.address);
                open.extend(
                    ram.write.iter().flat_map(|&(enable, address, word)| [enable, address, word]),
                );
            }
            ref op => open.extend(op.operands()),
        }
    }
}
