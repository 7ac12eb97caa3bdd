// SPDX-License-Identifier: MIT OR Apache-2.0
//! Mutants of a netlist: faults of hardware, made in the graph.
//!
//! | class | what is wrong |
//! | --- | --- |
//! | missing reset | a register starts with another code: 1 of a bit, the last state, else its largest code |
//! | missing clear | a register's next value, or an instance's input, ignores an input that begins anew ([`BEGINS`]) |
//! | sticky flag | a register of one bit that is set stays set |
//! | held one clock | a register of one bit, or a state, follows one cycle late |
//! | stale operand | an operand of a sum, difference or product, of a memory or of an instance is what it was one cycle before |
//!
//! A mutant is a netlist again: it can be clocked ([`Simulation`]) and printed. A fault in a module
//! is in all of its instances. Registers of blocks that do not [reset](crate::block::Interface::RESETS) have no
//! *missing reset*.

use super::simulation::Simulation;
use super::start::is_irrelevant;
use super::{Module, Named, Netlist, Node, Op, Wire};
use crate::format::{BIT, Format};
use std::collections::HashMap;
use std::fmt;

/// The inputs of blocks that make registers begin anew.
pub const BEGINS: [&str; 5] = ["clear", "restart", "first", "start", "reset"];

/// What is wrong, and where in its module.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
enum Fault {
    /// This register.
    Reset(usize),
    /// This input, for this sink.
    Clear(usize, Sink),
    /// This register.
    Sticky(usize),
    /// This register.
    Held(usize),
    /// This place.
    Stale(Sink),
}

/// What a register of every instance of a module starts with; both by their index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Start {
    /// The module.
    pub module: usize,
    /// Its register.
    pub register: usize,
    /// The code.
    pub code: i64,
}

/// A place where a node is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Sink {
    /// What this register takes next.
    Register(usize),
    /// This input of this instance.
    Instance(usize, usize),
    /// This operand of this wire: 0 or 1.
    Operand(usize, usize),
    /// Address (0), or enable, address and data of the write port (1, 2, 3) of this memory.
    Memory(usize, usize),
}

/// One fault in a module.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Mutant {
    /// The name of the module.
    pub module: &'static str,
    /// Its register, instance or wire, and what is wrong.
    pub place: String,
    /// The class.
    pub class: &'static str,
    fault: Fault,
}

impl fmt::Display for Mutant {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}.{}: {}", self.module, self.place, self.class)
    }
}

impl Mutant {
    /// All mutants of a module.
    pub fn all(netlist: &Netlist, module: &Module) -> Vec<Mutant> {
        let faults = resets(module)
            .chain(clears(module))
            .chain(of_bits(module))
            .chain(sinks(module).map(Fault::Stale));
        let named = |fault: Fault| {
            let (place, class) = described(netlist, module, &fault);
            Mutant { module: module.name, place, class, fault }
        };
        faults.map(named).collect()
    }

    /// The netlist with the fault of this name in each module that has it, and the registers that start with another code
    /// than zero; `None` where no module has it.
    pub fn netlist(netlist: &Netlist, name: &str) -> Option<(Netlist, Vec<Start>)> {
        let (mut mutated, mut starts) = (netlist.clone(), Vec::new());
        let mut found = false;
        for (index, own) in mutated.modules.iter_mut().enumerate() {
            let module = &netlist.modules[index];
            if !name.strip_prefix(module.name).is_some_and(|rest| rest.starts_with('.')) {
                continue;
            }
            let all = Mutant::all(netlist, module);
            let Some(mutant) = all.iter().find(|mutant| mutant.to_string() == name) else {
                continue;
            };
            found = true;
            let start = mutant.start(module);
            starts.extend(start.map(|(register, code)| Start { module: index, register, code }));
            mutant.change(own);
        }
        found.then_some((mutated, starts))
    }

