// SPDX-License-Identifier: MIT OR Apache-2.0
//! A clock of a design. An instance that holds what the sound design's holds, and gets the same inputs, is not evaluated
//! again; nor is one in which nothing has changed.

use super::design::{Held, Unit};
use super::memory::access;
use super::terms::Terms;
use hapticore_hdl::interpretations::netlist::{Named, Netlist, Node, Op};

/// What an instance of the sound design has done in a clock.
#[derive(Debug, Clone)]
pub(super) struct Did {
    pub(super) inputs: Vec<Node>,
    pub(super) outputs: Vec<Node>,
    pub(super) changed: bool,
}

/// What the sound design holds after a clock, and what each instance that was evaluated has done.
pub(super) struct Done<'a> {
    pub(super) held: &'a Held,
    pub(super) did: &'a [Option<Did>],
}

/// A clock of a design.
pub(super) struct Run<'a> {
    pub(super) terms: &'a mut Terms,
    pub(super) netlist: &'a Netlist,
    pub(super) done: Option<Done<'a>>,
    pub(super) did: Vec<Option<Did>>,
}

impl<'a> Run<'a> {
    pub(super) fn new(terms: &'a mut Terms, netlist: &'a Netlist, done: Option<Done<'a>>) -> Self {
        Run { terms, netlist, done, did: Vec::new() }
    }

    /// One cycle of an instance: its outputs.
    pub(super) fn clock(&mut self, unit: &mut Unit, held: &mut Held, inputs: &[Node]) -> Vec<Node> {
        let known = self.as_sound(unit, held, inputs).or_else(|| unit.as_before(inputs));
        let outputs = known.unwrap_or_else(|| self.evaluate(unit, held, inputs));
        if self.done.is_none() {
            let changed = unit.quiet.is_none();
            let did = Did { inputs: inputs.to_vec(), outputs: outputs.clone(), changed };
            self.did.resize(self.did.len().max(unit.number + 1), None);
            self.did[unit.number] = Some(did);
        }
        outputs
    }

    /// The outputs, where the instance holds what the sound design's does and gets the same inputs.
    fn as_sound(&self, unit: &mut Unit, held: &mut Held, inputs: &[Node]) -> Option<Vec<Node>> {
        let done = self.done.as_ref().filter(|_| unit.sound && unit.equal)?;
        let did = done.did.get(unit.number)?.as_ref().filter(|did| did.inputs == inputs)?;
        unit.wake();
        if did.changed {
            held.copy(unit, done.held);
        } else {
            unit.quiet = Some((inputs.to_vec(), did.outputs.clone()));
        }
        Some(did.outputs.clone())
    }

    fn evaluate(&mut self, unit: &mut Unit, held: &mut Held, inputs: &[Node]) -> Vec<Node> {
        let module = &self.netlist.modules[unit.module];
        let mut wires: Vec<Node> = Vec::with_capacity(module.wires.len());
        let mut outputs: Vec<Option<Vec<Node>>> = vec![None; module.instances.len()];
        let given = |wires: &[Node], own: usize| -> Vec<Node> {
            module.instances[own].inputs.iter().map(|node| wires[node.0 as usize]).collect()
        };
        for wire in &module.wires {
            let node = match wire.op {
                Op::Input(port) => self.terms.with_format(inputs[port], wire.format),
                Op::Register(own) => held.registers[unit.registers.start + own],
                Op::Data(own) => held.data[unit.memories.start + own],
                Op::Output(own, port) => {
                    let of_instance = outputs[own].get_or_insert_with(|| {
                        self.clock(&mut unit.instances[own], held, &given(&wires, own))
                    });
                    self.terms.with_format(of_instance[port], wire.format)
                }
                ref op => {
                    self.terms.of(op.with_operands(|node| wires[node.0 as usize]), wire.format)
                }
            };
            wires.push(node);
        }
        for own in (0..module.instances.len()).filter(|own| outputs[*own].is_none()) {
            self.clock(&mut unit.instances[own], held, &given(&wires, own));
        }
        let changes = self.next(unit, held, &wires);
        let of = |port: &Named| wires[port.node.0 as usize];
        let outputs: Vec<Node> = module.outputs.iter().map(of).collect();
        unit.quiet = (!changes).then(|| (inputs.to_vec(), outputs.clone()));
        unit.equal =
            unit.sound && self.done.as_ref().is_some_and(|done| held.equals(unit, done.held));
        outputs
    }

    /// What the registers and memories of an instance hold next; whether anything in it or in the instances within changes.
    fn next(&mut self, unit: &Unit, held: &mut Held, wires: &[Node]) -> bool {
        let module = &self.netlist.modules[unit.module];
        let of = |node: Node| wires[node.0 as usize];
        let mut changes = unit.instances.iter().any(|instance| instance.quiet.is_none());
        for (own, register) in module.registers.iter().enumerate() {
            let next = self.terms.with_format(of(register.node), register.format);
            let before = std::mem::replace(&mut held.registers[unit.registers.start + own], next);
            changes |= before != next;
        }
        for (own, ram) in module.memories.iter().enumerate() {
            let at = unit.memories.start + own;
            let (data, words) = (&mut held.data[at], &mut held.words[at]);
            changes |= access(self.terms, ram, (data, words), of);
        }
        changes
    }
}
