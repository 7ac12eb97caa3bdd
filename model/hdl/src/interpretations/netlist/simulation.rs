// SPDX-License-Identifier: MIT OR Apache-2.0
//! A netlist, clocked as it stands: operation by operation, for tests that change the graph
//! ([`mutants`](super::mutants)). Results are those of the clocked interpretation, with one
//! difference: what does not fit a `Proved` or `Assumed` narrowing wraps, as it does in the printed
//! Verilog.

use super::{Module, Netlist, Node, Op, Ram};
use crate::block::{Block, Edit, Inputs, Outputs, State, Submodule, Visitor};
use crate::bundle::{Bundle, Field};
use crate::format::Format;
use crate::interpretations::Codes;
use crate::memory::{Memory, Storage, Write};
use crate::signal::{Overflow, Signal, Value};

/// An instance of a module: where its registers and memories begin, and what its wires carry.
#[derive(Debug, Clone)]
pub(super) struct Unit {
    pub(super) module: usize,
    pub(super) registers: usize,
    pub(super) memories: usize,
    wires: Vec<i64>,
    pub(super) instances: Vec<Unit>,
}

impl Unit {
    /// How many wires there are, those of instances among them.
    pub(super) fn wires(&self) -> usize {
        self.wires.len() + self.instances.iter().map(Unit::wires).sum::<usize>()
    }
}

/// The instances of a design, and how many registers and memories there are.
pub(super) fn units(netlist: &Netlist) -> (Unit, usize, usize) {
    let mut held = Held::default();
    let top = held.unit(netlist, netlist.modules.len() - 1, "");
    (top, held.registers.len(), held.memories.len())
}

/// What the registers and memories of a design hold.
#[derive(Debug, Default, Clone)]
struct Held {
    registers: Vec<i64>,
    next: Vec<i64>,
    memories: Vec<(Memory, Codes)>,
    names: Names,
}

/// The path of each register and memory, in the order of [`Held`].
#[derive(Debug, Default, Clone)]
struct Names {
    registers: Vec<String>,
    memories: Vec<String>,
}

/// A design, its registers and memories at reset or later.
#[derive(Debug, Clone)]
pub struct Simulation {
    netlist: Netlist,
    top: Unit,
    held: Held,
    /// Where the registers and memories of a block's state are held, once they are known.
    places: Option<Places>,
}

impl Simulation {
    /// The design at reset.
    pub fn new(netlist: Netlist) -> Self {
        let mut held = Held::default();
        let top = held.unit(&netlist, netlist.modules.len() - 1, "");
        Simulation { netlist, top, held, places: None }
    }

    /// Runs one cycle: the codes of the inputs, in their order; those of the outputs.
    pub fn clock(&mut self, inputs: &[i64]) -> Vec<i64> {
        self.held.next.clone_from(&self.held.registers);
        let outputs = clock(&self.netlist, &mut self.top, &mut self.held, inputs);
        std::mem::swap(&mut self.held.registers, &mut self.held.next);
        outputs
    }

    /// Lets a register of every instance of a module, both by their index, hold a code.
    pub fn set(&mut self, module: usize, register: usize, code: i64) {
        fn visit(unit: &Unit, seen: &mut impl FnMut(&Unit)) {
            seen(unit);
            unit.instances.iter().for_each(|unit| visit(unit, seen));
        }
        visit(&self.top, &mut |unit| {
            if unit.module == module {
                self.held.registers[unit.registers + register] = code;
            }
        });
    }
}

impl Held {
    /// An instance with its registers at zero and its memories at their first words.
    fn unit(&mut self, netlist: &Netlist, module: usize, path: &str) -> Unit {
        let of = &netlist.modules[module];
        let (registers, memories) = (self.registers.len(), self.memories.len());
        self.registers.resize(registers + of.registers.len(), 0);
        self.names.registers.extend(of.registers.iter().map(|own| format!("{path}.{}", own.name)));
        self.names.memories.extend(of.memories.iter().map(|own| format!("{path}.{}", own.name)));
        self.memories.extend(of.memories.iter().map(memory));
        let instances = of.instances.iter();
        let instances = instances
            .map(|own| self.unit(netlist, own.module, &format!("{path}.{}", own.name)))
            .collect();
        Unit { module, registers, memories, wires: vec![0; of.wires.len()], instances }
    }
}