    /// [`Mutant::netlist`], clocked.
    pub fn simulation(netlist: &Netlist, name: &str) -> Option<Simulation> {
        let (mutated, starts) = Mutant::netlist(netlist, name)?;
        let mut simulation = Simulation::new(mutated);
        for Start { module, register, code } in starts {
            simulation.set(module, register, code);
        }
        Some(simulation)
    }

    /// Whether it is proved that no output of the design, whose top the mutant is in, depends on it.
    pub fn is_equivalent(&self, netlist: &Netlist) -> bool {
        matches!(self.fault, Fault::Reset(register) if is_irrelevant(netlist, register))
    }
}

/// Registers that start with another code than zero.
fn resets(module: &Module) -> impl Iterator<Item = Fault> {
    let resets = 0..if module.resets { module.registers.len() } else { 0 };
    resets.map(Fault::Reset)
}

/// What depends on an input that begins anew.
fn clears(module: &Module) -> impl Iterator<Item = Fault> {
    let begins = |port: &usize| BEGINS.contains(&module.inputs[*port].name);
    let ports = (0..module.inputs.len()).filter(begins);
    let registers = (0..module.registers.len()).map(Sink::Register);
    let sinks: Vec<Sink> = registers.chain(given(module)).collect();
    ports.flat_map(move |port| {
        let depends = depending(module, port);
        let sinks = sinks.clone().into_iter();
        let sinks = sinks.filter(move |sink| depends[sink.node(module).0 as usize]);
        sinks.map(move |sink| Fault::Clear(port, sink))
    })
}

/// Which wires depend on an input without a register between them.
fn depending(module: &Module, port: usize) -> Vec<bool> {
    let mut depends = Vec::new();
    for wire in &module.wires {
        let mut any = wire.op == Op::Input(port);
        wire.op.with_operands(|operand| {
            any |= depends[operand.0 as usize];
            operand
        });
        depends.push(any);
    }
    depends
}

/// Registers of one bit that stay set; those and states that are late.
fn of_bits(module: &Module) -> impl Iterator<Item = Fault> {
    let bits = |register: &Named| register.format == BIT;
    let all = || module.registers.iter().enumerate();
    let sticky = all().filter(move |(_, of)| bits(of)).map(|(own, _)| Fault::Sticky(own));
    let held = all().filter(move |(_, of)| bits(of) || !of.states.is_empty());
    sticky.chain(held.map(|(own, _)| Fault::Held(own)))
}

/// The inputs of instances and memories.
fn given(module: &Module) -> impl Iterator<Item = Sink> {
    let instances = module.instances.iter().enumerate();
    let ports = instances
        .flat_map(|(own, of)| (0..of.inputs.len()).map(move |port| Sink::Instance(own, port)));
    let memories = module.memories.iter().enumerate().filter(|(_, of)| of.address.is_some());
    let of_memories = memories.flat_map(|(own, of)| {
        (0..if of.write.is_some() { 4 } else { 1 }).map(move |port| Sink::Memory(own, port))
    });
    ports.chain(of_memories)
}

/// Places whose operand may be stale: those that are no constants.
fn sinks(module: &Module) -> impl Iterator<Item = Sink> {
    let arithmetic = |wire: &Wire| matches!(wire.op, Op::Add(..) | Op::Sub(..) | Op::Mul(..));
    let wires = module.wires.iter().enumerate().filter(move |(_, wire)| arithmetic(wire));
    let operands = wires.flat_map(|(own, _)| [0, 1].map(|operand| Sink::Operand(own, operand)));
    let varies = |sink: &Sink| {
        let node = sink.node(module);
        !matches!(module.wires[node.0 as usize].op, Op::Constant(_))
    };
    given(module).chain(operands).filter(varies)
}

/// The name of a place and the class of its fault.
fn described(netlist: &Netlist, module: &Module, fault: &Fault) -> (String, &'static str) {
    let register = |own: usize| module.registers[own].name.to_string();
    match *fault {
        Fault::Reset(own) => (register(own), "missing reset"),
        Fault::Sticky(own) => (register(own), "sticky flag"),
        Fault::Held(own) => (register(own), "held one clock"),
        Fault::Stale(sink) => (sink.name(netlist, module), "stale operand"),
        Fault::Clear(port, sink) => {
            let name = sink.name(netlist, module);
            (format!("{name} of {}", module.inputs[port].name), "missing clear")
        }
    }
}

impl Sink {
    fn node(self, module: &Module) -> Node {
        let used = "a sink of this module";
        let write = |own: usize| module.memories[own].write.expect(used);
        match self {
            Sink::Register(own) => module.registers[own].node,
            Sink::Instance(own, port) => module.instances[own].inputs[port],
            Sink::Operand(own, operand) => pair(&module.wires[own].op)[operand],
            Sink::Memory(own, 0) => module.memories[own].address.expect(used),
            Sink::Memory(own, port) => <[Node; 3]>::from(write(own))[port - 1],
        }
    }

    /// Puts another node there.
    fn put(self, module: &mut Module, node: Node) {
        match self {
            Sink::Register(own) => module.registers[own].node = node,
            Sink::Instance(own, port) => module.instances[own].inputs[port] = node,
            Sink::Operand(own, operand) => {
                let mut index = 0;
                let op = module.wires[own].op.with_operands(|before| {
                    index += 1;
                    if index - 1 == operand { node } else { before }
                });
                module.wires[own].op = op;
            }
            Sink::Memory(own, 0) => module.memories[own].address = Some(node),
            Sink::Memory(own, port) => {
                let mut all = <[Node; 3]>::from(module.memories[own].write.expect("a write port"));
                all[port - 1] = node;
                module.memories[own].write = Some(all.into());
            }
        }
    }

    fn name(self, netlist: &Netlist, module: &Module) -> String {
        match self {
            Sink::Register(own) => module.registers[own].name.to_string(),
            Sink::Instance(own, port) => {
                let instance = &module.instances[own];
                format!("{}.{}", instance.name, netlist.modules[instance.module].inputs[port].name)
            }
            Sink::Operand(own, operand) => format!("{} operand {operand}", operation(module, own)),
            Sink::Memory(own, port) => {
                let ports = ["address", "write enable", "write address", "write data"];
                format!("{}.{}", module.memories[own].name, ports[port])
            }
        }
    }
}

/// Both operands of an arithmetic operation.
fn pair(op: &Op) -> [Node; 2] {
    match *op {
        Op::Add(a, b) | Op::Sub(a, b) | Op::Mul(a, b) => [a, b],
        _ => unreachable!("only arithmetic has stale operands"),
    }
}

/// The name of an operation: that of its wire, or which of its kind it is.
fn operation(module: &Module, own: usize) -> String {
    let kind = |wire: &Wire| match wire.op {
        Op::Add(..) => "sum",
        Op::Sub(..) => "difference",
        _ => "product",
    };
    let wires = &module.wires;
    let arithmetic = wires[..own].iter().filter(|wire| {
        matches!(wire.op, Op::Add(..) | Op::Sub(..) | Op::Mul(..))
            && kind(wire) == kind(&wires[own])
    });
    let count = arithmetic.count();
    let name = wires[own].name.map(|name| format!(" ({name})")).unwrap_or_default();
    format!("{} {count}{name}", kind(&wires[own]))
}

impl Mutant {
    /// The register that starts with another code, and this code.
    fn start(&self, module: &Module) -> Option<(usize, i64)> {
        let Fault::Reset(own) = self.fault else { return None };
        let register = &module.registers[own];
        let states = register.states.len() as i64;
        let code = if states > 0 { states - 1 } else { register.format.max_code() as i64 };
        Some((own, code))
    }