fn memory(ram: &Ram) -> (Memory, Codes) {
    let &Ram { name, format, collision, block, ref initial, .. } = ram;
    let reals = initial.iter().map(|&code| format.real(code)).collect();
    let memory = Memory { name, words: initial.len(), format, collision, block, initial: reals };
    let codes = i64::words(&memory);
    (memory, codes)
}

/// One cycle of an instance: its outputs; registers go to `held.next`.
fn clock(netlist: &Netlist, unit: &mut Unit, held: &mut Held, inputs: &[i64]) -> Vec<i64> {
    let module = &netlist.modules[unit.module];
    let Unit { registers, memories, wires, instances, .. } = unit;
    let mut outputs: Vec<Option<Vec<i64>>> = vec![None; instances.len()];
    for (index, wire) in module.wires.iter().enumerate() {
        wires[index] = match wire.op {
            Op::Input(port) => inputs[port],
            Op::Register(own) => held.registers[*registers + own],
            Op::Data(own) => {
                let (memory, codes) = &mut held.memories[*memories + own];
                i64::data(memory, codes)
            }
            Op::Output(own, port) => {
                let (instance, given) = (&mut instances[own], &module.instances[own].inputs);
                outputs[own]
                    .get_or_insert_with(|| clock(netlist, instance, held, &codes(wires, given)))
                    [port]
            }
            ref op => operate(op, module, wires, wire.format),
        };
    }
    // An instance without outputs that anything reads has registers all the same.
    for (own, instance) in
        instances.iter_mut().enumerate().filter(|(own, _)| outputs[*own].is_none())
    {
        clock(netlist, instance, held, &codes(wires, &module.instances[own].inputs));
    }
    for (own, register) in module.registers.iter().enumerate() {
        held.next[*registers + own] = wires[register.node.0 as usize];
    }
    for (ram, (memory, codes)) in module.memories.iter().zip(&mut held.memories[*memories..]) {
        access(ram, memory, codes, module, wires);
    }
    module.outputs.iter().map(|port| wires[port.node.0 as usize]).collect()
}

fn codes(wires: &[i64], nodes: &[Node]) -> Vec<i64> {
    nodes.iter().map(|node| wires[node.0 as usize]).collect()
}

/// The result of an operation on wires of a module, whose codes are `wires`.
///
/// # Panics
/// Where the operation takes nothing from wires: that of a port, register, memory or instance.
pub fn operate(op: &Op, module: &Module, wires: &[i64], to: Format) -> i64 {
    let of = |node: Node| signal(node, module, wires);
    match *op {
        Op::Constant(code) => code,
        Op::Add(a, b) => i64::add(of(a), of(b), to),
        Op::Sub(a, b) => i64::sub(of(a), of(b), to),
        Op::Mul(a, b) => i64::mul(of(a), of(b), to),
        Op::Abs(a) => <i64 as Value>::abs(of(a), to),
        Op::Fit(a, rounding, Overflow::Proved | Overflow::Assumed(_)) => {
            i64::quantize(of(a), to, rounding, Overflow::Wrap)
        }
        Op::Fit(a, rounding, overflow) => i64::quantize(of(a), to, rounding, overflow),
        Op::Scale(a) => of(a).value,
        Op::Bits(a, low) => i64::bits(of(a), low, to),
        Op::Concat(high, low) => i64::concat(of(high), of(low), to),
        Op::Less(a, b) => i64::less(of(a), of(b)),
        Op::Equal(a, b) => i64::equal(of(a), of(b)),
        Op::And(a, b) => of(a).value & of(b).value,
        Op::Or(a, b) => of(a).value | of(b).value,
        Op::Not(a) => i64::not(of(a).value),
        Op::Select(bit, a, b) => i64::select(of(bit).value, of(a), of(b), to),
        Op::Input(_) | Op::Register(_) | Op::Data(_) | Op::Output(..) => {
            unreachable!("not computed from wires")
        }
    }
}

fn signal(node: Node, module: &Module, wires: &[i64]) -> Signal<i64> {
    let index = node.0 as usize;
    Signal { value: wires[index], format: module.wires[index].format }
}

/// One cycle of a memory. Writes beyond it are lost.
fn access(ram: &Ram, memory: &Memory, codes: &mut Codes, module: &Module, wires: &[i64]) {
    let Some(address) = ram.address else { return };
    let of = |node| signal(node, module, wires);
    let write = ram.write.map(|(enable, address, data)| Write {
        enable: of(enable),
        address: of(address),
        data: of(data),
    });
    let write = write.filter(|write| (write.address.value as usize) < memory.words);
    i64::access(memory, codes, of(address), write);
}

impl Simulation {
    /// Clocks the design in place of the block that it was read from: registers and memories are those of
    /// `state`, which a test may read and change. Registers that the block does not have keep what they hold.
    pub fn step<B: Block>(
        &mut self,
        block: &B,
        state: &mut State<B, i64>,
        inputs: Inputs<B, i64>,
    ) -> Outputs<B, i64> {
        self.exchange(block, state, |held, own| *held = *own);
        let mut given = Vec::new();
        B::Inputs::each(B::Inputs::zip(inputs, block.inputs()), |_, (code, format)| {
            given.extend((!format.is_none()).then_some(code));
        });
        let mut outputs = self.clock(&given).into_iter();
        self.exchange(block, state, |held, own| *own = *held);
        B::Outputs::map(block.outputs(), |format| {
            if format.is_none() { 0 } else { outputs.next().expect("a port for each output") }
        })
    }

    /// The state of the block at reset, and what registers of the design start with.
    pub fn reset<B: Block>(&mut self, block: &B) -> State<B, i64> {
        let mut state = block.reset();
        // Memories are swapped, twice.
        self.exchange(block, &mut state, |_, _| ());
        self.exchange(block, &mut state, |held, own| *own = *held);
        state
    }

    /// Goes through all registers of a state, and swaps the words of memories: those of the state are the design's
    /// while it is clocked.
    fn exchange<B: Block>(
        &mut self,
        block: &B,
        state: &mut State<B, i64>,
        register: fn(&mut i64, &mut i64),
    ) {
        let places = self.places.get_or_insert_with(|| {
            let (path, found) = (Vec::new(), Places::default());
            let mut search = Search { names: &self.held.names, path, found };
            block.visit("", state, &mut search);
            search.found
        });
        let [registers, memories] =
            [&places.registers, &places.memories].map(|places| places.iter());
        block.edit(state, &mut Exchange { held: &mut self.held, registers, memories, register });
    }
}

/// Where in [`Held`] each register and memory of a block's state lies, in the order of an [`Edit`]; those that the
/// netlist does not have lie nowhere.
#[derive(Debug, Default, Clone)]
struct Places {
    registers: Vec<Option<usize>>,
    memories: Vec<Option<usize>>,
}

/// Looks for the places.
struct Search<'a> {
    names: &'a Names,
    path: Vec<&'static str>,
    found: Places,
}

impl Search<'_> {
    fn place(&self, name: &str, names: &[String]) -> Option<usize> {
        let path = format!("{}.{name}", self.path.join("."));
        names.iter().position(|known| *known == path)
    }
}

impl Visitor<i64> for Search<'_> {
    fn enter(&mut self, name: &'static str) {
        self.path.push(name);
    }

    fn register(&mut self, field: &'static Field, _format: Format, _value: i64) {
        let place = self.place(field.name, &self.names.registers);
        self.found.registers.push(place);
    }

    fn memory(&mut self, memory: &Memory, _words: &Codes) {
        let place = self.place(memory.name, &self.names.memories);
        self.found.memories.push(place);
    }

    fn leave(&mut self) {
        self.path.pop();
    }
}

/// Exchanges what a state and a design hold.
struct Exchange<'a, I> {
    held: &'a mut Held,
    registers: I,
    memories: I,
    register: fn(&mut i64, &mut i64),
}

impl<'a, I: Iterator<Item = &'a Option<usize>>> Edit<i64> for Exchange<'a, I> {
    fn word(&mut self, _format: Format, mut value: i64) -> i64 {
        if let Some(place) = self.registers.next().expect("seen before") {
            (self.register)(&mut self.held.registers[*place], &mut value);
        }
        value
    }

    fn memory(&mut self, _memory: &Memory, words: &mut Codes) {
        if let Some(place) = self.memories.next().expect("seen before") {
            std::mem::swap(&mut self.held.memories[*place].1, words);
        }
    }
}

#[cfg(test)]
mod tests;