    /// Makes the fault.
    fn change(&self, module: &mut Module) {
        match self.fault {
            Fault::Reset(_) => return,
            Fault::Clear(port, sink) => {
                let node = sink.node(module);
                let node = Copy::without(port).of(module, node);
                sink.put(module, node);
            }
            Fault::Sticky(own) => {
                let held = wire(module, Op::Register(own), BIT);
                let node = module.registers[own].node;
                module.registers[own].node = wire(module, Op::Or(node, held), BIT);
            }
            Fault::Held(own) => late(module, Sink::Register(own)),
            Fault::Stale(sink) => late(module, sink),
        }
        sort(module);
    }
}

/// A wire at the end of a module.
fn wire(module: &mut Module, op: Op, format: Format) -> Node {
    module.wires.push(Wire { op, format, name: None });
    Node(module.wires.len() as u32 - 1)
}

/// Puts a register before a place.
fn late(module: &mut Module, sink: Sink) {
    let node = sink.node(module);
    let format = module.wires[node.0 as usize].format;
    let late = wire(module, Op::Register(module.registers.len()), format);
    sink.put(module, late);
    module.registers.push(Named { name: "late", format, states: &[], about: "", node });
}

/// Copies what a node depends on, with a port that is never set.
struct Copy {
    port: usize,
    known: HashMap<Node, Node>,
}

impl Copy {
    fn without(port: usize) -> Self {
        Copy { port, known: HashMap::new() }
    }

    /// The copy of a node; the node itself where it does not depend on the port.
    fn of(&mut self, module: &mut Module, node: Node) -> Node {
        if let Some(&known) = self.known.get(&node) {
            return known;
        }
        let Wire { op, format, .. } = module.wires[node.0 as usize].clone();
        let copied = match op {
            Op::Input(port) if port == self.port => Op::Constant(0),
            ref op => op.with_operands(|operand| self.of(module, operand)),
        };
        let copy = if copied == op { node } else { wire(module, copied, format) };
        self.known.insert(node, copy);
        copy
    }
}

/// Puts the wires of a module in an order in which each depends only on those before it.
fn sort(module: &mut Module) {
    let old = std::mem::take(&mut module.wires);
    let mut order =
        Order { old, instances: &module.instances, wires: Vec::new(), new: HashMap::new() };
    (0..order.old.len() as u32).for_each(|node| {
        order.place(Node(node));
    });
    let Order { wires, new, .. } = order;
    module.wires = wires;
    let moved = |node: &mut Node| *node = new[node];
    module.outputs.iter_mut().chain(&mut module.registers).for_each(|of| moved(&mut of.node));
    module.inputs.iter_mut().for_each(|of| moved(&mut of.node));
    module.instances.iter_mut().flat_map(|of| &mut of.inputs).for_each(moved);
    module.invariants.iter_mut().for_each(|(_, node)| moved(node));
    module.held.iter_mut().for_each(|(node, _)| moved(node));
    for memory in &mut module.memories {
        memory.address.iter_mut().for_each(moved);
        let write = memory.write.iter_mut();
        write.flat_map(|(enable, address, data)| [enable, address, data]).for_each(moved);
    }
}

struct Order<'a> {
    old: Vec<Wire>,
    instances: &'a [super::Instance],
    wires: Vec<Wire>,
    new: HashMap<Node, Node>,
}

impl Order<'_> {
    fn place(&mut self, node: Node) -> Node {
        if let Some(&new) = self.new.get(&node) {
            return new;
        }
        let Wire { op, format, name } = self.old[node.0 as usize].clone();
        if let Op::Output(instance, _) = op {
            self.instances[instance].inputs.iter().for_each(|input| {
                self.place(*input);
            });
        }
        let op = op.with_operands(|operand| self.place(operand));
        self.wires.push(Wire { op, format, name });
        let new = Node(self.wires.len() as u32 - 1);
        self.new.insert(node, new);
        new
    }
}

#[cfg(test)]
mod tests;
